// SPDX-License-Identifier: GPL-2.0-or-later
// A swing that the certificate cannot exclude is followed at wave steps for some time. When it
// stayed small all along, the weakening it was seen to bear is remembered node by node, and states
// with no more of it may be stepped over. One fast step, or a node that weakens more than was seen,
// and watching begins anew.
#include "stepping/watch.h"

#include "base/memory.h"

#include <math.h>

// Of v_c: a swing that gets so fast is not small. With 0.3 the second peak of a rod at v_c/34 came
// out 1 % too high (nu = 0, 16 cells); swings of rods at v_c/300 and below stay under 0.05.
static const double SMALL_RATE = 0.1;
// Weakening may exceed what was seen by this part: pressure creeps up as the rod moves on.
static const double SAME_WEAKENING = 1.02;

// duration 0: nothing is ever borne by being seen.
bool watch_create(const Block *block, double duration, Watch *watch, Error *err)
{
    const Interface *interface = block->interface;
    *watch = (Watch){.interface = interface, .law = block->law, .duration = duration};
    watch->weakening = NEW_ARRAY(double, interface->contact_count + interface->rod_count, err);
    if (!error_is_clean(err)) return false;
    watch_forget(watch);
    return true;
}

void watch_destroy(Watch *watch)
{
    memory_free(watch->weakening);
    *watch = (Watch){0};
}

// -1 at each node: not even moving was seen.
void watch_forget(Watch *watch)
{
    int32_t count = watch->interface->contact_count + watch->interface->rod_count;
    for (int32_t k = 0; k < count; k++) watch->weakening[k] = -1;
    watch->seen_for = 0;
}

// Weakening of contact node k (rod node k - contact_count) where it moves, -1 where it is held.
static double weakening_of(const Watch *watch, const State *state, int32_t k)
{
    int32_t contacts = watch->interface->contact_count;
    if (k >= contacts) return state->rod_touches[k - contacts] ? -1 : 0;
    if (state->status[k] == CONTACT_STICK) return -1;
    if (state->status[k] == CONTACT_OPEN) return 0;
    double speed = fabs(state->slip_rate[interface_tangent(k)]);
    return -friction_slope(watch->law, speed) * state->reaction[interface_normal(k)];
}

// At SMALL_RATE of v_c friction has lost so much of its drop already that a swing is no small one.
static bool is_fast(const Watch *watch, const State *state)
{
    double limit = SMALL_RATE * watch->law->critical_velocity;
    for (int32_t i = 0; i < watch->interface->contact_count; i++) {
        if (fabs(state->slip_rate[interface_tangent(i)]) > limit) return true;
    }
    return false;
}

// After every accepted step that resolves waves. `runs`: something was fast since the state was
// last certified; until it is again nothing is learned.
void watch_see(Watch *watch, const State *state, double step, bool certified)
{
    int32_t count = watch->interface->contact_count + watch->interface->rod_count;
    if (watch->duration == 0) return;
    watch->seen_for += step;
    if (certified) watch->runs = false;
    if (is_fast(watch, state)) watch->runs = true;
    if (watch->runs) {
        watch_forget(watch);
        return;
    }
    for (int32_t k = 0; k < count; k++) {
        double weakening = weakening_of(watch, state, k), seen = watch->weakening[k];
        if (weakening <= (seen > 0 ? SAME_WEAKENING * seen : seen)) continue;
        watch->weakening[k] = weakening;
        watch->seen_for = 0;
    }
}

// Every node moves with at most the weakening that it was seen with, for at least `duration`.
bool watch_bears(const Watch *watch, const State *state)
{
    int32_t count = watch->interface->contact_count + watch->interface->rod_count;
    if (watch->duration == 0 || watch->seen_for < watch->duration) return false;
    for (int32_t k = 0; k < count; k++) {
        double seen = watch->weakening[k];
        if (weakening_of(watch, state, k) > (seen > 0 ? SAME_WEAKENING * seen : seen)) return false;
    }
    return !is_fast(watch, state);
}
