// SPDX-License-Identifier: GPL-2.0-or-later
// The legend of a figure that is no plot: what its marks mean, in lines below it. Called by the
// figures.
#ifndef AMONTONS_RENDER_CANVAS_KEY_H
#define AMONTONS_RENDER_CANVAS_KEY_H

#include "render/canvas/page.h"

typedef enum KeyMark {
    KEY_NONE,
    KEY_LINE,
    KEY_DASHED,
    KEY_DISC,
    KEY_RING,
    KEY_BACK,   // a triangle that points left
    KEY_HATCH,
    KEY_PATCH
} KeyMark;

typedef struct KeyEntry {
    KeyMark mark;
    Color color;
    const char *words;
} KeyEntry;

// The triangle of KEY_BACK as large as a disc of this radius, pixels.
void key_draw_back(Canvas *canvas, Color color, Point centre, double radius);

// Draws the entries at the foot of the page's room, which becomes lower by that; nothing where the
// style wants no legend.
void key_draw(Page *page, const KeyEntry *entries, int32_t count);

// Points that they take where they are one line.
double key_line_height(void);

// Radius of the discs and width of the lines, points.
static const double KEY_RADIUS = 1.4;

#endif
