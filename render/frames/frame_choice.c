// SPDX-License-Identifier: GPL-2.0-or-later
// The way between two frames is the share of all U gone plus the share of all ups and downs of mu:
// half of the frames follow the rod, half the force, which moves most in rapid events.
#include "render/frames/frame_choice.h"

#include <math.h>

enum { EVENTS_SHARE = 2 };   // of the frames one in so many may be taken for events alone

static const double SLACK = 1e-9;   // of U: a time at the border of an event belongs to it

// Sums of the changes of U and mu between neighbouring rows from `from` to `to`; changes that are
// not finite count as 0.
typedef struct Way {
    double U, mu;
} Way;

static Way way_between(const ResultView *view, int64_t from, int64_t to)
{
    Way way = {0};
    for (int64_t row = from; row < to; ++row) {
        double dU = fabs(view->U[row + 1] - view->U[row]);
        double dmu = fabs(view->mu[row + 1] - view->mu[row]);
        way.U += isfinite(dU) ? dU : 0;
        way.mu += isfinite(dmu) ? dmu : 0;
    }
    return way;
}

static int32_t insert(int32_t index, int32_t *chosen, int32_t count)
{
    int32_t at = count;
    while (at > 0 && chosen[at - 1] >= index) --at;
    if (at < count && chosen[at] == index) return count;
    for (int32_t k = count; k > at; --k) chosen[k] = chosen[k - 1];
    chosen[at] = index;
    return count + 1;
}

int32_t frames_choose(const ResultView *view, const int64_t *rows, int32_t count, int32_t most,
                      int32_t *chosen)
{
    if (count <= most) {
        for (int32_t k = 0; k < count; ++k) chosen[k] = k;
        return count;
    }

    // The first frame of each event; the last events first, as the first ones belong to the start.
    int32_t found = 0;
    for (int32_t e = view->rapid_count - 1; e >= 0 && found < most / EVENTS_SHARE; --e) {
        double slack = SLACK * fabs(view->rapid[e][1]);
        int32_t k = 0;
        while (k < count && !(view->U[rows[k]] >= view->rapid[e][0] - slack)) ++k;
        if (k < count && view->U[rows[k]] <= view->rapid[e][1] + slack)
            found = insert(k, chosen, found);
    }

    int32_t wanted = most - found;
    Way all = way_between(view, rows[0], rows[count - 1]);
    double done = 0, before = 0, total = (all.U > 0) + (all.mu > 0);
    int32_t next = 0;   // of the frames wanted
    for (int32_t k = 0; k < count && next < wanted; ++k) {
        Way way = k > 0 ? way_between(view, rows[k - 1], rows[k]) : (Way){0};
        before = done;
        done += (all.U > 0 ? way.U / all.U : 0) + (all.mu > 0 ? way.mu / all.mu : 0);
        double target = total * next / (wanted > 1 ? wanted - 1 : 1) - SLACK;
        if (done < target) continue;
        bool earlier = k > 0 && target - before < done - target;
        found = insert(earlier ? k - 1 : k, chosen, found);
        while (next < wanted && total * next / (wanted > 1 ? wanted - 1 : 1) - SLACK <= done)
            ++next;
    }
    return found;
}
