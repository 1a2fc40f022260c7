// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/figure_axes.h"

#include <math.h>
#include <stdio.h>

static const double RIGHT_MARGIN = 8;   // points: half a number of the x axis
static const double FRAME_SHAPE = 0.27, ENDS_SHAPE = 0.16;   // over the width: a frame; all else
static const double ROOM = 0.06;   // of the range, above and below the curves

Axis figure_length_axis(const ResultView *view, const char *symbol, double low, double high)
{
    char name[16];
    Axis axis = {.low = low, .high = high, .factor = 1};
    snprintf(name, sizeof name, "~{%.8s}", symbol);
    if (view->si)
        axis_set_unit(&axis, name, "m");
    else
        snprintf(axis.label, sizeof axis.label, "%s / ~{L}_{0}", name);
    return axis;
}

Color stack_color(int32_t k)
{
    static const Color colors[STACK_COLORS] = {{0.00f, 0.29f, 0.76f, 1}, {0.72f, 0.04f, 0.00f, 1},
                                               {0.03f, 0.57f, 0.30f, 1}, {0.08f, 0.08f, 0.10f, 1},
                                               {0.47f, 0.19f, 0.48f, 1}, {0.78f, 0.68f, 0.10f, 1},
                                               {0.07f, 0.77f, 0.97f, 1}, {0.50f, 0.50f, 0.52f, 1}};
    return colors[k % STACK_COLORS];
}

double stack_shape(int32_t frames)
{
    return FRAME_SHAPE * frames + ENDS_SHAPE;
}

void stack_fit(const Page *page, Axes *axes, int32_t count)
{
    Page same = *page;
    double left = 0, above = 0;
    for (int32_t k = 0; k < count; ++k) {   // a first placing, which tells how wide numbers are
        axes[k].bare_x = k + 1 < count;
        axes[k].box = page->room;
        axes[k].box.bottom = page->room.top + (page->room.bottom - page->room.top) / count;
        left = fmax(left, axes_left_margin(page, &axes[k]));
    }
    for (int32_t k = 0; k < count; ++k) above = fmax(above, axes_top_margin(&axes[k]));
    for (int32_t k = 0; k < count; ++k) axes[k].above = above;
    same.beside[0] = left * page->point;
    double below = axes_bottom_margin(&axes[count - 1]) * page->point;
    double height = (page->room.bottom - below - page->room.top) / count;
    for (int32_t k = 0; k < count; ++k) {
        Box room = page->room;
        room.top = page->room.top + k * height;
        room.bottom = room.top + height + (k + 1 < count ? 0 : below);
        axes_fit(&same, &room, RIGHT_MARGIN, &axes[k]);
    }
}

void stack_widen(double value, double *low, double *high)
{
    if (!isfinite(value)) return;
    *low = fmin(*low, value);
    *high = fmax(*high, value);
}

Axis stack_axis(double low, double high)
{
    if (!(low <= high) || (low == 0 && high == 0)) low = 0, high = 1;
    if (low > 0 && low < 0.5 * high) low = 0;
    if (high < 0 && high > 0.5 * low) high = 0;
    double room = ROOM * (high - low);
    if (!(room > 1e-9 * fmax(fabs(low), fabs(high)))) room = fmax(fabs(low), fabs(high)) * 0.5;
    if (!(room > 0)) room = 1;
    return (Axis){
        .low = low == 0 ? 0 : low - room, .high = high == 0 ? 0 : high + room, .factor = 1};
}
