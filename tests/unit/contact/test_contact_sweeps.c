// SPDX-License-Identifier: GPL-2.0-or-later
// Sweeps in the plane, without statuses to begin from: random problems of every law, judged by
// their conditions; one node by hand; nothing allocated. Sweeps in space:
// test_contact_solver_space.c.
#include "contact/contact_sweeps.h"

#include "base/memory.h"
#include "contact_by_hand.h"

// Round after round from rest, each with Newton behind it, as the solver has them. false: none led
// to a solution.
static bool follow(HandContact *hand)
{
    Error err = {0};
    ContactSolver solver;
    ContactMatrix matrix;
    bool solved = false;
    assert_true(contact_matrix_create(hand->schur, hand->interface.count, &matrix, &err));
    assert_true(contact_solver_create(&hand->interface, &solver, &err));
    solver.sweeps_on = false;
    ContactProblem problem = hand_problem(hand, &matrix);
    ContactSolution solution = {hand->velocity, hand->reaction, hand->status, hand->rod_touches};
    int64_t allocations = memory_counters().allocations;
    for (int32_t round = 0; round < SWEEP_ROUNDS && !solved; round++) {
        memset(hand->velocity, 0, sizeof hand->velocity);
        assert_true(contact_sweep(&problem, &solution, round) > 0);
        solved = contact_solve(&solver, &problem, &solution);
    }
    assert_int_equal(memory_counters().allocations, allocations);
    contact_solver_destroy(&solver);
    contact_matrix_destroy(&matrix);
    return solved;
}

// S v = g + r with S = diag(2, 3): by hand for each of the three things a node can do.
TEST(test_one_node)
{
    static HandContact hand;
    const struct {
        double g_t, g_n;
        uint8_t status;
        double v_t, v_n, r_t, r_n;
    } known[] = {
        {0.25, -1, CONTACT_STICK, 0, 0, -0.25, 1},
        {2, -1, CONTACT_SLIP_FORWARD, 0.75, 0, -0.5, 1},   // |r_t| = mu r_n = 0.5
        {-2, -1, CONTACT_SLIP_BACKWARD, -0.75, 0, 0.5, 1},
        {1, 3, CONTACT_OPEN, 0.5, 1, 0, 0},
    };
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        hand_contact_size(&hand, 1, 0);
        hand.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.5};
        hand.schur[0] = 2;
        hand.schur[3] = 3;
        hand.g[0] = known[k].g_t;
        hand.g[1] = known[k].g_n;
        assert_true(follow(&hand));
        assert_int_equal(hand.status[0], known[k].status);
        assert_near("v_t", hand.velocity[0], known[k].v_t, 1e-8);
        assert_near("v_n", hand.velocity[1], known[k].v_n, 1e-8);
        assert_near("r_t", hand.reaction[0], known[k].r_t, 1e-8);
        assert_near("r_n", hand.reaction[1], known[k].r_n, 1e-8);
    }
}

// Strongly coupled, weakening by half of S and more: what Newton's statuses may cycle on.
TEST(test_random_problems)
{
    static HandContact hand;
    static const FrictionKind kinds[] = {FRICTION_COULOMB, FRICTION_LINEAR_WEAKENING,
                                         FRICTION_EXPONENTIAL_WEAKENING};
    enum { TRIALS = 600 };
    Random random = {.state = 11};
    int32_t missed = 0;
    for (int32_t trial = 0; trial < TRIALS; trial++) {
        hand_contact_size(&hand, 1 + random_index(&random, 12), random_index(&random, 3));
        hand.law = (FrictionLaw){.kind = kinds[trial % 3],
                                 .mu_static = random_between(&random, 0.2, 1.5),
                                 .mu_kinetic = 0.1,
                                 .critical_velocity = random_between(&random, 0.2, 2)};
        hand.rod_kind = trial % 2 ? ROD_PUSHES : ROD_IS_BONDED;
        hand_random_schur(&random, 0.5, 1, &hand);
        for (int32_t k = 0; k < hand.interface.count; k++) {
            hand.g[k] = random_between(&random, -1, 1);
            hand.bound[k] = random_between(&random, -0.2, 0.2);
        }
        bool found = follow(&hand);
        missed += !found;
        if (found) assert_near("conditions", hand_contact_error(&hand), 0, 1e-9);
    }
    printf("%d of %d given up\n", missed, TRIALS);
    assert_in_range(missed, 0, TRIALS / 100);
}

// Nodes above the substrate by up to 1e8 of what they move in a step, as where an impact is taken
// in very short steps.
TEST(test_from_a_height)
{
    static HandContact hand;
    enum { TRIALS = 300 };
    Random random = {.state = 3};
    int32_t missed = 0;
    for (int32_t trial = 0; trial < TRIALS; trial++) {
        hand_contact_size(&hand, 2 + random_index(&random, 8), 0);
        hand.law = (FrictionLaw){.kind = FRICTION_LINEAR_WEAKENING,
                                 .mu_static = 0.4,
                                 .mu_kinetic = 0.1,
                                 .critical_velocity = random_between(&random, 0.02, 0.2)};
        hand_random_schur(&random, 0.5, 1, &hand);
        for (int32_t k = 0; k < hand.interface.count; k++) {
            hand.g[k] = random_between(&random, -1, 1);
            if (k % 2 == 1 && random_index(&random, 2) == 1)
                hand.bound[k] = -pow(10, random_between(&random, 0, 8));
        }
        if (!follow(&hand)) {
            missed++;
            continue;
        }
        for (int32_t k = 1; k < hand.interface.count; k += 2)   // no more than rounding of it
            assert_true(hand.bound[k] == 0 || hand.status[k / 2] == CONTACT_OPEN);
        assert_near("conditions", hand_contact_error(&hand), 0, 1e-7);
    }
    printf("%d of %d given up\n", missed, TRIALS);
    assert_in_range(missed, 0, TRIALS / 100);
}

// The second node is 1e6 above the plane, but so soft that it falls: it carries what its own
// stiffness leaves. From 1e8 above it does not come down.
TEST(test_fallen)
{
    static HandContact hand;
    hand_contact_size(&hand, 2, 0);
    hand.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.5};
    for (int k = 0; k < 4; k++) hand.schur[5 * k] = k < 3 ? 1 : 1e-7;
    hand.g[1] = hand.g[3] = -1;
    hand.bound[3] = -1e6;
    assert_true(follow(&hand));
    assert_int_equal(hand.status[1], CONTACT_STICK);
    assert_near("v_n", hand.velocity[3], -1e6, 1e-4);
    assert_near("r_n", hand.reaction[3], 1 - 0.1, 1e-9);
    hand.bound[3] = -1e8;   // too far for that, too
    assert_true(follow(&hand));
    assert_int_equal(hand.status[1], CONTACT_OPEN);
    assert_near("v_n", hand.velocity[3], -1e7, 1e-3);
}

// Without friction at rest nothing sticks: v = g_t / s_t.
TEST(test_no_friction)
{
    static HandContact hand;
    hand_contact_size(&hand, 1, 0);
    hand.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0};
    hand.schur[0] = hand.schur[3] = 2;
    hand.g[0] = 1;
    hand.g[1] = -1;
    assert_true(follow(&hand));
    assert_near("v_t", hand.velocity[0], 0.5, 1e-12);
    assert_near("r_t", hand.reaction[0], 0, 1e-12);
}
