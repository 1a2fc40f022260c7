// SPDX-License-Identifier: GPL-2.0-or-later
// Everything that depends on the kind of a law. Slopes are what
// Newton's derivative (contact/contact_equations) and the certificate's W (stepping/certificate)
// need; tests/unit/friction/test_friction_law.c compares them with differences of the coefficient.
#include "friction/friction_law.h"

#include <math.h>
#include <stddef.h>

FrictionLaw friction_constant(double mu)
{
    return (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = mu};
}

FrictionLaw friction_scaled(const FrictionLaw *law, double factor)
{
    FrictionLaw scaled = *law;
    scaled.mu_static *= factor;
    scaled.mu_kinetic *= factor;
    scaled.steepest *= factor;
    scaled.bend *= factor;
    scaled.fall *= factor;
    scaled.factor *= factor;
    if (law->remembers) scaled.own.memory.factor *= factor;
    return scaled;
}

FrictionLaw friction_spread(const FrictionLaw *each, int32_t count)
{
    FrictionLaw law = each[0];
    double largest = 0, critical = INFINITY;
    for (int32_t i = 0; i < count; i++) {
        if (friction_drop(&each[i]) > friction_drop(&law)) law = each[i];
        largest = fmax(largest, each[i].mu_static);
        if (friction_drop(&each[i]) > 0) critical = fmin(critical, each[i].critical_velocity);
    }
    double drop = friction_drop(&law);
    law.mu_static = largest;
    law.mu_kinetic = friction_has_drop(&law) ? largest - drop : largest;
    if (isfinite(critical)) law.critical_velocity = critical;
    law.each = each;
    return law;
}

static const struct {
    const char *name;
    bool own, drops;
    MemoryKind memory;
} KINDS[] = {
#define X(symbol, name, own, drops, memory) {name, own, drops, memory},
    FRICTION_LAWS(X)
#undef X
};

static bool is_known(FrictionKind kind)
{
    return (size_t)kind < sizeof KINDS / sizeof KINDS[0];
}

const char *friction_kind_name(FrictionKind kind)
{
    return is_known(kind) ? KINDS[kind].name : "unknown";
}

const char *friction_law_name(const FrictionLaw *law)
{
    return friction_kind_name(law->kind);
}

bool friction_is_own(const FrictionLaw *law)
{
    return is_known(law->kind) && KINDS[law->kind].own;
}

MemoryKind friction_memory_kind(FrictionKind kind)
{
    return is_known(kind) ? KINDS[kind].memory : MEMORY_FORMULAS;
}

bool friction_has_drop(const FrictionLaw *law)
{
    return is_known(law->kind) && KINDS[law->kind].drops;
}

// mu_S - mu_K of a law without memory that has one.
static inline double drop_of(const FrictionLaw *law)
{
    return law->mu_static - law->mu_kinetic;
}

// With memory that of its numbers, whatever its state.
static double lasting_drop(const FrictionLaw *law)
{
    const FrictionMemory *memory = &law->own.memory;
    return law->remembers ? memory->factor * (memory->mu_static - memory->mu_kinetic)
                          : drop_of(law);
}

double friction_drop(const FrictionLaw *law)
{
    return friction_has_drop(law) ? fmax(lasting_drop(law), law->fall) : 0;
}

double friction_slip(const FrictionLaw *law, double pressure, double height, double young)
{
    double drop = friction_drop(law);
    if (drop <= 0) drop = law->mu_static > 0 ? law->mu_static : 1;
    return drop * pressure * height / young;
}

// One's own law up to its end.
static double own_value(const FrictionLaw *law, double speed, double *slope)
{
    const FrictionPlugin *plugin = &law->own.plugin;
    if (law->kind == FRICTION_FORMULA) return formula_at(&law->own.formula, speed, slope);
    if (law->kind == FRICTION_TABLE) {
        const FrictionTable *table = &law->own.table;
        return friction_table_at(table, friction_table_interval(table, speed), speed, slope);
    }
    *slope = plugin->slope(&plugin->given, speed);
    return plugin->coefficient(&plugin->given, speed);
}

// The same at every speed.
static double own_law(const FrictionLaw *law, double speed, double *slope)
{
    double mu = own_value(law, fmin(speed, law->end), slope);
    *slope = speed < law->end ? law->factor * *slope : 0;
    return law->factor * mu;
}

// Two functions that are not inlined: the built-in laws, asked some million times in a run, need no
// stack.
static __attribute__((noinline)) double own_coefficient(const FrictionLaw *law, double speed)
{
    double ignored;
    return own_law(law, speed, &ignored);
}

static __attribute__((noinline)) double own_slope(const FrictionLaw *law, double speed)
{
    double slope;
    own_law(law, speed, &slope);
    return slope;
}

static __attribute__((noinline)) double remembered_slope(const FrictionLaw *law, double speed)
{
    double slope;
    memory_coefficient(&law->own.memory, speed, &slope);
    return slope;
}

// Continuous at v_c, where the linear law has its kink.
double friction_coefficient(const FrictionLaw *law, double speed)
{
    double critical = law->critical_velocity;
    if (law->remembers) return memory_coefficient(&law->own.memory, speed, NULL);
    if (law->kind == FRICTION_LINEAR_WEAKENING)
        return speed >= critical ? law->mu_kinetic
                                 : law->mu_static - drop_of(law) * speed / critical;
    if (law->kind == FRICTION_EXPONENTIAL_WEAKENING)
        return law->mu_kinetic + drop_of(law) * exp(-speed / critical);
    return friction_is_own(law) ? own_coefficient(law, speed) : law->mu_static;
}

// At v_c itself the linear law gives 0, so that a node exactly there counts as one that weakens no
// more.
double friction_slope(const FrictionLaw *law, double speed)
{
    double critical = law->critical_velocity;
    if (law->remembers) return remembered_slope(law, speed);
    if (law->kind == FRICTION_LINEAR_WEAKENING)
        return speed < critical ? -drop_of(law) / critical : 0.0;
    if (law->kind == FRICTION_EXPONENTIAL_WEAKENING)
        return -drop_of(law) / critical * exp(-speed / critical);
    return friction_is_own(law) ? own_slope(law, speed) : 0.0;
}

double friction_steepest(const FrictionLaw *law)
{
    if (law->remembers && law->own.memory.creeps) return law->steepest;
    if (friction_is_own(law) && !law->remembers) return law->steepest;
    return fmax(-friction_slope(law, 0), law->steepest);
}

// Ageing: a product of falling convex factors, ln(1 + c/(1 + x)) one of them.
bool friction_is_convex(const FrictionLaw *law)
{
    return !friction_is_own(law) && law->kind != FRICTION_RATE_STATE;
}

// Exponential weakening never ends but by underflow: there is no speed from which on a node is
// safe.
bool friction_weakens(const FrictionLaw *law, double speed)
{
    if (law->remembers) {
        double state[STATES_MAX], falls = 0;
        FrictionRates rates;
        memory_state(&law->own.memory, speed, state);
        memory_rates(&law->own.memory, speed, state, &rates);
        for (int32_t k = 0; k < rates.states; k++) falls += rates.mu_state[k] * rates.rate[k];
        return rates.mu_speed < 0 || falls < 0;
    }
    return friction_slope(law, speed) < 0.0;
}

bool friction_strengthens(const FrictionLaw *law)
{
    return law->strengthens;
}

// In units of v_c: the speed at which exp(-5) of the exponential law's drop is left, less than 1 %.
static const double SPENT = 5;

double friction_spent_speed(const FrictionLaw *law)
{
    if (law->remembers) return memory_spent_speed(&law->own.memory);
    if (friction_is_own(law)) return law->spent;
    if (!friction_has_drop(law)) return 0;
    return (law->kind == FRICTION_LINEAR_WEAKENING ? 1 : SPENT) * law->critical_velocity;
}

// Solves mu = mu_K + (mu_S - mu_K) phi for phi <= 1: 1 at rest, 0 from v_c on, and for the linear
// law just the paper's 1 - |v|/v_c.
double friction_contact_density(const FrictionLaw *law, double speed)
{
    double drop = friction_has_drop(law) ? lasting_drop(law) : 0;
    double left = drop > 0 ? (friction_coefficient(law, speed) - law->mu_kinetic) / drop : 1.0;
    return fmin(fmax(left, 0), 1);
}

// Points of a table and fifteen between each two; else a hundred to a decade, over the twelve below
// the law's end, as a formula may change anywhere.
double friction_look_speed(const FrictionLaw *law, int32_t k)
{
    enum { BETWEEN = 16, DECADE = 100, DECADES = 12 };
    int32_t last = law->kind == FRICTION_TABLE ? BETWEEN * (law->own.table.count - 1)
                                               : DECADES * DECADE + 1;
    if (k > last) return INFINITY;
    if (k == last) return law->end;
    if (law->kind != FRICTION_TABLE)
        return k == 0 ? 0 : law->end * pow(10, (double)(k - last) / DECADE);
    const double *speed = law->own.table.speed + k / BETWEEN;
    return speed[0] + (speed[1] - speed[0]) * (k % BETWEEN) / BETWEEN;
}
