// SPDX-License-Identifier: GPL-2.0-or-later
// Lines, boxes and marks on a canvas. Called by axes and the figures.
#ifndef AMONTONS_RENDER_CANVAS_DRAWING_H
#define AMONTONS_RENDER_CANVAS_DRAWING_H

#include "render/canvas/canvas.h"

typedef struct Stroke {
    Color color;
    double width;   // pixels
    double dash, space;   // lengths along the line, pixels; dash 0: solid
} Stroke;

// A line that is drawn as its points come, joined and ended round; a point that is not finite
// breaks it.
typedef struct LinePen {
    cairo_t *cairo;
    bool dashed, down;   // down: the line goes on from `last`
    int32_t in_piece;   // points of it so far
    double
        thin;   // a point nearer than this to the one before adds nothing, pixels; 0: all are drawn
    Point last;
} LinePen;
LinePen line_begin(Canvas *canvas, const Stroke *stroke);
void line_add(LinePen *pen, Point point);
void line_end(LinePen *pen);

// The same through [count] points.
void draw_line(Canvas *canvas, const Stroke *stroke, const Point *points, int64_t count);
void draw_segment(Canvas *canvas, const Stroke *stroke, Point from, Point to);
void draw_outline(Canvas *canvas, const Stroke *stroke, const Box *box);   // corners square
void draw_fill(Canvas *canvas, Color color, const Box *box);
void draw_disc(Canvas *canvas, Color color, Point centre, double radius);
// A polygon of [count] corners that go round.
void draw_polygon(Canvas *canvas, Color color, const Point *corners, int32_t count);
// Slanting lines `spacing` pixels apart over `box`: where there is nothing to show.
void draw_hatch(Canvas *canvas, const Stroke *stroke, const Box *box, double spacing);

#endif
