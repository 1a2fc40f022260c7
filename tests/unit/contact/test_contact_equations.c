// SPDX-License-Identifier: GPL-2.0-or-later
// The equations against what they say in words, in the plane and in space, on random problems of
// every law with soft rod nodes: statuses and residuals written out, derivatives by differences,
// what is held.
#define HAND_DIM 3
#include "contact/contact_equations.h"

#include "contact_by_hand.h"
#include "own_laws.h"

enum { NODES = 6, RODS = 3, COUNT = 3 * NODES + RODS };

static const double REACH = 0.7, SOFTNESS[RODS] = {0.3, 0, 2};

static HandContact hand;
static ContactMatrix matrix;
static ContactProblem problem;
static ContactSolution at;
static int32_t free_list[COUNT], node_list[COUNT], dim, count;
static ContactRow row_list[NODES];

// Speeds about v_c = 1 and away from it and from 0, where mu has no derivative. Trials alternate
// between the plane and space.
static ContactEquations make_equations(Random *random, int32_t trial)
{
    Error err = {0};
    hand_contact_size(&hand, NODES, RODS);
    dim = hand.interface.dim = 2 + trial % 2;
    count = hand.interface.count = dim * NODES + RODS;
    hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                             .mu_static = 0.9,
                             .mu_kinetic = 0.2,
                             .critical_velocity = 1};
    hand.rod_softness = SOFTNESS;
    hand.rod_reach = REACH;
    hand_random_schur(random, 0.5, 1, &hand);
    assert_true(contact_matrix_create(hand.schur, count, &matrix, &err));
    problem = hand_problem(&hand, &matrix);
    at = (ContactSolution){hand.velocity, hand.reaction, hand.status, hand.rod_touches};
    for (int32_t k = 0; k < count; k++) {
        double speed = random_between(random, 0, 1) < 0.5 ? 0.3 : 1.7;
        double size = (speed + random_between(random, -0.2, 0.2)) / sqrt(dim - 1);
        hand.velocity[k] = random_index(random, 2) ? size : -size;
        hand.reaction[k] = random_between(random, -1, 1);
        hand.bound[k] = random_between(random, -1, 1);
        hand.g[k] = random_between(random, -1, 1);
    }
    for (int32_t i = 0; i < NODES; i++) hand.status[i] = (uint8_t)random_index(random, 3);
    for (int32_t j = 0; j < RODS; j++) hand.rod_touches[j] = (uint8_t)random_index(random, 2);
    return (ContactEquations){.problem = &problem,
                              .at = &at,
                              .tolerance = 1e-12,
                              .free = free_list,
                              .node = node_list,
                              .row = row_list};
}

// Rows of all nodes that slip, at velocities and reactions as they are.
static void make_rows(Random *random, ContactEquations *equations)
{
    contact_react(equations);
    for (int32_t i = 0; i < NODES; i++) {
        double angle = random_between(random, 0, 6.28);
        row_list[i] = (ContactRow){.d = {cos(angle), sin(angle)},
                                   .theta = random_between(random, 0.1, 0.9),
                                   .rho = random_between(random, 1, 2)};
        if (dim == 2) row_list[i].d[0] = angle < 3 ? 1 : -1, row_list[i].d[1] = 0;
        double speed = slip_size(&hand.interface, i, hand.velocity);
        const FrictionNode *node = friction_at(&hand.friction, i);
        row_list[i].mu = friction_coefficient(node, speed);
        for (int32_t c = 0; c < dim - 1; c++)
            row_list[i].slope[c] = friction_slope(node, speed) * hand.reaction[dim * i + dim - 1] *
                                   hand.velocity[dim * i + c] / speed;
    }
    contact_list_free(equations);
}

static double dot(const double *x, const double *y)
{
    return x[0] * y[0] + (dim == 3 ? x[1] * y[1] : 0);
}

// By r - rho v, as the header has it. What slips and would turn round rests.
TEST(test_statuses)
{
    Random random = {.state = 11};
    int32_t met[3] = {0}, turned = 0;
    for (int32_t trial = 0; trial < 400; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        make_rows(&random, &equations);
        uint8_t wanted[NODES], touches[RODS];
        bool changes = false;
        double d_wanted[NODES][2], theta_wanted[NODES];
        for (int32_t i = 0; i < NODES; i++) {
            const double *v = hand.velocity + dim * i, *r = hand.reaction + dim * i;
            const double *own = hand.schur + (int64_t)dim * i * (count + 1);
            double rho = dim == 2 ? own[0] : (own[0] + own[count + 1]) / 2;
            double rho_n = own[(dim - 1) * (count + 1)], z[2] = {0};
            double p = r[dim - 1] - rho_n * (v[dim - 1] - hand.bound[dim * i + dim - 1]);
            for (int32_t c = 0; c < dim - 1; c++) z[c] = r[c] - rho * v[c];
            double size = hypot(z[0], z[1]), speed = dim == 2 ? fabs(v[0]) : hypot(v[0], v[1]);
            double mu = friction_coefficient(NODE_OF(&hand.law), speed);
            wanted[i] = p <= 0           ? CONTACT_OPEN
                        : size <= mu * p ? CONTACT_STICK
                                         : CONTACT_SLIP_FORWARD;
            bool turns = hand.status[i] == CONTACT_SLIP_FORWARD && dot(row_list[i].d, z) > 0;
            if (wanted[i] == CONTACT_SLIP_FORWARD && turns) wanted[i] = CONTACT_STICK, turned++;
            for (int32_t c = 0; c < 2; c++) d_wanted[i][c] = -z[c] / size;
            theta_wanted[i] = rho * speed / (mu * p + rho * speed);
            met[wanted[i]]++;
            changes = changes || wanted[i] != hand.status[i];
        }
        for (int32_t j = 0; j < RODS; j++) {
            int32_t x = dim * NODES + j;
            touches[j] = hand.rod_touches[j] ? hand.reaction[x] >= 0
                                             : hand.velocity[x] < hand.bound[x];
            changes = changes || touches[j] != hand.rod_touches[j];
        }
        assert_int_equal(contact_judge(&equations), changes);
        assert_memory_equal(hand.status, wanted, sizeof wanted);
        assert_memory_equal(hand.rod_touches, touches, sizeof touches);
        for (int32_t i = 0; i < NODES; i++)
            if (wanted[i] == CONTACT_SLIP_FORWARD) {
                assert_all_near("d", row_list[i].d, d_wanted[i], 2, 1e-12);
                assert_near("theta", row_list[i].theta, theta_wanted[i], 1e-12);
            }
        contact_matrix_destroy(&matrix);
    }
    assert_true(met[0] > 100 && met[1] > 100 && met[2] > 100 && turned > 100);
}

// A node that creeps slips along its velocity, whatever its force is; from rest against its force,
// and friction across is mu'(0) p v.
TEST(test_creep)
{
    Random random = {.state = 16};
    for (int32_t trial = 0; trial < 100; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        FrictionLaw law = law_with_state((FrictionLaw){.kind = FRICTION_RATE_STATE,
                                                       .slip_distance = 1,
                                                       .evolution_effect = 0.01,
                                                       .direct_effect = 0.015,
                                                       .mu_reference = 0.4,
                                                       .reference_velocity = 1e-3});
        FrictionNode nodes[NODES];
        double from = 0;
        for (int32_t i = 0; i < NODES; i++) {
            nodes[i] = friction_node(&law, 1);
            friction_set_stage(&nodes[i], &from, 0.1);
            hand.reaction[dim * i + dim - 1] = 1;
            hand.bound[dim * i + dim - 1] = hand.velocity[dim * i + dim - 1];
            for (int32_t c = 0; c < dim - 1; c++)
                hand.velocity[dim * i + c] *= i % 2 ? pow(10, -3 * i) : 0;
        }
        hand.friction = friction_of_nodes(nodes, NODES);
        contact_judge(&equations);
        for (int32_t i = 0; i < NODES; i++) {
            const double *v = hand.velocity + dim * i, *r = hand.reaction + dim * i;
            const double *own = hand.schur + (int64_t)dim * i * (count + 1);
            double rho = dim == 2 ? own[0] : (own[0] + own[count + 1]) / 2;
            double speed = sqrt(dot(v, v)), force = sqrt(dot(r, r)), wanted[2] = {0};
            double slow = speed > 0 ? speed : 1e-6 / friction_slope(&nodes[i], 0);
            for (int32_t c = 0; c < dim - 1; c++)
                wanted[c] = speed > 0 ? v[c] / speed : -r[c] / force;
            assert_int_equal(hand.status[i], CONTACT_SLIP_FORWARD);
            assert_all_near("d", row_list[i].d, wanted, 2, 1e-12);
            double across = friction_coefficient(&nodes[i], slow) / slow;
            assert_near("theta", row_list[i].theta, rho / (rho + across), 1e-6 * rho / across);
        }
        contact_matrix_destroy(&matrix);
    }
}

// r_k, and what stands beside it, in the words of the header; of an axis of node i in space the
// equation across its slip.
static double residual_by_hand(int32_t k)
{
    int32_t i = k / dim, axis = k % dim;
    if (k >= dim * NODES) {
        int32_t j = k - dim * NODES;
        double value = hand.reaction[k];
        if (!hand.rod_touches[j]) return value;
        return value + REACH / SOFTNESS[j] * (hand.velocity[k] - hand.bound[k]);
    }
    const ContactRow *row = &row_list[i];
    const double *r = hand.reaction + dim * i, *v = hand.velocity + dim * i, *d = row->d;
    double speed = slip_size(&hand.interface, i, hand.velocity);
    double mu = friction_coefficient(NODE_OF(&hand.law), speed);
    const double e[] = {-d[1], d[0]};
    if (axis == 0) return dot(d, r) + mu * r[dim - 1];
    return row->theta * dot(e, r) + (1 - row->theta) * row->rho * dot(e, v);
}

// An addition to the reactions changes residuals as contact_combine says; in the directions of
// other rows they are turned.
TEST(test_residuals)
{
    Random random = {.state = 12};
    for (int32_t trial = 0; trial < 200; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        double x[COUNT], left[COUNT], less[COUNT], combined[COUNT] = {0}, largest = 0;
        make_rows(&random, &equations);
        double found = contact_residuals(&equations, NULL, left);
        for (int32_t k = 0; k < count; k++) x[k] = random_between(&random, -1, 1);
        contact_combine(&equations, row_list, x, combined);
        for (int32_t k = 0; k < count; k++) hand.reaction[k] -= x[k];
        contact_residuals(&equations, NULL, less);
        for (int32_t k = 0; k < count; k++) hand.reaction[k] += x[k];
        for (int32_t a = 0; a < equations.free_count; a++) {
            int32_t k = free_list[a];
            double value = residual_by_hand(k);
            assert_near("E", left[a], value, 1e-12);
            assert_near("combined", value - combined[a], less[a], 1e-12);
            double off = fabs(value);
            if (k < dim * NODES && dim == 3 && k % 3 == 0)
                off = hypot(value, residual_by_hand(k + 1) / row_list[k / 3].theta);
            if (k >= dim * NODES || k % dim == 0) largest = fmax(largest, off);
        }
        assert_near("largest", found, largest, 1e-12);
        ContactRow same[NODES];
        memcpy(same, row_list, sizeof same);
        contact_residuals(&equations, same, less);
        assert_all_near("in their own directions", less, left, equations.free_count, 1e-12);
        hand.reaction[free_list[0]] = NAN;
        assert_true(isinf(contact_residuals(&equations, NULL, less)));
        contact_matrix_destroy(&matrix);
    }
}

// Central differences of E by each free velocity, with directions held; equations of slip are at
// most quadratic in it, but for the exponential law.
TEST(test_derivative)
{
    Random random = {.state = 13};
    const double h = 1e-5;
    for (int32_t trial = 0; trial < 200; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        make_rows(&random, &equations);
        for (int32_t b = 0; b < equations.free_count; b++) {
            double side[2][COUNT], column[COUNT], *velocity = &hand.velocity[free_list[b]];
            double kept = *velocity;
            contact_derivative_column(&equations, hand.schur, b, column);
            for (int s = 0; s < 2; s++) {
                *velocity = kept + (s ? h : -h);
                contact_react(&equations);
                for (int32_t a = 0; a < equations.free_count; a++)
                    side[s][a] = residual_by_hand(free_list[a]);
            }
            *velocity = kept;
            contact_react(&equations);
            for (int32_t a = 0; a < equations.free_count; a++)
                assert_near("dE/dv", column[a], (side[1][a] - side[0][a]) / (2 * h), 1e-8);
        }
        contact_matrix_destroy(&matrix);
    }
}

// Held values are put in place and the rest is left alone; what touches nothing has no force;
// scales are those of forces and of S.
TEST(test_holds)
{
    Random random = {.state = 14};
    for (int32_t trial = 0; trial < 100; trial++) {
        ContactEquations equations = make_equations(&random, trial);
        double before[COUNT], force = 0, diagonal = 0;
        memcpy(before, hand.velocity, sizeof before);
        contact_hold(&equations);
        contact_release(&equations);
        for (int32_t k = 0; k < count; k++) {
            int32_t i = k / dim, j = k - dim * NODES;
            bool rod = j >= 0, tangent = !rod && k % dim < dim - 1;
            bool open = rod ? !hand.rod_touches[j] : hand.status[i] == CONTACT_OPEN;
            bool held = rod ? hand.rod_touches[j] && SOFTNESS[j] == 0
                            : !open && (!tangent || hand.status[i] == CONTACT_STICK);
            double wanted = !held ? before[k] : tangent ? 0 : hand.bound[k];
            assert_near("velocity", hand.velocity[k], wanted, 0);
            assert_int_equal(hand.reaction[k] == 0, open);
            force = fmax(force, fabs(hand.g[k]));
            diagonal = fmax(diagonal, hand.schur[k * count + k]);
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
