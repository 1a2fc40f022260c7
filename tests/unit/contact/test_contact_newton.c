// SPDX-License-Identifier: GPL-2.0-or-later
// Steps where most nodes are open: what one says of reactions and of open nodes against S v - g
// summed up here, and what a solve hands back.
#include "contact/contact_newton.h"

#include "contact_by_hand.h"
#include "plane.h"

enum { NODES = 30, RODS = 2 };

static HandContact hand;

// Five nodes: three are open, one slips and one sticks. None of this is the solution.
static void make_problem(Random *random)
{
    hand_contact_size(&hand, NODES, RODS);
    hand.law = (FrictionLaw){.kind = FRICTION_LINEAR_WEAKENING,
                             .mu_static = 0.4,
                             .mu_kinetic = 0.1,
                             .critical_velocity = 50};
    hand_random_schur(random, 3, 0.5, &hand);
    for (int32_t i = 0; i < NODES; i++) {
        hand.status[i] = i % 5 < 3    ? CONTACT_OPEN
                         : i % 5 == 3 ? CONTACT_SLIP_FORWARD
                                      : CONTACT_STICK;
        bool open = hand.status[i] == CONTACT_OPEN;
        hand.g[2 * i] = random_between(random, 0, 3);
        hand.g[2 * i + 1] = random_between(random, open ? 2 : -9, open ? 4 : -6);
    }
    for (int32_t k = 0; k < hand.interface.count; k++)
        hand.velocity[k] = k < 2 * NODES && hand.status[k / 2] == CONTACT_STICK
                               ? 0
                               : random_between(random, 0.1, 1);
    hand.rod_touches[0] = 1;
}

static double force_of(int32_t row)
{
    double sum = -hand.g[row];
    for (int32_t j = 0; j < hand.interface.count; j++)
        sum += hand.schur[j * hand.interface.count + row] * hand.velocity[j];
    return sum;
}

// From velocities that leave forces at open nodes: after one step these have none, all other
// reactions are those of the velocities there are, and each further step keeps them so.
TEST(test_step_adds_up)
{
    Error err = {0};
    Random random = {.state = 41};
    ContactMatrix matrix;
    ContactNewton newton;
    make_problem(&random);
    assert_true(contact_matrix_create(hand.schur, hand.interface.count, &matrix, &err));
    assert_true(contact_newton_create(&hand.interface, &newton, &err));
    ContactSolution solution = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
    ContactProblem problem = hand_problem(&hand, &matrix);
    contact_newton_begin(&newton, &problem, &solution, 1e-15);
    assert_true(newton.exact);
    assert_true(contact_newton_list(&newton));
    assert_int_equal(newton.open_count, 2 * 18);
    double before = contact_newton_residual(&newton), after = before;
    for (int step = 0; step < 8; step++) {
        assert_true(contact_newton_step(&newton));
        assert_false(newton.exact);
        for (int32_t k = 0; k < hand.interface.count; k++)
            assert_near("reaction", hand.reaction[k], force_of(k), 1e-12 * before);
        after = contact_newton_residual(&newton);
        newton.factors_gain = step % 2;   // anew, and once more with the same
    }
    assert_true(before > 1 && after < 1e-9 * before);
    contact_newton_react(&newton);
    assert_true(newton.exact);
    contact_newton_destroy(&newton);
    contact_matrix_destroy(&matrix);
}

// Where statuses change reactions follow what moves: nodes that stick or close are put in their
// place, those that open or slip stay as they are, and against its status none slips.
TEST(test_reactions_follow_statuses)
{
    Error err = {0};
    Random random = {.state = 43};
    ContactMatrix matrix;
    ContactNewton newton;
    make_problem(&random);
    assert_true(contact_matrix_create(hand.schur, hand.interface.count, &matrix, &err));
    assert_true(contact_newton_create(&hand.interface, &newton, &err));
    ContactSolution solution = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
    ContactProblem problem = hand_problem(&hand, &matrix);
    for (int32_t k = 0; k < hand.interface.count; k++) hand.reaction[k] = NAN;   // of no use to it
    contact_newton_begin(&newton, &problem, &solution, 1e-15);
    for (int32_t k = 0; k < hand.interface.count; k++)
        assert_near("at first", hand.reaction[k], force_of(k), 1e-12);
    hand.status[4] = CONTACT_OPEN;   // it stuck
    hand.status[9] = CONTACT_SLIP_FORWARD;   // it stuck, too
    contact_newton_settle(&newton);
    assert_true(newton.exact);   // nothing has moved
    hand.status[0] = CONTACT_STICK;
    hand.status[3] = CONTACT_SLIP_BACKWARD;
    contact_newton_settle(&newton);
    assert_false(newton.exact);
    assert_true(hand.velocity[0] == 0 && hand.velocity[1] == hand.bound[1]);
    assert_true(hand.velocity[2 * 3] == 0);
    for (int32_t k = 0; k < hand.interface.count; k++)
        assert_near("reaction", hand.reaction[k], force_of(k), 1e-12);
    contact_newton_destroy(&newton);
    contact_matrix_destroy(&matrix);
}

// To the last bit, not as steps added them up.
TEST(test_solution_is_exact)
{
    Random random = {.state = 42};
    int32_t open = 0;
    for (int trial = 0; trial < 40; trial++) {
        make_problem(&random);
        for (int32_t i = 0; i < NODES; i++) hand.g[2 * i + 1] = random_between(&random, -9, 6);
        assert_true(hand_contact_solve(&hand));
        HandContact found = hand;
        ContactMatrix matrix = {.schur = hand.schur, .count = hand.interface.count};
        ContactProblem problem = hand_problem(&hand, &matrix);
        ContactSolution at = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
        contact_react(&(ContactEquations){.problem = &problem, .at = &at});
        for (int32_t i = 0; i < NODES; i++) {
            open += hand.status[i] == CONTACT_OPEN;
            if (hand.status[i] != CONTACT_OPEN)
                assert_memory_equal(found.reaction + 2 * i, hand.reaction + 2 * i, 16);
        }
    }
    assert_true(open > 10 * 40);
}
