// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/moving_set.h"

#include "base/memory.h"

#include <math.h>

bool moving_set_create(const Block *block, MovingSet *set, Error *err)
{
    *set = (MovingSet){.interface = block->interface, .law = block->law, .rod = block->rod};
    int64_t count = block->interface->count;
    set->list = NEW_ARRAY(MovingUnknown, count, err);
    set->unknown = NEW_ARRAY(int32_t, count, err);
    set->normal = NEW_ARRAY(int32_t, count, err);
    set->friction = NEW_ARRAY(double, count, err);
    return error_is_clean(err);
}

void moving_set_destroy(MovingSet *set)
{
    memory_free(set->list);
    memory_free(set->unknown);
    memory_free(set->normal);
    memory_free(set->friction);
    *set = (MovingSet){0};
}

// Without friction, weakening and rod: the caller adds what it has.
static MovingUnknown *add_unknown(MovingSet *set, int32_t unknown)
{
    MovingUnknown *moving = &set->list[set->count++];
    *moving = (MovingUnknown){.unknown = unknown, .normal = -1};
    return moving;
}

static void add_slipping(MovingSet *set, const State *state, int32_t i)
{
    int32_t t = interface_tangent(set->interface, i), n = interface_normal(set->interface, i);
    const FrictionLaw *law = friction_at(set->law, i);
    double speed = fabs(state->slip_rate[t]);
    MovingUnknown *moving = add_unknown(set, t);
    moving->normal = n;
    moving->friction = status_direction(state->status[i]) * friction_coefficient(law, speed);
    double slope = friction_slope(law, speed);
    *(slope > 0 ? &moving->damper : &moving->weakening) = fabs(slope) * state->reaction[n];
    set->weakens = set->weakens || moving->weakening > 0;
}

void moving_set_find(MovingSet *set, const State *state, bool with_open)
{
    const Interface *interface = set->interface;
    set->count = 0;
    set->weakens = false;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (status_slips(state->status[i])) add_slipping(set, state, i);
        if (!with_open || state->status[i] != CONTACT_OPEN) continue;
        add_unknown(set, interface_tangent(interface, i));
        add_unknown(set, interface_normal(interface, i));
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        double softness = set->rod->softness[j];
        if (state->rod_touches[j] && softness == 0) continue;
        MovingUnknown *moving = add_unknown(set, interface_rod(interface, j));
        if (!state->rod_touches[j]) continue;
        moving->spring = 1 / softness;
        moving->damper = set->rod->lag[j] / softness;
    }
    for (int32_t a = 0; a < set->count; a++) {
        const MovingUnknown *moving = &set->list[a];
        set->unknown[a] = moving->unknown;
        set->normal[a] = moving->normal >= 0 ? moving->normal : moving->unknown;
        set->friction[a] = moving->friction;
    }
}

void moving_set_gather(const MovingSet *set, const double *schur, double factor, double keep,
                       double *matrix)
{
    int64_t size = set->interface->count, count = set->count;
    const int32_t *row = set->unknown;
    for (int64_t b = 0; b < count; b++) {
        const double *column = schur + size * row[b];
        double *out = matrix + count * b;
        if (keep == 0)
            for (int64_t a = 0; a < count; a++) out[a] = factor * column[row[a]];
        else
            for (int64_t a = 0; a < count; a++) out[a] = keep * out[a] + factor * column[row[a]];
    }
}

void moving_set_couple(const MovingSet *set, const double *schur, double *matrix)
{
    int64_t size = set->interface->count, count = set->count;
    for (int64_t b = 0; b < count; b++) {
        const double *column = schur + size * set->unknown[b];
        double *out = matrix + count * b;
        for (int64_t a = 0; a < count; a++) out[a] += set->friction[a] * column[set->normal[a]];
    }
}

// S[n_b, a] is read as S[a, n_b], whose column lies beside that of b.
void moving_set_gather_symmetric(const MovingSet *set, const double *schur, double *matrix)
{
    int64_t size = set->interface->count, count = set->count;
    const int32_t *row = set->unknown, *normal = set->normal;
    const double *friction = set->friction;
    for (int64_t b = 0; b < count; b++) {
        const double *column = schur + size * row[b], *pressed = schur + size * normal[b];
        double *out = matrix + count * b;
        for (int64_t a = b; a < count; a++)
            out[a] = column[row[a]] +
                     0.5 * (friction[a] * column[normal[a]] + friction[b] * pressed[row[a]]);
    }
}

void moving_set_add_dampers(const MovingSet *set, double reach, double *matrix)
{
    for (int64_t a = 0; a < set->count; a++)
        matrix[a * set->count + a] += set->list[a].damper + reach * set->list[a].spring;
}

void moving_set_subtract_weakening(const MovingSet *set, double *matrix)
{
    for (int64_t a = 0; a < set->count; a++) matrix[a * set->count + a] -= set->list[a].weakening;
}
