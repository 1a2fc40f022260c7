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
static double t[3] = {0, 2, 6};   // s: V is 0.5 mm/s
static double x[2] = {0, 0.1}, rates[6], statuses[6] = {1, 1, 1, 1, 1, 1},
              areas[6] = {1, 1, 1, 1, 1, 1};
static ResultView view = {.si = true,
                          .rows = 3,
                          .t = t,
                          .U = U,
                          .mu = mu,
                          .front = front,
                          .nodes = 2,
                          .x = x,
                          .slip_rate = rates,
                          .status = statuses,
                          .area = areas};

FIXTURE(begin)
{
    view.number[NUMBER_LENGTH] = 0.1;
    view.number[NUMBER_C_RAYLEIGH] = 900;
    view.number[NUMBER_ROD_VELOCITY] = -5e-4;
    view.precursors = view.front_speed = (ViewCurve){3, U, front};
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
    return measured_read(path, kind, &view, measured, err);
}

// 0.03 more than 0.1 and 0.04 less than 0.3; the third point lies beyond the history.
TEST(the_misfit_is_a_root_mean_square)
{
    Error err = {0};
    Measured measured;
    assert_true(take("U (mm),F_T/F_N,error,source\n0.5,0.13,0.01,me\n2,0.26,0.02,me\n9,1,0.1,me\n",
                     MEASURED_MU, &measured, &err));
    assert_int_equal(measured.count, 3);
    assert_float_equal(measured.at[1], 2e-3, 1e-15);
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
    assert_float_equal(measured.at[0], 1e-3, 1e-15);
    measured_destroy(&measured);
    // The load of the result is 500 N/m times 8 mm.
    view.number[NUMBER_LOAD] = 500;
    view.number[NUMBER_THICKNESS] = 8e-3;
    assert_true(take("U (mm);F_T (mN);F_T error (N)\n1;800;0,04\n", MEASURED_MU, &measured, &err));
    assert_float_equal(measured.value[0], 0.2, 1e-15);
    assert_float_equal(measured.error[0], 0.01, 1e-15);
    measured_destroy(&measured);
    view.number[NUMBER_THICKNESS] = NAN;
    assert_false(take("U (mm),F_T (mN)\n1,800\n", MEASURED_MU, &measured, &err));
    error_clear(&err);
    assert_true(take("F_N (kN);F_T (N);U/mm\n2;400;1,0\n", MEASURED_MU, &measured, &err));
    assert_float_equal(measured.value[0], 0.2, 1e-15);   // semicolons, decimal commas, N over kN
    assert_float_equal(measured.at[0], 1e-3, 1e-15);
    measured_destroy(&measured);
    assert_true(
        take("x (cm),v (m/s),v_error (km/s)\n5,500,0.01\n", MEASURED_SPEED, &measured, &err));
    assert_float_equal(measured.error[0], 10, 1e-12);
    measured_destroy(&measured);
    assert_true(take("U (um),x (cm),error\n1000,1.5,0.1\n", MEASURED_FRONT, &measured, &err));
    assert_float_equal(measured.value[0], 0.015, 1e-15);
    assert_non_null(strstr(measured.words, "misfit 0.05 ~{L}, 5 of its errors"));
    measured_destroy(&measured);
    assert_true(take("U (um),x (cm)\n1000,1.5\n", MEASURED_MU, &measured, &err));
    assert_int_equal(measured.count, 0);
    measured_destroy(&measured);
}

// The columns of the file say what was measured: U by time, lengths over the load ratio, speeds
// over a wave's.
TEST(columns_say_what_was_measured)
{
    static const struct {
        const char *text;
        MeasuredKind kind;
        double at, value, error;
    } cases[] = {{"t (ms),mu\n1000,0.1\n", MEASURED_MU, 5e-4, 0.1, NAN},
                 {"t (min),x/L,error\n0.05,0.5,0.1\n", MEASURED_FRONT, 1.5e-3, 0.05, 0.01},
                 {"U (mm),x (mm),A/A_0\n1,20,0.9\n", MEASURED_AREA, 1e-3, 0.9, NAN},
                 {"F_T/F_N,l (mm),error\n0.3,40,2\n", MEASURED_LENGTH, 0.3, 0.04, 2e-3},
                 {"x (cm),v/c_R\n5,0.5\n", MEASURED_SPEED, 0.05, 450, NAN},
                 {"x (cm),v/V\n5,4\n", MEASURED_SPEED, 0.05, 2e-3, NAN},
                 {"x (cm),v (km/s)\n5,0.5\n", MEASURED_SPEED, 0.05, 500, NAN}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        Error err = {0};
        Measured measured;
        for (int32_t kind = 0; kind < MEASURED_KINDS; ++kind) {
            if (!take(cases[k].text, (MeasuredKind)kind, &measured, &err))
                fail_msg("%s", err.message);
            assert_int_equal(measured.count, kind == (int32_t)cases[k].kind);
            if (measured.count > 0) {
                assert_float_equal(measured.at[0], cases[k].at, 1e-12);
                assert_float_equal(measured.value[0], cases[k].value, 1e-12);
                if (isfinite(cases[k].error))
                    assert_float_equal(measured.error[0], cases[k].error, 1e-12);
                else
                    assert_true(isnan(measured.error[0]));
            }
            measured_destroy(&measured);
        }
    }
}

// By hand: between rows half-way, at both ends, beyond them; where a curve stands still its end.
TEST(a_curve_is_linear_between_its_points)
{
    double at[5] = {0, 1, 1, 1, 3}, value[5] = {0, 2, 5, 6, 10};
    const ViewCurve curve = {5, at, value};
    assert_float_equal(curve_value(&curve, 0), 0, 1e-15);
    assert_float_equal(curve_value(&curve, 0.5), 1, 1e-15);
    assert_float_equal(curve_value(&curve, 1), 6, 1e-15);
    assert_float_equal(curve_value(&curve, 2), 8, 1e-15);
    assert_float_equal(curve_value(&curve, 3), 10, 1e-15);
    assert_true(isnan(curve_value(&curve, 3.1)) && isnan(curve_value(&curve, -0.1)));
}

TEST(what_is_wrong_is_said)
{
    static const char *const cases[][2] = {
        {"U,mu\n1,2\n", "U needs a unit"},
        {"U (ft),mu\n1,2\n", ":1:1: U (ft) has `ft`, which is no unit of length; allowed: m"},
        {"U (mm),y\n1,2\n", "it needs the columns"},
        {"U (mm),mu\n1\n", ":2: 1 cell, the first row has 2"},
        {"U (mm),mu\n", "there is no row"},
        {"U (mm),mu\n1,\n1,0.3 kN\n", ":3:3: mu: `0.3 kN` is no number;"},
        {"U (mm),x (cm),mu\n1,?,1\n", ":2:3: x (cm): `?`"},
        {"U (mm),mu\n1e999,1\n", "`1e999` is no number;"},
        {"U (mm),mu,error\n1,1,0\n", "error: `0` is no number above 0"},
        {"U (mm),F_T,F_N\n1,1,0\n", "F_N: `0` is no number above 0"},
        {"U (mm),F_T (N),F_N\n1,1,1\n", "F_N cannot stand under F_T (N): both need units"},
        {"U (mm),F_T (N),F_N (N/m)\n1,1,1\n", "cannot stand under"},
        {"U (mm),mu,U/L\n1,1,1\n", ":1:1: U (mm) is U a second time, beside U/L"},
        {"U (mm),mu,F_T/F_N\n1,1,1\n", "F_T/F_N is mu a second time"},
        {"U (mm),mu,mu\n1,1,1\n", "mu stands twice, in column 2 and in column 3"}};
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
