// SPDX-License-Identifier: GPL-2.0-or-later
// Error bars from runs on several meshes, against sums by hand.
#include "record/error_bars.h"

#include "near.h"

static void begin(Levels *levels, double refine)
{
    levels->list[levels->count++] = (Level){.refine = refine, .contact_nodes = 1001};
}

static void add(Levels *levels, double mu_M, double mu_hold, double error)
{
    Answers answers = {.mu_M = {mu_M, error}, .mu_hold = {mu_hold, error}, .peaks_counted = 8};
    levels_add_run(levels, 1, &answers, 100);
}

// One level: mean, spread 0.02 / sqrt(2), and no mesh part.
static void test_one_level(void **state)
{
    (void)state;
    Levels levels = {0};
    begin(&levels, 0.5);
    add(&levels, 0.29, 0.2, 0.003);
    add(&levels, 0.31, 0.2, 0.004);
    const ErrorBar *mu_M = levels_answer(&levels, ANSWER_MU_M);
    assert_near("mean", mu_M->value, 0.3, 1e-15);
    assert_true(isnan(mu_M->parts.mesh));
    assert_near("drops", mu_M->parts.drops, 0.005 / 2, 1e-15);
    assert_near("branches", mu_M->parts.branches, 2 * 0.02 / sqrt(2) / sqrt(2), 1e-15);
    assert_near("bar", mu_M->bar, sqrt(0.0025 * 0.0025 + 0.02 * 0.02), 1e-15);
    assert_true(isnan(levels_order(&levels)));
}

// The spread of runs is that of both levels: squares 2 * 0.01^2 and 2 * 0.02^2 over two freedoms.
static void test_two_levels(void **state)
{
    (void)state;
    Levels levels = {0};
    begin(&levels, 1);
    add(&levels, 0.29, 0.2, NAN);
    add(&levels, 0.31, 0.2, NAN);
    begin(&levels, 2);
    add(&levels, 0.30, 0.2, NAN);
    add(&levels, 0.34, 0.2, NAN);
    const ErrorBar *mu_M = levels_answer(&levels, ANSWER_MU_M);
    assert_near("mean", mu_M->value, 0.32, 1e-15);
    assert_near("mesh", mu_M->parts.mesh, 2 * 0.02, 1e-15);
    assert_near("branches", mu_M->parts.branches, 2 * sqrt((2e-4 + 8e-4) / 2) / sqrt(2), 1e-15);
    assert_near("drops", mu_M->parts.drops, 0, 0);
    const ErrorBar *hold = levels_answer(&levels, ANSWER_MU_HOLD);   // both meshes agree
    assert_near("least", hold->parts.mesh, 0.002 * 0.2, 1e-15);
    levels.list[1].contact_nodes = 21;   // a quarter of a cell is more than steps leave
    levels_estimate(&levels);
    assert_near("cell", levels_answer(&levels, ANSWER_MU_HOLD)->parts.mesh, 0.2 / 80, 1e-15);
    Answers answers = {.mu_max = 1};
    levels_answer_for(&levels, &answers);
    assert_true(answers.mu_M.value == mu_M->value && answers.mu_M.error == mu_M->bar);
    assert_true(answers.mu_hold_parts.mesh == hold->parts.mesh && answers.mu_max == 1);
}

// Differences 0.08, 0.02: order 2, and half of the one before is the larger.
static void test_three_levels(void **state)
{
    (void)state;
    Levels levels = {0};
    double values[] = {0.2, 0.28, 0.30};
    for (int32_t k = 0; k < 3; k++) {
        begin(&levels, ldexp(1, k));
        add(&levels, values[k], 0.1, NAN);
    }
    assert_near("mesh", levels_answer(&levels, ANSWER_MU_M)->parts.mesh, 0.04, 1e-15);
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_M)->parts.branches));   // no two runs
    assert_near("order", levels_order(&levels), 2, 1e-12);
}

// A run in which the block never slid as a whole: the request is about mu_hold.
static void test_without_mu_M(void **state)
{
    (void)state;
    Levels levels = {0};
    begin(&levels, 1);
    add(&levels, 0.3, 0.2, NAN);
    assert_true(levels.asked == ANSWER_MU_M);
    add(&levels, NAN, 0.22, NAN);
    assert_true(levels.asked == ANSWER_MU_HOLD);
    assert_true(isnan(levels_answer(&levels, ANSWER_MU_M)->bar));   // no value, no bar
    assert_near("lowest", levels_answer(&levels, ANSWER_MU_HOLD)->value, 0.2, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_level),
        cmocka_unit_test(test_two_levels),
        cmocka_unit_test(test_three_levels),
        cmocka_unit_test(test_without_mu_M),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
