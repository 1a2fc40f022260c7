// SPDX-License-Identifier: GPL-2.0-or-later
// Both halves are done, side by side where a second thread is to be had, else one after the other;
// signals stay with the caller's thread.
#include "base/share.h"

#include "base/error.h"

#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <unistd.h>

#include <cmocka.h>

enum { COUNT = 1001 };

// Sums of squares, each half's on its own; a number that is none ends a half with an error.
typedef struct Rig {
    double given[COUNT], sum[2];
    int32_t calls[2];
    pthread_t thread[2];
    bool masked[2];
    Error errors[2];
} Rig;

static bool add(double *sum, double number, Error *err)
{
    if (number != number) FAIL(err, ERROR_COMPUTE, "no number");
    *sum += number * number;
cleanup:
    return error_is_clean(err);
}

static void half(void *context, int32_t which)
{
    Rig *rig = context;
    Error *err = &rig->errors[which];
    sigset_t mask;
    pthread_sigmask(SIG_SETMASK, NULL, &mask);
    rig->masked[which] = sigismember(&mask, SIGINT) && sigismember(&mask, SIGTERM);
    rig->thread[which] = pthread_self();
    rig->calls[which]++;
    for (int32_t k = which; k < COUNT; k += 2)
        if (!add(&rig->sum[which], rig->given[k], err)) return;
}

static Rig shared(int32_t bad)
{
    static Rig rig;
    rig = (Rig){0};
    for (int32_t k = 0; k < COUNT; k++) rig.given[k] = k;
    if (bad >= 0) rig.given[bad] = 0.0 / 0.0;
    share_in_two(half, &rig);
    return rig;
}

// 0^2 + ... + 1000^2, even and odd; all is written when the call returns.
static void expect_sums(const Rig *rig)
{
    for (int which = 0; which < 2; which++) assert_int_equal(rig->calls[which], 1);
    assert_true(rig->sum[0] == 167167000.0);
    assert_true(rig->sum[1] == 166666500.0);
    assert_true(pthread_equal(rig->thread[0], pthread_self()));
}

static void test_two_threads(void **state)
{
    (void)state;
    for (int32_t round = 0; round < 50; round++) {
        Rig rig = shared(-1);
        expect_sums(&rig);
        assert_false(pthread_equal(rig.thread[1], pthread_self()));
        assert_false(rig.masked[0]);
        assert_true(rig.masked[1]);
    }
}

// What a half says is kept for the caller, and the other half is done all the same.
static void test_error_of_one_half(void **state)
{
    (void)state;
    for (int32_t bad = 0; bad < 2; bad++) {
        Rig rig = shared(500 + bad);
        assert_int_equal(rig.errors[bad].code, ERROR_COMPUTE);
        assert_string_equal(rig.errors[bad].message, "no number");
        assert_true(error_is_clean(&rig.errors[1 - bad]));
        assert_true(rig.sum[1 - bad] == (bad ? 167167000.0 : 166666500.0));
    }
}

// A stack that no machine has room for.
static void test_no_second_thread(void **state)
{
    (void)state;
    pthread_attr_t before, endless;
    assert_int_equal(pthread_getattr_default_np(&before), 0);
    pthread_attr_init(&endless);
    assert_int_equal(pthread_attr_setstacksize(&endless, (size_t)1 << 60), 0);
    assert_int_equal(pthread_setattr_default_np(&endless), 0);
    Rig rig = shared(-1);
    pthread_setattr_default_np(&before);
    pthread_attr_destroy(&before);
    pthread_attr_destroy(&endless);
    expect_sums(&rig);
    assert_true(pthread_equal(rig.thread[1], pthread_self()));
    assert_false(rig.masked[1]);   // the caller's mask is as it was
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_threads),
        cmocka_unit_test(test_error_of_one_half),
        cmocka_unit_test(test_no_second_thread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
