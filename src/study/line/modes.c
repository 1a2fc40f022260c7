// SPDX-License-Identifier: GPL-2.0-or-later
// The linear problem behind the slip front, whole: in the cosines cos(k_m x/l), k_m = (m + 1/2) pi,
//
//     [ rho w^2 + w (C - W) + K ] a = 0,   C, K diagonal,
//     W_mn = (mu_S - mu_K)/v_c 2P/(L alpha H) l X_mn,
//     X_mn = f(m - n) + f(m + n + 1),  f(0) = 1/2,  f(j) = ((-1)^j - 1)/(j pi)^2.
//
// The paper keeps X's diagonal alone. Solved as the companion matrix [ 0 1; -K/rho -(C - W)/rho ].
#include "study/line/model1d.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// A rate counts as real when its imaginary part is below this part of it: where the pair is born as
// a double root, rounding (1e-16) shows as its square root.
static const double REAL_BELOW = 1e-6;
static const double FIRST_FRONT = 1e-4;   // of L: nothing grows on so short a front
static const double FRONT_ERROR = 1e-7;   // of L, of the fronts found
enum { SCAN_FRONTS = 64 };   // on which losses are looked for before halving

// f(j) above: the integral over 0..1 of y cos(j pi y), p growing linearly with x = l y.
static double overlap(int32_t j)
{
    if (j == 0) return 0.5;
    return j % 2 == 0 ? 0 : -2 / (M_PI * M_PI * j * j);
}

int64_t model1d_rates_work(int32_t count)
{
    int64_t size = 2 * (int64_t)count;
    return 2 * size * size + 2 * size + DENSE_EIGEN_WORK(size);
}

bool model1d_rates(const Model1d *model, double l, int32_t count, double *work, Model1dRates *rates)
{
    int64_t size = 2 * (int64_t)count;
    double *matrix = work, *vectors = matrix + size * size, *re = vectors + size * size;
    double *im = re + size, *rest = im + size;
    double springs = 1 / (model->alpha * model->drive * model->height);
    double weakening = -model1d_friction_slope(model) * 2 * model->pressure * l /
                       (model->length * model->alpha * model->height);
    *rates = (Model1dRates){.rightmost = {.re = -INFINITY}};

    // Columns first (LAPACK): the lower left block is -K/rho, the lower right (W - C)/rho, the
    // upper right 1. matrix: [2 count][2 count].
    memset(matrix, 0, (size_t)(size * size) * sizeof(double));
    for (int64_t m = 0; m < count; m++) {
        double k = ((double)m + 0.5) * M_PI / l;
        double *column = matrix + (count + m) * size;
        matrix[m * size + count + m] =
            -(model->elastic_x * k * k + model->elastic_shear * springs) / model->density;
        column[m] = 1;
        for (int32_t n = 0; n < count; n++)
            column[count + n] = weakening *
                                (overlap((int32_t)m - n) + overlap((int32_t)m + n + 1)) /
                                model->density;
        column[count + m] -= (model->viscous_x * k * k + model->viscous_shear * springs) /
                             model->density;
    }
    if (!dense_eigen_general(matrix, (int32_t)size, re, im, vectors, rest)) return false;
    for (int32_t k = 0; k < size; k++) {
        bool real = fabs(im[k]) <= REAL_BELOW * fabs(re[k]);
        if (real && re[k] > rates->real) rates->real = re[k];
        if (re[k] > rates->rightmost.re)
            rates->rightmost = (GrowthRate){.re = re[k], .im = real ? 0 : fabs(im[k])};
    }
    return true;
}

// --- where something is lost --------------------------------------------------------------------

// The three ways in which something is lost: an oscillation grows; a disturbance grows without
// oscillating; that, or growth from V to v_c within half a period, exp(pi Re/Im) > v_c/V
// (study/stability/stability, half_period).
enum { GROWS, RUNS_AWAY, RUNS_AWAY_AT_SPEED };

// Once lost it stays lost as l grows: W grows with l, C and K fall.
static bool is_lost(const Model1d *model, int32_t way, double l, double *work, bool *answer,
                    Error *err)
{
    Model1dRates rates;
    const GrowthRate *rightmost = &rates.rightmost;
    if (!model1d_rates(model, l, MODEL1D_MODES, work, &rates))
        return FAULT(err, ERROR_LIBRARY, "LAPACK found no eigenvalues with the front at l = %g", l);
    double ratio = model->law.critical_velocity / model->velocity;
    bool grows = rightmost->re > 0, runs_away = rates.real > 0;
    bool at_speed = runs_away || (grows && M_PI * rightmost->re / rightmost->im > log(ratio));
    *answer = way == GROWS ? grows : way == RUNS_AWAY ? runs_away : at_speed;
    return true;
}

// The shortest front at which it is lost: fronts in geometric progression, then halving; NaN: not
// up to L. work: [model1d_rates_work(MODEL1D_MODES)].
static bool find_first(const Model1d *model, int32_t way, double *work, double *l, Error *err)
{
    double low = FIRST_FRONT * model->length, high = NAN;
    double grow = pow(1 / FIRST_FRONT, 1.0 / SCAN_FRONTS);
    bool answer = false;
    for (int32_t k = 1; k <= SCAN_FRONTS && isnan(high); k++) {
        double next = k == SCAN_FRONTS ? model->length : low * grow;
        if (!is_lost(model, way, next, work, &answer, err)) return false;
        *(answer ? &high : &low) = next;
    }
    while (high - low > FRONT_ERROR * model->length) {
        double middle = 0.5 * (low + high);
        if (!is_lost(model, way, middle, work, &answer, err)) return false;
        *(answer ? &high : &low) = middle;
    }
    *l = high;
    return true;
}

bool model1d_losses(const Model1d *model, Model1dLosses *losses, Error *err)
{
    *losses = (Model1dLosses){.l_sc = NAN, .l_c = NAN, .l_rod = NAN};
    double *work = NEW_ARRAY(double, model1d_rates_work(MODEL1D_MODES), err);
    if (!work) goto cleanup;
    if (!(model1d_friction_slope(model) < 0)) goto cleanup;
    TRY(find_first(model, GROWS, work, &losses->l_sc, err));
    TRY(find_first(model, RUNS_AWAY, work, &losses->l_c, err));
    TRY(find_first(model, RUNS_AWAY_AT_SPEED, work, &losses->l_rod, err));
cleanup:
    memory_free(work);
    return error_is_clean(err);
}
