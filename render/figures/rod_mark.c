// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/rod_mark.h"

#include <math.h>

static const double STRIP_WIDTH = 3.5, SHAFT_WIDTH = 1;   // points
static const double ARROW = 9, HEAD = 3,
                    GAP = 2.5;   // points: its length, head, and way to the face

void arrow_draw(const Page *page, const Stroke *stroke, Point from, Point to, double size)
{
    double length = hypot(to.x - from.x, to.y - from.y);
    if (!(length > 0)) return;
    double x = size * (to.x - from.x) / length, y = size * (to.y - from.y) / length;
    const Point head[3] = {{to.x - x - y, to.y - y + x}, to, {to.x - x + y, to.y - y - x}};
    draw_segment(page->canvas, stroke, from, to);
    draw_line(page->canvas, stroke, head, 3);
}

void rod_mark_draw(const Page *page, const Axes *axes, const RodMark *rod)
{
    double unit = rod->share * page->point;
    if (!isfinite(rod->face + rod->low + rod->high)) return;
    Point foot = axes_place(axes, rod->face, rod->low),
          top = axes_place(axes, rod->face, rod->high);
    Stroke strip = {.color = ROD_COLOR, .width = STRIP_WIDTH * unit};
    Stroke shaft = {.color = ROD_COLOR, .width = SHAFT_WIDTH * unit};
    foot.x = top.x -= STRIP_WIDTH / 2 * unit;   // beside the face
    Point tip = {foot.x - GAP * unit, (foot.y + top.y) / 2};
    draw_segment(page->canvas, &strip, foot, top);
    arrow_draw(page, &shaft, (Point){tip.x - ARROW * unit, tip.y}, tip, HEAD * unit);
}
