// SPDX-License-Identifier: GPL-2.0-or-later
// Random contact problems in space, judged by the conditions of contact alone and, with a loop of
// projected sweeps written here, by velocities.
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

// Up to 40 nodes and 4 rod nodes, the three laws in turn, friction and weakening small against S.
static void test_large_problems(void **state)
{
    (void)state;
    Random random = {.state = 131};
    int32_t seen[4] = {0}, touching = 0, solves = 0, unsolved = 0, apart = 0;
    int64_t iterations = 0, rescued = 0;
    for (int32_t trial = 0; trial < 150; trial++) {
        hand_contact_size(&hand, 1 + random_index(&random, HAND_NODES),
                          random_index(&random, HAND_RODS + 1));
        hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 3),
                                 .mu_static = random_between(&random, 0.1, 0.5),
                                 .mu_kinetic = 0.1,
                                 .critical_velocity = random_between(&random, 0.8, 3)};
        if (trial % 5 == 0) hand.rod_kind = ROD_IS_BONDED;
        hand_random_schur(&random, 3, 0.5, &hand);
        random_loads(&random, &hand);
        random_statuses(&random, &hand);
        HandCounts counts;
        solves++;
        if (!hand_contact_solve_by(&hand, true, &counts)) { unsolved++; continue; }
        iterations += counts.iterations, rescued += counts.rescued;
        assert_near("judged", hand_contact_error(&hand), 0, 1e-9);
        other = hand;
        random_statuses(&random, &other);
        if (trial % 2) memset(other.status, CONTACT_STICK, sizeof other.status);
        solves++;
        if (!hand_contact_solve_by(&other, true, &counts)) { unsolved++; continue; }
        iterations += counts.iterations, rescued += counts.rescued;
        double far = 0;
        for (int32_t k = 0; k < hand.interface.count; k++) far = fmax(far, fabs(hand.velocity[k] - other.velocity[k]));
        apart += far > 1e-8;
        for (int32_t i = 0; i < hand.interface.contact_count; i++) seen[hand.status[i]]++;
        for (int32_t j = 0; j < hand.interface.rod_count; j++) touching += hand.rod_touches[j];
    }
    print_message("%d of %d unsolved, %d apart; %d iterations, %d rescued; seen %d %d %d %d, %d\n", unsolved, solves, apart,
                  (int)iterations, (int)rescued, seen[0], seen[1], seen[2], seen[3], touching);
}

// Small ones where friction weakens faster than S resists, or is large.
static void test_hard_problems(void **state)
{
    (void)state;
    Random random = {.state = 132};
    for (int32_t kind = 0; kind < 4; kind++) {
    int32_t seen[4] = {0}, solves = 0, unsolved = 0;
    int64_t iterations = 0, rescued = 0;
    double worst = 0;
    for (int32_t trial = 0; trial < 500; trial++) {
        hand_contact_size(&hand, 1 + random_index(&random, 30), 2);
        hand.law = (FrictionLaw){.kind = (FrictionKind)(trial % 2),
                                 .mu_static = random_between(&random, 0.1, kind & 1 ? 1.2 : 0.6),
                                 .mu_kinetic = 0.1,
                                 .critical_velocity = random_between(&random, 0.01, kind & 2 ? 0.02 : 0.5)};
        hand_random_schur(&random, kind == 3 ? 1 : 3, 0.5, &hand);
        random_loads(&random, &hand);
        random_statuses(&random, &hand);
        HandCounts counts;
        solves++;
        if (!hand_contact_solve_by(&hand, true, &counts)) { unsolved++; continue; }
        iterations += counts.iterations, rescued += counts.rescued;
        worst = fmax(worst, hand_contact_error(&hand));
        for (int32_t i = 0; i < hand.interface.contact_count; i++) seen[hand.status[i]]++;
    }
    print_message("kind %d: %d of %d unsolved; %d iterations, %d rescued; seen %d %d %d %d; worst %g\n", kind, unsolved, solves,
                  (int)iterations, (int)rescued, seen[0], seen[1], seen[2], seen[3], worst);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_large_problems),
        cmocka_unit_test(test_hard_problems),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
