// SPDX-License-Identifier: GPL-2.0-or-later
// Steps where most nodes are open: what one says of reactions and of open nodes against S v - g
// summed up here, what a solve hands back, and factors that are read back from an archive.
#include "contact/contact_newton.h"

#include "contact/contact_solver.h"
#include "contact_by_hand.h"
#include "own_laws.h"
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

// Rows of nodes that slip forward, at velocities and reactions as they are.
static void find_rows(ContactNewton *newton)
{
    for (int32_t i = 0; i < NODES; i++) {
        double v = hand.velocity[2 * i];
        const FrictionNode *node = friction_at(&hand.friction, i);
        newton->row[i] = (ContactRow){.d = {1}, .mu = friction_coefficient(node, fabs(v))};
        newton->row[i].slope[0] = friction_slope(node, fabs(v)) * hand.reaction[2 * i + 1];
    }
}

// From the statuses of the problem, which those velocities and reactions would change.
static void begin_steps(ContactNewton *newton, const ContactProblem *problem,
                        ContactSolution *solution)
{
    uint8_t wanted[NODES];
    memcpy(wanted, hand.status, sizeof wanted);
    newton->in_double = true;
    contact_newton_begin(newton, problem, solution, 1e-12);
    memcpy(hand.status, wanted, sizeof wanted);
    contact_newton_settle(newton);
    contact_newton_react(newton);
    find_rows(newton);
}

typedef struct Rig {
    ContactMatrix matrix;
    ContactNewton newton;
    ContactSolution solution;
    ContactProblem problem;
} Rig;

static void begin_rig(uint64_t seed, Rig *rig)
{
    Error err = {0};
    Random random = {.state = seed};
    make_problem(&random);
    assert_true(contact_matrix_create(hand.schur, hand.interface.count, &rig->matrix, &err));
    assert_true(contact_newton_create(&hand.interface, &rig->newton, &err));
    rig->solution = (ContactSolution){hand.velocity, hand.reaction, hand.status, hand.rod_touches};
    rig->problem = hand_problem(&hand, &rig->matrix);
    begin_steps(&rig->newton, &rig->problem, &rig->solution);
}

static void end_rig(Rig *rig)
{
    contact_newton_destroy(&rig->newton);
    contact_matrix_destroy(&rig->matrix);
}

// From velocities that leave forces at open nodes: after one step these have none, all other
// reactions are those of the velocities there are, and each further step keeps them so.
TEST(test_step_adds_up)
{
    Rig rig;
    begin_rig(41, &rig);
    double force = contact_scales(&rig.problem, NULL).force, after = INFINITY;
    for (int step = 0; step < 8; step++) {
        assert_true(contact_newton_step(&rig.newton));
        assert_false(rig.newton.exact);
        for (int32_t k = 0; k < hand.interface.count; k++)
            assert_near("reaction", hand.reaction[k], force_of(k), 1e-12 * force);
        assert_int_equal(rig.newton.open_count, 2 * 18);
        find_rows(&rig.newton);
        after = contact_newton_residual(&rig.newton);
        rig.newton.factors_gain = step % 2;   // anew, and once more with the same
        assert_int_equal(rig.newton.reused, step > 0 && step % 2 == 0);
    }
    assert_true(after < 1e-9 * force);
    contact_newton_react(&rig.newton);
    assert_true(rig.newton.exact);
    end_rig(&rig);
}

// Where statuses change reactions follow what moves: nodes that stick or close are put in their
// place, those that open or slip stay as they are.
TEST(test_reactions_follow_statuses)
{
    Rig rig;
    begin_rig(43, &rig);
    for (int32_t k = 0; k < hand.interface.count; k++)
        assert_near("at first", hand.reaction[k], force_of(k), 1e-12);
    hand.status[4] = CONTACT_OPEN;   // it stuck
    hand.status[9] = CONTACT_SLIP_FORWARD;   // it stuck, too
    contact_newton_settle(&rig.newton);
    assert_true(rig.newton.exact);   // nothing has moved
    hand.status[0] = CONTACT_STICK;
    contact_newton_settle(&rig.newton);
    assert_false(rig.newton.exact);
    assert_true(hand.velocity[0] == 0 && hand.velocity[1] == hand.bound[1]);
    for (int32_t k = 0; k < hand.interface.count; k++)
        assert_near("reaction", hand.reaction[k], force_of(k), 1e-12);
    end_rig(&rig);
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

// Half of a step is taken back: velocities lie half way, and reactions are theirs.
TEST(test_half_a_step)
{
    Rig rig;
    begin_rig(44, &rig);
    assert_true(contact_newton_step(&rig.newton));   // open nodes have no force from here on
    double from[HAND_UNKNOWNS], to[HAND_UNKNOWNS];
    memcpy(from, hand.velocity, sizeof from);
    assert_true(contact_newton_step(&rig.newton));
    memcpy(to, hand.velocity, sizeof to);
    contact_newton_halve(&rig.newton);
    for (int32_t k = 0; k < hand.interface.count; k++) {
        assert_near("v", hand.velocity[k], (from[k] + to[k]) / 2, 1e-12);
        assert_near("reaction", hand.reaction[k], force_of(k), 1e-11);
    }
    end_rig(&rig);
}

// A step with factors that were read back has the bits of one with those that were written, in
// either precision.
TEST(test_archive)
{
    static char bytes[4 * 8 * HAND_UNKNOWNS * HAND_UNKNOWNS];
    Error err = {0};
    Random random = {.state = 45};
    for (int in_double = 0; in_double < 2; in_double++) {
        ContactMatrix matrix;
        ContactNewton newton, copy;
        make_problem(&random);
        assert_true(contact_matrix_create(hand.schur, hand.interface.count, &matrix, &err));
        assert_true(contact_newton_create(&hand.interface, &newton, &err));
        assert_true(contact_newton_create(&hand.interface, &copy, &err));
        ContactSolution solution = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
        ContactProblem problem = hand_problem(&hand, &matrix);
        begin_steps(&newton, &problem, &solution);
        newton.in_double = copy.in_double = in_double;
        assert_true(contact_newton_step(&newton));
        Archive archive = archive_write(bytes, sizeof bytes);
        contact_newton_archive(&newton, &hand.interface, &archive);
        archive = archive_read(bytes, archive.at);
        contact_newton_archive(&copy, &hand.interface, &archive);
        assert_true(archive_check(&archive, true, &err));
        HandContact before = hand;
        double found[2][HAND_UNKNOWNS];
        for (int k = 0; k < 2; k++) {
            ContactNewton *with = k ? &copy : &newton;
            hand = before;
            begin_steps(with, &problem, &solution);
            with->in_double = in_double;
            assert_true(contact_newton_step(with) && with->reused);
            memcpy(found[k], hand.velocity, sizeof found[k]);
        }
        assert_memory_equal(found[0], found[1], sizeof found[0]);
        contact_newton_destroy(&newton);
        contact_newton_destroy(&copy);
        contact_matrix_destroy(&matrix);
    }
}

// The first-order change of a solution under a small change of g, against the difference of two
// solutions; also of a law that creeps, whose steps are bent elsewhere.
TEST(test_follows_a_small_change)
{
    const double h = 1e-6;
    Error err = {0};
    Random random = {.state = 46};
    for (int creeps = 0; creeps < 2; creeps++) {
        ContactMatrix matrix;
        ContactSolver solver;
        ContactNewton newton;
        FrictionNode nodes[NODES];
        double change[HAND_UNKNOWNS] = {0}, before[HAND_UNKNOWNS], moved[HAND_UNKNOWNS],
               force[HAND_UNKNOWNS];
        hand_contact_size(&hand, NODES, 0);
        hand.law =
            creeps ? law_with_state((FrictionLaw){.kind = FRICTION_RATE_STATE,
                                                  .slip_distance = 1,
                                                  .evolution_effect = 0.01,
                                                  .direct_effect = 0.015,
                                                  .mu_reference = 0.4,
                                                  .reference_velocity = 1e-3})
                   : (FrictionLaw){.mu_static = 0.4, .mu_kinetic = 0.1, .critical_velocity = 50};
        for (int32_t i = 0; i < NODES; i++) {
            double from = 0;
            nodes[i] = friction_node(&hand.law, 1);
            if (creeps) friction_set_stage(&nodes[i], &from, 0.1);
            hand.g[2 * i] = random_between(&random, 1, 4);
            hand.g[2 * i + 1] = -6;
            change[2 * i] = random_between(&random, -1, 1);
        }
        hand.friction = friction_of_nodes(nodes, NODES);
        hand_random_schur(&random, 3, 0.2, &hand);
        assert_true(contact_matrix_create(hand.schur, hand.interface.count, &matrix, &err));
        assert_true(contact_solver_create(&hand.interface, &solver, &err));
        assert_true(contact_newton_create(&hand.interface, &newton, &err));
        ContactSolution solution = {hand.velocity, hand.reaction, hand.status, hand.rod_touches};
        ContactSolution moves = {moved, force, hand.status, hand.rod_touches};
        ContactProblem problem = hand_problem(&hand, &matrix), changes = problem;
        assert_true(contact_solve(&solver, &problem, &solution));
        memcpy(before, hand.velocity, sizeof before);
        changes.g = change;
        assert_true(contact_newton_follow(&newton, solver.newton.row, &changes, &moves));
        for (int32_t k = 0; k < hand.interface.count; k++) hand.g[k] += h * change[k];
        assert_true(contact_solve(&solver, &problem, &solution));
        double largest = 0;
        for (int32_t k = 0; k < hand.interface.count; k++) largest = fmax(largest, fabs(moved[k]));
        assert_true(largest > 0.01);
        for (int32_t k = 0; k < hand.interface.count; k++)
            assert_near("dv", (hand.velocity[k] - before[k]) / h, moved[k], 1e-4 * largest);
        contact_newton_destroy(&newton);
        contact_solver_destroy(&solver);
        contact_matrix_destroy(&matrix);
    }
}
