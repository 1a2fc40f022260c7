// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of a state that is its own mirror image across y: their contact problems on one side
// (contact/contact_half), at a quarter of the matrices and an eighth of their factors. A
// disturbance to one side is odd and would not show. So each state is asked, too, whether what is
// odd can gain energy, S_C - W of the odd part positive definite (stepping/certificate): where it
// cannot, a disturbance to one side decays whatever else happens, and the even part is enough.
// Where it may, what is odd, if only rounding, is stepped along to first order. From the first
// problem on whose odd part is above rounding contact is solved as a whole. Owned by
// stepping/step_control, which decides that.
#ifndef AMONTONS_STEPPING_HALF_STEP_H
#define AMONTONS_STEPPING_HALF_STEP_H

#include "contact/contact_solver.h"
#include "stepping/certificate.h"

typedef struct HalfStep {
    ContactHalf half;   // owned, like all that follows
    bool exists;   // the contact has two sides that are alike
    ContactSolver solver;   // of one side
    Friction friction;   // of one side
    FrictionNode *nodes;   // [contact_count of both sides] its nodes
    Rod rod;   // of one side: softness and lag
    State state;   // one side of the last one folded: what the contact knows of it, nothing else
    double *g, *bound;   // [interface.count] work, like the next
    ContactNewton newton;   // of what is odd, like the next
    double *odd_g, *odd_bound, *odd_velocity, *odd_reaction;
    Certificate even, odd;
    double odd_part;   // of the last problem, over what is even: followed where it is not rounding
    bool odd_decays;   // of the state last asked about (stepping/both_sides)
} HalfStep;

// whole: the certificate of both sides.
bool half_step_create(const Block *block, const Certificate *whole, HalfStep *half, Error *err);
void half_step_destroy(HalfStep *half);

// Takes the friction that acts now. Returns false where it is not alike on both sides.
bool half_step_take_friction(HalfStep *half, const Friction *friction);

// `state` on one side; stands until the next is folded.
const State *half_step_fold(HalfStep *half, const State *state);

// Solves `problem`, but for its matrix, what is even, that of both sides, from what is in
// `solution`. odd: the matrix of what is odd; NULL: it decays. *alike: whether it is its own mirror
// image; false: it is not solved.
bool half_step_solve(HalfStep *half, const ContactProblem *problem, ContactMatrix *odd,
                     ContactSolution *solution, bool *alike);

// Writes or reads all that outlives a step.
void half_step_archive(HalfStep *half, Archive *archive);

#endif
