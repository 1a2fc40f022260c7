// SPDX-License-Identifier: GPL-2.0-or-later
// Contact in space by hand: one node, whose slip has a closed form; a problem in the plane with y
// beside it; and many sweeps written here.
#define HAND_DIM 3
#define HAND_NODES 12
#include "contact_by_hand.h"

static HandContact hand;

static void one_node(double resists, double p, double gx, double gy)
{
    hand_contact_size(&hand, 1, 0);
    hand.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.5};
    for (int32_t k = 0; k < 3; k++) hand.schur[4 * k] = resists;
    hand.g[0] = gx;
    hand.g[1] = gy;
    hand.g[2] = -p;
}

// Alike in all directions it slips along the force: v = (|g| - mu p)/S g/|g|; mu p holds what is
// less, in any direction; a tensile g opens it.
TEST(test_one_node)
{
    for (uint8_t guess = CONTACT_OPEN; guess <= CONTACT_SLIP_BACKWARD; guess++) {
        one_node(2, 2, -3, 4);
        hand.status[0] = guess;
        assert_true(hand_contact_solve(&hand));
        assert_all_near("v", hand.velocity, (double[]){-1.2, 1.6, 0}, 3, 1e-12);
        assert_all_near("r", hand.reaction, (double[]){0.6, -0.8, 2}, 3, 1e-12);
        assert_int_equal(hand.status[0], CONTACT_SLIP_BACKWARD);
        one_node(2, 10.1, -3, 4);
        hand.status[0] = guess;
        assert_true(hand_contact_solve(&hand));
        assert_all_near("v", hand.velocity, (double[]){0, 0, 0}, 3, 0);
        assert_all_near("r", hand.reaction, (double[]){3, -4, 10.1}, 3, 1e-12);
        assert_int_equal(hand.status[0], CONTACT_STICK);
        one_node(2, -1, -3, 4);
        hand.status[0] = guess;
        assert_true(hand_contact_solve(&hand));
        assert_all_near("v", hand.velocity, (double[]){-1.5, 2, 0.5}, 3, 1e-12);
        assert_all_near("r", hand.reaction, (double[]){0, 0, 0}, 3, 0);
    }
}

// Stiffer along y it turns away from the force: v = (S + l)^-1 g with l |v| = mu p, by halving.
TEST(test_turning)
{
    one_node(1, 2, 3, 4);
    hand.schur[4] = 7;
    hand.status[0] = CONTACT_STICK;
    double low = 0, high = 1e6;
    for (int32_t k = 0; k < 200; k++) {
        double l = 0.5 * (low + high);
        *(l * hypot(3 / (1 + l), 4 / (7 + l)) < 1 ? &low : &high) = l;
    }
    assert_true(hand_contact_solve(&hand));
    assert_all_near("v", hand.velocity, (double[]){3 / (1 + low), 4 / (7 + low), 0}, 3, 1e-12);
}

// A problem without y and without a force along it does not move along y; its solution is that of
// the plane to rounding.
TEST(test_plane)
{
    enum { NODES = 9, UNKNOWNS = 2 * NODES };
    Random random = {.state = 7};
    Error err = {0};
    int32_t slipping = 0;
    for (int32_t trial = 0; trial < 60; trial++) {
        double schur[UNKNOWNS * UNKNOWNS], g[UNKNOWNS], bound[UNKNOWNS], v[UNKNOWNS] = {0};
        double r[UNKNOWNS] = {0};
        uint8_t status[NODES];
        memset(status, CONTACT_STICK, sizeof status);
        hand_contact_size(&hand, NODES, 0);
        hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                                 .mu_static = 0.4,
                                 .mu_kinetic = 0.1,
                                 .critical_velocity = 1};
        hand_random_schur(&random, 3, 0.5, &hand);
        for (int32_t b = 0; b < 3 * NODES; b++)
            for (int32_t a = 0; a < 3 * NODES; a++)
                if ((a % 3 == 1) != (b % 3 == 1)) hand.schur[3 * NODES * b + a] = 0;
        for (int32_t k = 0; k < UNKNOWNS; k++) {
            int32_t in_space = 3 * (k / 2) + 2 * (k % 2);
            g[k] = hand.g[in_space] = random_between(&random, k % 2 ? -4 : -3, k % 2 ? 1 : 3);
            bound[k] = hand.bound[in_space] = k % 2 ? random_between(&random, -0.4, 0.1) : 0;
            for (int32_t l = 0; l < UNKNOWNS; l++)
                schur[UNKNOWNS * l + k] =
                    hand.schur[3 * NODES * (3 * (l / 2) + 2 * (l % 2)) + in_space];
        }
        Interface plane = {.dim = 2, .contact_count = NODES, .count = UNKNOWNS};
        ContactSolver solver;
        ContactMatrix matrix;
        assert_true(contact_matrix_create(schur, UNKNOWNS, &matrix, &err) &&
                    contact_solver_create(&plane, &solver, &err));
        hand.friction = FRICTION_OF(&hand.law);
        ContactProblem problem = {.interface = &plane,
                                  .friction = &hand.friction,
                                  .matrix = &matrix,
                                  .g = g,
                                  .bound = bound};
        uint8_t no_rod[1] = {0};
        assert_true(contact_solve(&solver, &problem, &(ContactSolution){v, r, status, no_rod}));
        memset(hand.status, CONTACT_STICK, sizeof hand.status);
        assert_true(hand_contact_solve(&hand));
        for (int32_t k = 0; k < UNKNOWNS; k++) {
            int32_t in_space = 3 * (k / 2) + 2 * (k % 2);
            assert_near("v", hand.velocity[in_space], v[k], 1e-10);
            assert_near("r", hand.reaction[in_space], r[k], 1e-10);
        }
        for (int32_t i = 0; i < NODES; i++) {
            assert_true(fabs(hand.velocity[3 * i + 1]) < 1e-12);
            assert_int_equal(hand.status[i], status[i]);
            slipping += status_slips(status[i]);
        }
        contact_solver_destroy(&solver);
        contact_matrix_destroy(&matrix);
    }
    assert_true(slipping > 50);
}

// Constant friction, nodes hardly coupled: projecting r - rho v onto bound and disc over and over
// ends at the solution.
TEST(test_projections)
{
    Random random = {.state = 17};
    for (int32_t trial = 0; trial < 10; trial++) {
        hand_contact_size(&hand, HAND_NODES, 0);
        hand.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.3};
        hand_random_schur(&random, 4, 0.2, &hand);
        int32_t count = hand.interface.count;
        double v[HAND_UNKNOWNS] = {0}, r[HAND_UNKNOWNS] = {0}, rho = 3;
        for (int32_t k = 0; k < count; k++)
            hand.g[k] = random_between(&random, -3, k % 3 == 2 ? 1 : 3);
        for (int32_t pass = 0; pass < 4000; pass++) {
            for (int32_t i = 0; i < HAND_NODES; i++) {
                for (int32_t k = 3 * i; k < 3 * i + 3; k++) {
                    double rest = hand.g[k] + r[k];
                    for (int32_t l = 0; l < count; l++)
                        if (l != k) rest -= hand.schur[count * l + k] * v[l];
                    v[k] = rest / hand.schur[(count + 1) * k];
                }
                double *at = r + 3 * i;
                for (int32_t c = 0; c < 3; c++) at[c] -= rho * v[3 * i + c];
                at[2] = fmax(at[2], 0);
                double size = hypot(at[0], at[1]), part = fmin(1, 0.3 * at[2] / fmax(size, 1e-300));
                at[0] *= part;
                at[1] *= part;
            }
        }
        assert_true(hand_contact_solve(&hand));
        assert_all_near("v", hand.velocity, v, count, 1e-9);
    }
}

// The force turns from problem to problem, and slip turns with it: factors of the problem before
// gain too little. Those that are made then serve the steps that follow.
TEST(test_factors_kept)
{
    enum { PROBLEMS = 40 };
    Random random = {.state = 5};
    Error err = {0};
    ContactSolver solver;
    ContactMatrix matrix;
    hand_contact_size(&hand, HAND_NODES, 0);
    hand.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.3};
    hand_random_schur(&random, 4, 0.2, &hand);
    assert_true(contact_matrix_create(hand.schur, hand.interface.count, &matrix, &err) &&
                contact_solver_create(&hand.interface, &solver, &err));
    ContactSolution solution = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
    ContactProblem problem = hand_problem(&hand, &matrix);
    for (int32_t k = 0; k < PROBLEMS; k++) {
        for (int32_t i = 0; i < HAND_NODES; i++) {
            hand.g[3 * i] = 3 * cos(0.3 * k + 0.1 * i);
            hand.g[3 * i + 1] = 3 * sin(0.3 * k + 0.1 * i);
            hand.g[3 * i + 2] = -2;
        }
        assert_true(contact_solve(&solver, &problem, &solution));
        assert_true(hand_contact_error(&hand) < 1e-11);
    }
    assert_true(solver.newton.factorisations <= PROBLEMS);
    contact_solver_destroy(&solver);
    contact_matrix_destroy(&matrix);
}
