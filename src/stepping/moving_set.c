// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/moving_set.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "friction/friction_response.h"
#include "contact/slip.h"

#include <math.h>
#include <string.h>

bool moving_set_create(const Block *block, MovingSet *set, Error *err)
{
    *set = (MovingSet){
        .interface = block->interface, .contact_friction = block->friction, .rod = block->rod};
    int64_t count = block->interface->count;
    set->list = NEW_ARRAY(MovingUnknown, count, err);
    set->unknown = NEW_ARRAY(int32_t, count, err);
    set->normal = NEW_ARRAY(int32_t, count, err);
    set->friction = NEW_ARRAY(double, count, err);
    set->turned = NEW_ARRAY(int32_t, count, err);
    set->direction = NEW_ARRAY(double, count, err);
    if (friction_remembers(block->friction, block->interface->contact_count))
        set->rates = NEW_ARRAY(FrictionRates, block->interface->contact_count, err);
    return error_is_clean(err);
}

void moving_set_destroy(MovingSet *set)
{
    memory_free_all(set->list, set->unknown, set->normal, set->friction, set->turned,
                    set->direction, set->rates);
    *set = (MovingSet){0};
}

// Adds an unknown without friction, weakening and rod: the caller adds what it has.
static MovingUnknown *add_unknown(MovingSet *set, int32_t unknown)
{
    MovingUnknown *moving = &set->list[set->count++];
    *moving = (MovingUnknown){.unknown = unknown, .normal = -1, .node = -1};
    return moving;
}

// The tangents of slipping node i, in space along the slip and across it.
static void add_slipping(MovingSet *set, const State *state, int32_t i)
{
    const Interface *interface = set->interface;
    int32_t t = interface_tangent(interface, i), n = interface_normal(interface, i);
    bool in_space = slip_tangents(interface) > 1;
    double speed = slip_size(interface, i, state->slip_rate), pressing = state->reaction[n];
    FrictionRates rates;
    state_friction(state, interface, friction_at(set->contact_friction, i), i, &rates);

    // Direction d of the slip; against friction where it has no speed.
    double d[TANGENTS_MAX] = {status_direction(state->status[i])};
    if (in_space) {
        double shear = slip_size(interface, i, state->reaction);
        const double *along = speed > 0 ? state->slip_rate + t : state->reaction + t;
        double length = speed > 0 ? speed : -shear;
        for (int32_t c = 0; c < 2 && length != 0; c++) d[c] = along[c] / length;
    }

    // Along: friction where pressure grows, and where speed does.
    MovingUnknown *moving = add_unknown(set, t);
    double follows = rates.mu;
    if (rates.mu_pressure != 0) follows += rates.mu_pressure * pressing / interface->weight[i];
    moving->normal = n;
    moving->friction = d[0] * follows;
    double slope = rates.mu_speed;
    *(slope > 0 ? &moving->damper : &moving->weakening) = fabs(slope) * pressing;
    set->weakens = set->weakens || moving->weakening > 0;

    // Across: friction mu r_n against a slip of that speed, which turns with it.
    if (in_space) {
        memcpy(set->direction + 2 * (size_t)set->turned_count, d, sizeof d);
        set->turned[set->turned_count++] = set->count - 1;
        MovingUnknown *across = add_unknown(set, t + 1);
        across->normal = n;
        across->friction = d[1] * follows;
        across->held = speed == 0 && rates.mu > 0;
        across->damper = speed > 0 ? rates.mu * pressing / speed
                                   : fmax(rates.mu_speed, 0) * pressing;
    }

    // Memory of the slip in friction: one state that fades, or several.
    if (rates.states == 1 && rates.rate_state[0][0] <= 0) {
        moving->memory = -rates.mu_state[0] * rates.rate_speed[0] * pressing;
        moving->fading = -rates.rate_state[0][0];
        set->remembers = set->remembers || moving->memory != 0;
    } else if (rates.states > 0) {
        moving->node = i;
        set->remembers = true;
        set->rates[i] = rates;
        for (int32_t k = 0; k < rates.states; k++) set->rates[i].mu_state[k] *= pressing;
    }
}

void moving_set_find(MovingSet *set, const State *state, bool with_open)
{
    const Interface *interface = set->interface;
    set->count = set->turned_count = 0;
    set->weakens = set->remembers = false;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (status_slips(state->status[i])) add_slipping(set, state, i);
        if (!with_open || state->status[i] != CONTACT_OPEN) continue;
        for (int32_t c = 0; c < interface->dim; c++)
            add_unknown(set, interface_unknown(interface, i, c));
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

// True if the second unknown of turned node k, across its slip, does not move.
static bool is_held_across(const MovingSet *set, int32_t k)
{
    return set->list[set->turned[k] + 1].held;
}

// (x, y) becomes (d.(x, y), e.(x, y)).
static void turn(const double d[2], double *x, double *y)
{
    double along = d[0] * *x + d[1] * *y;
    *y = d[0] * *y - d[1] * *x;
    *x = along;
}

void moving_set_turn_vector(const MovingSet *set, bool back, double *vector)
{
    for (int32_t k = 0; k < set->turned_count; k++) {
        const double *d = set->direction + 2 * k, other[] = {d[0], -d[1]};
        double *along = vector + set->turned[k];
        turn(back ? other : d, along, along + 1);
        if (!back && is_held_across(set, k)) along[1] = 0;
    }
}

// Takes row and column `held` out of the matrix: it keeps its own diagonal entry alone.
static void uncouple(double *matrix, int64_t count, int64_t held)
{
    for (int64_t a = 0; a < count; a++)
        if (a != held) matrix[count * held + a] = matrix[count * a + held] = 0;
}

void moving_set_turn(const MovingSet *set, bool lower, double *matrix)
{
    int64_t count = set->count;
    for (int64_t b = 0; set->turned_count > 0 && b < count; b++) {
        double *column = matrix + count * b;
        for (int32_t k = 0; k < set->turned_count; k++) {
            int32_t a = set->turned[k];
            if (!lower || a > b) turn(set->direction + 2 * k, column + a, column + a + 1);
        }
    }
    for (int32_t k = 0; k < set->turned_count; k++) {
        int64_t a = set->turned[k];
        double *column = matrix + count * a;
        if (lower) {   // the block of a node's own rows and columns, which has no upper triangle
            const double *d = set->direction + 2 * k;
            double *block = column + a, upper = block[1], *second = block + count;
            turn(d, block, block + 1);
            turn(d, &upper, second + 1);
            turn(d, block, &upper);
            turn(d, block + 1, second + 1);
        }
        for (int64_t r = lower ? a + 2 : 0; r < count; r++)
            turn(set->direction + 2 * k, column + r, column + count + r);
    }
    for (int32_t k = 0; k < set->turned_count; k++)
        if (is_held_across(set, k)) uncouple(matrix, count, set->turned[k] + 1);
}

void moving_set_add_dampers(const MovingSet *set, double reach, double *matrix)
{
    for (int64_t a = 0; a < set->count; a++)
        matrix[a * set->count + a] += set->list[a].damper + reach * set->list[a].spring;
}

// W(s) - W of unknown a at s = 1/reach.
static double remembered_at(const MovingSet *set, int32_t a, double reach)
{
    const MovingUnknown *moving = &set->list[a];
    if (moving->node >= 0) return friction_weakens_at(&set->rates[moving->node], reach);
    return moving->memory * reach / (1 + reach * moving->fading);
}

void moving_set_subtract_weakening(const MovingSet *set, double reach, double *matrix)
{
    for (int64_t a = 0; a < set->count; a++) {
        double remembered = remembered_at(set, (int32_t)a, reach);
        matrix[a * set->count + a] -= set->list[a].weakening + remembered;
    }
}

// With s = |s| exp(i phi) Re 1/(s + k) falls as |s| grows; in cos phi it rises for |s| > k and
// falls below. So it is largest at |s| = 1/reach, at cos phi = 1 or at `narrow`.
void moving_set_subtract_memory(const MovingSet *set, double reach, double narrow, double factor,
                                double *matrix)
{
    for (int64_t a = 0; set->remembers && a < set->count; a++) {
        const MovingUnknown *moving = &set->list[a];
        double *diagonal = &matrix[a * (set->count + 1)];
        double fades = reach * moving->fading, cosine = fades > 1 ? narrow : 1;
        double part = factor * (cosine + fades) / (1 + 2 * cosine * fades + fades * fades);
        if (moving->memory > 0) *diagonal -= moving->memory * reach * part;
        if (moving->node >= 0)
            *diagonal -= factor * friction_weakens_most(&set->rates[moving->node], reach);
    }
}

bool moving_set_decays(const MovingSet *set, double reach)
{
    for (int32_t a = 0; set->remembers && a < set->count; a++) {
        int32_t i = set->list[a].node;
        if (i >= 0 && !friction_states_decay(&set->rates[i], reach)) return false;
    }
    return true;
}

void moving_set_settle(MovingSet *set, double reach)
{
    for (int32_t a = 0; set->remembers && a < set->count; a++) {
        MovingUnknown *moving = &set->list[a];
        if (moving->memory == 0 && moving->node < 0) continue;
        double weakening = moving->weakening - moving->damper + remembered_at(set, a, reach);
        moving->weakening = fmax(weakening, 0);
        moving->damper = fmax(-weakening, 0);
        moving->memory = 0;
        moving->node = -1;
        set->weakens = set->weakens || weakening > 0;
    }
    set->remembers = false;
}

// --- weakening ratio ----------------------------------------------------------------------------

// Lengths of vectors are sqrt(x' W x): where A is symmetric so is A^-1 W in that product, and the
// growth of the length converges twice as fast as the vector (Parlett, The Symmetric Eigenvalue
// Problem, 4.2).
enum { POWERS_LIMIT = 1000 };   // 300 were enough for 430 000 ratios of 60 scenes

static double length_of(const MovingSet *set, const double *x)
{
    double square = 0;
    for (int32_t a = 0; a < set->count; a++) square += set->list[a].weakening * x[a] * x[a];
    return sqrt(square);
}

double weakening_ratio(const MovingSet *set, const double *lu, const int32_t *pivots,
                       double tolerance, double *x)
{
    if (!set->weakens) return 0;
    for (int32_t a = 0; a < set->count; a++) x[a] = 1;
    double length = length_of(set, x), ratio = INFINITY;
    for (int32_t power = 0; power < POWERS_LIMIT; power++) {
        double before = ratio;
        for (int32_t a = 0; a < set->count; a++) x[a] *= set->list[a].weakening / length;
        dense_lu_solve(lu, set->count, pivots, x);
        ratio = length = length_of(set, x);
        if (fabs(ratio - before) <= tolerance * ratio) return ratio;
    }
    return INFINITY;
}

double weakening_ratio_top(const double ratio[3], double *octaves)
{
    double slope = (ratio[2] - ratio[0]) / 2, curve = ratio[2] - 2 * ratio[1] + ratio[0];
    *octaves = 0;
    if (!(curve < 0 && ratio[1] >= ratio[0] && ratio[1] >= ratio[2])) return ratio[1];
    *octaves = -slope / curve;
    return ratio[1] - slope * slope / (2 * curve);
}
