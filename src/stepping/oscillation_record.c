// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/oscillation_record.h"

#include "base/memory.h"
#include "friction/friction_response.h"
#include "contact/slip.h"

// Part of v_c: an oscillation that gets so fast is not small. With 0.3 the second peak of a rod at
// v_c/34 came out 1 % too high (nu = 0, 16 cells); oscillations of rods at v_c/300 and below stay
// under 0.05.
static const double SMALL_RATE = 0.1;
// Weakening may exceed what was seen by this part: pressure creeps up as the rod moves on.
static const double SAME_WEAKENING = 1.02;

bool oscillation_record_create(const Block *block, double duration, OscillationRecord *record,
                               Error *err)
{
    const Interface *interface = block->interface;
    *record = (OscillationRecord){
        .interface = interface, .friction = block->friction, .duration = duration};
    record->weakening = NEW_ARRAY(double, interface->contact_count + interface->rod_count, err);
    if (!error_is_clean(err)) return false;
    oscillation_record_clear(record);
    return true;
}

void oscillation_record_destroy(OscillationRecord *record)
{
    memory_free(record->weakening);
    *record = (OscillationRecord){0};
}

void oscillation_record_clear(OscillationRecord *record)
{
    int32_t count = record->interface->contact_count + record->interface->rod_count;
    for (int32_t k = 0; k < count; k++) record->weakening[k] = -1;
    record->seen_for = 0;
}

// Weakening, with what is remembered at s = 1/duration, of contact node k (rod node k -
// contact_count) where it moves; -1, less than any, where it is held.
static double weakening_of(const OscillationRecord *record, const State *state, int32_t k)
{
    int32_t contacts = record->interface->contact_count;
    if (k >= contacts) return state->rod_touches[k - contacts] ? -1 : 0;
    if (state->status[k] == CONTACT_STICK) return -1;
    if (state->status[k] == CONTACT_OPEN) return 0;
    FrictionRates rates;
    state_friction(state, record->interface, friction_at(record->friction, k), k, &rates);
    double slope = rates.mu_speed - friction_weakens_at(&rates, record->duration);
    return slope < 0 ? -slope * state->reaction[interface_normal(record->interface, k)]
                     : 0;   // 0: it strengthens
}

static bool is_fast(const OscillationRecord *record, const State *state)
{
    for (int32_t i = 0; i < record->interface->contact_count; i++) {
        double limit = SMALL_RATE * friction_at(record->friction, i)->law->critical_velocity;
        if (slip_size(record->interface, i, state->slip_rate) > limit) return true;
    }
    return false;
}

void oscillation_record_add(OscillationRecord *record, const State *state, double step,
                            bool certified)
{
    int32_t count = record->interface->contact_count + record->interface->rod_count;
    if (record->duration == 0) return;
    record->seen_for += step;
    if (is_fast(record, state)) {
        oscillation_record_clear(record);
        record->runs = true;
        return;
    }
    if (record->runs) {
        record->runs = !certified && record->seen_for < record->duration;
        if (record->runs) return;
        record->seen_for = step;
    }
    for (int32_t k = 0; k < count; k++) {
        double weakening = weakening_of(record, state, k), seen = record->weakening[k];
        if (weakening <= (seen > 0 ? SAME_WEAKENING * seen : seen)) continue;
        record->weakening[k] = weakening;
        record->seen_for = 0;
    }
}

bool oscillation_record_covers(const OscillationRecord *record, const State *state)
{
    int32_t count = record->interface->contact_count + record->interface->rod_count;
    if (record->duration == 0 || record->seen_for < record->duration) return false;
    for (int32_t k = 0; k < count; k++) {
        double seen = record->weakening[k];
        if (weakening_of(record, state, k) > (seen > 0 ? SAME_WEAKENING * seen : seen))
            return false;
    }
    return !is_fast(record, state);
}

void oscillation_record_archive(OscillationRecord *record, Archive *archive)
{
    archive_section(archive, "oscillations");
    archive_number(archive, &record->seen_for);
    archive_flag(archive, &record->runs);
    archive_numbers(archive, record->weakening,
                    record->interface->contact_count + record->interface->rod_count);
}
