// SPDX-License-Identifier: GPL-2.0-or-later
// The estimate of the local error is calibrated on v' = lambda v, z = lambda dt, to which every
// smooth linear motion comes down, loads and the rod's way included: R(z) = 1 + z b (I - z A)^-1 1
// misses exp(z) by C z^(p+1) (Hairer and Wanner, Solving ODEs II, IV.3), C = -1/2, -0.0404, 0.0259,
// and the estimate has the same C. Of v_n and the stages as they are it has to be made: quadrature
// through them alone is 6.83 times too small for SDIRK2, whose first stage is of order 1, and of
// order 3 instead of 4 for SDIRK3.
#include "stepping/tableau.h"

#include "algebra/dense.h"

enum { VALUES_MAX = TABLEAU_STAGES_MAX + 1 };   // of v: v_n and the stages

Tableau tableau_of(TableauKind kind)
{
    Tableau tableau = {.stages = 1, .order = 1, .gamma = 1, .a = {{1}}};
    if (kind == TABLEAU_SDIRK2) {
        double g = 1 - 0.70710678118654752440;
        tableau = (Tableau){.stages = 2, .order = 2, .gamma = g, .a = {{g}, {1 - g, g}}};
    }
    if (kind == TABLEAU_SDIRK3) {
        double g = 0.43586652150845899942;   // of g^3 - 3 g^2 + 3 g/2 = 1/6
        double b1 = -(6 * g * g - 16 * g + 1) / 4, b2 = (6 * g * g - 20 * g + 5) / 4;
        tableau = (Tableau){
            .stages = 3, .order = 3, .gamma = g, .a = {{g}, {(1 - g) / 2, g}, {b1, b2, g}}};
    }

    // power[k + j rows]: A^k 1 of value j, k < rows. On v' = z v, dt = 1, v_n = 1, value j is the
    // sum over k of z^k times that; b makes of z^k in its stages what the last of them has of
    // z^(k + 1). Row sums are c.
    double power[VALUES_MAX * (VALUES_MAX + 1)];
    int32_t stages = tableau.stages, values = stages + 1, rows = values + 1;
    for (int32_t i = 0; i <= stages; i++) {
        power[i * rows] = 1;
        for (int32_t k = 1; k < rows; k++) {
            double sum = 0;
            for (int32_t j = 1; j <= i; j++) {
                double earlier = power[k - 1 + j * rows];
                sum += tableau.a[i - 1][j - 1] * earlier;
            }
            power[k + i * rows] = sum;
        }
    }
    for (int32_t i = 0; i < stages; i++) tableau.c[i] = power[1 + (i + 1) * rows];

    // Weights of the error. There are as many stages as the order p: p + 1 values of v just suffice
    // for e_0 v_n + e_1 v_1 + ... without powers of z below p, and with 1/(p + 1)! - b A^p 1 of
    // z^p.
    double matrix[VALUES_MAX * VALUES_MAX], factorial = 1;
    int32_t pivots[VALUES_MAX];
    for (int32_t j = 0; j < values; j++) {
        factorial *= j + 1;
        tableau.error[j] = 0;
        for (int32_t k = 0; k < values; k++) matrix[k + j * values] = power[k + j * rows];
    }
    tableau.error[stages] = 1 / factorial - power[values + stages * rows];
    dense_lu(matrix, values, pivots);   // regular for each tableau here: tested
    dense_lu_solve(matrix, values, pivots, tableau.error);
    return tableau;
}
