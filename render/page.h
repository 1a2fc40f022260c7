// SPDX-License-Identifier: GPL-2.0-or-later
// What every drawing routine is handed, and the few sizes all figures share. Sizes are in printer's
// points at the width of one journal column: a figure is drawn for that print, whatever its pixels.
#ifndef AMONTONS_RENDER_PAGE_H
#define AMONTONS_RENDER_PAGE_H

#include "render/shapes.h"
#include "render/text.h"

typedef struct Page {
    Canvas *canvas;   // not owned
    Text *text;   // not owned
    double point;   // pixels in a printed point
    double foot;   // pixels kept free below the figure, a whole number
} Page;

static const double COLUMN_WIDTH_MM = 86;   // of a journal's column
static const double COLUMN_WIDTH_POINTS = 86 * 72 / 25.4;

static const double LABEL_SIZE = 7.5;   // points: names of axes
static const double NUMBER_SIZE = 6.8;   // points: numbers at ticks
static const double SMALL_SIZE = 6.0;   // points: inside an inset
static const double FRAME_WIDTH = 0.5;   // points: frames and ticks
static const double CURVE_WIDTH = 0.8;   // points: data

static const Color INK = {0.08f, 0.08f, 0.10f, 1};
static const Color PAPER = {1, 1, 1, 1};
static const Color ZOOM_FORCE = {0.75f, 0.12f, 0.12f, 1};   // outlines what an inset shows
static const Color ZOOM_DENSITY = {0.08f, 0.35f, 0.70f, 1};   // outlines the contact-density map

#endif
