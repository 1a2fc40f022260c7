// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/tableau.h"

// The integral from 0 to 1 of the polynomial that is 1 at node `j` and 0 at the others.
static double lagrange_integral(const double *node, int32_t count, int32_t j)
{
    double polynomial[TABLEAU_STAGES_MAX + 1] = {1}, integral = 0;   // by powers
    int32_t degree = 0;
    for (int32_t k = 0; k < count; k++) {
        if (k == j) continue;
        double scale = 1 / (node[j] - node[k]);
        degree++;
        for (int32_t p = degree; p >= 0; p--) {
            double lower = p > 0 ? polynomial[p - 1] : 0;
            double here = p < degree ? polynomial[p] : 0;
            polynomial[p] = scale * (lower - node[k] * here);
        }
    }
    for (int32_t p = 0; p <= degree; p++) integral += polynomial[p] / (p + 1);
    return integral;
}

// Row sums to c, and the weights of the error from both.
static void complete(Tableau *tableau)
{
    double node[TABLEAU_STAGES_MAX + 1] = {0};
    int32_t stages = tableau->stages;
    for (int32_t i = 0; i < stages; i++) {
        tableau->c[i] = 0;
        for (int32_t j = 0; j <= i; j++) tableau->c[i] += tableau->a[i][j];
        node[i + 1] = tableau->c[i];
    }
    for (int32_t j = 0; j <= stages; j++) {
        double weight = j > 0 ? tableau->a[stages - 1][j - 1] : 0;
        tableau->error[j] = lagrange_integral(node, stages + 1, j) - weight;
    }
}

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
    complete(&tableau);
    return tableau;
}
