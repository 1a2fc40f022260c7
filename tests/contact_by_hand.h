// SPDX-License-Identifier: GPL-2.0-or-later
// Contact problems written down number by number, without mesh or bulk: S, g and bounds are what a
// test says they are.
#ifndef AMONTONS_TESTS_CONTACT_BY_HAND_H
#define AMONTONS_TESTS_CONTACT_BY_HAND_H

#include "base/memory.h"
#include "contact/contact_check.h"
#include "contact/contact_solver.h"
#include "friction_by_hand.h"
#include "near.h"
#include "random_numbers.h"

#ifndef HAND_NODES   // a test may need more
#define HAND_NODES 40
#endif
#ifndef HAND_DIM
#define HAND_DIM 2
#endif
enum { HAND_RODS = 4, HAND_UNKNOWNS = HAND_DIM * HAND_NODES + HAND_RODS };

typedef struct HandContact {
    Interface interface;   // counts only
    FrictionLaw law;
    Friction friction;   // everywhere by that law, unless it has nodes
    RodKind rod_kind;
    const double *rod_softness;
    double rod_reach;
    double schur[HAND_UNKNOWNS * HAND_UNKNOWNS];
    double g[HAND_UNKNOWNS], bound[HAND_UNKNOWNS];
    double velocity[HAND_UNKNOWNS], reaction[HAND_UNKNOWNS];
    uint8_t status[HAND_NODES], rod_touches[HAND_RODS];
} HandContact;

static inline void hand_contact_size(HandContact *hand, int32_t contacts, int32_t rods)
{
    memset(hand, 0, sizeof *hand);
    hand->interface.dim = HAND_DIM;
    hand->interface.contact_count = contacts;
    hand->interface.rod_count = rods;
    hand->interface.count = HAND_DIM * contacts + rods;
    hand->rod_kind = ROD_PUSHES;
}

// matrix: of hand->schur; NULL: to be judged only.
static inline ContactProblem hand_problem(HandContact *hand, ContactMatrix *matrix)
{
    if (!hand->friction.node) hand->friction = FRICTION_OF(&hand->law);
    return (ContactProblem){.interface = &hand->interface,
                            .friction = &hand->friction,
                            .rod_kind = hand->rod_kind,
                            .rod_softness = hand->rod_softness,
                            .rod_reach = hand->rod_reach,
                            .matrix = matrix,
                            .g = hand->g,
                            .bound = hand->bound};
}

// Counts of one solve of a solver.
typedef struct HandCounts {
    int64_t iterations, rescued, sweeps;
} HandCounts;

// Solves with a solver of its own, from the statuses that stand there and from rest, allocating
// nothing.
static inline bool hand_contact_solve_by(HandContact *hand, bool sweeps_on, HandCounts *counts)
{
    Error err = {0};
    ContactSolver solver;
    ContactMatrix matrix;
    assert_true(contact_matrix_create(hand->schur, hand->interface.count, &matrix, &err));
    assert_true(contact_solver_create(&hand->interface, &solver, &err));
    solver.sweeps_on = sweeps_on;
    memset(hand->velocity, 0, sizeof hand->velocity);
    memset(hand->reaction, 0, sizeof hand->reaction);
    ContactSolution solution = {hand->velocity, hand->reaction, hand->status, hand->rod_touches};
    ContactProblem problem = hand_problem(hand, &matrix);
    int64_t allocations = memory_counters().allocations;
    bool solved = contact_solve(&solver, &problem, &solution);
    assert_int_equal(memory_counters().allocations, allocations);
    assert_int_equal(solver.solves, 1);
    assert_int_equal(solver.unsolved, !solved);
    *counts = (HandCounts){solver.iterations, solver.rescued, solver.sweeps};
    contact_solver_destroy(&solver);
    contact_matrix_destroy(&matrix);
    return solved;
}

static inline bool hand_contact_solve(HandContact *hand)
{
    HandCounts counts;
    return hand_contact_solve_by(hand, true, &counts);
}

// The largest violation, and of S v = g + r, relative to the forces there are.
static inline double hand_contact_error(HandContact *hand)
{
    int32_t count = hand->interface.count;
    double force = 0, diagonal = 0, worst = 0;
    for (int32_t k = 0; k < count; k++) {
        force = fmax(force, fmax(fabs(hand->g[k]), fabs(hand->reaction[k])));
        diagonal = fmax(diagonal, hand->schur[k * count + k]);
    }
    ContactProblem problem = hand_problem(hand, NULL);
    ContactResidual residual =
        contact_residual(&problem, hand->velocity, hand->reaction, force, force / diagonal);
    worst = contact_residual_max(&residual);
    for (int32_t i = 0; i < count; i++) {
        double sum = -hand->g[i] - hand->reaction[i];
        for (int32_t j = 0; j < count; j++) sum += hand->schur[j * count + i] * hand->velocity[j];
        worst = fmax(worst, fabs(sum) / force);
    }
    return worst;
}

// S = B B' / count + diagonal: positive definite, everything coupled to everything; coupling 0
// keeps tangents and normals apart.
static inline void hand_random_schur(Random *random, double diagonal, double coupling,
                                     HandContact *hand)
{
    int32_t count = hand->interface.count;
    static double b[HAND_UNKNOWNS * HAND_UNKNOWNS];
    for (int32_t k = 0; k < count * count; k++) b[k] = random_between(random, -1, 1);
    for (int32_t j = 0; j < count; j++) {
        for (int32_t i = 0; i < count; i++) {
            double sum = 0;
            for (int32_t k = 0; k < count; k++) sum += b[k * count + i] * b[k * count + j];
            int32_t contacts = HAND_DIM * hand->interface.contact_count, n = HAND_DIM - 1;
            bool across = i < contacts && j < contacts &&
                          (i % HAND_DIM == n) != (j % HAND_DIM == n);
            hand->schur[j * count + i] = (across ? coupling : 1) * 3 * sum / count +
                                         (i == j ? diagonal : 0);
        }
    }
}

#endif
