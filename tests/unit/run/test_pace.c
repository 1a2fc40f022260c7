// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/pace.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// `count` steps of dt each, from where `pace` and *steps, *time stand; whether all were borne.
static bool go_on(Pace *pace, int64_t count, double dt, int64_t *steps, double *time, Error *err)
{
    for (int64_t k = 0; k < count; k++) {
        *time += dt;
        if (!pace_check(pace, ++*steps, *time, 1000, err)) return false;
    }
    return true;
}

// An event of many short steps between long ones is no standstill.
static void short_steps_that_end_are_borne(void **state)
{
    (void)state;
    Pace pace = {0};
    Error err = {0};
    int64_t steps = 0;
    double time = 0;
    assert_true(go_on(&pace, PACE_STEPS / 2, 1e-2, &steps, &time, &err));
    assert_true(go_on(&pace, PACE_STEPS - 10, 1e-9, &steps, &time, &err));
    assert_true(go_on(&pace, PACE_STEPS, 1e-2, &steps, &time, &err));
}

// 1000 away at 1e-6: 1e9 steps; refused at the first look after a whole row of them.
static void a_standstill_is_refused(void **state)
{
    (void)state;
    Pace pace = {0};
    Error err = {0};
    int64_t steps = 0;
    double time = 0;
    assert_true(go_on(&pace, PACE_STEPS / 2, 1e-2, &steps, &time, &err));
    assert_false(go_on(&pace, 3 * PACE_STEPS, 1e-6, &steps, &time, &err));
    assert_in_range(steps, PACE_STEPS, 2 * PACE_STEPS);
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_non_null(strstr(err.message, "steps of 1e-06"));
    assert_non_null(strstr(err.message, "9.0e+08"));
}

// 1e7 steps to go are long, and no reason to refuse.
static void long_runs_are_borne(void **state)
{
    (void)state;
    Pace pace = {0};
    Error err = {0};
    int64_t steps = 0;
    double time = 0;
    assert_true(go_on(&pace, 2 * PACE_STEPS, 1e-4, &steps, &time, &err));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(short_steps_that_end_are_borne),
                                       cmocka_unit_test(a_standstill_is_refused),
                                       cmocka_unit_test(long_runs_are_borne)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
