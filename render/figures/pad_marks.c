// SPDX-License-Identifier: GPL-2.0-or-later
// A bar and a name for each pad at the right of a map, so that gaps in it can be told from open
// contact. A single contact needs none.
#include "render/figures/pad_marks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double BAR_GAP = 1.6;   // points: frame to bar
static const double BAR_WIDTH = 1.2;   // points
static const double NAME_GAP = 1.6;   // points: bar to name
static const Color BAR_COLOR = {0.45f, 0.46f, 0.48f, 1};

enum { NAME_SIZE = 96 };

// "contact_3" is shown as pad 3, a name of the user's own as it is; without names, numbers from 1.
static void pad_name(const ResultView *view, int32_t pad, char name[NAME_SIZE])
{
    static const char common[] = "contact_";
    const char *start = view->pad_names;
    for (int32_t k = 0; start && k < pad; ++k) {
        start = strchr(start, '\n');
        if (start) ++start;
    }
    int length = start ? (int)strcspn(start, "\n") : 0, skip = sizeof common - 1;
    if (length == 0)
        snprintf(name, NAME_SIZE, "pad %d", pad + 1);
    else if (length > skip && strncmp(start, common, sizeof common - 1) == 0)
        snprintf(name, NAME_SIZE, "pad %.*s", length - skip, start + skip);
    else
        snprintf(name, NAME_SIZE, "%.*s", length, start);
}

// Pads are numbered from 0 without gaps; one is the least.
static int32_t pad_count(const ResultView *view)
{
    double last = 0;
    for (int32_t i = 0; i < view->nodes; ++i) last = fmax(last, view->pad[i]);
    return (int32_t)last + 1;
}

// Extent of a pad along x; false: no node is on it.
static bool pad_extent(const ResultView *view, int32_t pad, double *from, double *to)
{
    *from = INFINITY;
    *to = -INFINITY;
    for (int32_t i = 0; i < view->nodes; ++i) {
        if ((int32_t)view->pad[i] != pad) continue;
        *from = fmin(*from, view->x[i]);
        *to = fmax(*to, view->x[i]);
    }
    return *to >= *from;
}

double pad_marks_width(const Page *page, const ResultView *view)
{
    char name[NAME_SIZE];
    double widest = 0;
    int32_t count = pad_count(view);
    if (count < 2) return 0;
    for (int32_t pad = 0; pad < count; ++pad) {
        pad_name(view, pad, name);
        widest = fmax(widest, text_width(page->text, SMALL_SIZE * page->point, name));
    }
    return BAR_GAP + BAR_WIDTH + NAME_GAP + widest / page->point;
}

void pad_marks_draw(const Page *page, const ResultView *view, const Axes *axes, double beside)
{
    double point = page->point, from = 0, to = 0;
    double left = axes->box.right + (beside + BAR_GAP) * point;
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK, .up = 0.5};
    int32_t count = pad_count(view);
    for (int32_t pad = 0; count > 1 && pad < count; ++pad) {
        char name[NAME_SIZE];
        if (!pad_extent(view, pad, &from, &to)) continue;
        Point low = axes_place(axes, axes->x.high, from), high = axes_place(axes, axes->x.high, to);
        Box bar = {left, high.y, left + BAR_WIDTH * point, fmax(low.y, high.y + 1)};
        draw_fill(page->canvas, BAR_COLOR, &bar);
        pad_name(view, pad, name);
        Point place = {bar.right + NAME_GAP * point, (low.y + high.y) / 2};
        text_draw(page->text, &style, place, name);
    }
}
