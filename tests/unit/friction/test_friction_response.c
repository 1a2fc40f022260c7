// SPDX-License-Identifier: GPL-2.0-or-later
// Response to small disturbances of slip: the critical stiffness of one state and of two by closed
// forms, of any number by all rates of the body on its spring; the bound of what coupled states
// weaken against their worst s, and between two levels; poles on the right.
#include "friction/friction_response.h"

#include "algebra/dense.h"
#include "near.h"
#include "random_numbers.h"

#include <complex.h>
#include <string.h>

static double log_between(Random *random, double low, double high)
{
    return exp(random_between(random, log(low), log(high)));
}

// Rates y' = A y of a massless body on a spring k/r_n: y = (u, theta), u' = v from
// mu_v v = -k u - mu_theta theta. Returns the largest real part.
static double growth_on_spring(const FrictionRates *rates, double spring)
{
    enum { MOST = STATES_MAX + 1, WORK = DENSE_EIGEN_WORK(MOST) };
    double a[MOST * MOST], re[MOST], im[MOST], vectors[MOST * MOST], work[WORK], most = -INFINITY;
    int32_t n = rates->states, size = n + 1;
    for (int32_t j = 0; j < size; j++) {
        double speed = -(j == 0 ? spring : rates->mu_state[j - 1]) / rates->mu_speed;
        a[j * size] = speed;
        for (int32_t k = 0; k < n; k++)
            a[j * size + k + 1] = rates->rate_speed[k] * speed +
                                  (j == 0 ? 0 : rates->rate_state[k][j - 1]);
    }
    assert_true(dense_eigen_general(a, size, re, im, vectors, work));
    for (int32_t k = 0; k < size; k++) most = fmax(most, re[k]);
    return most;
}

// Ruina's (1983): (b - a)/D_c; and without a direct effect b/D_c. Both states of Gu, Rice, Ruina
// and Tse (J. Mech. Phys. Solids 32, 1984), theta_i' = -(v/D_i) (theta_i + ln(v/V)): with
// K = k D_1/(a r_n), r = D_1/D_2, B_i = b_i/a the cubic
//
//     x^3 + (K + p) x^2 + (K (1 + r) - r q) x + K r = 0,
//     p = 1 + r - B_1 - B_2 r, q = B_1 + B_2 - 1
//
// has a pair on the imaginary axis where (K + p) (K (1 + r) - r q) = K r (Hurwitz).
TEST(test_closed_forms)
{
    Random random = {.state = 3};
    for (int32_t trial = 0; trial < 100; trial++) {
        double v = log_between(&random, 1e-8, 1e-2), D[2], b[2],
               a = log_between(&random, 1e-3, 0.1);
        FrictionRates rates = {.states = 1, .mu_speed = a / v};
        for (int32_t k = 0; k < 2; k++) {
            D[k] = log_between(&random, 1e-6, 1e-2);
            b[k] = a * random_between(&random, 0.2, 4);
            rates.mu_state[k] = b[k];
            rates.rate_speed[k] = -1 / D[k];
            rates.rate_state[k][k] = -v / D[k];
        }
        double one = fmax(b[0] - a, 0) / D[0], found = friction_critical_stiffness(&rates);
        assert_near("Ruina", found, one, 1e-12 * one);
        rates.mu_speed = 0;
        assert_near("at once", friction_critical_stiffness(&rates), b[0] / D[0],
                    1e-9 * b[0] / D[0]);
        rates.states = 2;
        rates.mu_speed = a / v;
        double r = D[0] / D[1], q = (b[0] + b[1]) / a - 1, p = 1 + r - b[0] / a - b[1] / a * r;
        double half = 0.5 * (p * (1 + r) - r * q - r) / (1 + r), rest = p * r * q / (1 + r);
        double both = fmax(-half + sqrt(fmax(half * half + rest, 0)), 0) * a / D[0];
        if (half * half + rest < 0) both = 0;
        found = friction_critical_stiffness(&rates);
        assert_near("Gu and others", found, both, 1e-10 * both);
        rates.mu_speed = -1e-9;
        assert_true(isnan(friction_critical_stiffness(&rates)));   // weakens at once: on no spring
    }
}

static FrictionRates random_rates(Random *random, int32_t most, double pull)
{
    FrictionRates rates = {.states = 1 + random_index(random, most)};
    rates.mu_speed = random_between(random, 0.05, 0.5);
    for (int32_t k = 0; k < rates.states; k++) {
        rates.mu_state[k] = random_between(random, -1, 1);
        rates.rate_speed[k] = random_between(random, -1, 1);
        for (int32_t j = 0; j < rates.states; j++)
            rates.rate_state[k][j] = j == k ? random_between(random, -2, 0.1)
                                            : random_between(random, -pull, pull);
    }
    return rates;
}

static double own_growth(const FrictionRates *rates, bool real)
{
    double re[STATES_MAX], im[STATES_MAX] = {0}, most = -INFINITY;
    friction_own_rates(rates, re, im);
    for (int32_t k = 0; k < rates->states; k++)
        if (!real || im[k] == 0) most = fmax(most, re[k]);
    return most;
}

TEST(test_critical_stiffness)
{
    Random random = {.state = 11};
    int32_t critical = 0, never = 0, grows = 0;
    for (int32_t trial = 0; trial < 400; trial++) {
        FrictionRates rates = random_rates(&random, 4, 1);
        double stiffness = friction_critical_stiffness(&rates);
        bool alone = own_growth(&rates, false) >= 0;
        grows += alone;
        assert_int_equal(isnan(stiffness), alone);
        if (alone) continue;
        critical += stiffness > 0;
        never += stiffness == 0;
        // Above it all decays, just below something grows.
        for (double part = 1.0001; part < 1e3; part *= 1.5)
            if (!(growth_on_spring(&rates, fmax(stiffness, 1e-3) * part) < 0))
                fail_msg("trial %d: %g times %g", trial, part, stiffness);
        if (stiffness > 0) assert_true(growth_on_spring(&rates, stiffness * 0.9999) > 0);
    }
    print_message("%d critical, %d on any spring, %d on none\n", critical, never, grows);
    assert_true(critical > 100 && never > 30 && grows > 20);
}

// -mu_theta (s - G)^-1 g_v.
static double complex weakens(const FrictionRates *rates, double complex s)
{
    double complex matrix[STATES_MAX][STATES_MAX], x[STATES_MAX], sum = 0;
    int32_t n = rates->states;
    for (int32_t k = 0; k < n; k++) {
        x[k] = rates->rate_speed[k];
        for (int32_t j = 0; j < n; j++) matrix[k][j] = (k == j) * s - rates->rate_state[k][j];
    }
    for (int32_t k = 0; k < n; k++)   // Gauss: the diagonal is never small here
        for (int32_t j = k + 1; j < n; j++) {
            double complex part = matrix[j][k] / matrix[k][k];
            for (int32_t c = k; c < n; c++) matrix[j][c] -= part * matrix[k][c];
            x[j] -= part * x[k];
        }
    for (int32_t k = n - 1; k >= 0; k--) {
        for (int32_t c = k + 1; c < n; c++) x[k] -= matrix[k][c] * x[c];
        x[k] /= matrix[k][k];
        sum -= rates->mu_state[k] * x[k];
    }
    return sum;
}

// On the boundary of where |s| >= 1/reach and Re s >= 0, where the real part is largest: it is no
// less. Between two levels it is at most 1.125 times a sum of theirs, weighed as s M + K/s is.
TEST(test_bound_of_weakening)
{
    Random random = {.state = 5};
    int32_t bounded = 0, coupled = 0;
    double between = 0;
    for (int trial = 0; trial < 400; trial++) {
        FrictionRates rates = random_rates(&random, 3, 0.4);
        double reach = exp(random_between(&random, -4, 4)), worst = 0;
        double most = friction_weakens_most(&rates, reach);
        if (!isfinite(most)) continue;
        bounded++;
        coupled += rates.states > 1;
        for (int32_t step = 0; step < 400; step++) {
            // A quarter of the circle, then up the imaginary axis.
            double complex s = step < 200 ? cexp(I * (M_PI / 2 * step / 199.0)) / reach
                                          : I * exp((step - 200) * 0.05) / reach;
            worst = fmax(worst, creal(weakens(&rates, s)));
        }
        if (most < worst * (1 - 1e-9)) fail_msg("trial %d: %g < %g", trial, most, worst);
        assert_true(friction_weakens_at(&rates, reach) <= most * (1 + 1e-9));
        double next = friction_weakens_most(&rates, reach / 2);   // s from 1 to 2 over reach
        for (double s = 1; s <= 2; s += 0.05) {
            double second = (s - 1 / s) / 1.5, first = s - 2 * second;
            double sum = first * most + second * next;
            if (most > 0) between = fmax(between, friction_weakens_most(&rates, reach / s) / sum);
        }
    }
    print_message("%d bounded, %d of several states, %.4f between\n", bounded, coupled, between);
    assert_true(between > 1.07 && between < 1.125);   // 1.0607 is not enough
    assert_true(bounded > 250 && coupled > 150);
}

// As many states as there may be, which do not couple: their rates are the diagonal.
TEST(test_most_states)
{
    FrictionRates rates = {.states = STATES_MAX, .mu_speed = 1};
    double re[STATES_MAX], im[STATES_MAX];
    for (int32_t k = 0; k < STATES_MAX; k++) rates.rate_state[k][k] = -(k + 1.0);
    friction_own_rates(&rates, re, im);
    for (int32_t k = 0; k < STATES_MAX; k++) {
        int32_t found = 0;
        for (int32_t j = 0; j < STATES_MAX; j++) found += re[j] == -(k + 1.0) && im[j] == 0;
        assert_int_equal(found, 1);
    }
}

TEST(test_states_decay)
{
    Random random = {.state = 7};
    int32_t decaying = 0;
    for (int32_t trial = 0; trial < 400; trial++) {
        FrictionRates rates = random_rates(&random, 4, 1);
        double reach = exp(random_between(&random, -1, 4));
        bool decays = !(own_growth(&rates, true) * reach >= 1);
        assert_int_equal(friction_states_decay(&rates, reach), decays);
        decaying += decays;
    }
    assert_in_range(decaying, 100, 390);
    FrictionRates none = {.states = 1, .rate_state[0][0] = NAN};
    assert_false(friction_states_decay(&none, 1));
}

// The result satisfies its equation, whatever the scales, and those of states that slip moves
// through others only.
TEST(test_respond)
{
    Random random = {.state = 9};
    for (int32_t trial = 0; trial < 100; trial++) {
        FrictionRates rates = random_rates(&random, 3, 1);
        double s = 5, y = random_between(&random, -1, 1), c[STATES_MAX], zero[STATES_MAX] = {0};
        double once[STATES_MAX], again[STATES_MAX];
        if (rates.states > 1) rates.rate_speed[1] = 0;
        for (int32_t k = 0; k < rates.states; k++) c[k] = random_between(&random, -1, 1);
        double falls = friction_respond(&rates, s, y, zero, once);
        assert_near("falls", falls, s * y * creal(weakens(&rates, s)), 1e-12);
        double with = friction_respond(&rates, s, y, c, again);
        assert_near("a sum", with - falls, friction_respond(&rates, s, 0, c, NULL), 1e-12);
        for (int32_t k = 0; k < rates.states; k++) assert_true(isfinite(again[k] - once[k]));
    }
}
