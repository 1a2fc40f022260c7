// SPDX-License-Identifier: GPL-2.0-or-later
// Random contact problems in space, judged by the conditions of contact alone, and held against
// solutions that they were made from.
#define HAND_DIM 3
#include "contact_by_hand.h"
#include "own_laws.h"

static void random_loads(Random *random, HandContact *hand)
{
    for (int32_t i = 0; i < hand->interface.contact_count; i++) {
        int32_t n = interface_normal(&hand->interface, i);
        hand->g[n - 2] = random_between(random, -3, 3);
        hand->g[n - 1] = random_between(random, -3, 3);
        hand->g[n] = random_between(random, -4, 1.5);
        hand->bound[n] = random_between(random, -0.4, 0.1);
    }
    for (int32_t j = 0; j < hand->interface.rod_count; j++) {
        hand->g[interface_rod(&hand->interface, j)] = random_between(random, -1, 1);
        hand->bound[interface_rod(&hand->interface, j)] = random_between(random, -0.5, 0.5);
    }
}

static void random_statuses(Random *random, HandContact *hand)
{
    for (int32_t i = 0; i < hand->interface.contact_count; i++)
        hand->status[i] = (uint8_t)random_index(random, 4);
    for (int32_t j = 0; j < hand->interface.rod_count; j++)
        hand->rod_touches[j] = (uint8_t)random_index(random, 2);
}

static HandContact hand, other;   // large; a test runs alone

static void random_problem(Random *random, int32_t trial)
{
    hand_contact_size(&hand, 1 + random_index(random, HAND_NODES),
                      random_index(random, HAND_RODS + 1));
    hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                             .mu_static = random_between(random, 0.1, 0.5),
                             .mu_kinetic = 0.1,
                             .critical_velocity = random_between(random, 0.8, 3)};
    if (trial % 5 == 0) hand.rod_kind = ROD_IS_BONDED;
    hand_random_schur(random, 3, 0.5, &hand);
}

// Friction and weakening small against S: one solution, from whatever guess.
TEST(test_large_problems)
{
    Random random = {.state = 131};
    int32_t seen[4] = {0}, touching = 0;
    for (int32_t trial = 0; trial < 90; trial++) {
        random_problem(&random, trial);
        random_loads(&random, &hand);
        random_statuses(&random, &hand);
        if (!hand_contact_solve(&hand)) fail_msg("trial %d is not solved", trial);
        assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        other = hand;
        random_statuses(&random, &other);
        if (trial % 2) memset(other.status, CONTACT_STICK, sizeof other.status);
        assert_true(hand_contact_solve(&other));
        assert_all_near("from another guess", other.velocity, hand.velocity, hand.interface.count,
                        1e-8);
        for (int32_t i = 0; i < hand.interface.contact_count; i++) seen[hand.status[i]]++;
        for (int32_t j = 0; j < hand.interface.rod_count; j++) touching += hand.rod_touches[j];
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k] > 10);
    assert_true(touching > 50);
}

// A third of the nodes open, a third at rest within its disc, a third slipping against r_t: g
// follows from S, v and r. Weakening and coupling so small that there is no other solution.
static void make_solution(Random *random, double *velocity, double *reaction)
{
    const Interface *interface = &hand.interface;
    memset(velocity, 0, HAND_UNKNOWNS * sizeof *velocity);
    memset(reaction, 0, HAND_UNKNOWNS * sizeof *reaction);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double angle = random_between(random, 0, 2 * M_PI), size = random_between(random, 0.01, 1);
        double along[] = {cos(angle), sin(angle)}, *v = velocity + 3 * i, *r = reaction + 3 * i;
        double bound = random_between(random, -0.4, 0.1), p = random_between(random, 0.1, 3);
        int32_t kind = random_index(random, 3);   // 0: open
        hand.bound[3 * i + 2] = bound;
        v[2] = kind == 0 ? bound + size : bound;
        r[2] = kind == 0 ? 0 : p;
        double shear = kind == 1 ? 0.95 * size * hand.law.mu_static
                                 : friction_coefficient(NODE_OF(&hand.law), size);
        for (int32_t c = 0; c < 2; c++) {
            v[c] = kind == 1 ? 0 : size * along[c];
            r[c] = kind == 0 ? 0 : -shear * p * along[c];
        }
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        double size = random_between(random, 0.1, 1);
        bool touches = hand.rod_kind == ROD_IS_BONDED || random_index(random, 2);
        velocity[x] = hand.bound[x] = random_between(random, -0.5, 0.5);
        *(touches ? &reaction[x] : &velocity[x]) += size;
    }
}

TEST(test_known_solutions)
{
    Random random = {.state = 133};
    double velocity[HAND_UNKNOWNS], reaction[HAND_UNKNOWNS];
    for (int32_t trial = 0; trial < 90; trial++) {
        random_problem(&random, trial);
        make_solution(&random, velocity, reaction);
        int32_t count = hand.interface.count;
        for (int32_t k = 0; k < count; k++) {
            hand.g[k] = -reaction[k];
            for (int32_t l = 0; l < count; l++)
                hand.g[k] += hand.schur[l * count + k] * velocity[l];
        }
        random_statuses(&random, &hand);
        assert_true(hand_contact_solve(&hand));
        assert_all_near("v", hand.velocity, velocity, count, 1e-9);
        assert_all_near("r", hand.reaction, reaction, count, 1e-8);
    }
}

// Weakening up to three hundred times faster than S resists, and friction up to 1.2: there may be
// many solutions; one is found, now and then by sweeps only.
TEST(test_hard_problems)
{
    Random random = {.state = 132};
    int64_t rescued = 0;
    for (int32_t trial = 0; trial < 500; trial++) {
        hand_contact_size(&hand, 1 + random_index(&random, 20), 2);
        hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 2),
                                 .mu_static = random_between(&random, 0.1, 1.2),
                                 .mu_kinetic = 0.1,
                                 .critical_velocity = random_between(&random, 0.003, 0.1)};
        hand_random_schur(&random, 1, 0.5, &hand);
        random_loads(&random, &hand);
        random_statuses(&random, &hand);
        HandCounts counts;
        if (!hand_contact_solve_by(&hand, true, &counts)) fail_msg("trial %d is not solved", trial);
        assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        rescued += counts.rescued;
    }
    print_message("%d of 500 by sweeps\n", (int)rescued);
    assert_true(rescued > 20);
}
