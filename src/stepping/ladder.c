// SPDX-License-Identifier: GPL-2.0-or-later
// dt_k = dt_max 2^-k. A rung is the matrix A_k = M/(gamma dt_k) + C + gamma dt_k K
// condensed on the interface: it does not depend on the state, is made when a step first asks for
// it, and is kept to the end of the run, so that a change of step costs nothing after that. gamma
// is that of the scheme that steps on it (stepping/tableau).
#include "stepping/ladder.h"

#include "base/clock.h"
#include "stepping/tableau.h"

#include <math.h>
#include <stddef.h>

// Nothing is factored yet.
void ladder_init(BulkOperator *system, double step_max, double step_min, Ladder *ladder)
{
    *ladder =
        (Ladder){.system = system, .step_max = step_max, .gamma = tableau_of(TABLEAU_SDIRK2).gamma};
    double rungs = floor(log2(step_max / step_min) * (1 + 1e-12)) + 1;
    ladder->rung_count = (int32_t)fmin(fmax(rungs, 1), LADDER_RUNGS_MAX);
}

void ladder_destroy(Ladder *ladder)
{
    for (int32_t k = 0; k < LADDER_RUNGS_MAX; k++) {
        contact_matrix_destroy(&ladder->contact[k]);
        interface_operator_destroy(ladder->rung[k]);
    }
    *ladder = (Ladder){0};
}

// A power of two times the longest step, exactly.
double ladder_step(const Ladder *ladder, int32_t k)
{
    return ldexp(ladder->step_max, -k);
}

// gamma dt: displacement over velocity of one stage, time.
double ladder_reach(const Ladder *ladder, int32_t k)
{
    return ladder->gamma * ladder_step(ladder, k);
}

// The longest rung that is not longer than `step`; rung_count where even the shortest is.
int32_t ladder_find(const Ladder *ladder, double step)
{
    int32_t k = 0;
    while (k < ladder->rung_count && ladder_step(ladder, k) > step * (1 + 1e-12)) k++;
    return k;
}

// A of SDIRK2, over gamma dt.
static OperatorTerms rung_terms(const Ladder *ladder, int32_t k)
{
    double scaled = ladder_reach(ladder, k);
    return (OperatorTerms){.mass = 1 / scaled, .damping = 1, .stiffness = scaled};
}

// NULL with the error set. The time of a factorisation is counted here, not in the step's.
InterfaceOperator *ladder_rung(Ladder *ladder, int32_t k, Error *err)
{
    if (!ladder->rung[k]) {
        double started = clock_seconds();
        InterfaceOperator *rung =
            interface_operator_create(ladder->system, rung_terms(ladder, k), err);
        if (rung &&
            contact_matrix_create(interface_operator_schur(rung), ladder->system->interface_count,
                                  &ladder->contact[k], err)) {
            ladder->rung[k] = rung;
        } else {
            contact_matrix_destroy(&ladder->contact[k]);
            interface_operator_destroy(rung);
            error_context(err, "step %g", ladder_step(ladder, k));
        }
        ladder->seconds += clock_seconds() - started;
    }
    return ladder->rung[k];
}

ContactMatrix *ladder_contact(Ladder *ladder, int32_t k)
{
    return ladder->rung[k] ? &ladder->contact[k] : NULL;
}

// By the errors that were measured when the basis was made; the full mesh is not asked again.
double ladder_reduction_error(const Ladder *ladder)
{
    double error = 0;
    for (int32_t k = 0; ladder->system && k < ladder->rung_count; k++) {
        if (ladder->accepted[k] > 0)
            error = fmax(error, bulk_operator_error(ladder->system, rung_terms(ladder, k)));
    }
    return error;
}
