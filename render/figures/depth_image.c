// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/depth_image.h"

#include "base/memory.h"

#include <math.h>

bool depth_image_create(int32_t columns, int32_t rows, double slack, DepthImage *image, Error *err)
{
    int64_t count = (int64_t)columns * rows;
    *image = (DepthImage){.columns = columns, .rows = rows, .slack = slack};
    if (!(image->values = NEW_ARRAY(float, count, err))) return false;
    if (!(image->depth = NEW_ARRAY(double, count, err))) return false;
    for (int64_t k = 0; k < count; ++k) {
        image->values[k] = NAN;
        image->depth[k] = INFINITY;
    }
    return true;
}

void depth_image_destroy(DepthImage *image)
{
    memory_free_all(image->values, image->depth);
    *image = (DepthImage){0};
}

// Finds the pixels whose middles lie between the least and the largest of three numbers, within 0
// and `end`.
static void pixel_range(double a, double b, double c, int32_t end, int32_t range[2])
{
    range[0] = (int32_t)fmax(0, ceil(fmin(a, fmin(b, c)) - 0.5));
    range[1] = (int32_t)fmin(end - 1, floor(fmax(a, fmax(b, c)) - 0.5));
}

void depth_image_add(DepthImage *image, const DepthPoint corner[3])
{
    const Point *a = &corner[0].at, *b = &corner[1].at, *c = &corner[2].at;
    double area = (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
    int32_t columns[2], rows[2];
    if (!isfinite(area) || area == 0) return;
    pixel_range(a->x, b->x, c->x, image->columns, columns);
    pixel_range(a->y, b->y, c->y, image->rows, rows);
    for (int32_t row = rows[0]; row <= rows[1]; ++row)
        for (int32_t column = columns[0]; column <= columns[1]; ++column) {
            double x = column + 0.5, y = row + 0.5, part[3];
            part[1] = ((x - a->x) * (c->y - a->y) - (y - a->y) * (c->x - a->x)) / area;
            part[2] = ((b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x)) / area;
            part[0] = 1 - part[1] - part[2];
            if (!(part[0] >= 0 && part[1] >= 0 && part[2] >= 0)) continue;
            double depth = 0, value = 0;
            for (int32_t k = 0; k < 3; ++k) {
                depth += part[k] * corner[k].depth;
                value += part[k] * corner[k].value;
            }
            int64_t at = (int64_t)row * image->columns + column;
            if (depth >= image->depth[at]) continue;
            image->depth[at] = depth;
            image->values[at] = (float)value;
        }
}

// Compares with the farthest of the pixels around: a line on an edge has the face behind it beside
// it.
static bool shows(const DepthImage *image, Point at, double depth)
{
    double farthest = -INFINITY;
    int32_t column = (int32_t)floor(at.x), row = (int32_t)floor(at.y);
    for (int32_t j = row - 1; j <= row + 1; ++j)
        for (int32_t i = column - 1; i <= column + 1; ++i) {
            bool inside = i >= 0 && j >= 0 && i < image->columns && j < image->rows;
            double there = inside ? image->depth[(int64_t)j * image->columns + i] : INFINITY;
            farthest = fmax(farthest, there);
        }
    return depth <= farthest + image->slack;
}

void depth_image_line(const DepthImage *image, Canvas *canvas, Point corner, const Stroke *stroke,
                      const DepthPoint ends[2])
{
    Point from = ends[0].at, to = ends[1].at, begun = {NAN, NAN};
    double length = hypot(to.x - from.x, to.y - from.y);
    int32_t steps = length < 1 ? 1 : (int32_t)fmin(ceil(length), 1e5);
    if (!isfinite(length)) return;
    for (int32_t k = 0; k <= steps; ++k) {
        double part = (double)k / steps, middle = fmin(part + 0.5 / steps, 1);
        Point here = {corner.x + from.x + part * (to.x - from.x),
                      corner.y + from.y + part * (to.y - from.y)};
        Point seen = {from.x + middle * (to.x - from.x), from.y + middle * (to.y - from.y)};
        double depth = ends[0].depth + middle * (ends[1].depth - ends[0].depth);
        bool goes_on = k < steps && shows(image, seen, depth);
        if (goes_on && !isfinite(begun.x)) begun = here;
        if (goes_on || !isfinite(begun.x)) continue;
        draw_segment(canvas, stroke, begun, here);
        begun = (Point){NAN, NAN};
    }
}
