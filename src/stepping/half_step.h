// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of a state that is its own mirror image across y: their contact problems on one side
// (contact/contact_half), at a quarter of the matrices and an eighth of their factors. A
// disturbance to one side is antisymmetric and would not show. So each state is asked, too, whether
// its antisymmetric part can gain energy, S_C - W of that part positive definite
// (stepping/certificate): where it cannot, a disturbance to one side decays whatever else happens,
// the symmetric part is enough, and an antisymmetric part that is only rounding is dropped. Where
// it may, that part is stepped along to first order. From the first problem on whose antisymmetric
// part is above rounding contact is solved as a whole. Owned by stepping/step_control, which
// decides that.
#ifndef AMONTONS_STEPPING_HALF_STEP_H
#define AMONTONS_STEPPING_HALF_STEP_H

#include "contact/contact_solver.h"
#include "reduction/symmetric_part.h"
#include "stepping/certificate.h"

typedef struct HalfStep {
    ContactHalf contact;   // how its two sides fold into one; owned, like all that follows
    bool exists;   // the contact has two sides that are alike
    ContactSolver solver;   // of one side
    Friction friction;   // of one side
    FrictionNode *nodes;   // [contact_count of both sides] its nodes
    Rod rod;   // of one side: softness and lag
    State one_side;   // of the last state folded: what the contact knows of it, nothing else
    SymmetricPart bulk;   // of both sides
    State symmetrised;   // the symmetric part of a state, work
    double *g, *bound;   // [interface.count] work, like the next
    ContactNewton newton;   // of the antisymmetric part, like the next four
    double *anti_g, *anti_bound, *anti_velocity, *anti_reaction;   // [interface.count] work
    Certificate symmetric, antisymmetric;
    double asymmetry;   // antisymmetric part of the last problem, over the symmetric one: followed
        // where it is not rounding
    bool antisymmetric_decays;   // in the state that parts_hold was last asked about
} HalfStep;

// whole: the certificate of the contact as a whole.
bool half_step_create(const Block *block, const Certificate *whole, HalfStep *half, Error *err);
void half_step_destroy(HalfStep *half);

// Takes the friction that acts now. Returns false where it is not alike on both sides.
bool half_step_take_friction(HalfStep *half, const Friction *friction);

// `state` on one side; stands until the next is folded.
const State *half_step_fold(HalfStep *half, const State *state);

// Drops the antisymmetric part of `state`, in which it decays, and of the bounds [interface.count
// of both sides] of the step that led there. It stays where the bulk is not split by the mirror, or
// where it has more than 1e-18 of the state's energy: ALIKE, squared.
void half_step_symmetrise(HalfStep *half, State *state, double *bound);

// All that acts on the bulk from `state` on, and its load, is symmetric but for the part `limit` of
// each; false, too, where the bulk is not reduced.
bool half_step_is_symmetric(const HalfStep *half, const State *state, double limit);

// Solves `problem`, whose matrix is that of the symmetric part, all else of both sides, from what
// is in `solution`. antisymmetric: the matrix of that part; NULL: it decays. *alike: whether the
// problem is its own mirror image; false: it is not solved.
bool half_step_solve(HalfStep *half, const ContactProblem *problem, ContactMatrix *antisymmetric,
                     ContactSolution *solution, bool *alike);

// Writes or reads all that outlives a step.
void half_step_archive(HalfStep *half, Archive *archive);

// Questions of stepping/certificate to a state, as a whole or to its symmetric and antisymmetric
// part. The latter is asked no further where it cannot gain energy. Nothing is owned.
typedef struct CertifiedParts {
    Certificate *whole;
    HalfStep *half;
    DtLevels *dt_levels;
    bool halved;   // the parts are asked
} CertifiedParts;

// certificate_holds. *antisymmetric_decays: of that part alone; false, too, where the whole is
// asked. The questions that follow are about the state that this was asked about last.
bool parts_hold(CertifiedParts parts, const State *state, double reach, bool *antisymmetric_decays);

// Questions about the levels of a range; the first two are about its first level alone.
typedef enum PartsAsked {
    PARTS_RESOLVE,   // certificate_step_resolves
    PARTS_FIND_NO_RUNAWAY,   // not certificate_finds_runaway, known to hold on that level
    PARTS_OSCILLATE_LESS,   // certificate_oscillates_less than `growth`
    PARTS_EXCLUDE_RUNAWAY   // certificate_excludes_runaway
} PartsAsked;

// True if the answer is yes for the whole, or for both parts.
bool parts_ask(CertifiedParts parts, const State *state, PartsAsked asked, LevelRange range,
               double growth);

#endif
