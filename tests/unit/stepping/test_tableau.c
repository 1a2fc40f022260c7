// SPDX-License-Identifier: GPL-2.0-or-later
// The estimate of the scheme against its true local error on motions known in closed form, and its
// tableau against the conditions of its order.
#include "stepping/tableau.h"

#include "near.h"

#include <complex.h>

typedef struct Step {
    double complex u, error;   // at its end, and as it is estimated
} Step;

// One step on u' = v, v' = lambda v + drive t, u = 0 and v = 1 at its start, stage by stage.
static Step do_step(double complex lambda, double drive, double dt)
{
    double complex v[SDIRK_STAGES], rate[SDIRK_STAGES];
    Step step = {.error = dt * SDIRK2.error[0]};
    for (int32_t i = 0; i < SDIRK_STAGES; i++) {
        double complex start = 1;
        for (int32_t j = 0; j < i; j++) start += dt * SDIRK2.a[i][j] * rate[j];
        double g = SDIRK2.gamma * dt, t = SDIRK2.c[i] * dt;
        v[i] = (start + g * drive * t) / (1 - g * lambda);
        rate[i] = lambda * v[i] + drive * t;
        step.u += dt * SDIRK2.a[SDIRK_STAGES - 1][i] * v[i];
        step.error += dt * SDIRK2.error[i + 1] * v[i];
    }
    return step;
}

// v = (1 + d) e^(lambda t) - d (1 + lambda t), d = drive/lambda^2, and u its integral.
static double complex exact_way(double complex lambda, double drive, double dt)
{
    double complex d = drive / (lambda * lambda);
    return (1 + d) * (cexp(lambda * dt) - 1) / lambda - d * (dt + lambda * dt * dt / 2);
}

// Damped, oscillating, and driven by a force that grows in time: the estimate tends to the error,
// and the error falls as dt^3.
TEST(test_estimate_is_the_local_error)
{
    const struct {
        double complex lambda;
        double drive;
    } motions[] = {{-1, 0}, {-0.3 + 2 * I, 0}, {2 * I, 0}, {-1.5, 3}, {0.5, -1}};
    for (size_t m = 0; m < sizeof motions / sizeof *motions; m++) {
        double complex lambda = motions[m].lambda;
        double before = 0;
        for (double dt = 0.02; dt > 0.004; dt /= 2) {
            Step step = do_step(lambda, motions[m].drive, dt);
            double complex error = exact_way(lambda, motions[m].drive, dt) - step.u;
            double complex ratio = step.error / error;
            assert_near("estimate over error", creal(ratio), 1, 8 * dt);
            assert_near("and its phase", cimag(ratio), 0, 8 * dt);
            if (before > 0) assert_near("order", log2(before / cabs(error)), LOCAL_ORDER, 0.15);
            before = cabs(error);
        }
    }
}

// Closed form of the coefficient of z^3 in exp(z) - R(z): 1/6 - gamma^2 (3 - 2 gamma).
TEST(test_error_constant)
{
    double g = 1 - sqrt(0.5), wanted = 1. / 6 - g * g * (3 - 2 * g), dt = 1e-3;
    Step step = do_step(1, 0, dt);
    double constant = creal(step.error) / pow(dt, LOCAL_ORDER);
    assert_near("error constant", constant, wanted, 2e-3 * fabs(wanted) + 1e-4);
}

// Even motion has no error, and stages are summed to their places.
TEST(test_even_motion)
{
    double sum = SDIRK2.error[0];
    for (int32_t i = 0; i < SDIRK_STAGES; i++) {
        double place = 0;
        for (int32_t j = 0; j <= i; j++) place += SDIRK2.a[i][j];
        assert_near("c", SDIRK2.c[i], place, 1e-15);
        sum += SDIRK2.error[i + 1];
    }
    assert_near("even motion", sum, 0, 1e-15);
    assert_near("ends at 1", SDIRK2.c[SDIRK_STAGES - 1], 1, 1e-15);
}
