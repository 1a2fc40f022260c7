// SPDX-License-Identifier: GPL-2.0-or-later
// Random contact problems of nodes that remember, each with a law and a state of its own: rate and
// state over many decades of slip rate, where no node sticks; ageing and slip-weakening. They are
// solved, and rightly, from any guess, where S outweighs the weakening. test_contact_memory_space.c
// asks the same in space.
#include "contact_by_hand.h"
#include "own_laws.h"

#ifndef SWEEPS_ON
#define SWEEPS_ON false   // steps of Newton alone
#endif

static HandContact hand, other;   // large; a test runs alone
static FrictionLaw laws[HAND_NODES];
static FrictionNode nodes[HAND_NODES];

static double log_between(Random *random, double low, double high)
{
    return exp(random_between(random, log(low), log(high)));
}

static void set_law(Random *random, FrictionKind kind, FrictionLaw *law, FrictionNode *node)
{
    *law = law_with_state((FrictionLaw){.kind = kind,
                                        .mu_static = random_between(random, 0.2, 0.5),
                                        .mu_kinetic = 0.1,
                                        .critical_velocity = random_between(random, 1, 3),
                                        .slip_distance = 1,
                                        .healing_time = 1,
                                        .healing = random_between(random, 0.005, 0.02),
                                        .evolution_effect = random_between(random, 0.005, 0.02),
                                        .direct_effect = random_between(random, 0.005, 0.02),
                                        .mu_reference = random_between(random, 0.2, 0.6),
                                        .reference_velocity = log_between(random, 1e-9, 1e-2),
                                        .slip_law = random_index(random, 2) == 0});
    bool creeps = kind == FRICTION_RATE_STATE;
    double from = creeps ? random_between(random, -5, 5) : random_between(random, 0, 1);
    *node = friction_node(law, 1);
    friction_set_stage(node, &from, log_between(random, 1e-6, 0.3));
}

static void random_loads(Random *random)
{
    for (int32_t i = 0; i < hand.interface.contact_count; i++) {
        int32_t n = interface_normal(&hand.interface, i);
        for (int32_t t = interface_tangent(&hand.interface, i); t < n; t++)
            hand.g[t] = random_between(random, -3, 3);
        hand.g[n] = random_between(random, -4, 1);
        hand.bound[n] = random_between(random, -0.4, 0.1);
    }
    for (int32_t j = 0; j < hand.interface.rod_count; j++) {
        hand.g[interface_rod(&hand.interface, j)] = random_between(random, -1, 1);
        hand.bound[interface_rod(&hand.interface, j)] = random_between(random, -0.5, 0.5);
    }
}

static void random_statuses(Random *random, HandContact *contact)
{
    for (int32_t i = 0; i < contact->interface.contact_count; i++)
        contact->status[i] = (uint8_t)random_index(random, 4);
    for (int32_t j = 0; j < contact->interface.rod_count; j++)
        contact->rod_touches[j] = (uint8_t)random_index(random, 2);
}

TEST(test_solved_from_any_guess)
{
    static const FrictionKind kinds[] = {FRICTION_RATE_STATE, FRICTION_RATE_STATE, FRICTION_AGEING,
                                         FRICTION_SLIP_WEAKENING};
    Random random = {.state = 11};
    double slowest = INFINITY, fastest = 0;
    int64_t solves = 0, iterations = 0;
    for (int32_t trial = 0; trial < 200; trial++) {
        HandCounts counts;
        FrictionKind kind = kinds[trial % 4];
        hand_contact_size(&hand, 1 + random_index(&random, HAND_NODES),
                          random_index(&random, HAND_RODS + 1));
        int32_t count = hand.interface.contact_count;
        for (int32_t i = 0; i < count; i++) set_law(&random, kind, &laws[i], &nodes[i]);
        hand.friction = friction_of_nodes(nodes, count);
        hand_random_schur(&random, 3, 0.5, &hand);
        random_loads(&random);
        random_statuses(&random, &hand);
        if (!hand_contact_solve_by(&hand, SWEEPS_ON, &counts))
            fail_msg("trial %d with %d nodes is not solved", trial, count);
        assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        other = hand;
        random_statuses(&random, &other);
        assert_true(hand_contact_solve_by(&other, SWEEPS_ON, &counts));
        assert_all_near("from another guess", other.velocity, hand.velocity, hand.interface.count,
                        1e-8);
        if (kind != FRICTION_RATE_STATE) continue;
        solves++;
        iterations += counts.iterations;
        for (int32_t i = 0; i < count; i++) {
            double speed = slip_size(&hand.interface, i, hand.velocity);
            assert_true(hand.status[i] != CONTACT_STICK || speed == 0);
            if (status_slips(hand.status[i])) slowest = fmin(slowest, speed);
            if (status_slips(hand.status[i])) fastest = fmax(fastest, speed);
        }
    }
    print_message("slip from %g to %g, %.1f iterations\n", slowest, fastest,
                  (double)iterations / (double)solves);
    assert_true(slowest < 1e-15 && fastest > 0.1 && iterations < 15 * solves);
}
