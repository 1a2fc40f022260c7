// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/measured.h"

#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char path[] = "/tmp/amontons_measured_XXXXXX";
static double U[3] = {0, 1e-3, 3e-3}, mu[3] = {0, 0.2, 0.4}, front[3] = {0, 0.01, 0.05};
static ResultView view = {.si = true, .rows = 3, .U = U, .mu = mu};

FIXTURE(begin)
{
    view.number[NUMBER_LENGTH] = 0.1;
    int file = mkstemp(path);
    return file < 0 ? -1 : close(file);
}

FIXTURE(end)
{
    return unlink(path);
}

static bool take(const char *text, MeasuredKind kind, Measured *measured, Error *err)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return measured_read(path, kind, &view, kind == MEASURED_MU ? mu : front, measured, err);
}

// 0.03 more than 0.1 and 0.04 less than 0.3; the third point lies beyond the history.
TEST(the_misfit_is_a_root_mean_square)
{
    Error err = {0};
    Measured measured;
    assert_true(take("U (mm),F_T/F_N,error,source\n0.5,0.13,0.01,me\n2,0.26,0.02,me\n9,1,0.1,me\n",
                     MEASURED_MU, &measured, &err));
    assert_int_equal(measured.count, 3);
    assert_float_equal(measured.U[1], 2e-3, 1e-15);
    assert_non_null(strstr(measured.words, ": misfit 0.0354, 2.55 of its errors"));
    measured_destroy(&measured);
    // sqrt((0.03^2 + 0.04^2) / 2) and sqrt((3^2 + 2^2) / 2)
}

TEST(units_and_quotients)
{
    Error err = {0};
    Measured measured;
    assert_true(take("F_N (kN), F_T (kN), U/L\n2,0.4,0.01\n", MEASURED_MU, &measured, &err));
    assert_float_equal(measured.value[0], 0.2, 1e-15);
    assert_float_equal(measured.U[0], 1e-3, 1e-15);
    measured_destroy(&measured);
    assert_true(take("U (um),x (cm),error\n1000,1.5,0.1\n", MEASURED_X, &measured, &err));
    assert_float_equal(measured.value[0], 0.015, 1e-15);
    assert_non_null(strstr(measured.words, "misfit 0.05 ~{L}, 5 of its errors"));
    measured_destroy(&measured);
    assert_true(take("U (um),x (cm)\n1000,1.5\n", MEASURED_MU, &measured, &err));
    assert_int_equal(measured.count, 0);
    measured_destroy(&measured);
}

TEST(what_is_wrong_is_said)
{
    static const char *const cases[][2] = {{"U,mu\n1,2\n", "lengths need a unit"},
                                           {"U (ft),mu\n1,2\n", "no unit \"ft\""},
                                           {"U (mm),y\n1,2\n", "it needs the columns"},
                                           {"U (mm),mu\n1\n", "cells"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        Error err = {0};
        Measured measured;
        assert_false(take(cases[k][0], MEASURED_MU, &measured, &err));
        if (!strstr(err.message, cases[k][1])) fail_msg("%s", err.message);
    }
    Error err = {0};
    Measured measured;
    view.si = false;
    assert_false(take("U (mm),mu\n1,2\n", MEASURED_MU, &measured, &err));
    assert_non_null(strstr(err.message, "normalised"));
    view.si = true;
}

GROUP_BETWEEN(begin, end);
