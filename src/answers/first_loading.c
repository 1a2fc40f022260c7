// SPDX-License-Identifier: GPL-2.0-or-later
#include "answers/first_loading.h"

#include <math.h>
#include <stddef.h>

// Length that slipped when slip turned fast, over the length of the front from the trailing end.
// Above this ratio most of it slipped elsewhere, and the front says nothing of when the block
// slides.
static const double ELSEWHERE = 2;

// Number of the first sliding of the whole block from event number `from` on; without one the
// number of events.
static int32_t next_sliding(const Events *events, int32_t from)
{
    int32_t k = from;
    while (k < events->count && events->list[k].kind != EVENT_LEADING) k++;
    return k;
}

// Distance from the trailing end of the block to which a rapid event came, length.
static double precursor_length(const Events *events, const Event *event)
{
    return event->reach - events->trailing;
}

// Counts the precursors among the events from number `from` to the one before `to`. *longest: the
// largest of their lengths, 0 without any.
static int32_t count_precursors(const Events *events, int32_t from, int32_t to, double *longest)
{
    int32_t count = 0;
    *longest = 0;
    for (int32_t k = from; k < to; k++) {
        if (events->list[k].kind != EVENT_BOUNDED) continue;
        *longest = fmax(*longest, precursor_length(events, &events->list[k]));
        count++;
    }
    return count;
}

FirstLoading first_loading_of(const Drops *drops)
{
    FirstLoading first = {.mu = {NAN, NAN},
                          .parts = {NAN, NAN, NAN},
                          .known_to = NAN,
                          .U = NAN,
                          .critical_length = NAN,
                          .critical_part = NAN};
    const Events *events = drops->events;
    if (!events) return first;   // a run that failed early
    int32_t sliding = next_sliding(events, 0);
    first.precursors = count_precursors(events, 0, sliding, &first.longest);

    // A block that moves from t = 0 on has slid without a peak before: no drop belongs to that.
    for (int32_t k = 0; k < drops->count && !first.slid; k++) {
        if (!drops->list[k].bulk || drops->list[k].event != sliding) continue;
        Drop peak = drops_as(drops, DROP_BULK, k);
        first.slid = true;
        first.mu.value = peak.mu;
        first.U = peak.U;
        for (int32_t i = 0; i < sliding; i++)
            if (events->list[i].kind == EVENT_BOUNDED && events->list[i].U_start < peak.U &&
                isfinite(events->list[i].mu_start))
                first.since_precursor = fmax(peak.mu - events->list[i].mu_start, 0);
        const Event *event = &events->list[sliding];
        bool elsewhere = event->slip_length > ELSEWHERE * peak.critical_length;
        first.critical_length = elsewhere ? (double)NAN : peak.critical_length;
        first.critical_part = peak.critical_part;
    }
    return first;
}

LaterCycles later_cycles_of(const Drops *drops, int32_t first)
{
    LaterCycles later = {.way = NAN, .precursors = NAN, .longest = NAN};
    const Events *events = drops->events;
    double U = NAN, way = 0, precursors = 0, longest = 0;
    int32_t before = -1;   // number of the sliding before
    for (int32_t k = 0; k < drops->count; k++) {
        if (!drops->list[k].bulk) continue;
        Drop peak = drops_as(drops, DROP_BULK, k);
        if (k >= first && before >= 0) {
            double most;
            precursors += count_precursors(events, before + 1, peak.event, &most);
            longest += most;
            way += peak.U - U;
            later.count++;
        }
        before = peak.event;
        U = peak.U;
    }
    if (later.count == 0) return later;
    later.way = way / later.count;
    later.precursors = precursors / later.count;
    later.longest = longest / later.count;
    return later;
}

void first_loading_write_json(const FirstLoading *first, const LaterCycles *later,
                              const Events *events, double length, JsonWriter *json)
{
    json_begin_object(json, "first");
    json_boolean(json, "slid", first->slid);
    json_numbers_of(json, {"mu", first->mu.value}, {"mu_error", first->mu.error});
    json_begin_object(json, "mu_error_parts");
    json_numbers_of(json, {"mesh", first->parts.mesh}, {"branches", first->parts.branches});
    json_end(json);
    json_numbers_of(json, {"mu_known_to", first->known_to}, {"U", first->U});
    json_integer(json, "precursors", first->precursors);
    json_number(json, "longest_over_L", first->longest / length);
    json_number(json, "l_c_over_L", first->critical_length / length);
    if (events && events->in_space) json_number(json, "A_c_over_A", first->critical_part);
    int32_t sliding = events ? next_sliding(events, 0) : 0;
    json_begin_list(json, "list");
    for (int32_t k = 0; k < sliding; k++) {
        const Event *event = &events->list[k];
        if (event->kind != EVENT_BOUNDED) continue;
        json_object_of(json, NULL, {"U", event->U_start}, {"mu", event->mu_start},
                       {"length_over_L", precursor_length(events, event) / length},
                       {"slipped_over_A", event->slipped / events->size},
                       {"peak_slip_rate", event->peak_slip_rate});
    }
    json_end(json);
    json_end(json);
    json_object_of(json, "later_cycles", {"count", later->count}, {"U", later->way},
                   {"precursors", later->precursors}, {"longest_over_L", later->longest / length});
}
