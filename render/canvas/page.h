// SPDX-License-Identifier: GPL-2.0-or-later
// The page that every drawing routine is handed, from its beginning to its file, and the few sizes
// all figures share. Sizes are in printer's points: a figure is drawn for print, whatever its
// pixels.
#ifndef AMONTONS_RENDER_CANVAS_PAGE_H
#define AMONTONS_RENDER_CANVAS_PAGE_H

#include "amontons_pictures.h"
#include "render/canvas/drawing.h"
#include "render/canvas/text.h"

typedef struct Page {
    Canvas *canvas;   // owned
    Text *text;   // owned
    double point;   // pixels in a printed point, times what the style enlarges all by
    Box room;   // what the figure may fill, pixels: not title and foot, and of panels one
    double beside
        [2];   // pixels left and right of the frame at least: panels with frames below each other
    Box *frame;   // where the frame came to lie; not owned; NULL: nobody asks
    bool bare_x;   // numbers of U stand below the next panel
    const char *zoom_name;   // of what contact-density enlarges, on this page; NULL: it is not here
    PictureStyle style;   // as asked; its texts borrowed
} Page;

typedef struct PageDef {
    const PictureStyle *style;
    double height;   // of the figure over the page's width
    const char *title;   // drawn above the figure, shrunk to fit; NULL or empty: none
    double foot;   // points below the figure
} PageDef;

// Points in the width of a page of this style.
double page_width(const PictureStyle *style);

// Height over width of a figure that may have any shape: `shape` on a column, less on a wider page,
// as nobody has a curve twice as high because it is twice as wide.
double page_shape(const PictureStyle *style, double shape);

// The words above a figure whose own title this is: what the style asks for; "": none.
const char *page_title(const PictureStyle *style, const char *own, bool by_default);

// A page that is empty but for its title. ERROR_INPUT: a format there is none of, or a size beyond
// what canvas allows.
bool page_begin(Page *page, const PageDef *def, Error *err);

// Writes the picture into the file `path`, with `title` stored in it.
bool page_finish(Page *page, const char *path, const char *title, Error *err);
void page_destroy(Page *page);   // zeroed is fine

// The style with the format that the file's name ends in; ERROR_INPUT: in none.
bool page_style_of_name(const char *path, PictureStyle *style, Error *err);

// Lines below a figure, outside of its axes: the warnings of the run that it shows.
enum { FOOT_LINES_MAX = 6, FOOT_LINE_SIZE = 160 };

typedef struct Foot {
    int32_t count;
    char line[FOOT_LINES_MAX][FOOT_LINE_SIZE];   // [count]
} Foot;

// warnings: one a line; "": none. width: of the page, points.
// Words that do not fit are left to run.json, and the last line says so.
Foot foot_wrap(const char *warnings, double width);
double foot_height(const Foot *foot);   // points; 0 without lines
void foot_draw(const Page *page, const Foot *foot);

static const double LABEL_SIZE = 8;   // points: names of axes
static const double NUMBER_SIZE = 7.2;   // points: numbers at ticks
static const double SMALL_SIZE = 7;   // points: inside an inset, notes
static const double FRAME_WIDTH = 0.5;   // points: frames and ticks
static const double CURVE_WIDTH = 0.8;   // points: data

static const Color INK = {0.08f, 0.08f, 0.10f, 1};
static const Color PAPER = {1, 1, 1, 1};
static const Color ZOOM_FORCE = {0.75f, 0.12f, 0.12f, 1};   // outlines what an inset shows
static const Color ZOOM_DENSITY = {0.08f, 0.35f, 0.70f, 1};   // outlines the contact-density map

#endif
