// SPDX-License-Identifier: GPL-2.0-or-later
// The local friction law |tau| <= mu(v) p: THE replaceable file. A law is a coefficient that is
// continuous and not negative; at rest mu(0) is the static threshold, stick is set-valued.
//
//   linear weakening   mu_S - (mu_S - mu_K) |v| / v_c  for |v| < v_c,  mu_K above
//                      (Otsuki and Matsukawa, Sci. Rep. 3, 1586, 2013)
//   exponential        mu_K + (mu_S - mu_K) exp(-|v| / v_c)
//   Coulomb            mu_S
//   one's own          a table, a formula or a plug-in: may rise, also above mu(0)
//   with memory        of speed and states, which a stage eliminates (friction/friction_state)
//
// A new law is a line of FRICTION_LAWS, its cases in friction_law.c and its column of keys in
// friction_make.c; one with a state has its functions in friction_memory.c and its numbers from
// scene/own_law.
#ifndef AMONTONS_FRICTION_FRICTION_LAW_H
#define AMONTONS_FRICTION_FRICTION_LAW_H

#include "base/formula.h"
#include "friction/friction_memory.h"
#include "friction/friction_plugin.h"
#include "friction/friction_table.h"

// symbol, name in a scene, it is one's own, it has mu_K and v_c, what it remembers by a row that is
// built in (FORMULAS: by none)
#define FRICTION_LAWS(X)                                                                           \
    X(FRICTION_LINEAR_WEAKENING, "linear-weakening", false, true, MEMORY_FORMULAS)                 \
    X(FRICTION_EXPONENTIAL_WEAKENING, "exponential-weakening", false, true, MEMORY_FORMULAS)       \
    X(FRICTION_COULOMB, "coulomb", false, false, MEMORY_FORMULAS)                                  \
    X(FRICTION_TABLE, "table", true, true, MEMORY_FORMULAS)                                        \
    X(FRICTION_FORMULA, "formula", true, true, MEMORY_FORMULAS)                                    \
    X(FRICTION_PLUGIN, "plugin", true, true, MEMORY_FORMULAS)                                      \
    X(FRICTION_AGEING, "ageing", false, true, MEMORY_AGEING)                                       \
    X(FRICTION_SLIP_WEAKENING, "slip-weakening", false, true, MEMORY_SLIP_WEAKENING)               \
    X(FRICTION_RATE_STATE, "rate-and-state", false, true, MEMORY_RATE_STATE)

typedef enum FrictionKind {
#define X(symbol, name, own, drops, memory) symbol,
    FRICTION_LAWS(X)
#undef X
} FrictionKind;

// Nothing is owned: copies are as good.
typedef struct FrictionLaw {
    FrictionKind kind;
    bool remembers;   // it has states (friction/friction_memory); by friction_make_memory
    double mu_static;   // mu_S = mu(0), 1; with memory: in the stage under way
    double mu_kinetic;   // mu_K <= mu_S, the lowest coefficient, 1; of laws that weaken
    double critical_velocity;   // v_c > 0, velocity; of laws that weaken
    // The rest: of one's own laws, by friction/friction_make and friction/friction_look.
    double end;   // beyond this speed mu stays, velocity
    double steepest;   // the largest -mu'(v), one over a velocity
    double bend;   // the largest |mu'(v)|, one over a velocity
    double fall;   // of a law that rises above mu(0): the most that mu falls from one speed to a
        // faster one, 1; else 0
    double spent;   // friction_spent_speed, velocity
    bool strengthens;   // at some speed a faster slip meets more friction
    double factor;   // on what `own` says, 1
    // Where laws differ along the contact: that of each node [contact_count], not owned; the rest
    // of this struct then speaks of them all (friction_spread). NULL: this one holds everywhere.
    const struct FrictionLaw *each;
    union {
        FrictionTable table;
        Formula formula;   // of v
        FrictionPlugin plugin;
        FrictionMemory memory;   // of laws with memory
    } own;
} FrictionLaw;

// mu at every speed; 0: no friction.
FrictionLaw friction_constant(double mu);

// That of contact node i.
static inline const FrictionLaw *friction_at(const FrictionLaw *law, int32_t i)
{
    return law->each ? &law->each[i] : law;
}

// With `factor` >= 0 times the coefficient at every speed.
FrictionLaw friction_scaled(const FrictionLaw *law, double factor);

// The law that stands for the laws `each` [count] of all nodes: it has the largest mu_S, the
// largest drop and the least v_c. friction_at gives the law of a node.
FrictionLaw friction_spread(const FrictionLaw *each, int32_t count);

const char *friction_kind_name(FrictionKind kind);   // "unknown" for one that there is not
const char *friction_law_name(const FrictionLaw *law);   // "unknown" for a kind that there is not

// A table, a formula or a plug-in.
bool friction_is_own(const FrictionLaw *law);
MemoryKind friction_memory_kind(FrictionKind kind);   // MEMORY_FORMULAS: none that is built in

// It has mu_K and v_c; else they mean nothing.
bool friction_has_drop(const FrictionLaw *law);

// The largest loss of mu from a speed to a faster one: mu_S - mu_K where mu is nowhere above
// mu(0); 0 where nothing weakens.
double friction_drop(const FrictionLaw *law);

// The slip that the drop can drive under a mean pressure, drop * pressure * height / young, length;
// mu_S stands for the drop where nothing weakens, 1 without any friction.
double friction_slip(const FrictionLaw *law, double pressure, double height, double young);

// speed, here and below: |slip rate| >= 0.
double friction_coefficient(const FrictionLaw *law, double speed);

// d mu / d speed, one over a velocity: below 0 where the law weakens, above 0 where it strengthens;
// at a kink the slope beyond it.
double friction_slope(const FrictionLaw *law, double speed);

// The largest weakening -mu' of all speeds, one over a velocity.
double friction_steepest(const FrictionLaw *law);

// mu' never falls: w + a mu(w), a > 0, has no more than two roots.
bool friction_is_convex(const FrictionLaw *law);

// Still weakening at this speed: a faster, or with memory a further slip meets less friction.
bool friction_weakens(const FrictionLaw *law, double speed);

// At some speed a faster slip meets more friction.
bool friction_strengthens(const FrictionLaw *law);

// From about this speed on next to nothing weakens any more, velocity; 0 where nothing weakens.
double friction_spent_speed(const FrictionLaw *law);

// phi = max(0, 1 - |v|/v_c), the density of real contacts that hold (the paper's Figure 1d); from
// the coefficient for the other laws: (mu - mu_K) / (mu_S - mu_K), 1 from mu_S on.
double friction_contact_density(const FrictionLaw *law, double speed);

// The k-th of the speeds, ascending from 0 to its end, at which one's own law is looked at before
// it is used (friction/friction_look); INFINITY: there are no more.
double friction_look_speed(const FrictionLaw *law, int32_t k);

#endif
