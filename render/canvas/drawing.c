// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/drawing.h"

#include <cairo.h>

#include <math.h>
#include <stddef.h>

static const double PI = 3.14159265358979323846;

// Cairo's time to stroke a path grows faster than its length: a long one is stroked in pieces,
// which share a point. They are opaque, so that joints do not show.
enum { PIECE = 256 };

void draw_fill(Canvas *canvas, Color color, const Box *box)
{
    cairo_t *cairo = canvas_ink(canvas, color);
    cairo_rectangle(cairo, box->left, box->top, box->right - box->left, box->bottom - box->top);
    cairo_fill(cairo);
}

void draw_disc(Canvas *canvas, Color color, Point centre, double radius)
{
    cairo_t *cairo = canvas_ink(canvas, color);
    cairo_new_sub_path(cairo);
    cairo_arc(cairo, centre.x, centre.y, radius, 0, 2 * PI);
    cairo_fill(cairo);
}

void draw_polygon(Canvas *canvas, Color color, const Point *corners, int32_t count)
{
    cairo_t *cairo = canvas_ink(canvas, color);
    for (int32_t k = 0; k < count; ++k) cairo_line_to(cairo, corners[k].x, corners[k].y);
    cairo_close_path(cairo);
    cairo_fill(cairo);
}

static cairo_t *stroke_begin(Canvas *canvas, const Stroke *stroke, cairo_line_cap_t cap)
{
    cairo_t *cairo = canvas_ink(canvas, stroke->color);
    const double dashes[2] = {stroke->dash, stroke->space};
    cairo_set_line_width(cairo, stroke->width);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cairo, stroke->dash > 0 ? CAIRO_LINE_CAP_BUTT : cap);
    cairo_set_dash(cairo, dashes, stroke->dash > 0 ? 2 : 0, 0);
    return cairo;
}

LinePen line_begin(Canvas *canvas, const Stroke *stroke)
{
    return (LinePen){.cairo = stroke_begin(canvas, stroke, CAIRO_LINE_CAP_ROUND),
                     .dashed = stroke->dash > 0};
}

// A point alone becomes a dot. Dashes are not cut into pieces: each would begin anew.
void line_add(LinePen *pen, Point point)
{
    bool shown = isfinite(point.x) && isfinite(point.y);
    if (shown && pen->down && hypot(point.x - pen->last.x, point.y - pen->last.y) < pen->thin)
        return;
    if (shown && !pen->down) cairo_move_to(pen->cairo, point.x, point.y);
    pen->down = shown;
    if (!shown) return;
    pen->last = point;
    cairo_line_to(pen->cairo, point.x, point.y);
    if (++pen->in_piece < PIECE || pen->dashed) return;
    cairo_stroke(pen->cairo);
    cairo_move_to(pen->cairo, point.x, point.y);
    pen->in_piece = 0;
}

void line_end(LinePen *pen)
{
    cairo_stroke(pen->cairo);
}

void draw_line(Canvas *canvas, const Stroke *stroke, const Point *points, int64_t count)
{
    LinePen pen = line_begin(canvas, stroke);
    for (int64_t k = 0; k < count; ++k) line_add(&pen, points[k]);
    line_end(&pen);
}

void draw_segment(Canvas *canvas, const Stroke *stroke, Point from, Point to)
{
    cairo_t *cairo = stroke_begin(canvas, stroke, CAIRO_LINE_CAP_BUTT);
    cairo_move_to(cairo, from.x, from.y);
    cairo_line_to(cairo, to.x, to.y);
    cairo_stroke(cairo);
}

void draw_outline(Canvas *canvas, const Stroke *stroke, const Box *box)
{
    cairo_t *cairo = stroke_begin(canvas, stroke, CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_MITER);
    cairo_rectangle(cairo, box->left, box->top, box->right - box->left, box->bottom - box->top);
    cairo_stroke(cairo);
}

// Lines at 45 degrees that begin left of the box, as far as it is high; the clip cuts them off. A
// box beyond the page, as a damaged file may have one, is hatched on the page alone.
void draw_hatch(Canvas *canvas, const Stroke *stroke, const Box *box, double spacing)
{
    const Box seen = {fmax(box->left, 0), fmax(box->top, 0), fmin(box->right, canvas_width(canvas)),
                      fmin(box->bottom, canvas_height(canvas))};
    double height = seen.bottom - seen.top;
    canvas_clip(canvas, &seen);
    for (double x = seen.left - height; x < seen.right; x += spacing)
        draw_segment(canvas, stroke, (Point){x, seen.bottom}, (Point){x + height, seen.top});
    canvas_clip(canvas, NULL);
}
