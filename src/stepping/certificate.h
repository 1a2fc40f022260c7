// SPDX-License-Identifier: GPL-2.0-or-later
// When may inertia's time scale be skipped? Let F be the interface unknowns that can move (slipping
// tangents, open nodes, rod nodes let go), J the slipping nodes on the weakening branch and
//
//     W = diag(-mu'(|v_i|) r_n,i) on J, 0 elsewhere     (linear law: (mu_S - mu_K) p_i w_i / v_c).
//
//   * S_C[F,F] - W positive definite, S_C the Schur complement of the damping C alone: viscosity
//     takes more out of any slip than weakening puts in. No perturbation can gain energy, and any
//     step that accuracy allows may be taken. First lost at about l_sc.
//   * S(dt)[F,F] - W positive definite for a rung's S(dt) = (M s + C + K/s) condensed, with s =
//     1/(gamma dt): nothing grows faster than s. Lost: there may be a real growth rate above s,
//     which the step would hide.
//
// Both leave out that pressure follows slip. The rows of slipping nodes with it,
//
//     J(s) = S_t + sign(v) mu S_n - W,
//
// are singular exactly at real growth rates, and det J > 0 for s to infinity, where M decides. So
// where the second test fails, det J > 0 still clears the step: no single rate lies above s. (With
// mu_S = 1.2 slip is steady for long while S - W is indefinite.) Called by stepping/step_control.
#ifndef AMONTONS_STEPPING_CERTIFICATE_H
#define AMONTONS_STEPPING_CERTIFICATE_H

#include "stepping/ladder.h"
#include "stepping/state.h"

typedef struct Certificate {
    const Interface *interface;   // not owned, like the law
    const FrictionLaw *law;
    InterfaceOperator *damping;   // holds S_C; owned
    double *matrix;   // [count^2] work; owned
    double *weakening;   // [count] work: W's diagonal; owned
    int32_t *moving;             // [count] work: F; owned
    int32_t *pivots;             // [count] work; owned
    int64_t checks;   // counted: Cholesky factorisations
    double seconds;              // wall time spent
} Certificate;

bool certificate_create(const Block *block, Certificate *certificate, Error *err);
void certificate_destroy(Certificate *certificate);

// The slip set of `state` cannot gain energy.
bool certificate_holds(Certificate *certificate, const State *state);

// Nothing grows faster than 1/(gamma dt), dt that of `rung`.
bool certificate_step_resolves(Certificate *certificate, const State *state,
                               const InterfaceOperator *rung);

#endif
