// SPDX-License-Identifier: GPL-2.0-or-later
// A friction law, mu = mu(v, states), d state_k/dt = g_k(v, states), v = |slip rate| >= 0: its
// numbers, what a scene gives to make it, and its table of operations. mu is continuous and not
// negative; at rest it is the threshold of sticking. A law may also ask for the pressure p.
//
// Each file of this folder holds one law or a family: its equations, its functions, and at the end
// its table. FRICTION_LAWS lists them. Tables are asked by friction/ alone, which has what is the
// same for all laws. tests/unit/friction compare slopes with differences of the coefficient, and
// states with their equation.
#ifndef AMONTONS_FRICTION_LAWS_LAW_H
#define AMONTONS_FRICTION_LAWS_LAW_H

#include "amontons_friction.h"
#include "base/error.h"
#include "base/formula.h"

#include <stdbool.h>
#include <stdint.h>

// symbol, name in a scene, its table of operations in friction/laws
#define FRICTION_LAWS(X)                                                                           \
    X(FRICTION_LINEAR_WEAKENING, "linear-weakening", friction_linear_weakening)                    \
    X(FRICTION_EXPONENTIAL_WEAKENING, "exponential-weakening", friction_exponential_weakening)     \
    X(FRICTION_COULOMB, "coulomb", friction_coulomb)                                               \
    X(FRICTION_TABLE, "table", friction_table)                                                     \
    X(FRICTION_FORMULA, "formula", friction_formula)                                               \
    X(FRICTION_PLUGIN, "plugin", friction_plugin)                                                  \
    X(FRICTION_AGEING, "ageing", friction_ageing)                                                  \
    X(FRICTION_SLIP_WEAKENING, "slip-weakening", friction_slip_weakening)                          \
    X(FRICTION_RATE_STATE, "rate-and-state", friction_rate_state)

typedef enum FrictionKind {
#define X(symbol, name, operations) symbol,
    FRICTION_LAWS(X)
#undef X
} FrictionKind;

// Numbers of a law beside mu_S, mu_K and v_c: field, which is its key in the map `friction` of a
// scene, and symbol. A formula may name them by either.
#define FRICTION_NUMBERS(X)                                                                        \
    X(slip_distance, "D_c") /* length */                                                           \
    X(healing_time, "theta_0") /* of slip-weakening t_h; time */                                   \
    X(healing, "beta") /* 1 */                                                                     \
    X(direct_effect, "a") /* 1 */                                                                  \
    X(evolution_effect, "b") /* 1 */                                                               \
    X(mu_reference, "f_0") /* mu of steady slip at V_0, of one's own law at the rod's V; 1 */      \
    X(reference_velocity, "V_0") /* velocity */

enum { STATES_MAX = AMONTONS_FRICTION_STATES_MAX };   // states of a node
enum { FRICTION_POINTS_MAX = 256 };   // points of a table

// mu and the rates g of the states, with their derivatives: as many entries as there are states.
typedef AmontonsFrictionRates FrictionRates;

// Points of the law `table`.
typedef struct FrictionTable {
    int32_t count;   // number of points, at least 2
    bool straight;   // lines between the points in place of cubics
    bool by_log;   // cubics over ln v; below the first point a line from `rest` at v = 0
    double rest;   // mu at v = 0, 1
    double first;   // the least velocity that is given; 0: mu at rest is
    double speed[FRICTION_POINTS_MAX];   // ascending, from 0 but where by_log, velocity
    double at[FRICTION_POINTS_MAX];   // the same, or their logarithms
    double mu[FRICTION_POINTS_MAX];   // 1
    double slope[FRICTION_POINTS_MAX];   // slopes of the cubics at the points, over `at`
} FrictionTable;

// Expressions of the law `formula`.
typedef struct FrictionFormula {
    Formula text;   // of v, the states and p: mu, then the rates, one behind the other
    int32_t ends[STATES_MAX + 2];   // where each begins, and where the last one ends
} FrictionFormula;

// Functions of the law `plugin`: of a law of speed alone coefficient and slope, of one with states
// the rest; the others are NULL.
typedef struct FrictionPlugin {
    double (*coefficient)(const AmontonsFriction *given, double speed);
    double (*slope)(const AmontonsFriction *given, double speed);
    int (*states)(const AmontonsFriction *given);
    void (*start)(const AmontonsFriction *given, double speed, double rest, double *state);
    void (*rates)(const AmontonsFriction *given, double speed, double pressure, const double *state,
                  AmontonsFrictionRates *rates);
    AmontonsFriction given;
} FrictionPlugin;

// A law with its numbers. Made by friction_make (friction/friction_make.h), which completes what a
// scene gives; a linear, exponential or Coulomb law needs no more than its first four numbers.
// Nothing is owned: copies are as good.
typedef struct FrictionLaw {
    FrictionKind kind;
    // Numbers of the scene's map `friction`.
    double mu_static;   // mu_S, 1: mu at rest; with states a scale: ageing at theta = 0,
        // rate-and-state what the slowest slip meets, others mu at rest at the start
    double mu_kinetic;   // mu_K <= mu_S, the lowest coefficient, 1; of laws that weaken
    double critical_velocity;   // v_c > 0, velocity; of laws that weaken
#define X(number, symbol) double number;
    FRICTION_NUMBERS(X)
#undef X
    bool slip_law;   // of rate-and-state: its state evolves by the slip law
    // The shape of mu(v).
    bool creeps;   // mu is 0 at rest, whatever the states are: no node ever sticks
    bool strengthens;   // at some speed a faster slip meets more friction
    double end;   // beyond this speed mu stays, velocity; of one's own law, like the next three
    double bend;   // the largest |mu'(v)|, one over a velocity
    double fall;   // of a law that rises above mu(0): the most that mu falls from one speed to a
        // faster one, 1; else 0
    double spent;   // speed from which on next to nothing weakens, velocity
    double steepest;   // the largest -mu'(v) with the states held, one over a velocity
    // States and pressure.
    bool remembers;   // mu depends on numbers of the stage: states, or pressure
    bool feels_pressure;   // mu or a rate depends on p
    int32_t states;   // number of states
    double start[STATES_MAX];   // the states when the rod begins to move
    double pressure;   // nominal p, stress
    union {
        FrictionTable table;
        FrictionFormula formula;
        FrictionPlugin plugin;
    };
} FrictionLaw;

// --- from a scene to a law ----------------------------------------------------------------------

enum { STATE_NAME_SIZE = 32, STATE_TEXT_SIZE = 512 };

// A state of the law `formula`, an entry of friction.state.
typedef struct FrictionStateText {
    char name[STATE_NAME_SIZE];
    char rate[STATE_TEXT_SIZE];   // formula of v, p and all states
    char start[STATE_TEXT_SIZE];   // formula of numbers; empty: that of steady slip
} FrictionStateText;

// The rest that a scene gives beside the kind and the numbers of a law. Nothing is owned.
typedef struct FrictionSource {
    const double *velocity, *mu;   // [velocity_count], [mu_count] points of a table
    int32_t velocity_count, mu_count;
    bool straight, by_log;   // lines between them; cubics over ln v
    const char *formula, *file;
    FormulaLookUp look_up;   // numbers that a formula may name; NULL: none
    const void *context;   // handed to look_up
    const FrictionStateText *state;   // [state_count]
    int32_t state_count;
    double rod_velocity;   // velocity; 0: no rod moves
    double rest;   // rest of the contacts before the rod moves, time; 0: not given
    double pressure;   // nominal, stress; NaN: not known yet
    const double *parameters;   // [parameter_count] of a plug-in
    int32_t parameter_count;
    double end;   // the fastest slip that a law is asked about, velocity
    bool trusted;   // a plug-in may be run
} FrictionSource;

// --- the table of operations --------------------------------------------------------------------

// Fills mu, or the rates g of the states, in *rates, with the derivatives. One function may fill
// both.
typedef void FrictionPart(const FrictionLaw *law, double speed, double pressure,
                          const double *state, FrictionRates *rates);

// Entries that a law leaves out are NULL, false and 0.
typedef struct FrictionOperations {
    // Keys of the scene's map `friction` that the law needs and that it takes, with blanks between
    // them; all take law, along and contacts.
    const char *must, *may;
    bool own;   // made by the user: it is looked at before it is used
    bool has_drop;   // it has mu_K and v_c
    bool is_convex;   // mu' never falls
    double spent;   // speed from which on next to nothing of mu(v) is left to fall, in units of v_c

    // Completes the law from what a scene gives. The state at the start, `rested` or `steady`, is
    // there by then, and may not use what is completed here. An error gives its key of the map
    // `friction`.
    bool (*make)(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err);

    // A built-in law of speed alone, with mu_S and mu_K times the factor: mu and d mu/d speed.
    double (*coefficient)(const FrictionLaw *law, double factor, double speed);
    double (*slope)(const FrictionLaw *law, double factor, double speed);
    // One's own law of speed alone, up to its end: mu, and through *slope d mu/d speed.
    double (*value)(const FrictionLaw *law, double speed, double *slope);
    // The k-th of the speeds, ascending from 0 to the end, at which it is looked at; INFINITY:
    // there are no more. NULL: a hundred to a decade.
    double (*look_speed)(const FrictionLaw *law, int32_t k);

    // A law that remembers: mu, and g.
    FrictionPart *mu, *rate;
    bool rate_is_linear;   // g is linear in the state
    // mu alone, where that costs less than with its derivatives.
    double (*mu_alone)(const FrictionLaw *law, double speed, double pressure, const double *state);
    // A built-in law has one state where `rested` is not NULL: that of contacts that rested for a
    // time, and that of steady slip.
    double (*rested)(const FrictionLaw *law, double rest);
    double (*steady)(const FrictionLaw *law, double speed);
    // One's own: the states at the start. NULL: the formulas of the source, else steady slip.
    void (*start)(const FrictionLaw *law, const FrictionSource *source, double *state);
    // The keys that are named where its states, and where mu, are not to be worked with.
    const char *state_key, *mu_key;
    // Area of the real contacts in these states, in a unit of its own; NULL: no state says it.
    double (*area)(const FrictionLaw *law, const double *state);
    // The state as people read it; NULL: as it is.
    double (*shown)(const FrictionLaw *law, double state);
    const char *state_name, *state_unit;   // NULL: theta, time
} FrictionOperations;

#define X(symbol, name, operations) extern const FrictionOperations operations;
FRICTION_LAWS(X)
#undef X

// The table of a law.
extern const FrictionOperations *const FRICTION_OPERATIONS[];
static inline const FrictionOperations *friction_operations(const FrictionLaw *law)
{
    return FRICTION_OPERATIONS[law->kind];
}

#endif
