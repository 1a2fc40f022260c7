// SPDX-License-Identifier: GPL-2.0-or-later
// Least squares that are not negative by their optimality conditions; a solid found again from its
// moduli; M' against the integral of its relaxation.
#include "fem/relaxation_fit.h"

#include "cases.h"
#include "near.h"
#include "random_numbers.h"

#include <math.h>
#include <string.h>

// At the optimum the gradient is 0 where x is free and points outwards where x is held at 0
// (Karush, Kuhn and Tucker); no other point is as good, as the problem is convex.
TEST(optimality)
{
    enum { ROWS = 12, COLUMNS = 7 };
    Random random = {1};
    for (int32_t trial = 0; trial < 200; trial++) {
        Error err = {0};
        double A[ROWS * COLUMNS], b[ROWS], x[COLUMNS];
        for (int32_t k = 0; k < ROWS * COLUMNS; k++) A[k] = random_between(&random, -1, 1);
        for (int32_t k = 0; k < ROWS; k++) b[k] = random_between(&random, -1, 1);
        if (trial % 4 == 0)   // two columns alike
            for (int32_t r = 0; r < ROWS; r++) A[r * COLUMNS + 3] = A[r * COLUMNS + 1];
        assert_true(least_squares_not_negative(A, b, ROWS, COLUMNS, x, &err));
        for (int32_t c = 0; c < COLUMNS; c++) {
            double gradient = 0;
            for (int32_t r = 0; r < ROWS; r++) {
                double left = b[r];
                for (int32_t k = 0; k < COLUMNS; k++) left -= A[r * COLUMNS + k] * x[k];
                gradient += A[r * COLUMNS + c] * left;
            }
            assert_true(x[c] >= 0);
            assert_true(gradient < 1e-10);
            if (x[c] > 0) assert_near("gradient", gradient, 0, 1e-10);
        }
    }
}

static const RelaxationFit SOLID = {.rest = 1e6,
                                    .viscosity = 2e2,
                                    .count = 3,
                                    .time = {1e-3, 2e-2, 0.7},
                                    .modulus = {5e6, 2e6, 4e5}};

TEST(a_solid_is_found_again)
{
    enum { COUNT = 41 };
    double at[COUNT], storage[COUNT], loss[COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        at[i] = 0.1 * pow(10, 0.125 * i);
        relaxation_moduli(&SOLID, at[i], &storage[i], &loss[i]);
    }
    Error err = {0};
    RelaxationFit fit;
    RelaxationData data = {COUNT, false, at, storage, loss};
    assert_true(relaxation_fit(&data, true, &fit, &err));
    assert_true(fit.misfit < 0.01 && fit.worst < 0.04 && fit.count <= 9);
    assert_near("rest", fit.rest / SOLID.rest, 1, 0.02);
    for (int32_t k = 0; k < fit.count; k++) assert_true(fit.modulus[k] > 0);
    for (int32_t i = 0; i + 1 < COUNT; i++) {   // between the data, too
        double wanted[2], found[2], between = sqrt(at[i] * at[i + 1]);
        relaxation_moduli(&SOLID, between, &wanted[0], &wanted[1]);
        relaxation_moduli(&fit, between, &found[0], &found[1]);
        for (int32_t d = 0; d < 2; d++) assert_near("modulus", found[d] / wanted[d], 1, 0.04);
    }
    for (int32_t i = 0; i < COUNT; i++) {
        at[i] = 1 / at[i];
        storage[i] = relaxation_at(&SOLID, at[i]);
    }
    data = (RelaxationData){COUNT, true, at, storage, NULL};
    assert_true(relaxation_fit(&data, true, &fit, &err));
    assert_true(fit.misfit < 0.01 && fit.viscosity == 0);
}

// M'(w) = M_0 + w int (M(t) - M_0) sin(w t) dt, M''(w) - eta w likewise with cos.
TEST(moduli_are_transforms_of_the_relaxation)
{
    const double w = 40, end = 12, step = 2e-6;
    double in[2] = {0, 0}, found[2];
    for (double t = step / 2; t < end; t += step) {
        double fades = (relaxation_at(&SOLID, t) - SOLID.rest) * step * w;
        in[0] += fades * sin(w * t);
        in[1] += fades * cos(w * t);
    }
    relaxation_moduli(&SOLID, w, &found[0], &found[1]);
    assert_near("storage", found[0], SOLID.rest + in[0], 1e-4 * found[0]);
    assert_near("loss", found[1], SOLID.viscosity * w + in[1], 1e-4 * found[1]);
}

// The universal constants of Williams, Landel and Ferry, from T_g on.
TEST(shifts)
{
    assert_near("T_g", wlf_shift(17.44, 51.6, -60, -60), 1, 0);
    assert_near("T_g + 51.6", log10(wlf_shift(17.44, 51.6, -60, -8.4)), -8.72, 1e-9);
    assert_true(isnan(wlf_shift(17.44, 51.6, -60, -112)));
}

TEST(wrong_data)
{
    static const struct {
        double at[2], storage[2], loss[2];
        int32_t count;
        const char *words;
    } wrong[] = {{{1, 2}, {1, 1}, {1, 1}, 1, "1 points"},
                 {{1, -2}, {1, 1}, {1, 1}, 2, "point 2"},
                 {{1, 2}, {0, 1}, {1, 1}, 2, "point 1"},
                 {{1, 2}, {1, 1}, {1, NAN}, 2, "point 2"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        Error err = {0};
        RelaxationFit fit;
        RelaxationData data = {wrong[k].count, false, wrong[k].at, wrong[k].storage, wrong[k].loss};
        assert_false(relaxation_fit(&data, true, &fit, &err));
        if (!strstr(err.message, wrong[k].words)) fail_msg("%s", err.message);
    }
}
