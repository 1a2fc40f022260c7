// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/pace.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// A run to t = 1000, as far as it has come.
typedef struct Run {
    Pace pace;
    int64_t steps;
    double time;
    Error err;
} Run;

// `count` steps of dt each; whether all were borne.
static bool go_on(Run *run, int64_t count, double dt)
{
    for (int64_t k = 0; k < count; k++) {
        run->time += dt;
        if (!pace_check(&run->pace, ++run->steps, run->time, 1000, &run->err)) return false;
    }
    return true;
}

// An event of many short steps between long ones is no standstill.
static void short_steps_that_end_are_borne(void **state)
{
    (void)state;
    Run run = {0};
    assert_true(go_on(&run, PACE_STEPS / 2, 1e-2));
    assert_true(go_on(&run, PACE_STEPS - 10, 1e-9));
    assert_true(go_on(&run, PACE_STEPS, 1e-2));
}

// 1000 away at 1e-6: 1e9 steps; refused at the first look after a whole row of them.
static void a_standstill_is_refused(void **state)
{
    (void)state;
    Run run = {0};
    assert_true(go_on(&run, PACE_STEPS / 2, 1e-2));
    assert_false(go_on(&run, 3 * PACE_STEPS, 1e-6));
    assert_in_range(run.steps, PACE_STEPS, 2 * PACE_STEPS);
    assert_int_equal(run.err.code, ERROR_COMPUTE);
    assert_non_null(strstr(run.err.message, "steps of 1e-06"));
    assert_non_null(strstr(run.err.message, "9.0e+08"));
}

// 1e7 steps to go are long, and no reason to refuse.
static void long_runs_are_borne(void **state)
{
    (void)state;
    Run run = {0};
    assert_true(go_on(&run, 2 * PACE_STEPS, 1e-4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(short_steps_that_end_are_borne),
                                       cmocka_unit_test(a_standstill_is_refused),
                                       cmocka_unit_test(long_runs_are_borne)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
