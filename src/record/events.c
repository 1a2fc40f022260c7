// SPDX-License-Identifier: GPL-2.0-or-later
// The three kinds of precursor that Otsuki and Matsukawa (2013) tell apart, by two thresholds on
// the largest slip rate, with hysteresis: quasi-static slip goes at V or less (its front and rate
// are proportional to V), rapid slip at several V (bounded) or at several v_c (leading). A fourth
// kind is what passes the first threshold but is no precursor: slow slip that oscillates about V
// comes to 2 V without ever turning back, and where it is not resolved single nodes jump.
//
// At any time at most one rapid event and one slow one are under way. A rapid event has hysteresis:
// it begins above RATE_START and ends below RATE_STOP. `slipped` marks the nodes that have slipped
// since it began; when all have, it is leading, and from then on the block slides. An event begins
// as slight; what it has come to so far can only raise its kind.
#include "record/events.h"

#include "base/memory.h"
#include "contact/slip.h"

#include <math.h>
#include <string.h>

// Slip rates at which a rapid event starts and stops, over the rod's velocity. Quasi-static slip
// stays below 1 in parameter set A (bounded events reach 3 to 6, leading ones 90), so 2 and 1 leave
// room on both sides.
static const double RATE_START = 2, RATE_STOP = 1;
// A quarter above the most that an oscillation about V comes to without turning back.
static const double RATE_COUNTS = 2.5;
const double LEAST_RAPID = 0.05;
// Part of the largest slip rate of a precursor: what follows at once and stays below it rings.
static const double AFTER_SLIP = 0.1;
enum { FIRST_ROOM = 64 };

// --- the front of a rapid event -----------------------------------------------------------------

// Arrival times as seismology takes them: the first passage of a threshold. With |v| known at both
// ends of a step the moment is found by linear interpolation, so that speeds are better than the
// contact's spacing over the step.

// Distance so near to a node that the next one does not count: the front may have stopped there.
static const double AT_NODE = 1e-6;   // of the way to the next

bool front_path_create(const Interface *interface, double threshold, FrontPath *path, Error *err)
{
    *path = (FrontPath){.threshold = threshold, .t_before = NAN};
    path->rate_before = NEW_ARRAY(double, interface->contact_count, err);
    path->arrival = NEW_ARRAY(double, interface->contact_count, err);
    if (!error_is_clean(err)) return false;
    front_path_restart(interface, path);

    int32_t last = interface_line_count(interface) - 1, i = 0;
    double start = interface_line_x(interface, 0);
    double length = interface_line_x(interface, last) - start;
    path->spacing = length / (FRONT_STATIONS - 1);
    for (int32_t k = 0; k < FRONT_STATIONS; k++) {
        double place = start + length * k / (FRONT_STATIONS - 1);
        while (i < last - 1 && interface_line_x(interface, i + 1) <= place) i++;
        int32_t node = interface_line_node(interface, i);   // place within [x_i, x_i+1]
        int32_t behind = last > 0 ? interface_line_node(interface, i + 1) : node;
        const double *x = interface->x;
        double part = last > 0 ? (place - x[node]) / (x[behind] - x[node]) : 0;
        FrontStation *station = &path->station[k];
        *station =
            (FrontStation){.node = {node, behind}, .part = part, .pad = interface->pad[node]};
        if (part < AT_NODE) continue;
        int32_t next = interface->pad[behind];
        if (part > 1 - AT_NODE)
            station->pad = next;
        else if (next != station->pad)
            station->pad = -1;
    }

    return true;
}

void front_path_destroy(FrontPath *path)
{
    memory_free_all(path->rate_before, path->arrival);
    *path = (FrontPath){0};
}

void front_path_restart(const Interface *interface, FrontPath *path)
{
    for (int32_t i = 0; i < interface->contact_count; i++) path->arrival[i] = NAN;
}

void front_path_follow(FrontPath *path, const Observation *seen)
{
    for (int32_t i = 0; i < seen->interface->contact_count; i++) {
        double rate = slip_size(seen->interface, i, seen->state->slip_rate);
        if (!(rate > path->threshold) || !isnan(path->arrival[i])) continue;
        // The time when the rate passed the threshold on its way from `before` to now.
        double before = path->rate_before[i];
        double part = (path->threshold - before) / (rate - before);
        bool at_once = isnan(path->t_before) || before >= path->threshold;
        path->arrival[i] = at_once ? seen->t : path->t_before + part * (seen->t - path->t_before);
    }
}

// Called in every step, also in those without a rapid event, so that its first step can be
// interpolated.
void front_path_keep(FrontPath *path, const Observation *seen)
{
    for (int32_t i = 0; i < seen->interface->contact_count; i++)
        path->rate_before[i] = slip_size(seen->interface, i, seen->state->slip_rate);
    path->t_before = seen->t;
}

// Where one of two neighbours was never reached, stations between them are NaN.
void front_path_stations(const FrontPath *path, double origin, double times[FRONT_STATIONS])
{
    for (int32_t k = 0; k < FRONT_STATIONS; k++) {
        const FrontStation *station = &path->station[k];
        double first = path->arrival[station->node[0]], second = path->arrival[station->node[1]];
        double part = station->part;
        if (station->pad < 0)
            times[k] = NAN;
        else if (part < AT_NODE)
            times[k] = first - origin;
        else if (part > 1 - AT_NODE)
            times[k] = second - origin;
        else
            times[k] = (1 - part) * first + part * second - origin;
    }
}

double front_path_speed(const FrontPath *path, const double times[FRONT_STATIONS], int32_t k)
{
    double elapsed = times[k + 1] - times[k];
    bool together = path->station[k].pad == path->station[k + 1].pad;
    return together && elapsed != 0 ? path->spacing / elapsed : NAN;
}

static void front_path_archive(FrontPath *path, int32_t contact_count, Archive *archive)
{
    archive_number(archive, &path->t_before);
    archive_numbers(archive, path->rate_before, contact_count);
    archive_numbers(archive, path->arrival, contact_count);
}

// --- events -------------------------------------------------------------------------------------

static const struct {
    const char *name, *words;
} KINDS[] = {
#define X(symbol, name, words) {name, words},
    EVENT_KINDS(X)
#undef X
};

const char *event_name(EventKind kind)
{
    return KINDS[kind].name;
}

const char *event_words(double stored)
{
    return stored >= 0 && stored < EVENT_KIND_COUNT ? KINDS[(int32_t)stored].words : "unknown";
}

// rate_scale: the rod's velocity, or what stands for it (model/obtain, set_scales).
bool events_create(const Interface *interface, double rate_scale, Events *events, Error *err)
{
    *events = (Events){.rate_start = RATE_START * rate_scale,
                       .rate_stop = RATE_STOP * rate_scale,
                       .rate_counts = RATE_COUNTS * rate_scale,
                       .in_space = interface->dim > 2,
                       .rapid = -1,
                       .slow = -1,
                       .mu_before = NAN,
                       .front_before = interface_line_x(interface, 0),
                       .room = FIRST_ROOM};
    events->list = NEW_ARRAY(Event, FIRST_ROOM, err);
    events->slipped = NEW_ARRAY(uint8_t, interface->contact_count, err);
    events->pads = NEW_ARRAY(PadSum, interface->pad_count, err);
    events->pads_before = NEW_ARRAY(PadSum, interface->pad_count, err);
    if (!error_is_clean(err)) return false;
    for (int32_t i = 0; i < interface->contact_count; i++) events->size += interface->weight[i];
    for (int32_t p = 0; p < interface->pad_count; p++)
        events->pads[p].slipping = events->pads[p].slipping_cells = NAN;
    return front_path_create(interface, events->rate_start, &events->path, err);
}

void events_destroy(Events *events)
{
    memory_free_all(events->list, events->slipped, events->pads, events->pads_before);
    front_path_destroy(&events->path);
    *events = (Events){0};
}

// A new event of `kind`, whose place in the list is *index. ERROR_MEMORY leaves the list as it was.
static bool start_event(Events *events, EventKind kind, const Observation *seen, int32_t *index,
                        Error *err)
{
    if (!memory_grow(&events->list, events->count, &events->room, sizeof(Event), err)) return false;
    *index = events->count++;
    events->kinds[kind]++;
    events->list[*index] = (Event){.kind = kind,
                                   .U_start = seen->U,
                                   .t_start = seen->t,
                                   .mu_start = events->mu_before,
                                   .front_start = events->front_before,
                                   .front_slips = events->front_slips_before,
                                   .reach = seen->front,
                                   .front_speed = NAN,
                                   .pad = -1,
                                   .slip_length = NAN,
                                   .slip_cells = NAN,
                                   .slip_before = NAN};
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
// front goes by nodes), without the gaps between pads that it passed.
static void end_slow(Events *events, const Interface *interface)
{
    if (events->slow < 0) return;
    Event *event = &events->list[events->slow];
    double from = event->front_start, to = event->reach, duration = event->t_stop - event->t_start;
    double gaps = 0;
    for (int32_t k = 1; k < interface_line_count(interface); k++) {
        double before = interface_line_x(interface, k - 1), x = interface_line_x(interface, k);
        int32_t pad = interface->pad[interface_line_node(interface, k)];
        bool gap = pad != interface->pad[interface_line_node(interface, k - 1)];
        if (gap && before >= from && x <= to) gaps += x - before;
    }
    if (duration > 0 && to > from) event->front_speed = (to - from - gaps) / duration;
    events->slow = -1;
}

// Sets the values of a rapid event that are known only when it is over.
static void end_rapid(Events *events)
{
    Event *event = &events->list[events->rapid];
    front_path_stations(&events->path, event->t_start, event->front_times);
    events->rapid = -1;
}

// The x up to which pad p has slipped in the event, from its trailing end on without a gap; the
// start of the contact where it has not.
static double pad_reach(const Events *events, const Interface *interface, int32_t p)
{
    double reach = interface_line_x(interface, 0);
    for (int32_t k = 0; k < interface_line_count(interface); k++) {
        int32_t i = interface_line_node(interface, k);
        if (interface->pad[i] != p) continue;
        if (!events->slipped[i]) break;
        reach = interface->x[i];
    }
    return reach;
}

// Some node of pad p was fast in the event. A node or two at the ends of the other pads creep.
static bool takes_part(const Events *events, const Interface *interface, int32_t p)
{
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (interface->pad[i] == p && !isnan(events->path.arrival[i])) return true;
    return false;
}

// The farthest node of a pad that slips fast.
// NaN: none does, as while a rapid event slows down.
static double fast_front(const Events *events, const Observation *seen, int32_t pad)
{
    const Interface *interface = seen->interface;
    for (int32_t k = interface_line_count(interface) - 1; k >= 0; k--) {
        int32_t i = interface_line_node(interface, k);
        if (interface->pad[i] == pad &&
            slip_size(interface, i, seen->state->slip_rate) > events->rate_start)
            return interface->x[i];
    }
    return NAN;
}

static double sum_slipping(const PadSum *pads, int32_t count)
{
    double sum = 0;
    for (int32_t p = 0; p < count; p++) sum += pads[p].slipping;
    return sum;
}

// Slip was rapid over LEAST_RAPID of the contact by now, and has run as far from the trailing end
// of the block or of a pad; or a pad has slid over all its length. What rings behind a precursor,
// about the place where that stopped, is not connected with a trailing end.
static bool is_wide(const Events *events, const Interface *interface)
{
    double rapid = 0, from_ends = 0;
    bool pad_slid = false;
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (!isnan(events->path.arrival[i])) rapid += interface->weight[i];
    for (int32_t p = 0; interface->pad_count > 1 && p < interface->pad_count; p++)
        pad_slid = pad_slid || events_pad_slid(events, interface, p);
    if (pad_slid || rapid < LEAST_RAPID * events->size) return pad_slid;

    for (int32_t p = 0; p < interface->pad_count; p++) {
        if (!takes_part(events, interface, p)) continue;
        PadSize size = pad_size(interface, p);
        double end = size.x_from + LEAST_RAPID * (size.x_to - size.x_from);
        bool slips = true;
        for (int32_t i = 0; i < interface->contact_count; i++) {
            if (interface->pad[i] != p) continue;
            // In space: slip within LEAST_RAPID of the pad's length of its trailing end, at
            // whatever y.
            if (events->in_space && events->slipped[i] && interface->x[i] <= end) return true;
            // In the plane: what has slipped without a gap from the trailing end.
            slips = slips && events->slipped[i];
            if (slips) from_ends += interface->weight[i];
        }
    }
    return !events->in_space && from_ends / events->size >= LEAST_RAPID;
}

static void raise_kind(Events *events, Event *event, EventKind kind)
{
    events->kinds[event->kind]--;
    events->kinds[kind]++;
    event->kind = kind;
}

// One step of the rapid event under way. It becomes leading in the step in which the last node has
// slipped; the slow growth that came before ends with that, too.
static void follow_rapid(Events *events, const Observation *seen)
{
    const Interface *interface = seen->interface;
    Event *event = &events->list[events->rapid];

    // Who slips in this step; `all`: by now every node has.
    bool all = true;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (seen_status(seen, i) != CONTACT_STICK && !events->slipped[i]) {
            events->slipped[i] = 1;
            event->slipped += interface->weight[i];
        }
        all = all && events->slipped[i];
    }

    // The farthest that a pad has slipped of those that take part.
    front_path_follow(&events->path, seen);
    double farthest = interface_line_x(interface, 0);
    for (int32_t p = 0; p < interface->pad_count; p++)
        if (takes_part(events, interface, p))
            farthest = fmax(farthest, pad_reach(events, interface, p));
    extend_event(event, seen, farthest);

    // The mean speed on the pad where the event began, from the first step in which its front is
    // on the line (it may begin beside it) to the last one in which slip has grown there.
    double reach = pad_reach(events, interface, event->pad);
    double front = fast_front(events, seen, event->pad), elapsed = seen->t - events->fast_t_start;
    if (interface->line && isnan(events->fast_front_start)) {
        events->fast_front_start = front;
        events->fast_t_start = seen->t;
    }
    if (front > events->fast_front_start && reach > events->fast_reach && elapsed > 0)
        event->front_speed = (front - events->fast_front_start) / elapsed;
    events->fast_reach = reach;

    // Its kind. It rings only, if it began sooner behind the last precursor or sliding than that
    // took, and is so much slower.
    if (event->kind == EVENT_SLIGHT && event->peak_slip_rate >= events->rate_counts &&
        is_wide(events, interface)) {
        int32_t k = events->rapid - 1;
        while (k >= 0 && events->list[k].kind != EVENT_BOUNDED &&
               events->list[k].kind != EVENT_LEADING)
            k--;
        const Event *before = &events->list[k >= 0 ? k : 0];
        bool rings = k >= 0 && event->t_start - before->t_stop < before->t_stop - before->t_start &&
                     event->peak_slip_rate < AFTER_SLIP * before->peak_slip_rate;
        if (!rings) raise_kind(events, event, EVENT_BOUNDED);
    }
    if (all && event->kind != EVENT_LEADING) {
        raise_kind(events, event, EVENT_LEADING);
        events->crossed = true;
        end_slow(events, interface);
    }
}

// Slow and rapid events never overlap in a step: while something is rapid, the slow one pauses.
static bool follow_step(Events *events, const Observation *seen, Error *err)
{
    events->began = events->ended = events->crossed = false;
    const Interface *interface = seen->interface;
    if (events->rapid < 0 && seen->max_slip_rate > events->rate_start) {
        // Slip has turned fast in this step: where, and how much slipped there before.
        if (!start_event(events, EVENT_SLIGHT, seen, &events->rapid, err)) return false;
        Event *event = &events->list[events->rapid];
        event->reach = interface_line_x(interface, 0);   // slow slip of other pads is none of it
        event->pad = 0;
        for (int32_t p = 1; p < interface->pad_count; p++)
            if (events->pads[p].fastest > events->pads[event->pad].fastest) event->pad = p;

        // The lengths that slipped in the step before, on the event's pad and in all. A cell in
        // space is as long as the root of its mean area.
        const PadSum *before = &events->pads_before[event->pad];
        PadSize size = pad_size(interface, event->pad);
        event->slip_length = before->slipping / size.breadth;
        event->slip_cells = interface->dim == 2
                                ? before->slipping_cells
                                : event->slip_length / sqrt(size.weight / size.nodes);
        event->slip_before = sum_slipping(events->pads_before, interface->pad_count);
        events->began = true;
        front_path_restart(interface, &events->path);
        memset(events->slipped, 0, (size_t)interface->contact_count);
        events->fast_front_start = fast_front(events, seen, event->pad);
        events->fast_t_start = seen->t;
    }
    if (events->rapid >= 0) {
        follow_rapid(events, seen);
        if (seen->max_slip_rate < events->rate_stop) {
            end_rapid(events);
            events->ended = true;
        }
        return true;
    }
    bool slips = seen->front > interface_line_x(interface, 0) && seen->max_slip_rate > 0;
    if (events->slow < 0 && slips &&
        !start_event(events, EVENT_QUASI_STATIC, seen, &events->slow, err))
        return false;
    if (events->slow < 0) return true;
    Event *event = &events->list[events->slow];
    extend_event(event, seen, seen->front);
    event->slipped = fmax(event->slipped, sum_slipping(events->pads, interface->pad_count));
    return true;
}

// A Recorder, the first of all: began, ended and crossed hold for this step only.
bool events_record(void *self, const Observation *seen, Error *err)
{
    Events *events = self;
    PadSum *before = events->pads_before;
    events->pads_before = events->pads;
    events->pads = before;
    pad_sums(seen, events->pads);
    bool followed = follow_step(events, seen, err);
    events->trailing = seen->trailing;
    events->front_before = seen->front;
    events->mu_before = seen->mu;
    events->front_slips_before = seen->front_slips;
    front_path_keep(&events->path, seen);
    return followed;
}

// Events that are still under way end with the run; its last step is `last`.
void events_close(Events *events, const Observation *last)
{
    if (!events->list) return;   // the run failed before they were created
    if (events->rapid >= 0) {
        extend_event(&events->list[events->rapid], last, 0);
        end_rapid(events);
    }
    end_slow(events, last->interface);
}

bool events_pad_slid(const Events *events, const Interface *interface, int32_t p)
{
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (interface->pad[i] == p && !events->slipped[i]) return false;
    return true;
}

bool events_archive(Events *events, const Interface *interface, Archive *archive, Error *err)
{
    void *list = events->list;
    archive_section(archive, "events");
    if (!archive_list(archive, &list, &events->count, &events->room, sizeof(Event), err))
        return false;
    events->list = list;
    for (int32_t k = 0; k < events->count; k++) {
        Event *event = &events->list[k];
        int32_t kind = (int32_t)event->kind;
        archive_index(archive, &kind, EVENT_QUASI_STATIC, EVENT_KIND_COUNT);
        event->kind = (EventKind)kind;
        archive_numbers_of(archive, &event->U_start, &event->U_stop, &event->t_start,
                           &event->t_stop, &event->mu_start, &event->front_start, &event->reach,
                           &event->slipped, &event->peak_slip_rate, &event->front_speed);
        archive_flag(archive, &event->front_slips);
        archive_index(archive, &event->pad, -1, interface->pad_count);
        archive_numbers_of(archive, &event->slip_length, &event->slip_cells, &event->slip_before);
        archive_numbers(archive, event->front_times, FRONT_STATIONS);
    }
    archive_indices(archive, events->kinds, EVENT_KIND_COUNT, 0, events->count + 1);
    archive_index(archive, &events->rapid, -1, events->count);
    archive_index(archive, &events->slow, -1, events->count);
    archive_numbers_of(archive, &events->trailing, &events->front_before, &events->mu_before);
    archive_flag(archive, &events->front_slips_before);
    archive_flag(archive, &events->began);
    archive_flag(archive, &events->ended);
    archive_flag(archive, &events->crossed);
    archive_octets(archive, events->slipped, interface->contact_count);
    archive_numbers_of(archive, &events->fast_front_start, &events->fast_t_start,
                       &events->fast_reach);
    front_path_archive(&events->path, interface->contact_count, archive);
    pad_sums_archive(events->pads, interface->pad_count, archive);
    pad_sums_archive(events->pads_before, interface->pad_count, archive);
    return true;
}
