// SPDX-License-Identifier: GPL-2.0-or-later
// The state of a pad follows from two marks of each contact node: it has stuck since the last
// sliding, and it has slipped since it stuck. A pad is detached when each of its nodes has slipped
// or is open, and at least one of them has slipped: a lifted corner holds nothing, whether or not
// it ever stuck. A pad slips rapidly between the rates at which record/events begins and ends rapid
// events, so that the same thresholds hold for pads and block.
#include "record/pads.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const PadCycle NOTHING_YET = {.normal_force = NAN,
                                     .shear = NAN,
                                     .U_first_slip = NAN,
                                     .U_detached = NAN,
                                     .U_rapid = NAN,
                                     .t_rapid = NAN,
                                     .slow_length = NAN};

// interface is read only here and is not kept; events is borrowed. A plain block has one pad.
bool pads_create(const Interface *interface, const Events *events, Pads *pads, Error *err)
{
    *pads = (Pads){.events = events, .contact_count = interface->contact_count, .mu = -INFINITY};
    pads->list = NEW_ARRAY(Pad, interface->pad_count, err);
    pads->stuck = NEW_ARRAY(uint8_t, interface->contact_count, err);
    pads->slipped = NEW_ARRAY(uint8_t, interface->contact_count, err);
    if (!error_is_clean(err)) return false;
    pads->count = interface->pad_count;
    for (int32_t p = 0; p < pads->count; p++) {
        Pad *pad = &pads->list[p];
        *pad = (Pad){.size = pad_size(interface, p),
                     .now = NOTHING_YET,
                     .first = NOTHING_YET,
                     .last = NOTHING_YET};
        pad->length = pad->size.weight / pad->size.breadth;
        if (interface->pad_name)
            snprintf(pad->name, sizeof pad->name, "%s", interface->pad_name[p]);
    }
    pads->in_space = interface->dim > 2;
    return true;
}

void pads_destroy(Pads *pads)
{
    memory_free_all(pads->list, pads->stuck, pads->slipped);
    *pads = (Pads){0};
}

// Length of pad p that slipped before slip turned fast, if a rapid event has begun on this pad; NaN
// where the event of another pad has run over it.
static double slow_length(const Events *events, int32_t p)
{
    if (!events->began) return NAN;
    const Event *event = &events->list[events->count - 1];
    return event->pad == p ? event->slip_length : NAN;
}

// now: loads where mu was largest so far, and the first U of what happens once. *detaching: one
// more where the pad has just lost its last sticking node; those of one step share their order.
static void follow_pad(Pads *pads, const Observation *seen, int32_t p, int32_t *detaching)
{
    Pad *pad = &pads->list[p];
    PadCycle *now = &pad->now;
    const PadSum *sum = &pads->events->pads[p];
    int32_t slipped = 0, free = 0;   // nodes that have slipped in this cycle; that or are open now
    for (int32_t i = 0; i < pads->contact_count; i++) {
        if (seen->interface->pad[i] != p) continue;
        slipped += pads->slipped[i];
        free += pads->slipped[i] || seen_status(seen, i) == CONTACT_OPEN;
    }
    if (!pads->started) pad->normal_force_start = sum->normal_force;
    if (seen->mu > pads->mu) {
        now->normal_force = sum->normal_force;
        now->shear = sum->shear;
    }
    if (slipped > 0 && isnan(now->U_first_slip)) now->U_first_slip = seen->U;
    if (slipped > 0 && free == pad->size.nodes && isnan(now->U_detached)) {
        now->U_detached = seen->U;
        now->order = pads->detached + 1;
        ++*detaching;
    }
    if (!pad->rapid && sum->fastest > pads->events->rate_start) {
        pad->rapid = true;
        now->U_rapid = seen->U;
        now->t_rapid = seen->t;
        now->slow_length = slow_length(pads->events, p);
    }
    if (sum->fastest < pads->events->rate_stop) pad->rapid = false;
}

// While the block slides as a whole nothing is followed but the step in which it crosses: what pads
// do then says nothing of how they detach.
bool pads_record(void *self, const Observation *seen, Error *err)
{
    Pads *pads = self;
    const Events *events = pads->events;
    bool sliding = events->rapid >= 0 && events->list[events->rapid].kind == EVENT_LEADING;
    int32_t detaching = 0;
    for (int32_t p = 0; events->ended && p < pads->count; p++)
        pads->list[p].slidings += events_pad_slid(events, seen->interface, p);
    if (!sliding || events->crossed) {
        // A node counts from when it has stuck: the tail of a sliding is not the next cycle's slip.
        // A node that opens after it stuck has slipped, as it carries nothing any more.
        for (int32_t i = 0; i < pads->contact_count; i++) {
            if (seen_status(seen, i) == CONTACT_STICK)
                pads->stuck[i] = 1;
            else if (pads->stuck[i])
                pads->slipped[i] = 1;
        }

        for (int32_t p = 0; p < pads->count; p++) follow_pad(pads, seen, p, &detaching);
        pads->detached += detaching;
        pads->mu = fmax(pads->mu, seen->mu);
        pads->started = true;
    }
    if (events->crossed) {
        pads->cycles++;
        for (int32_t p = 0; p < pads->count; p++) {
            Pad *pad = &pads->list[p];
            pad->last = pad->now;
            if (pads->cycles == 1) pad->first = pad->now;
        }
    }
    if (sliding || (events->ended && events->list[events->count - 1].kind == EVENT_LEADING)) {
        // All is forgotten but `last`, in every step of a sliding, so that a cycle begins with its
        // end.
        memset(pads->stuck, 0, (size_t)pads->contact_count);
        memset(pads->slipped, 0, (size_t)pads->contact_count);
        pads->detached = 0;
        pads->mu = -INFINITY;
        for (int32_t p = 0; p < pads->count; p++) pads->list[p].now = NOTHING_YET;
    }

    return error_is_clean(err);
}

static int32_t order_of(const Pad *pad, bool of_first)
{
    return of_first ? pad->first.order : pad->last.order;
}

void pads_order(const Pads *pads, bool of_first, char text[PADS_ORDER_SIZE])
{
    int32_t told = 0, left = 0;
    size_t used = 0;
    *text = '\0';
    for (int32_t p = 0; p < pads->count; p++) left += order_of(&pads->list[p], of_first) > 0;
    for (int32_t order = 1; order <= pads->count; order++) {
        bool first = true;   // of those that let go in the same step
        for (int32_t p = 0; p < pads->count; p++) {
            const Pad *pad = &pads->list[p];
            if (order_of(pad, of_first) != order) continue;
            const char *before = told == 0 ? "" : first ? ", " : " with ";
            if (used + strlen(before) + strlen(pad->name) + sizeof ", and 2147483647 more" >
                PADS_ORDER_SIZE) {
                snprintf(text + used, PADS_ORDER_SIZE - used, ", and %d more", left);
                return;
            }
            used += (size_t)sprintf(text + used, "%s%s", before, pad->name);
            first = false;
            told++;
            left--;
        }
    }
}

void pads_write_json(const Pads *pads, JsonWriter *json)
{
    json_begin_list(json, "pads");
    for (int32_t p = 0; p < pads->count; p++) {
        const Pad *pad = &pads->list[p];
        const PadCycle *last = &pad->last;
        json_begin_object(json, NULL);
        json_text(json, "name", pad->name);
        json_numbers_of(json, {"x_from", pad->size.x_from}, {"x_to", pad->size.x_to});
        if (pads->in_space) {
            json_numbers_of(json, {"y_from", pad->size.y_from}, {"y_to", pad->size.y_to},
                            {"area", pad->size.weight});
        }
        json_numbers_of(
            json, {"nodes", pad->size.nodes}, {"normal_force_start", pad->normal_force_start},
            {"normal_force_peak", last->normal_force}, {"shear_peak", last->shear},
            {"U_first_slip", last->U_first_slip}, {"U_detached", last->U_detached},
            {"detachment_order", last->order}, {"U_rapid", last->U_rapid},
            {"t_rapid", last->t_rapid}, {"l_c", last->slow_length},
            {"l_c_over_length", last->slow_length / pad->length}, {"slidings", pad->slidings});
        json_object_of(json, "first", {"normal_force_peak", pad->first.normal_force},
                       {"shear_peak", pad->first.shear}, {"U_first_slip", pad->first.U_first_slip},
                       {"U_detached", pad->first.U_detached},
                       {"detachment_order", pad->first.order}, {"U_rapid", pad->first.U_rapid});
        json_end(json);
    }
    json_end(json);
}

static void cycle_archive(PadCycle *cycle, Archive *archive)
{
    archive_numbers_of(archive, &cycle->normal_force, &cycle->shear, &cycle->U_first_slip,
                       &cycle->U_detached);
    archive_integer(archive, &cycle->order);
    archive_numbers_of(archive, &cycle->U_rapid, &cycle->t_rapid, &cycle->slow_length);
}

void pads_archive(Pads *pads, Archive *archive)
{
    archive_section(archive, "pads");
    for (int32_t p = 0; p < pads->count; p++) {
        Pad *pad = &pads->list[p];
        archive_number(archive, &pad->normal_force_start);
        cycle_archive(&pad->now, archive);
        cycle_archive(&pad->first, archive);
        cycle_archive(&pad->last, archive);
        archive_integer(archive, &pad->slidings);
        archive_flag(archive, &pad->rapid);
    }
    archive_octets(archive, pads->stuck, pads->contact_count);
    archive_octets(archive, pads->slipped, pads->contact_count);
    archive_integer(archive, &pads->detached);
    archive_integer(archive, &pads->cycles);
    archive_number(archive, &pads->mu);
    archive_flag(archive, &pads->started);
}
