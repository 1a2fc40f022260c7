// SPDX-License-Identifier: GPL-2.0-or-later
// What reduction.use: auto goes by: what must hold of any machine, and any constants that make
// sense.
#include "model/choice.h"

#include "near.h"

// A block of `side` x `side` cells of order 1, and a run of so many stages.
static ChoiceSizes block(double side, double stages)
{
    return (ChoiceSizes){.unknowns = 2 * (side + 1) * (side + 1),
                         .interface = 2 * (side + 1) + 0.1 * side,
                         .stages = stages,
                         .halves = 1,
                         .runs = 1};
}

static bool reduces(const ChoiceSizes *sizes)
{
    ExpectedCost cost = choice_expect(sizes);
    return choice_reduces(sizes, &cost);
}

static void test_short_and_long_runs(void **state)
{
    (void)state;
    for (double side = 60; side <= 200; side += 20) {
        ChoiceSizes brief = block(side, 100), with_slidings = block(side, 3000);
        assert_false(reduces(&brief));
        assert_true(reduces(&with_slidings));
    }
}

// What is decided for some number of stages is decided for more of them.
static void test_once_it_pays_it_pays(void **state)
{
    (void)state;
    for (double side = 30; side <= 250; side += 20) {
        bool before = false;
        for (double stages = 50; stages < 1e5; stages *= 1.5) {
            ChoiceSizes sizes = block(side, stages);
            bool now = reduces(&sizes);
            assert_true(now || !before);
            before = now;
        }
        assert_true(before);
    }
}

static void test_held(void **state)
{
    (void)state;
    ChoiceSizes brief = block(160, 100);
    assert_false(reduces(&brief));
    brief.held = true;
    assert_true(reduces(&brief));
}

static void test_many_runs(void **state)
{
    (void)state;
    ChoiceSizes brief = block(160, 100);
    brief.runs = 20;
    assert_true(reduces(&brief));
    ExpectedCost one = choice_expect(&brief);
    brief.runs = 1;
    ExpectedCost same = choice_expect(&brief);
    assert_true(one.reduction == same.reduction && one.full == same.full);   // of all, of one
}

// Small ones are reduced in any case: tests and sweeps of small blocks do not depend on seconds.
static void test_not_worth_asking(void **state)
{
    (void)state;
    for (double side = 2; side <= 20; side++) {
        ChoiceSizes none = block(side, 0);
        assert_true(reduces(&none));
    }
}

// 320 x 320 cells are to be reduced within 6 GB; beyond memory there is no choice.
static void test_memory(void **state)
{
    (void)state;
    ChoiceSizes large = block(320, 1e4), huge = block(700, 1e6);
    assert_true(reduces(&large));
    assert_false(reduces(&huge));
}

// mu_S = 0.4 and mu_K = 0.2: slidings where the rod is at 0.4, 0.6, ... times `way`.
static void test_stages(void **state)
{
    (void)state;
    Scene scene = {.rod = {.kind = ROD_PUSH, .velocity = 2}, .time = {.until_U = 0.3}};
    scene.friction.mu_static = 0.4;
    scene.friction.mu_kinetic = 0.2;
    double rest = choice_stages(&scene, 1);
    assert_true(rest > 0);   // relaxing, and the way to the first
    scene.time.until_U = 0.6;
    double sliding = choice_stages(&scene, 1) - rest;
    assert_true(sliding > 0);
    scene.time.until_U = 1.4;
    assert_near("five", choice_stages(&scene, 1), rest + 5 * sliding, 1e-9);
    scene.time.until_U = 0;
    scene.time.until_t = 0.7;
    assert_near("as long", choice_stages(&scene, 1), rest + 5 * sliding, 1e-9);
    scene.time.until_slidings = 2;
    assert_near("two asked for", choice_stages(&scene, 1), rest + 2 * sliding, 1e-9);
    scene.time.until_slidings = 0;
    scene.time.until_t = 1e6;
    scene.time.until_periodic = true;
    assert_true(choice_stages(&scene, 1) < rest + 20 * sliding);
    scene.friction.mu_kinetic = 0.4;   // Coulomb
    assert_true(isfinite(choice_stages(&scene, 1)));
    scene.friction.mu_static = scene.friction.mu_kinetic = 0;
    assert_true(isfinite(choice_stages(&scene, 1)));
    scene.time.until_periodic = false;
    scene.time.step_max = 1;   // a million steps of two stages
    assert_near("steps", choice_stages(&scene, 1), 2e6, 0);
    scene.time.step_max = 0;
    scene.rod.kind = ROD_NONE;
    assert_near("no rod", choice_stages(&scene, 1), rest, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_short_and_long_runs),
                                       cmocka_unit_test(test_once_it_pays_it_pays),
                                       cmocka_unit_test(test_held),
                                       cmocka_unit_test(test_many_runs),
                                       cmocka_unit_test(test_not_worth_asking),
                                       cmocka_unit_test(test_memory),
                                       cmocka_unit_test(test_stages)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
