// SPDX-License-Identifier: GPL-2.0-or-later
// Butcher tableaus of the implicit schemes: singly diagonal (one matrix for all stages) and stiffly
// accurate (the last row is b: contact, friction and rod hold at the end of a step), all L-stable.
//
//     c_1 | gamma                            backward Euler   1 stage,  order 1, gamma = 1
//      :  |   :    .                         SDIRK2           2 stages, order 2, 1 - 1/sqrt 2
//     c_s | a_s1  ...  gamma                 SDIRK3           3 stages, order 3, 0.43587
//     ----+-----------------
//         | a_s1  ...  gamma                 (Alexander, SIAM J. Numer. Anal. 14, 1977)
//
// Used by stepping/sdirk.
#ifndef AMONTONS_STEPPING_TABLEAU_H
#define AMONTONS_STEPPING_TABLEAU_H

#include <stdint.h>

enum { TABLEAU_STAGES_MAX = 3 };

typedef enum TableauKind { TABLEAU_SDIRK2, TABLEAU_EULER, TABLEAU_SDIRK3 } TableauKind;

typedef struct Tableau {
    int32_t stages, order;
    double gamma;
    double a[TABLEAU_STAGES_MAX][TABLEAU_STAGES_MAX];   // lower triangle; the last row is b
    double c[TABLEAU_STAGES_MAX];
    // dt (error[0] v_n + error[1] v_1 + ...) is the local error of u, exact step less ours, to
    // leading order dt^(order + 1) where motion is smooth and friction falls linearly.
    double error[TABLEAU_STAGES_MAX + 1];
} Tableau;

Tableau tableau_of(TableauKind kind);

#endif
