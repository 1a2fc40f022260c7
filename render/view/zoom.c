// SPDX-License-Identifier: GPL-2.0-or-later
// Which part of U the zoomed pictures show: the last precursors before a sliding, of the first
// loading all of them. The table of events tells it.
#include "render/view/zoom.h"

#include "render/view/block.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A run of so few slidings, or less, is one of the first loading.
enum { PRECURSORS_SHOWN = 8, FEW_SLIDINGS = 2 };

static const double BEHIND = 0.04;   // of a cycle: shown after its sliding
static const double PAD = 0.08;   // beside the precursors, over what they span
static const double CYCLE_SHOWN = 0.15;   // of a cycle without rapid precursors
static const double SPAN_MIN = 0.01;   // of a cycle: one precursor close to sliding

// Counts the slidings of the whole block: as many cycles have ended.
static int32_t count_slidings(const ResultView *view)
{
    int32_t count = 0;
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        count += event->kind == VIEW_LEADING && isfinite(event->U_start);
    }
    return count;
}

// A cycle lasts from the end of one sliding to the start of the next.
typedef struct Cycle {
    int32_t number;   // from 1
    double U_start, U_slide, U_stop;   // length
    double U_precursor;   // start of the first bounded precursor to be shown
    int32_t bounded;   // rapid precursors inside
    bool periodic;   // its peak counts for mu_M
} Cycle;

// The figures are about precursors: a cycle with them comes before one without, a periodic
// one before others. Of those that are not periodic the first loading is what people measure.
static int32_t cycle_merit(const Cycle *cycle)
{
    if (cycle->bounded > 0) return cycle->periodic ? 4 : cycle->number == 1 ? 3 : 2;
    return cycle->periodic ? 1 : 0;
}

// The cycle of the events table that is asked for, or the best; false where no sliding is in it.
// *slidings: how many there are.
static bool cycle_find(const ResultView *view, Cycle *best, int32_t *slidings)
{
    double low = 0, high = 0;
    bool found = false;
    *slidings = count_slidings(view);
    int32_t asked = view->cycle == VIEW_CYCLE_LAST ? *slidings : view->cycle;
    if (asked == VIEW_CYCLE_CHOSEN && *slidings <= FEW_SLIDINGS) asked = 1;
    result_view_range(view, &low, &high);
    Cycle cycle = {.U_start = low};
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        if (event->kind != VIEW_LEADING || !isfinite(event->U_start)) continue;
        ++cycle.number;
        cycle.U_slide = event->U_start;
        cycle.U_stop = isfinite(event->U_stop) ? event->U_stop : high;

        // Its bounded precursors, and where the first of the last few starts; in the first loading
        // the first of all.
        cycle.bounded = 0;
        for (int32_t i = 0; i < view->event_count; ++i) {
            const ViewEvent *inside = &view->events[i];
            cycle.bounded += inside->kind == VIEW_BOUNDED && inside->U_start >= cycle.U_start &&
                             inside->U_start < cycle.U_slide;
        }
        int32_t passed = cycle.number == 1 ? 0 : cycle.bounded - PRECURSORS_SHOWN;
        for (int32_t i = 0; i < view->event_count && cycle.bounded > 0; ++i) {
            const ViewEvent *inside = &view->events[i];
            if (inside->kind != VIEW_BOUNDED || inside->U_start < cycle.U_start) continue;
            if (passed-- > 0) continue;
            cycle.U_precursor = inside->U_start;
            break;
        }

        // It is periodic when a peak of mu inside it counts for mu_M.
        cycle.periodic = false;
        for (int32_t i = 0; i < view->peak_count; ++i) {
            const ViewPeak *peak = &view->peaks[i];
            bool inside = peak->U > cycle.U_start && peak->U <= cycle.U_stop;
            if (inside && peak->counts) cycle.periodic = true;
        }

        bool better = asked > 0 ? cycle.number == asked
                                : !found || cycle_merit(&cycle) >= cycle_merit(best);
        if (cycle.U_slide > cycle.U_start && better) {
            *best = cycle;
            found = true;
        }
        cycle.U_start = cycle.U_stop;
    }
    return found;
}

// The zoom goes from the first precursor to be shown to a little beyond the sliding. It is never
// less than SPAN_MIN of the cycle, and never beyond the history.
Zoom zoom_choose(const ResultView *view)
{
    Cycle cycle = {0};
    Zoom zoom = {0};
    double low = 0, high = 0;
    if (view->cycle == VIEW_CYCLE_ALL) {
        snprintf(zoom.words, sizeof zoom.words, "all cycles");
        return zoom;
    }
    zoom.found = cycle_find(view, &cycle, &zoom.cycles);
    if (!zoom.found) return zoom;
    zoom.cycle = cycle.number;
    zoom.U_stop = cycle.U_stop;
    zoom.U_behind = cycle.U_stop + BEHIND * (cycle.U_stop - cycle.U_start);
    if (cycle.number == 1)
        snprintf(zoom.words, sizeof zoom.words, "first loading");
    else
        snprintf(zoom.words, sizeof zoom.words, "cycle %d of %d", cycle.number, zoom.cycles);
    double length = cycle.U_slide - cycle.U_start;
    double first = cycle.bounded > 0 ? cycle.U_precursor : cycle.U_slide - CYCLE_SHOWN * length;
    double span = fmax(cycle.U_slide - first, SPAN_MIN * length);
    result_view_range(view, &low, &high);
    zoom.U_start = cycle.U_start;
    zoom.U_slide = cycle.U_slide;
    zoom.smooth = cycle.bounded == 0;
    zoom.U_low = fmax(low, cycle.U_slide - (1 + PAD) * span);
    zoom.U_high = fmin(high, cycle.U_slide + PAD * span);
    return zoom;
}

bool zoom_covers(const Zoom *zoom, double U)
{
    return !zoom->found || (U >= zoom->U_start && U <= zoom->U_slide);
}

void zoom_cycles(const ResultView *view, int32_t *first, int32_t *last)
{
    int32_t slidings = count_slidings(view);
    bool all = view->cycle == VIEW_CYCLE_ALL && slidings > 0;
    *first = all ? 1 : view->cycle;
    *last = all ? slidings : view->cycle;
}

bool zoom_choose_cycle(ResultView *view, const char *words, Error *err)
{
    int32_t slidings = count_slidings(view);
    char *end = NULL;
    if (strcmp(words, "first") == 0) {
        view->cycle = 1;
    } else if (strcmp(words, "last") == 0) {
        view->cycle = VIEW_CYCLE_LAST;
    } else if (strcmp(words, "all") == 0) {
        view->cycle = VIEW_CYCLE_ALL;
    } else {
        long number = strtol(words, &end, 10);
        if (end == words || *end || number < 1)
            return REFUSE(err, "cycle %.40s: first, last, all or a number from 1 is allowed",
                          words);
        if (number > slidings)
            return REFUSE(err, "there is no cycle %ld: the block slid %d time%s", number, slidings,
                          slidings == 1 ? "" : "s");
        view->cycle = (int32_t)number;
    }
    return true;
}

const ViewEvent *zoom_sliding(const ResultView *view)
{
    if (view->cycle == VIEW_CYCLE_CHOSEN || view->cycle == VIEW_CYCLE_ALL) return NULL;
    Zoom zoom = zoom_choose(view);
    for (int32_t k = 0; zoom.found && k < view->event_count; ++k)
        if (view->events[k].kind == VIEW_LEADING && view->events[k].U_start == zoom.U_slide)
            return &view->events[k];
    return NULL;
}

// --- range of figures against U ------------------------------------------------------------------

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
