// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/ladder.h"

#include "base/clock.h"
#include "stepping/tableau.h"

#include <math.h>
#include <stddef.h>

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

double ladder_step(const Ladder *ladder, int32_t k)
{
    return ldexp(ladder->step_max, -k);
}

double ladder_reach(const Ladder *ladder, int32_t k)
{
    return ladder->gamma * ladder_step(ladder, k);
}

int32_t ladder_find(const Ladder *ladder, double step)
{
    int32_t k = 0;
    while (k < ladder->rung_count && ladder_step(ladder, k) > step * (1 + 1e-12)) k++;
    return k;
}

static OperatorTerms rung_terms(const Ladder *ladder, int32_t k)
{
    double scaled = ladder_reach(ladder, k);
    return (OperatorTerms){.mass = 1 / scaled, .damping = 1, .stiffness = scaled};
}

// The time of a factorisation is counted here, not in the step's.
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

bool ladder_fill(Ladder *ladder)
{
    Error err = {0};
    int32_t first = 0, last = ladder->rung_count - 1;
    while (first < last && !ladder->rung[first]) first++;
    while (last > first && !ladder->rung[last]) last--;
    for (int32_t k = first + 1; k < last; k++)
        if (!ladder_rung(ladder, k, &err)) return false;
    return true;
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

static void drop_rung(Ladder *ladder, int32_t k)
{
    contact_matrix_destroy(&ladder->contact[k]);
    interface_operator_destroy(ladder->rung[k]);
    ladder->rung[k] = NULL;
}

bool ladder_archive(Ladder *ladder, int64_t last, Archive *archive, Error *err)
{
    double longest = ladder->step_max;
    int32_t count = ladder->rung_count;
    archive_section(archive, "ladder");
    archive_number(archive, &longest);
    archive_integer(archive, &count);
    if (longest != ladder->step_max || count != ladder->rung_count) archive->failed = true;
    for (int32_t k = 0; k < ladder->rung_count; k++) {
        bool built = ladder->rung[k] != NULL;
        archive_count(archive, &ladder->accepted[k]);
        archive_flag(archive, &built);
        TRY(archive_check(archive, false, err));
        if (!built && ladder->rung[k]) drop_rung(ladder, k);
        if (!built) continue;
        TRY(ladder_rung(ladder, k, err));
        contact_matrix_archive(&ladder->contact[k], last, archive);
    }
cleanup:
    return error_is_clean(err);
}
