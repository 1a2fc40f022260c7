// SPDX-License-Identifier: GPL-2.0-or-later
// How far mu falls in an event is its drawdown: from the largest mu, that of the step before
// included, down to the smallest after it. A bulk sliding is listed when it crosses the interface,
// also where the run ends before it does; other drops when their event has ended.
#include "record/drops.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

// Relative to the top. In parameter set A on up to 12 pads, single pads that slide lower mu by at
// most 2.5 %, and what makes the block give way by 8 % and more. In set B on 8 pads there is no
// such gap (slidings of pads lower mu by 0.5 to 80 %, half of them by 2 to 5 %): there it is a
// choice. docs/constants.md has what half and twice of it change.
const double LEAST_DROP = 0.05;

enum { FIRST_ROOM = 16 };

// --- the contact in segments --------------------------------------------------------------------

enum { SEGMENTS = 16 };   // about so many, and no fewer than pads

bool segments_create(const Interface *interface, Segments *segments, Error *err)
{
    int32_t nodes = interface->contact_count;
    *segments = (Segments){.contact_count = nodes, .stuck = nodes};
    segments->of_node = NEW_ARRAY(int32_t, nodes, err);
    segments->slipped = NEW_ARRAY(uint8_t, nodes, err);
    segments->nodes = NEW_ARRAY(double, nodes, err);
    if (!error_is_clean(err)) return false;
    for (int32_t p = 0; p < interface->pad_count; p++) {
        int32_t own = 0, seen = 0;
        for (int32_t i = 0; i < nodes; i++) own += interface->pad[i] == p;
        if (own == 0) continue;
        // Parts with as many nodes each, as far as it goes.
        int32_t parts = (int32_t)lround((double)SEGMENTS * own / nodes);
        parts = parts < 1 ? 1 : (parts > own ? own : parts);
        for (int32_t i = 0; i < nodes; i++) {
            if (interface->pad[i] != p) continue;
            int32_t segment = segments->count + seen++ * parts / own;
            segments->of_node[i] = segment;
            segments->nodes[segment]++;
        }
        segments->count += parts;
    }
    return true;
}

void segments_destroy(Segments *segments)
{
    memory_free_all(segments->of_node, segments->nodes, segments->slipped);
    *segments = (Segments){0};
}

void segments_follow(Segments *segments, const Observation *seen)
{
    if (segments->stuck == 0) return;
    for (int32_t i = 0; i < segments->contact_count; i++) {
        if (seen_status(seen, i) == CONTACT_STICK || segments->slipped[i]) continue;
        segments->slipped[i] = 1;
        segments->stuck--;
    }
}

void segments_read(const Segments *segments, const Observation *seen, double *state)
{
    const State *now = seen->state;
    double *shear = state, *lag = state + segments->count, normal = 0;
    memset(state, 0, 2 * (size_t)segments->count * sizeof *state);
    for (int32_t i = 0; i < segments->contact_count; i++) {
        int32_t s = segments->of_node[i], t = interface_tangent(seen->interface, i);
        normal += now->reaction[interface_normal(seen->interface, i)];
        shear[s] -= now->reaction[t];
        lag[s] += seen->U - now->displacement[seen->system->interface_dofs[t]];
    }
    for (int32_t s = 0; s < segments->count; s++) {
        shear[s] = normal > 0 ? shear[s] / normal : 0;
        lag[s] /= segments->nodes[s];
    }
}

static void segments_archive(Segments *segments, Archive *archive)
{
    archive_octets(archive, segments->slipped, segments->contact_count);
    archive_index(archive, &segments->stuck, 0, segments->contact_count + 1);
}

// --- drops --------------------------------------------------------------------------------------

static const Drop NOTHING_SEEN = {
    .mu = -INFINITY, .mu_after = INFINITY, .front_uncertified = NAN, .front_growth = NAN};

// Returns how many numbers a row of `states` has.
static int32_t drops_state_size(const Drops *drops)
{
    return 2 * drops->segments.count;
}

Drops drops_none(void)
{
    return (Drops){.settled = -1,
                   .mu_static = NAN,
                   .rising = NOTHING_SEEN,
                   .top = -INFINITY,
                   .mu_max = -INFINITY,
                   .mu_seen = -INFINITY,
                   .mu_beside = -INFINITY};
}

bool drops_create(const Interface *interface, const Events *events, double tolerance, Drops *drops,
                  Error *err)
{
    *drops = drops_none();
    drops->events = events;
    drops->tolerance = tolerance;
    drops->pad_count = interface->pad_count;
    drops->pad_name = interface->pad_name;
    drops->room = FIRST_ROOM;
    if (!segments_create(interface, &drops->segments, err)) return false;
    drops->list = NEW_ARRAY(Drop, FIRST_ROOM, err);
    drops->series = NEW_ARRAY(SeriesItem, FIRST_ROOM, err);
    drops->slid = NEW_ARRAY(uint8_t, FIRST_ROOM * drops->pad_count, err);
    drops->states = NEW_ARRAY(double, (FIRST_ROOM + 1) * drops_state_size(drops), err);
    return error_is_clean(err);
}

void drops_destroy(Drops *drops)
{
    memory_free_all(drops->list, drops->series, drops->slid, drops->states);
    segments_destroy(&drops->segments);
    *drops = (Drops){0};
}

// --- recording ----------------------------------------------------------------------------------

// True if mu has fallen enough in the event under way. A block that the rod pulls (mu below 0)
// holds nothing that could drop.
static bool has_fallen(const Drops *drops)
{
    return drops->top > 0 && drops->fall >= LEAST_DROP * drops->top;
}

static void rise(Drops *drops, const Observation *seen)
{
    Drop *rising = &drops->rising;
    if (seen->mu <= rising->mu) return;
    rising->mu = seen->mu;
    rising->U = seen->U;
    segments_read(&drops->segments, seen,
                  &drops->states[(int64_t)drops->count * drops_state_size(drops)]);
}

// Across gaps the place of the front is no length of slip.
static double front_of_slip(const Observation *seen)
{
    return seen->interface->pad_count == 1 ? seen->front - seen->trailing : NAN;
}

// The event of this step makes a drop, of these kinds; but one that began with the run.
static bool add_drop(Drops *drops, const Observation *seen, bool bulk, Error *err)
{
    Drop *rising = &drops->rising;
    rising->event = drops->events->count - 1;
    const Event *event = &drops->events->list[rising->event];
    if (isnan(event->slip_length)) {   // it moved at t = 0: nothing had held before
        *rising = NOTHING_SEEN;
        return true;
    }
    bool divided = seen->interface->pad_count > 1;
    rising->critical_length = divided ? event->slip_length : event->front_start - seen->trailing;
    if (divided ? !(event->slip_length > 0) : !event->front_slips) rising->critical_length = NAN;
    rising->critical_part = event->slip_before / drops->events->size;
    rising->pads = 0;
    for (int32_t p = 0; p < drops->pad_count; p++)
        rising->pads += events_pad_slid(drops->events, seen->interface, p);
    rising->bulk = bulk;
    rising->load = bulk || has_fallen(drops);
    if (!rising->load && rising->pads == 0) return true;

    // It joins the list, and what follows starts anew. ERROR_MEMORY leaves the list as it was.
    int32_t room = drops->room, size = drops_state_size(drops);
    if (!memory_grow(&drops->series, drops->count, &room, sizeof *drops->series, err)) return false;
    if (room > drops->room &&
        (!memory_resize(&drops->states, (int64_t)(drops->room + 1) * size,
                        (int64_t)(room + 1) * size, sizeof *drops->states, err) ||
         !memory_resize(&drops->slid, (int64_t)drops->room * drops->pad_count,
                        (int64_t)room * drops->pad_count, sizeof *drops->slid, err)))
        return false;
    if (!memory_grow(&drops->list, drops->count, &drops->room, sizeof *drops->list, err))
        return false;
    for (int32_t p = 0; p < drops->pad_count; p++)
        drops->slid[(int64_t)drops->count * drops->pad_count + p] =
            events_pad_slid(drops->events, seen->interface, p);
    rising->state = drops->count;
    drops->list[drops->count++] = *rising;
    *rising = NOTHING_SEEN;
    return true;
}

// While the whole block slides nothing rises: mu then says nothing of static friction.
bool drops_record(void *self, const Observation *seen, Error *err)
{
    Drops *drops = self;
    Drop *rising = &drops->rising;
    const Events *events = drops->events;
    bool in_event = events->rapid >= 0 || events->ended;   // the last of the list
    bool sliding = in_event && events->list[events->count - 1].kind == EVENT_LEADING;

    // The largest mu of the run, and how far it is known: where it is that of a single step, as
    // where the rod hits the block, shorter steps have another.
    if (seen->mu > drops->mu_max) {
        drops->mu_max = seen->mu;
        drops->mu_beside = drops->mu_seen;
    } else if (drops->mu_seen == drops->mu_max) {
        drops->mu_beside = fmax(drops->mu_beside, seen->mu);
    }
    drops->mu_seen = seen->mu;

    segments_follow(&drops->segments, seen);
    if (drops->settled < 0 && drops->segments.stuck == 0) drops->settled = drops->count;

    // The fall of mu in the event under way.
    if (in_event) {
        drops->top = fmax(drops->top, seen->mu);
        drops->fall = fmax(drops->fall, drops->top - seen->mu);
        rising->mu_after = fmin(rising->mu_after, seen->mu);
    }

    if (events->crossed) {
        if (seen->grows && isnan(rising->front_growth)) rising->front_growth = front_of_slip(seen);
        if (!add_drop(drops, seen, true, err)) return false;
    } else if (sliding && drops->count > 0) {
        Drop *drop = &drops->list[drops->count - 1];
        drop->mu_after = fmin(drop->mu_after, seen->mu);
    } else {
        // The largest mu before a drop is that before the force falls: what it does after that,
        // while the event goes on, says nothing of what the contact holds.
        if (!has_fallen(drops)) rise(drops, seen);
        if (!seen->certified && isnan(rising->front_uncertified))
            rising->front_uncertified = front_of_slip(seen);
        if (seen->grows && isnan(rising->front_growth)) rising->front_growth = front_of_slip(seen);
        if (events->ended && !add_drop(drops, seen, false, err)) return false;
    }

    // Without an event, and when one has ended: the next may begin in the very next step.
    if (!in_event || events->ended) {
        drops->top = seen->mu;
        drops->fall = 0;
        rising->mu_after = INFINITY;
        rise(drops, seen);
    }
    return true;
}

// --- reading ------------------------------------------------------------------------------------

bool drop_is(const Drop *drop, DropKind kind)
{
    return kind == DROP_BULK ? drop->bulk : kind == DROP_LOAD ? drop->load : drop->pads > 0;
}

int32_t drops_count(const Drops *drops, DropKind kind)
{
    int32_t count = 0;
    for (int32_t k = 0; k < drops->count; k++) count += drop_is(&drops->list[k], kind);
    return count;
}

Drop drops_as(const Drops *drops, DropKind kind, int32_t k)
{
    Drop drop = drops->list[k];
    for (int32_t j = k - 1; j >= 0 && !drop_is(&drops->list[j], kind); j--) {
        const Drop *before = &drops->list[j];
        if (before->mu >= drop.mu) {
            drop.mu = before->mu;
            drop.U = before->U;
            drop.state = before->state;
        }
        if (!isnan(before->front_uncertified)) drop.front_uncertified = before->front_uncertified;
        if (!isnan(before->front_growth)) drop.front_growth = before->front_growth;
    }
    return drop;
}

// events: its own is one of so many.
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

static void drop_archive(Drop *drop, int32_t events, Archive *archive)
{
    archive_numbers_of(archive, &drop->U, &drop->mu, &drop->mu_after);
    archive_index(archive, &drop->event, 0, events);
    archive_integer(archive, &drop->pads);
    archive_flag(archive, &drop->bulk);
    archive_flag(archive, &drop->load);
    archive_numbers_of(archive, &drop->critical_length, &drop->critical_part,
                       &drop->front_uncertified, &drop->front_growth);
}

bool drops_archive(Drops *drops, Archive *archive, Error *err)
{
    int32_t events = drops->events->count;   // which are read before
    void *list = drops->list;
    archive_section(archive, "drops");
    if (!archive_list(archive, &list, &drops->count, &drops->room, sizeof(Drop), err)) return false;
    drops->list = list;

    if (archive_reads(archive)) {
        // Work, states and pads that slid: room for as many as the list has.
        memory_free_all(drops->series, drops->slid, drops->states);
        drops->slid = NEW_ARRAY(uint8_t, (int64_t)drops->room * drops->pad_count, err);
        drops->series = NEW_ARRAY(SeriesItem, drops->room, err);
        drops->states =
            NEW_ARRAY(double, (int64_t)(drops->room + 1) * drops_state_size(drops), err);
        if (!error_is_clean(err)) return false;
    }

    for (int32_t k = 0; k < drops->count; k++) {
        drop_archive(&drops->list[k], events, archive);
        drops->list[k].state = k;
    }
    archive_octets(archive, drops->slid, drops->count * drops->pad_count);
    archive_numbers(archive, drops->states, (int64_t)(drops->count + 1) * drops_state_size(drops));
    segments_archive(&drops->segments, archive);
    archive_index(archive, &drops->settled, -1, drops->count + 1);
    drop_archive(&drops->rising, events + 1, archive);   // it has none yet
    archive_numbers_of(archive, &drops->top, &drops->fall, &drops->mu_max, &drops->mu_seen,
                       &drops->mu_beside);
    return true;
}
