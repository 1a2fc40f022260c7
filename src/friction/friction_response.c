// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_response.h"

#include "algebra/dense.h"

#include <math.h>

double friction_weakens_at(const FrictionRates *rates, double reach)
{
    return -friction_feedback(rates, reach);
}

// With G = D + O, D the diagonal, and R = (s - D)^-1, |R_kk| <= P_kk = reach/sqrt(1 + (reach
// G_kk)^2) at such s where G_kk <= 0: (s - G)^-1 = R + R O R + R O R O R + ... The first term is a
// sum over the states, of which only those that weaken count, as Re R_kk >= 0 (a state that grows
// by itself, G_kk > 0, has 1/reach - G_kk in the place of 1/P_kk, and counts either way); all
// others together are no more, entry by entry, than (P^-1 - |O|)^-1 |g_v| - P |g_v|, where these
// sums converge: where (P^-1 - |O|)^-1 (1, ..., 1) is above 0 (Berman and Plemmons, Nonnegative
// Matrices in the Mathematical Sciences, 1994, ch. 6).
double friction_weakens_most(const FrictionRates *rates, double reach)
{
    double matrix[STATES_MAX * STATES_MAX], coupled[STATES_MAX], ones[STATES_MAX];
    double bound[STATES_MAX], most = 0;
    int32_t pivots[STATES_MAX], n = rates->states;
    bool couples = false;
    for (int32_t k = 0; k < n; k++) {
        double own = reach * rates->rate_state[k][k];
        double weakens = -rates->mu_state[k] * rates->rate_speed[k];
        bound[k] = reach / (own <= 0 ? hypot(1, own) : 1 - own);
        if (!(bound[k] >= 0)) return INFINITY;
        most += (own <= 0 ? fmax(weakens, 0) : fabs(weakens)) * bound[k];
        coupled[k] = fabs(rates->rate_speed[k]);
        ones[k] = 1;
        for (int32_t j = 0; j < n; j++) {
            couples = couples || (j != k && rates->rate_state[k][j] != 0);
            matrix[j * n + k] = j == k ? 1 / bound[k] : -fabs(rates->rate_state[k][j]);
        }
    }
    if (!couples || reach == 0) return most;
    if (!dense_lu(matrix, n, pivots)) return INFINITY;
    dense_lu_solve(matrix, n, pivots, coupled);
    dense_lu_solve(matrix, n, pivots, ones);
    for (int32_t k = 0; k < n; k++) {
        if (!(ones[k] > 0)) return INFINITY;
        most += fabs(rates->mu_state[k]) *
                fmax(coupled[k] - bound[k] * fabs(rates->rate_speed[k]), 0);
    }
    return most;
}

double friction_respond(const FrictionRates *rates, double s, double y, const double *c, double *z)
{
    double theta[STATES_MAX], scale[STATES_MAX], falls = 0;
    int32_t n = rates->states;

    // theta' of a unit of z: that of a unit of slip, or what the other states make of theirs at s,
    // if that is more.
    for (int32_t k = 0; k < n; k++) scale[k] = fabs(rates->rate_speed[k]);
    for (int32_t round = 1; round < n; round++)
        for (int32_t k = 0; k < n; k++)
            for (int32_t j = 0; j < n; j++)
                if (j != k)
                    scale[k] = fmax(scale[k], scale[j] * fabs(rates->rate_state[k][j]) /
                                                  (s + fabs(rates->rate_state[k][k])));
    for (int32_t k = 0; k < n; k++)
        if (scale[k] == 0) scale[k] = 1;

    for (int32_t k = 0; k < n; k++) theta[k] = rates->rate_speed[k] * y - scale[k] * c[k] / s;
    if (!friction_solve_states(rates, 1 / s, theta)) return NAN;
    for (int32_t k = 0; k < n; k++) {
        if (z) z[k] = theta[k] / scale[k];
        falls -= rates->mu_state[k] * theta[k];
    }
    return falls;
}

void friction_own_rates(const FrictionRates *rates, double *re, double *im)
{
    double matrix[STATES_MAX * STATES_MAX], vectors[STATES_MAX * STATES_MAX], sum = 0;
    double work[DENSE_EIGEN_WORK(STATES_MAX)];
    int32_t n = rates->states;
    for (int32_t j = 0; j < n; j++)
        for (int32_t k = 0; k < n; k++) sum += matrix[j * n + k] = rates->rate_state[k][j];
    if (isfinite(sum) && dense_eigen_general(matrix, n, re, im, vectors, work)) return;
    for (int32_t k = 0; k < n; k++) re[k] = INFINITY;
}

// Gershgorin's circles, which lie about the diagonal, are asked first.
bool friction_states_decay(const FrictionRates *rates, double reach)
{
    double re[STATES_MAX], im[STATES_MAX] = {0};
    bool decays = true;
    for (int32_t k = 0; k < rates->states; k++) {
        double most = rates->rate_state[k][k];
        for (int32_t j = 0; j < rates->states; j++)
            most += j == k ? 0 : fabs(rates->rate_state[k][j]);
        decays = decays && reach * most < 1;
    }
    if (decays) return true;
    friction_own_rates(rates, re, im);
    decays = true;
    for (int32_t k = 0; k < rates->states; k++)
        decays = decays && (im[k] != 0 || reach * re[k] < 1);
    return decays;
}

// F(i w): its real part, and in *stiffness -w^2 mu_theta (w^2 + G^2)^-1 g_v, which is k/r_n where
// that is 0. Real numbers suffice: (i w - G)^-1 = -(i w + G) (w^2 + G^2)^-1.
static double real_part(const FrictionRates *rates, double w, double *stiffness)
{
    double square[STATES_MAX * STATES_MAX], q[STATES_MAX], real = rates->mu_speed;
    int32_t pivots[STATES_MAX], n = rates->states;
    for (int32_t j = 0; j < n; j++) {
        q[j] = rates->rate_speed[j];
        for (int32_t k = 0; k < n; k++) {
            square[j * n + k] = j == k ? w * w : 0;
            for (int32_t m = 0; m < n; m++)
                square[j * n + k] += rates->rate_state[k][m] * rates->rate_state[m][j];
        }
    }
    *stiffness = 0;
    if (!dense_lu(square, n, pivots)) return NAN;
    dense_lu_solve(square, n, pivots, q);
    for (int32_t k = 0; k < n; k++) {
        *stiffness -= w * w * rates->mu_state[k] * q[k];
        for (int32_t m = 0; m < n; m++) real -= rates->mu_state[k] * rates->rate_state[k][m] * q[m];
    }
    return real;
}

// On a stiff spring slip is stable where the states by themselves are and mu_v >= 0; so this is the
// largest k with a rate on the imaginary axis, i w. For w to infinity, where with mu_v = 0 there is
// one, k goes to -mu_theta g_v.
double friction_critical_stiffness(const FrictionRates *rates)
{
    enum { DECADES = 12, DECADE = 40, HALVINGS = 60 };
    double re[STATES_MAX], im[STATES_MAX], slowest = INFINITY, critical = 0, stiffness;
    if (rates->mu_speed < 0) return NAN;

    // The slowest rate of the states by themselves, which must decay.
    friction_own_rates(rates, re, im);
    for (int32_t k = 0; k < rates->states; k++) {
        if (!(re[k] < 0)) return NAN;
        slowest = fmin(slowest, hypot(re[k], im[k]));
    }
    double first = 1e-3 * slowest;
    if (!(first > 0)) return NAN;

    // Frequencies are gone through upwards, from far below it.
    double low = first, before = real_part(rates, low, &stiffness);
    for (int32_t k = 1; k <= DECADES * DECADE; k++) {
        double high = first * pow(10, (double)k / DECADE);
        double after = real_part(rates, high, &stiffness);
        if (before * after < 0) {
            double a = low, b = high;
            for (int32_t halved = 0; halved < HALVINGS; halved++) {
                double middle = sqrt(a * b);
                *(real_part(rates, middle, &stiffness) * before > 0 ? &a : &b) = middle;
            }
            critical = fmax(critical, stiffness);
        }
        low = high;
        before = after;
    }
    real_part(rates, low, &stiffness);
    return rates->mu_speed == 0 ? fmax(critical, stiffness) : critical;
}
