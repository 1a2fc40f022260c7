// SPDX-License-Identifier: GPL-2.0-or-later
// Lines are quads with a disc at each joint. They are opaque, so overlapping pieces do not show.
#include "render/shapes.h"

#include <math.h>
#include <stddef.h>

enum { DISC_SIDES_MIN = 8, DISC_SIDES_MAX = 64 };

static const double PI = 3.14159265358979323846;

static Vertex vertex_at(Color color, double x, double y)
{
    return (Vertex){.x = (float)x, .y = (float)y, .color = color};
}

// Two triangles; the corners go round.
static void quad_fill(Canvas *canvas, Color color, const Point corner[4])
{
    static const int32_t order[6] = {0, 1, 2, 0, 2, 3};
    Vertex vertices[6];
    for (int32_t k = 0; k < 6; ++k)
        vertices[k] = vertex_at(color, corner[order[k]].x, corner[order[k]].y);
    canvas_triangles(canvas, PAINT_COLOR, vertices, 6);
}

void shape_fill(Canvas *canvas, Color color, const Box *box)
{
    const Point corner[4] = {{box->left, box->top},
                             {box->right, box->top},
                             {box->right, box->bottom},
                             {box->left, box->bottom}};
    quad_fill(canvas, color, corner);
}

// A regular polygon with as many sides as keep its edge round to a fraction of a pixel.
void shape_disc(Canvas *canvas, Color color, Point centre, double radius)
{
    int32_t sides = (int32_t)ceil(3 * sqrt(radius)) + DISC_SIDES_MIN;
    if (sides > DISC_SIDES_MAX) sides = DISC_SIDES_MAX;
    for (int32_t k = 0; k < sides; ++k) {
        double from = 2 * PI * k / sides, to = 2 * PI * (k + 1) / sides;
        Vertex vertices[3] = {
            vertex_at(color, centre.x, centre.y),
            vertex_at(color, centre.x + radius * cos(from), centre.y + radius * sin(from)),
            vertex_at(color, centre.x + radius * cos(to), centre.y + radius * sin(to))};
        canvas_triangles(canvas, PAINT_COLOR, vertices, 3);
    }
}

// A fan from the first corner, which a convex polygon allows.
void shape_polygon(Canvas *canvas, Color color, const Point *corners, int32_t count)
{
    for (int32_t k = 2; k < count; ++k) {
        Vertex vertices[3] = {vertex_at(color, corners[0].x, corners[0].y),
                              vertex_at(color, corners[k - 1].x, corners[k - 1].y),
                              vertex_at(color, corners[k].x, corners[k].y)};
        canvas_triangles(canvas, PAINT_COLOR, vertices, 3);
    }
}

// A solid piece without ends.
static void piece_draw(Canvas *canvas, const Stroke *stroke, Point from, Point to)
{
    double dx = to.x - from.x, dy = to.y - from.y, length = hypot(dx, dy);
    if (!(length > 0)) return;
    double across_x = -dy / length * stroke->width / 2, across_y = dx / length * stroke->width / 2;
    const Point corner[4] = {{from.x + across_x, from.y + across_y},
                             {to.x + across_x, to.y + across_y},
                             {to.x - across_x, to.y - across_y},
                             {from.x - across_x, from.y - across_y}};
    quad_fill(canvas, stroke->color, corner);
}

// The dashes of one segment; `done`: length along the line drawn before it.
static void dashes_draw(Canvas *canvas, const Stroke *stroke, Point from, Point to, double *done)
{
    double length = hypot(to.x - from.x, to.y - from.y), period = stroke->dash + stroke->space;
    double at = 0;
    while (at < length) {
        double phase = fmod(*done + at, period);
        bool inked = phase < stroke->dash;
        double end = fmin(length, at + (inked ? stroke->dash : period) - phase + 1e-9);
        if (inked) {
            double a = at / length, b = end / length;
            piece_draw(canvas, stroke,
                       (Point){from.x + a * (to.x - from.x), from.y + a * (to.y - from.y)},
                       (Point){from.x + b * (to.x - from.x), from.y + b * (to.y - from.y)});
        }
        at = end;
    }
    *done += length;
}

static bool point_is_finite(Point point)
{
    return isfinite(point.x) && isfinite(point.y);
}

// Discs of the line's width make joints and ends round. Dashes run on over the joints.
void shape_line(Canvas *canvas, const Stroke *stroke, const Point *points, int64_t count)
{
    double done = 0;
    for (int64_t k = 0; k < count; ++k) {
        if (!point_is_finite(points[k])) continue;
        if (stroke->dash <= 0) shape_disc(canvas, stroke->color, points[k], stroke->width / 2);
        if (k == 0 || !point_is_finite(points[k - 1])) continue;
        if (stroke->dash > 0)
            dashes_draw(canvas, stroke, points[k - 1], points[k], &done);
        else
            piece_draw(canvas, stroke, points[k - 1], points[k]);
    }
}

void shape_segment(Canvas *canvas, const Stroke *stroke, Point from, Point to)
{
    double done = 0;
    if (stroke->dash > 0)
        dashes_draw(canvas, stroke, from, to, &done);
    else
        piece_draw(canvas, stroke, from, to);
}

// Four bars that overlap at the corners, so these are square.
void shape_outline(Canvas *canvas, const Stroke *stroke, const Box *box)
{
    double half = stroke->width / 2;
    Box outer = {box->left - half, box->top - half, box->right + half, box->bottom + half};
    shape_fill(canvas, stroke->color,
               &(Box){outer.left, outer.top, outer.right, outer.top + stroke->width});
    shape_fill(canvas, stroke->color,
               &(Box){outer.left, outer.bottom - stroke->width, outer.right, outer.bottom});
    shape_fill(canvas, stroke->color,
               &(Box){outer.left, outer.top, outer.left + stroke->width, outer.bottom});
    shape_fill(canvas, stroke->color,
               &(Box){outer.right - stroke->width, outer.top, outer.right, outer.bottom});
}

// Lines at 45 degrees that begin left of the box, as far as it is high; the clip cuts them off.
void shape_hatch(Canvas *canvas, const Stroke *stroke, const Box *box, double spacing)
{
    double height = box->bottom - box->top;
    canvas_clip(canvas, box);
    for (double x = box->left - height; x < box->right; x += spacing)
        shape_segment(canvas, stroke, (Point){x, box->bottom}, (Point){x + height, box->top});
    canvas_clip(canvas, NULL);
}
