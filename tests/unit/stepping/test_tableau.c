// SPDX-License-Identifier: GPL-2.0-or-later
// The estimate of each scheme against its true local error on motions known in closed form, and its
// tableau against the conditions of its order.
#include "stepping/tableau.h"

#include "near.h"

#include <complex.h>

static const TableauKind KINDS[] = {TABLEAU_EULER, TABLEAU_SDIRK2, TABLEAU_SDIRK3};
enum { KINDS_COUNT = 3 };

typedef struct Step {
    double complex u, error;   // at its end, and as it is estimated
} Step;

// One step on u' = v, v' = lambda v + drive t, u = 0 and v = 1 at its start, stage by stage.
static Step do_step(const Tableau *tableau, double complex lambda, double drive, double dt)
{
    double complex v[TABLEAU_STAGES_MAX], rate[TABLEAU_STAGES_MAX];
    Step step = {.error = dt * tableau->error[0]};
    for (int32_t i = 0; i < tableau->stages; i++) {
        double complex start = 1;
        for (int32_t j = 0; j < i; j++) start += dt * tableau->a[i][j] * rate[j];
        double g = tableau->gamma * dt, t = tableau->c[i] * dt;
        v[i] = (start + g * drive * t) / (1 - g * lambda);
        rate[i] = lambda * v[i] + drive * t;
        step.u += dt * tableau->a[tableau->stages - 1][i] * v[i];
        step.error += dt * tableau->error[i + 1] * v[i];
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
// and the error falls as dt^(order + 1).
TEST(test_estimate_is_the_local_error)
{
    const struct {
        double complex lambda;
        double drive;
    } motions[] = {{-1, 0}, {-0.3 + 2 * I, 0}, {2 * I, 0}, {-1.5, 3}, {0.5, -1}};
    for (int32_t s = 0; s < KINDS_COUNT; s++) {
        Tableau tableau = tableau_of(KINDS[s]);
        for (size_t m = 0; m < sizeof motions / sizeof *motions; m++) {
            double complex lambda = motions[m].lambda;
            double before = 0;
            for (double dt = 0.02; dt > 0.004; dt /= 2) {
                Step step = do_step(&tableau, lambda, motions[m].drive, dt);
                double complex error = exact_way(lambda, motions[m].drive, dt) - step.u;
                double complex ratio = step.error / error;
                assert_near("estimate over error", creal(ratio), 1, 8 * dt);
                assert_near("and its phase", cimag(ratio), 0, 8 * dt);
                if (before > 0)
                    assert_near("order", log2(before / cabs(error)), tableau.order + 1, 0.15);
                before = cabs(error);
            }
        }
    }
}

// Closed forms: -1/2, 1/6 - gamma^2 (3 - 2 gamma), 1/24 - gamma/2 + 3 gamma^2/2 ... of exp(z) -
// R(z), whose next coefficient for R = P/(1 - gamma z)^3 follows from P.
TEST(test_error_constants)
{
    double g = 1 - sqrt(0.5), h = 0.43586652150845899942;
    // R = (1 + p1 z + p2 z^2)/(1 - h z)^3: its z^4 is 15 h^4 + 10 h^3 p1 + 6 h^2 p2
    double p1 = 1 - 3 * h, p2 = 0.5 - 3 * h + 3 * h * h;
    const double wanted[] = {-0.5, 1. / 6 - g * g * (3 - 2 * g),
                             1. / 24 - (15 * h * h * h * h + 10 * h * h * h * p1 + 6 * h * h * p2)};
    for (int32_t s = 0; s < KINDS_COUNT; s++) {
        Tableau tableau = tableau_of(KINDS[s]);
        double dt = 1e-3;
        Step step = do_step(&tableau, 1, 0, dt);
        double constant = creal(step.error) / pow(dt, tableau.order + 1);
        assert_near("error constant", constant, wanted[s], 2e-3 * fabs(wanted[s]) + 1e-4);
    }
}

// Even motion has no error, and stages are summed to their places.
TEST(test_even_motion)
{
    for (int32_t s = 0; s < KINDS_COUNT; s++) {
        Tableau tableau = tableau_of(KINDS[s]);
        double sum = tableau.error[0];
        for (int32_t i = 0; i < tableau.stages; i++) {
            double place = 0;
            for (int32_t j = 0; j <= i; j++) place += tableau.a[i][j];
            assert_near("c", tableau.c[i], place, 1e-15);
            sum += tableau.error[i + 1];
        }
        assert_near("even motion", sum, 0, 1e-15);
        assert_near("ends at 1", tableau.c[tableau.stages - 1], 1, 1e-15);
    }
}
