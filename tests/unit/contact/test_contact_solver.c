// SPDX-License-Identifier: GPL-2.0-or-later
// One and two contact nodes and a rod node, with the solutions worked out by hand; every solution
// is to be found from every first guess.
#include "contact/contact_solver.h"

#include "base/memory.h"
#include "contact_by_hand.h"
#include "plane.h"

// One node:  S = [s_t c; c s_n],  with g and bound as they come.
typedef struct OneNode {
    double s_t, s_n, coupling;
    double g_t, g_n, bound;
} OneNode;

static void one_node(OneNode numbers, FrictionLaw law, HandContact *hand)
{
    hand_contact_size(hand, 1, 0);
    hand->law = law;
    const double s[] = {numbers.s_t, numbers.coupling, numbers.coupling, numbers.s_n};
    memcpy(hand->schur, s, sizeof s);
    hand->g[0] = numbers.g_t;
    hand->g[1] = numbers.g_n;
    hand->bound[1] = numbers.bound;
}

// Solved from all four statuses; v and r as wanted: {v_t, v_n, r_t, r_n}.
static void expect_one(OneNode numbers, FrictionLaw law, ContactStatus status,
                       const double wanted[4])
{
    for (uint8_t guess = CONTACT_OPEN; guess <= CONTACT_SLIP_BACKWARD; guess++) {
        HandContact hand;
        one_node(numbers, law, &hand);
        hand.status[0] = guess;
        assert_true(hand_contact_solve(&hand));
        assert_int_equal(hand.status[0], status);
        assert_near("v_t", hand.velocity[0], wanted[0], 1e-10);
        assert_near("v_n", hand.velocity[1], wanted[1], 1e-10);
        assert_near("r_t", hand.reaction[0], wanted[2], 1e-10);
        assert_near("r_n", hand.reaction[1], wanted[3], 1e-10);
    }
}

static const FrictionLaw COULOMB = {.kind = FRICTION_COULOMB, .mu_static = 0.5};

TEST(test_stick_and_open)
{
    // Pressed with 10, pulled with 4.9 < 0.5 * 10: r = -g.
    OneNode pressed = {.s_t = 2, .s_n = 3, .coupling = 0.4, .g_t = 4.9, .g_n = -10};
    expect_one(pressed, COULOMB, CONTACT_STICK, (double[]){0, 0, -4.9, 10});
    // Pulled up: v = S^-1 g, no force.
    OneNode lifted = {.s_t = 2, .s_n = 3, .coupling = 1, .g_t = 1, .g_n = 8};
    expect_one(lifted, COULOMB, CONTACT_OPEN, (double[]){-1, 3, 0, 0});
    // The plane is 2 below in this step: falling at 1 does not reach it.
    OneNode falling = {.s_t = 2, .s_n = 3, .g_t = 2, .g_n = -3, .bound = -2};
    expect_one(falling, COULOMB, CONTACT_OPEN, (double[]){1, -1, 0, 0});
    // At 0.5 below it lands: r_n = 3 (-0.5) + 3, and 2 pulls against 0.75.
    falling.bound = -0.5;
    expect_one(falling, COULOMB, CONTACT_SLIP_FORWARD, (double[]){0.625, -0.5, -0.75, 1.5});
    // Held by friction where it lands.
    falling.g_t = 0.7;
    expect_one(falling, COULOMB, CONTACT_STICK, (double[]){0, -0.5, -0.7, 1.5});
}

// v_t = (g_t - mu p)/(s_t + mu c): pressed with 10, mu 0.5.
TEST(test_coulomb_slip)
{
    OneNode pulled = {.s_t = 2, .s_n = 3, .coupling = 0.4, .g_t = 9, .g_n = -10};
    double v = 4 / (2 + 0.5 * 0.4), p = 10 + 0.4 * v;
    expect_one(pulled, COULOMB, CONTACT_SLIP_FORWARD, (double[]){v, 0, -0.5 * p, p});
    pulled.g_t = -9;   // the coupling now lowers the pressure
    v = -4 / (2 - 0.5 * 0.4), p = 10 + 0.4 * v;
    expect_one(pulled, COULOMB, CONTACT_SLIP_BACKWARD, (double[]){v, 0, 0.5 * p, p});
}

// s_t v - g_t + (mu_S - k v)(p + c v) = 0, k = (mu_S - mu_K)/v_c, for 0 < v < v_c; beyond v_c the
// same with mu_K.
TEST(test_weakening_slip)
{
    FrictionLaw law = {.mu_static = 0.5, .mu_kinetic = 0.1, .critical_velocity = 2};
    OneNode numbers = {.s_t = 3, .s_n = 3, .coupling = 0.4, .g_n = -10};
    double k = 0.4 / 2, p = 10;
    for (double pull = 5.1; pull < 9; pull += 0.3) {
        double a = -k * numbers.coupling, b = numbers.s_t + 0.5 * numbers.coupling - k * p;
        double c = 0.5 * p - pull, v = (-b + sqrt(b * b - 4 * a * c)) / (2 * a), mu = 0.5 - k * v;
        if (v > 2) {
            mu = 0.1;
            v = (pull - 0.1 * p) / (numbers.s_t + 0.1 * numbers.coupling);
        }
        double pressing = p + numbers.coupling * v;
        for (int sign = -1; sign <= 1; sign += 2) {
            numbers.g_t = sign * pull;
            OneNode mirrored = numbers;
            mirrored.coupling *= sign;
            expect_one(mirrored, law, sign > 0 ? CONTACT_SLIP_FORWARD : CONTACT_SLIP_BACKWARD,
                       (double[]){sign * v, 0, -sign * mu * pressing, pressing});
        }
    }
}

// s_t < k p: friction falls faster than the block resists. Below the threshold it can stick; just
// above it only the fast branch is left: v = (g_t - mu_K p)/s_t, under linear weakening, and found
// without a path, however little g_t is above the threshold.
TEST(test_strong_weakening)
{
    FrictionLaw law = {.mu_static = 0.5, .mu_kinetic = 0.1, .critical_velocity = 0.1};
    OneNode numbers = {.s_t = 3, .s_n = 3, .g_n = -10};
    for (double above = 1e-9; above < 0.3; above *= 10) {
        for (uint8_t guess = CONTACT_OPEN; guess <= CONTACT_SLIP_BACKWARD; guess++) {
            numbers.g_t = 5 + above;
            HandContact hand;
            one_node(numbers, law, &hand);
            hand.status[0] = guess;
            HandCounts counts;
            assert_true(hand_contact_solve_by(&hand, false, &counts));
            assert_true(counts.iterations <= 12);   // a cycle seen, two looked at alone
            assert_near("v_t", hand.velocity[0], (numbers.g_t - 1) / 3, 1e-12);
            assert_near("judged", hand_contact_error(&hand), 0, 1e-10);
        }
    }
}

// Two nodes that resist their common slip by 1 - 0.9 alone, and friction that falls by 0.15 p: each
// by itself could slip slowly (its own entry is 1), both cannot. v = (0.55 - 0.2)/0.1 of either.
TEST(test_strong_weakening_together)
{
    FrictionLaw law = {.mu_static = 0.5, .mu_kinetic = 0.2, .critical_velocity = 2};
    for (int way = -1; way <= 1; way += 2) {
        HandContact hand;
        HandCounts counts;
        hand_contact_size(&hand, 2, 0);
        hand.law = law;
        const double s[] = {1, 0, -0.9, 0, 0, 1, 0, 0, -0.9, 0, 1, 0, 0, 0, 0, 1};
        memcpy(hand.schur, s, sizeof s);
        for (int32_t i = 0; i < 2; i++) {
            hand.g[plane_tangent(i)] = 0.55 * way;
            hand.g[plane_normal(i)] = -1;
            hand.status[i] = CONTACT_STICK;
        }
        assert_true(hand_contact_solve_by(&hand, false, &counts));
        for (int32_t i = 0; i < 2; i++)
            assert_near("v", hand.velocity[plane_tangent(i)], 3.5 * way, 1e-12);
    }
}

// Nothing that is not finite is called a solution, also where it is a force of what is held.
TEST(test_not_finite)
{
    for (int component = 0; component < 2; component++) {
        HandContact hand;
        one_node((OneNode){.s_t = 2, .s_n = 3, .g_n = -10}, COULOMB, &hand);
        hand.status[0] = CONTACT_STICK;
        hand.g[component] = component ? NAN : INFINITY;
        assert_false(hand_contact_solve(&hand));
    }
}

// s_t = k p: as steep as the block resists, so that Newton has no step on the weakening branch. The
// path goes round it to where friction falls no more.
TEST(test_singular_slip)
{
    FrictionLaw law = {.mu_static = 1, .mu_kinetic = 0.5, .critical_velocity = 0.5};
    HandContact hand;
    HandCounts counts;
    for (int way = 0; way < 2; way++) {
        one_node((OneNode){.s_t = 1, .s_n = 1, .g_t = 1.5, .g_n = -1}, law, &hand);
        hand.status[0] = CONTACT_SLIP_FORWARD;
        assert_int_equal(hand_contact_solve_by(&hand, way, &counts), way);
        assert_int_equal(counts.rescued, way);
    }
    assert_near("v_t", hand.velocity[0], 1, 1e-12);
    assert_near("judged", hand_contact_error(&hand), 0, 1e-12);
}

// Three nodes that only the plane holds up, S n = 0 for their normals: started as if all were open,
// where Newton has no matrix, the path puts them on the plane, and each carries what presses it.
// Lifted, nothing holds them.
TEST(test_floating_start)
{
    HandContact hand;
    hand_contact_size(&hand, 3, 0);
    hand.law = COULOMB;
    for (int i = 0; i < 3; i++) {
        hand.schur[2 * i * 6 + 2 * i] = 1;
        for (int j = 0; j < 3; j++) hand.schur[(2 * j + 1) * 6 + 2 * i + 1] = (i == j) - 1.0 / 3;
    }
    for (int lifted = 0; lifted < 2; lifted++) {
        HandCounts counts;
        for (int i = 0; i < 3; i++) hand.g[2 * i + 1] = lifted ? 1 : -1 - i;
        memset(hand.status, CONTACT_OPEN, 3);
        assert_int_equal(hand_contact_solve_by(&hand, true, &counts), !lifted);
        assert_int_equal(counts.rescued, !lifted);
        for (int i = 0; i < 3 && !lifted; i++) {
            assert_int_equal(hand.status[i], CONTACT_STICK);
            assert_near("r_n", hand.reaction[2 * i + 1], 1 + i, 1e-14);
        }
    }
}

// The rod beside one contact node that sticks: S couples them.
TEST(test_rod)
{
    for (int32_t start = 0; start < 2; start++) {
        HandContact hand;
        hand_contact_size(&hand, 1, 1);
        hand.law = COULOMB;
        const double s[] = {2, 0, -1, 0, 3, 0, -1, 0, 2};
        memcpy(hand.schur, s, sizeof s);
        hand.g[1] = -10;
        hand.bound[2] = 1;   // must reach 1: r = 2 - 0, and -1 on the node, which holds
        hand.rod_touches[0] = (uint8_t)start;
        hand.status[0] = CONTACT_STICK;
        assert_true(hand_contact_solve(&hand));
        assert_int_equal(hand.status[0], CONTACT_STICK);
        assert_int_equal(hand.rod_touches[0], 1);
        assert_near("rod force", hand.reaction[2], 2, 1e-12);
        assert_near("friction", hand.reaction[0], -1, 1e-12);

        hand.g[2] = 4;   // already goes at 2: the rod lets go
        assert_true(hand_contact_solve(&hand));
        assert_int_equal(hand.rod_touches[0], 0);
        assert_near("velocity", hand.velocity[2], 2, 1e-12);
        assert_near("rod force", hand.reaction[2], 0, 1e-12);

        hand.rod_kind = ROD_IS_BONDED;   // glued on, it pulls
        assert_true(hand_contact_solve(&hand));
        assert_int_equal(hand.rod_touches[0], 1);
        assert_near("rod force", hand.reaction[2], -2, 1e-12);

        hand.rod_kind = ROD_AWAY;
        hand.g[2] = 0;
        assert_true(hand_contact_solve(&hand));
        assert_int_equal(hand.rod_touches[0], 0);
        assert_near("rod force", hand.reaction[2], 0, 1e-12);
        assert_near("velocity", hand.velocity[2], 0, 1e-12);
    }
}

// Two like nodes pulled at the first: that one slips and drags at the other through S, which holds
// or follows. Tangents: [2 -1; -1 2] v = g + r.
TEST(test_two_nodes)
{
    const struct {
        double g[2], v[2], r[2];
    } cases[] = {
        {{4, 0}, {0, 0}, {-4, 0}},   // holds with 4 of 5
        {{8, 0}, {1.5, 0}, {-5, -1.5}},   // 2 v = 8 - 5; -v on the second, held
        {{14, 2}, {5, 1}, {-5, -5}},   // 2 v1 - v2 = 9, 2 v2 - v1 = -3
        {{14, -12}, {11. / 3, -5. / 3}, {-5, 5}},   // 2 v1 - v2 = 9, 2 v2 - v1 = -7
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        for (int32_t guess = 0; guess < 16; guess++) {
            HandContact hand;
            hand_contact_size(&hand, 2, 0);
            hand.law = COULOMB;
            const double s[] = {2, 0, -1, 0, 0, 1, 0, 0, -1, 0, 2, 0, 0, 0, 0, 1};
            memcpy(hand.schur, s, sizeof s);
            for (int32_t i = 0; i < 2; i++) {
                hand.g[plane_tangent(i)] = cases[k].g[i];
                hand.g[plane_normal(i)] = -10;
                hand.status[i] = (uint8_t)(i ? guess / 4 : guess % 4);
            }
            assert_true(hand_contact_solve(&hand));
            for (int32_t i = 0; i < 2; i++) {
                assert_near("v", hand.velocity[2 * i], cases[k].v[i], 1e-10);
                assert_near("r", hand.reaction[2 * i], cases[k].r[i], 1e-10);
            }
        }
    }
}

// Friction so strong (mu |c| > s_t) that a node may both hold and lift off, and plain iteration may
// run in circles. What is called solved is right; from the right status it stays; and where the
// mass of a small step makes s_t large it is always solved.
TEST(test_rough_friction)
{
    FrictionLaw rough = {.kind = FRICTION_COULOMB, .mu_static = 3};
    int32_t given_up = 0, cases = 0;
    for (double g_t = -12; g_t < 12; g_t += 0.7) {
        for (uint8_t guess = CONTACT_OPEN; guess <= CONTACT_SLIP_BACKWARD; guess++) {
            for (double mass = 0; mass < 4; mass += 3) {
                OneNode numbers = {
                    .s_t = 1 + mass, .s_n = 1 + mass, .coupling = -0.8, .g_t = g_t, .g_n = -3.3};
                bool holds = fabs(g_t) < 9.9;
                bool lifts = -3.3 * numbers.s_t + 0.8 * g_t > 0;
                HandContact hand;
                one_node(numbers, rough, &hand);
                hand.status[0] = guess;
                bool solved = hand_contact_solve(&hand);
                if (solved) assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
                if (mass > 0 || (guess == CONTACT_STICK && holds) ||
                    (guess == CONTACT_OPEN && lifts))
                    assert_true(solved);
                cases++;
                given_up += !solved;
            }
        }
    }
    assert_true(given_up < cases / 20);
}

TEST(test_allocates_nothing)
{
    Error err = {0};
    Random random = {.state = 21};
    HandContact hand;
    ContactSolver solver;
    ContactMatrix matrix;
    hand_contact_size(&hand, 20, 2);
    hand.law = (FrictionLaw){.mu_static = 0.4, .mu_kinetic = 0.1, .critical_velocity = 1};
    hand_random_schur(&random, 3, 1, &hand);
    int64_t live = memory_counters().live;
    assert_true(contact_matrix_create(hand.schur, hand.interface.count, &matrix, &err));
    assert_true(contact_solver_create(&hand.interface, &solver, &err));
    int64_t before = memory_counters().allocations;
    for (int32_t round = 0; round < 20; round++) {
        for (int32_t k = 0; k < hand.interface.count; k++)
            hand.g[k] = random_between(&random, -2, 1);
        ContactSolution solution = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
        ContactProblem problem = hand_problem(&hand, &matrix);
        contact_solve(&solver, &problem, &solution);
    }
    assert_int_equal(memory_counters().allocations, before);
    assert_int_equal(solver.solves, 20);
    assert_true(solver.iterations >= 20);
    contact_solver_destroy(&solver);
    contact_matrix_destroy(&matrix);
    assert_int_equal(memory_counters().live, live);
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        memory_fail_after(k);
        error_clear(&err);
        done = contact_solver_create(&hand.interface, &solver, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        contact_solver_destroy(&solver);
        assert_int_equal(memory_counters().live, live);
    }
}

// An matrix that ends and another one in its place, matrix and object at the same addresses, same
// statuses: nothing that was computed from the first may serve the second.
TEST(test_same_address)
{
    Error err = {0};
    Random random = {.state = 27};
    static HandContact hand;
    ContactSolver solver;
    ContactMatrix matrix;
    hand_contact_size(&hand, 12, 1);
    hand.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.3};
    assert_true(contact_solver_create(&hand.interface, &solver, &err));
    for (int32_t k = 0; k < hand.interface.count; k++)
        hand.g[k] = k % 2 == 0 ? 3 : (k / 2) % 3 == 0 ? 1 : -1;
    for (int32_t round = 0; round < 10; round++) {
        hand_random_schur(&random, 3, 0.1, &hand);
        assert_true(contact_matrix_create(hand.schur, hand.interface.count, &matrix, &err));
        ContactSolution solution = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
        ContactProblem problem = hand_problem(&hand, &matrix);
        int64_t factorisations = solver.newton.factorisations;
        assert_true(contact_solve(&solver, &problem, &solution));
        assert_true(solver.newton.factorisations > factorisations);
        assert_near("judged", hand_contact_error(&hand), 0, 1e-10);
        contact_matrix_destroy(&matrix);
    }
    contact_solver_destroy(&solver);
}

// A rod node alone, S = 5, g = 1, bound 2, spring 3/0.25 = 12: 5 v = 1 + 12 (2 - v). Where the face
// runs ahead (g = 20) the spring is let go; bonded, it pulls.
TEST(test_soft_rod)
{
    const double softness[] = {0.25};
    const struct {
        double g, v;
        RodKind kind;
        uint8_t touches;
    } cases[] = {
        {1, 25. / 17, ROD_PUSHES, 1}, {20, 4, ROD_PUSHES, 0}, {20, 44. / 17, ROD_IS_BONDED, 1}};
    for (size_t c = 0; c < 3; c++) {
        for (uint8_t guess = 0; guess < 2; guess++) {
            HandContact hand;
            hand_contact_size(&hand, 0, 1);
            hand.law = COULOMB;
            hand.rod_kind = cases[c].kind;
            hand.rod_softness = softness;
            hand.rod_reach = 3;
            hand.schur[0] = 5;
            hand.g[0] = cases[c].g;
            hand.bound[0] = 2;
            hand.rod_touches[0] = guess;
            assert_true(hand_contact_solve(&hand));
            assert_int_equal(hand.rod_touches[0], cases[c].touches);
            assert_near("v", hand.velocity[0], cases[c].v, 1e-12);
            assert_near("r", hand.reaction[0], cases[c].touches ? 12 * (2 - cases[c].v) : 0, 1e-11);
            assert_true(hand_contact_error(&hand) < 1e-12);
        }
    }
}
