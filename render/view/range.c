// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/view/range.h"

#include "render/view/block.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

enum { SLIDINGS_MOST = 40, SLIDINGS_SHOWN = 20 };   // each has 3 mm of a column then

// "U=0.01" as it is; of "t=100" where the rod was then.
static bool read_moment(const ResultView *view, const char *at, double *U, Error *err)
{
    bool is_U = false;
    double value = 0;
    if (!block_moment_read(at, &is_U, &value, err)) return false;
    *U = value;
    for (int64_t row = 0; !is_U && row < view->rows; ++row)
        if (row == 0 || view->t[row] <= value) *U = view->U[row];
    return true;
}

bool view_range_find(const ResultView *view, const PictureStyle *style, ViewRange *shown,
                     Error *err)
{
    double low = 0, high = 0;
    int32_t count = 0;
    result_view_range(view, &low, &high);
    *shown = (ViewRange){.low = low, .high = high};
    for (int32_t k = 0; k < view->event_count; ++k)
        if (view->events[k].kind == VIEW_LEADING) ++count;

    // The last of many slidings are shown, from the end of the one before them.
    double start = NAN;
    int32_t seen = 0;
    for (int32_t k = 0; k < view->event_count && count > SLIDINGS_MOST; ++k)
        if (view->events[k].kind == VIEW_LEADING && ++seen == count - SLIDINGS_SHOWN)
            start = view->events[k].U_stop;
    Zoom zoom = view->cycle != VIEW_CYCLE_CHOSEN ? zoom_choose(view) : (Zoom){0};
    if (zoom.found) {
        shown->low = zoom.U_start;
        shown->high = zoom.U_behind;
        snprintf(shown->words, sizeof shown->words, "%s", zoom.words);
    } else if (isfinite(start) && !style->from && !style->to && view->cycle != VIEW_CYCLE_ALL) {
        shown->low = start;
        snprintf(shown->words, sizeof shown->words, "the last %d of %d slidings", SLIDINGS_SHOWN,
                 count);
    }
    if (style->from && !read_moment(view, style->from, &shown->low, err)) return false;
    if (style->to && !read_moment(view, style->to, &shown->high, err)) return false;
    shown->low = fmax(shown->low, low);
    shown->high = fmin(shown->high, high);
    if (!(shown->high > shown->low))
        return REFUSE(err, "nothing lies from U = %g to U = %g: the history goes from %g to %g",
                      shown->low, shown->high, low, high);
    return true;
}
