// SPDX-License-Identifier: GPL-2.0-or-later
// The equations against what they say in words, on random problems of every law with soft rod
// nodes: residuals written out, derivatives by differences, what is held.
#include "contact/contact_equations.h"

#include "contact_by_hand.h"

enum { NODES = 6, RODS = 3, COUNT = 2 * NODES + RODS };

static HandContact hand;
static ContactMatrix matrix;
static ContactProblem problem;
static ContactSolution at;
static int32_t free_list[COUNT];
static ContactRow row_list[COUNT];

// Speeds about v_c = 1 and away from it and from 0, where mu has no derivative.
static ContactEquations make_equations(Random *random, int32_t trial)
{
    static const double softness[RODS] = {0.3, 0, 2};
    Error err = {0};
    hand_contact_size(&hand, NODES, RODS);
    hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                             .mu_static = 0.9,
                             .mu_kinetic = 0.2,
                             .critical_velocity = 1};
    hand.rod_softness = softness;
    hand.rod_reach = 0.7;
    hand_random_schur(random, 0.5, 1, &hand);
    assert_true(contact_matrix_create(hand.schur, COUNT, &matrix, &err));
    problem = hand_problem(&hand, &matrix);
    at = (ContactSolution){hand.velocity, hand.reaction, hand.status, hand.rod_touches};
    ContactEquations equations = {&problem, &at, free_list, 0, row_list};
    for (int32_t k = 0; k < COUNT; k++) {
        double speed = random_between(random, 0, 1) < 0.5 ? 0.3 : 1.7;
        hand.velocity[k] = speed + random_between(random, -0.2, 0.2);
        hand.bound[k] = random_between(random, -1, 1);
        hand.g[k] = random_between(random, -1, 1);
    }
    for (int32_t i = 0; i < NODES; i++) {
        hand.status[i] = (uint8_t)random_index(random, 4);
        if (hand.status[i] == CONTACT_SLIP_BACKWARD) hand.velocity[2 * i] *= -1;
        if (hand.status[i] != CONTACT_STICK) free_list[equations.free_count++] = 2 * i;
        if (hand.status[i] == CONTACT_OPEN) free_list[equations.free_count++] = 2 * i + 1;
    }
    for (int32_t j = 0; j < RODS; j++) {
        hand.rod_touches[j] = (uint8_t)random_index(random, 2);
        if (!hand.rod_touches[j] || softness[j] > 0)
            free_list[equations.free_count++] = 2 * NODES + j;
    }
    return equations;
}

// r_k, and what stands beside it, in the words of the header.
static double residual_by_hand(int32_t k)
{
    double value = -hand.g[k], normal = -hand.g[k | 1];
    for (int32_t j = 0; j < COUNT; j++) value += hand.schur[j * COUNT + k] * hand.velocity[j];
    if (k >= 2 * NODES) {
        int32_t j = k - 2 * NODES;
        if (!hand.rod_touches[j]) return value;
        return value + 0.7 / hand.rod_softness[j] * (hand.velocity[k] - hand.bound[k]);
    }
    uint8_t status = hand.status[k / 2];
    if (status == CONTACT_OPEN) return value;
    for (int32_t j = 0; j < COUNT; j++) normal += hand.schur[j * COUNT + k + 1] * hand.velocity[j];
    double speed = fabs(hand.velocity[k]), mu = friction_coefficient(NODE_OF(&hand.law), speed);
    return value + (status == CONTACT_SLIP_FORWARD ? mu : -mu) * normal;
}

TEST(test_equations)
{
    Random random = {.state = 12};
    for (int32_t trial = 0; trial < 200; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        double x[COUNT], left[COUNT], less[COUNT], combined[COUNT];
        contact_react(&equations);
        contact_find_rows(&equations);
        contact_residuals(&equations, left);
        for (int32_t k = 0; k < COUNT; k++) x[k] = random_between(&random, -1, 1);
        contact_combine(&equations, x, combined);
        for (int32_t k = 0; k < COUNT; k++) hand.reaction[k] -= x[k];
        contact_residuals(&equations, less);
        for (int32_t k = 0; k < COUNT; k++) hand.reaction[k] += x[k];
        for (int32_t a = 0; a < equations.free_count; a++) {
            int32_t k = free_list[a], i = contact_slipping_node(&equations, k);
            double value = residual_by_hand(k);
            assert_int_equal(
                i, k < 2 * NODES && k % 2 == 0 && hand.status[k / 2] > CONTACT_STICK ? k / 2 : -1);
            assert_near("E", left[a], value, 1e-12);
            assert_near("combined", value - combined[a], less[a], 1e-12);
        }
        contact_matrix_destroy(&matrix);
    }
}

// Central differences of E by each free velocity; equations of slip are at most quadratic in it,
// but for the exponential law.
TEST(test_derivative)
{
    Random random = {.state = 13};
    const double h = 1e-5;
    for (int32_t trial = 0; trial < 200; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        double jacobian[(COUNT + 1) * (COUNT + 1)];
        int32_t stride = equations.free_count + trial % 2;
        contact_react(&equations);
        contact_find_rows(&equations);
        contact_jacobian(&equations, hand.schur, stride, jacobian);
        for (int32_t b = 0; b < equations.free_count; b++) {
            double side[2][COUNT], *velocity = &hand.velocity[free_list[b]], kept = *velocity;
            for (int s = 0; s < 2; s++) {
                *velocity = kept + (s ? h : -h);
                contact_react(&equations);
                contact_find_rows(&equations);
                contact_residuals(&equations, side[s]);
            }
            *velocity = kept;
            for (int32_t a = 0; a < equations.free_count; a++)
                assert_near("dE/dv", jacobian[b * stride + a], (side[1][a] - side[0][a]) / (2 * h),
                            1e-8);
        }
        contact_matrix_destroy(&matrix);
    }
}

// Held values are put in place and the rest is left alone; scales are those of forces and of S.
TEST(test_holds)
{
    Random random = {.state = 14};
    for (int32_t trial = 0; trial < 100; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        double before[COUNT], force = 0, diagonal = 0;
        memcpy(before, hand.velocity, sizeof before);
        contact_hold(&equations);
        for (int32_t k = 0, a = 0; k < COUNT; k++) {
            bool is_free = a < equations.free_count && free_list[a] == k;
            a += is_free;
            bool tangent = k < 2 * NODES && k % 2 == 0;
            double held = tangent ? 0 : hand.bound[k];
            assert_near("held", hand.velocity[k], is_free ? before[k] : held, 0);
            force = fmax(force, fabs(hand.g[k]));
            diagonal = fmax(diagonal, hand.schur[k * COUNT + k]);
        }
        ContactScales scales = contact_scales(&problem, NULL);
        assert_near("force", scales.force, force, 0);
        assert_near("velocity", scales.velocity, force / diagonal, 1e-15);
        hand.reaction[2] = -7;
        assert_near("force", contact_scales(&problem, hand.reaction).force, 7, 0);
        memset(hand.g, 0, sizeof hand.g);
        assert_near("none", contact_scales(&problem, NULL).force, 1, 0);
        contact_matrix_destroy(&matrix);
    }
}
