// SPDX-License-Identifier: GPL-2.0-or-later
#include "answers/drop_series.h"

#include <math.h>

int32_t drops_series(const Drops *drops, DropKind kind, int32_t first)
{
    int32_t count = 0;
    for (int32_t k = first; k < drops->count; k++) {
        if (!drop_is(&drops->list[k], kind)) continue;
        Drop drop = drops_as(drops, kind, k);
        drops->series[count++] = (SeriesItem){
            drop.mu, drop.pads, &drops->states[(int64_t)drop.state * drops_state_size(drops)]};
    }
    return count;
}

const Event *drops_least_resolved(const Drops *drops, int32_t first)
{
    const Event *least = NULL;
    for (int32_t k = first; k < drops->count; k++) {
        if (!drop_is(&drops->list[k], DROP_LOAD)) continue;
        const Event *event = &drops->events->list[drops->list[k].event];
        if (isnan(event->slip_cells)) continue;   // slid from the first step on
        if (!least || event->slip_cells < least->slip_cells) least = event;
    }
    return least;
}
