// SPDX-License-Identifier: GPL-2.0-or-later
// The three kinds of precursor that Otsuki and Matsukawa (2013) tell apart, by two thresholds on
// the largest slip rate, with hysteresis: quasi-static slip goes at V or less (its front and rate
// are proportional to V), rapid slip at several V (bounded) or at several v_c (leading).
//
// At any time at most one rapid event and one slow one are under way. A rapid event has hysteresis:
// it begins above RATE_START and ends below RATE_STOP. `slipped` marks the nodes that have slipped
// since it began; when all have, it is leading, and from then on the block slides.
#include "record/events.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

// Against the rod's velocity. Quasi-static slip stays below 1 in parameter set A (bounded events
// reach 3 to 6, leading ones 90), so 2 and 1 leave room on both sides.
static const double RATE_START = 2, RATE_STOP = 1;
enum { FIRST_ROOM = 64 };

const char *event_name(EventKind kind)
{
    static const char *const names[] = {
#define X(symbol, name) name,
        EVENT_KINDS(X)
#undef X
    };
    return names[kind];
}

// rate_scale: the rod's velocity, or what stands for it (model/obtain, set_scales).
bool events_create(const Interface *interface, double rate_scale, Events *events, Error *err)
{
    *events = (Events){.rate_start = RATE_START * rate_scale,
                       .rate_stop = RATE_STOP * rate_scale,
                       .rapid = -1,
                       .slow = -1,
                       .front_before = interface->x[0],
                       .room = FIRST_ROOM};
    events->list = NEW_ARRAY(Event, FIRST_ROOM, err);
    events->slipped = NEW_ARRAY(uint8_t, interface->contact_count, err);
    front_path_create(interface, events->rate_start, &events->path, err);
    return error_is_clean(err);
}

void events_destroy(Events *events)
{
    memory_free(events->list);
    memory_free(events->slipped);
    front_path_destroy(&events->path);
    *events = (Events){0};
}

// A new event of `kind`, whose place in the list is *index. ERROR_MEMORY leaves the list as it was.
static bool start_event(Events *events, EventKind kind, const Observation *seen, int32_t *index,
                        Error *err)
{
    Event *list = memory_grow(events->list, events->count, &events->room, sizeof(Event), err);
    if (!list) return false;
    events->list = list;
    *index = events->count++;
    events->kinds[kind]++;
    events->list[*index] = (Event){.kind = kind,
                                   .U_start = seen->U,
                                   .t_start = seen->t,
                                   .front_start = events->front_before,
                                   .reach = seen->front,
                                   .front_speed = NAN};
    for (int32_t k = 0; k < FRONT_STATIONS; k++) events->list[*index].front_times[k] = NAN;
    return true;
}

// The event goes on in this step. reach: largest x it has come to so far, length.
static void extend_event(Event *event, const Observation *seen, double reach)
{
    event->U_stop = seen->U;
    event->t_stop = seen->t;
    event->reach = fmax(event->reach, reach);
    event->peak_slip_rate = fmax(event->peak_slip_rate, seen->max_slip_rate);
}

// The quasi-static event is over; its mean front speed is proportional to V (a plain mean: the
// front goes by nodes).
static void end_slow(Events *events)
{
    if (events->slow < 0) return;
    Event *event = &events->list[events->slow];
    double duration = event->t_stop - event->t_start;
    if (duration > 0 && event->reach > event->front_start)
        event->front_speed = (event->reach - event->front_start) / duration;
    events->slow = -1;
}

// What is known of a rapid event once it is over.
static void end_rapid(Events *events, const Interface *interface)
{
    Event *event = &events->list[events->rapid];
    front_path_stations(&events->path, interface, event->t_start, event->front_times);
    events->rapid = -1;
}

// The x up to which every node has slipped in this event; all: the last one too.
static double mark_slipped(Events *events, const Observation *seen, bool *all)
{
    const Interface *interface = seen->interface;
    double reach = interface->x[0];
    *all = true;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (seen->state->status[i] != CONTACT_STICK) events->slipped[i] = 1;
        if (!events->slipped[i]) *all = false;
        if (*all) reach = interface->x[i];
    }
    return reach;
}

// The farthest node that slips fast.
// NaN: none does, as while a rapid event slows down.
static double fast_front(const Events *events, const Observation *seen)
{
    const Interface *interface = seen->interface;
    for (int32_t i = interface->contact_count - 1; i >= 0; i--) {
        if (fabs(seen->state->slip_rate[interface_tangent(i)]) > events->rate_start)
            return interface->x[i];
    }
    return NAN;
}

// One step of the rapid event under way. It becomes leading in the step in which the last node has
// slipped; the slow growth that came before ends with that, too.
static void follow_rapid(Events *events, const Observation *seen)
{
    Event *event = &events->list[events->rapid];
    bool all = false;
    double before = event->reach, reach = mark_slipped(events, seen, &all);
    extend_event(event, seen, reach);
    front_path_follow(&events->path, seen);
    double front = fast_front(events, seen), elapsed = seen->t - events->fast_t_start;
    if (front > events->fast_front_start && event->reach > before && elapsed > 0)
        event->front_speed = (front - events->fast_front_start) / elapsed;
    if (all && event->kind != EVENT_LEADING) {
        events->kinds[event->kind]--;
        events->kinds[EVENT_LEADING]++;
        event->kind = EVENT_LEADING;
        events->crossed = true;
        end_slow(events);
    }
}

// Slow and rapid events never overlap in a step: while something is rapid, the slow one pauses.
static bool follow_step(Events *events, const Observation *seen, Error *err)
{
    events->began = events->ended = events->crossed = false;
    if (events->rapid < 0 && seen->max_slip_rate > events->rate_start) {
        TRY(start_event(events, EVENT_BOUNDED, seen, &events->rapid, err));
        events->began = true;
        front_path_restart(seen->interface, &events->path);
        memset(events->slipped, 0, (size_t)seen->interface->contact_count);
        events->fast_front_start = fast_front(events, seen);
        events->fast_t_start = seen->t;
    }
    if (events->rapid >= 0) {
        follow_rapid(events, seen);
        if (seen->max_slip_rate < events->rate_stop) {
            end_rapid(events, seen->interface);
            events->ended = true;
        }
        goto cleanup;
    }
    bool slips = seen->front > seen->interface->x[0] && seen->max_slip_rate > 0;
    if (events->slow < 0 && slips)
        TRY(start_event(events, EVENT_QUASI_STATIC, seen, &events->slow, err));
    if (events->slow >= 0) extend_event(&events->list[events->slow], seen, seen->front);
cleanup:
    return error_is_clean(err);
}

// A Recorder, the first of all: began, ended and crossed hold for this step only.
bool events_record(void *self, const Observation *seen, Error *err)
{
    Events *events = self;
    bool followed = follow_step(events, seen, err);
    events->front_before = seen->front;
    front_path_keep(&events->path, seen);
    return followed;
}

// What is still under way ends with the run; its last step is `last`.
void events_close(Events *events, const Observation *last)
{
    if (!events->list) return;   // the run failed before they were created
    if (events->rapid >= 0) {
        extend_event(&events->list[events->rapid], last, 0);
        end_rapid(events, last->interface);
    }
    end_slow(events);
}

bool events_pad_slid(const Events *events, const Interface *interface, int32_t p)
{
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (interface->pad[i] == p && !events->slipped[i]) return false;
    return true;
}
