// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/depth_image.h"

#include <math.h>

// Compares with the farthest of the pixels around: a line on an edge has the face behind it beside
// it.
static bool shows(const DepthImage *image, Point at, double depth)
{
    double farthest = 0;
    int32_t column = (int32_t)floor(at.x - image->box.left);
    int32_t row = (int32_t)floor(at.y - image->box.top);
    for (int32_t j = row - 1; j <= row + 1; ++j)
        for (int32_t i = column - 1; i <= column + 1; ++i) {
            bool inside = i >= 0 && j >= 0 && i < image->columns && j < image->rows;
            double there = inside ? (double)image->depth[(int64_t)j * image->columns + i] : 1;
            farthest = fmax(farthest, there);
        }
    return depth <= farthest + image->slack;
}

void depth_image_line(const DepthImage *image, Canvas *canvas, const Stroke *stroke,
                      const DepthPoint ends[2])
{
    Point from = ends[0].at, to = ends[1].at, begun = {NAN, NAN};
    double length = hypot(to.x - from.x, to.y - from.y);
    int32_t steps = length < 1 ? 1 : (int32_t)fmin(ceil(length), 1e5);
    if (!isfinite(length)) return;
    for (int32_t k = 0; k <= steps; ++k) {
        double part = (double)k / steps, middle = fmin(part + 0.5 / steps, 1);
        Point here = {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
        Point seen = {from.x + middle * (to.x - from.x), from.y + middle * (to.y - from.y)};
        double depth = ends[0].depth + middle * (ends[1].depth - ends[0].depth);
        bool goes_on = k < steps && shows(image, seen, depth);
        if (goes_on && !isfinite(begun.x)) begun = here;
        if (goes_on || !isfinite(begun.x)) continue;
        draw_segment(canvas, stroke, begun, here);
        begun = (Point){NAN, NAN};
    }
}
