// SPDX-License-Identifier: GPL-2.0-or-later
// The judge judged: states that keep every condition, then one condition broken at a time by a
// known amount, which must be found as that condition and with that size.
#include "contact/contact_check.h"

#include "contact_by_hand.h"
#include "own_laws.h"
#include "plane.h"

static const double FORCE = 10, VELOCITY = 0.5;

// Node 0 sticks, 1 slips forward at half v_c, 2 backward fast, 3 is open; rod node 0 presses, 1 has
// let go. Forces below are in units of FORCE, velocities of VELOCITY.
static void good_state(HandContact *hand)
{
    hand_contact_size(hand, 4, 2);
    hand->law = (FrictionLaw){.mu_static = 0.6, .mu_kinetic = 0.2, .critical_velocity = 0.1};
    for (int32_t i = 0; i < 4; i++) hand->bound[plane_normal(i)] = -0.01 * i;
    const double v[] = {0, 0, 0.05, -0.01, -2, -0.02, 7, 0.3, 0.4, 0.9};
    const double r[] = {-5.9, 10, -4, 10, 2, 10, 0, 0, 3, 0};
    memcpy(hand->velocity, v, sizeof v);
    memcpy(hand->reaction, r, sizeof r);
    hand->bound[8] = hand->bound[9] = 0.4;
}

static ContactResidual judge(HandContact *hand)
{
    ContactProblem problem = hand_problem(hand, NULL);
    return contact_residual(&problem, hand->velocity, hand->reaction, FORCE, VELOCITY);
}

TEST(test_good_state)
{
    HandContact hand;
    good_state(&hand);
    ContactResidual residual = judge(&hand);
    assert_near("nothing is broken", contact_residual_max(&residual), 0, 1e-15);
}

typedef enum Condition { PENETRATION, PULL, GAP_FORCE, CONE, DIRECTION } Condition;

static double *entry(ContactResidual *residual, Condition condition)
{
    double *entries[] = {&residual->penetration, &residual->pull, &residual->gap_force,
                         &residual->cone, &residual->direction};
    return entries[condition];
}

TEST(test_each_violation)
{
    const struct {
        int32_t unknown;
        bool is_velocity;
        double value;
        Condition condition;
        double size;
        const char *what;
    } broken[] = {
        {1, true, -0.1, PENETRATION, 0.2, "a node goes through the plane"},
        {7, true, -0.13, PENETRATION, 0.2, "an open node goes through the plane"},
        {7, false, -2, PULL, 0.2, "the plane pulls"},
        {1, true, 0.1, GAP_FORCE, 0.2, "pressed though it lifts off"},
        {7, false, 1, GAP_FORCE, 0.1, "pressed though open"},
        {0, false, -6.5, CONE, 0.05, "sticks beyond mu_S"},
        {0, false, 6.5, CONE, 0.05, "the same the other way"},
        {6, false, 0.3, CONE, 0.03, "shear on an open node"},
        {2, false, -4.7, CONE, 0.07, "slips with more than mu(v) p"},
        {2, false, -3, DIRECTION, 0.1, "slips with less than mu(v) p"},
        {2, false, 4, DIRECTION, 0.8, "friction drives the slip"},
        {4, false, -2, DIRECTION, 0.4, "friction drives a backward slip"},
        {8, true, 0.3, PENETRATION, 0.2, "the rod is inside the block"},
        {9, true, 0.2, PENETRATION, 0.4, "the free rod is inside the block"},
        {8, false, -1, PULL, 0.1, "the rod pulls"},
        {9, false, 2, GAP_FORCE, 0.2, "the rod presses from afar"},
    };
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++) {
        HandContact hand;
        good_state(&hand);
        (broken[k].is_velocity ? hand.velocity : hand.reaction)[broken[k].unknown] =
            broken[k].value;
        ContactResidual residual = judge(&hand);
        assert_near(broken[k].what, *entry(&residual, broken[k].condition), broken[k].size, 1e-14);
        assert_true(contact_residual_max(&residual) >= broken[k].size - 1e-14);
    }
}

TEST(test_rod_kinds)
{
    HandContact hand;
    good_state(&hand);
    hand.rod_kind = ROD_IS_BONDED;   // node 1 is 0.5 off where it is held; pulling is allowed
    hand.reaction[8] = -3;
    ContactResidual residual = judge(&hand);
    assert_near("not where it is held", residual.penetration, 1, 1e-14);
    assert_near("pulls", residual.pull, 0, 0);
    hand.velocity[9] = 0.4;
    residual = judge(&hand);
    assert_near("bonded", contact_residual_max(&residual), 0, 1e-15);
    hand.rod_kind = ROD_AWAY;
    residual = judge(&hand);
    assert_near("a force of a rod that is away", residual.gap_force, 0.3, 1e-15);
    hand.reaction[8] = 0;
    residual = judge(&hand);
    assert_near("away", contact_residual_max(&residual), 0, 1e-15);
}

// A velocity of rounding size has no direction that friction would have to oppose.
TEST(test_still_is_still)
{
    HandContact hand;
    good_state(&hand);
    hand.velocity[0] = 1e-12;
    ContactResidual residual = judge(&hand);
    assert_near("still", residual.direction, 0, 1e-15);
    hand.velocity[0] = 1e-6;   // and this moves along the friction that should oppose it
    hand.reaction[0] = 5.9;
    residual = judge(&hand);
    assert_true(residual.direction > 1);
}

// A creeping node is never still: force along the slip is in the cone, and wrong at any speed.
TEST(test_creep_has_a_direction)
{
    HandContact hand;
    good_state(&hand);
    FrictionLaw law = law_with_state((FrictionLaw){.kind = FRICTION_RATE_STATE,
                                                   .slip_distance = 1,
                                                   .evolution_effect = 0.01,
                                                   .direct_effect = 0.01,
                                                   .mu_reference = 0.4,
                                                   .reference_velocity = 1e-3});
    FrictionNode nodes[4];
    double from = 0;
    for (int32_t i = 0; i < 4; i++) {
        nodes[i] = friction_node(&law, 1);
        friction_set_stage(&nodes[i], &from, 0.1);
        hand.velocity[plane_tangent(i)] = 0;
    }
    hand.friction = friction_of_nodes(nodes, 4);
    hand.reaction[2] = hand.reaction[4] = 0;
    hand.velocity[0] = 1e-15;
    double mu = friction_coefficient(&nodes[0], 1e-15);
    assert_true(mu > 0.01);
    hand.reaction[0] = -mu * 10;
    ContactResidual residual = judge(&hand);
    assert_near("against the slip", contact_residual_max(&residual), 0, 1e-12);
    hand.reaction[0] = 0.5 * mu * 10;
    residual = judge(&hand);
    assert_near("in the cone", residual.cone, 0, 1e-12);
    assert_near("along the slip", residual.direction, 1.5 * mu, 1e-12);
}
