// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/ladder.h"

#include "base/clock.h"
#include "base/memory.h"
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

static void drop_contact(Ladder *ladder, int32_t k, ContactPart part)
{
    contact_matrix_destroy(&ladder->contact[part][k]);
    memory_free(ladder->half_schur[part][k]);
    ladder->half_schur[part][k] = NULL;
}

static void drop_rung(Ladder *ladder, int32_t k)
{
    for (ContactPart part = 0; part < CONTACT_PARTS; part++) drop_contact(ladder, k, part);
    interface_operator_destroy(ladder->rung[k]);
    ladder->rung[k] = NULL;
}

void ladder_destroy(Ladder *ladder)
{
    for (int32_t k = 0; k < LADDER_RUNGS_MAX; k++) drop_rung(ladder, k);
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

static ContactMatrix *made_contact(Ladder *ladder, int32_t k, ContactPart part)
{
    ContactMatrix *matrix = &ladder->contact[part][k];
    return matrix->schur ? matrix : NULL;
}

// The operator is made anew where its S was dropped: seldom is more than one part asked for.
static bool build_rung(Ladder *ladder, int32_t k, ContactPart part, Error *err)
{
    InterfaceOperator *rung = ladder->rung[k];
    if (!rung || !interface_operator_schur(rung)) {
        interface_operator_destroy(rung);
        rung = ladder->rung[k] =
            interface_operator_create(ladder->system, rung_terms(ladder, k), err);
        if (!rung) return false;
    }
    if (part != PART_WHOLE) {
        int64_t count = ladder->half->interface.count;
        double *schur = ladder->half_schur[part][k] = NEW_ARRAY(double, count *count, err);
        if (!schur) return false;
        if (contact_half_matrix(ladder->half, interface_operator_schur(rung),
                                part == PART_ANTISYMMETRIC, schur)) {
            // S itself is freed where nobody else uses it.
            if (!ladder->contact[PART_WHOLE][k].schur) interface_operator_drop_schur(rung);
            return contact_matrix_create(schur, (int32_t)count, &ladder->contact[part][k], err);
        }
        drop_contact(ladder, k, part);
        ladder->half = NULL;
        if (made_contact(ladder, k, PART_WHOLE)) return true;
    }
    return contact_matrix_create(interface_operator_schur(rung), ladder->system->interface_count,
                                 &ladder->contact[PART_WHOLE][k], err);
}

// The time of a factorisation is counted here, not in the step's.
InterfaceOperator *ladder_rung(Ladder *ladder, int32_t k, ContactPart part, Error *err)
{
    if (!ladder->half) part = PART_WHOLE;
    if (!made_contact(ladder, k, part)) {
        double started = clock_seconds();
        int64_t before = memory_counters().allocations;
        if (!build_rung(ladder, k, part, err)) {
            drop_rung(ladder, k);
            error_context(err, "step %g", ladder_step(ladder, k));
        }
        ladder->seconds += clock_seconds() - started;
        ladder->allocations += memory_counters().allocations - before;
    }
    return ladder->rung[k];
}

bool ladder_fill(Ladder *ladder, ContactPart part)
{
    Error err = {0};
    int32_t first = 0, last = ladder->rung_count - 1;
    while (first < last && !ladder->rung[first]) first++;
    while (last > first && !ladder->rung[last]) last--;
    for (int32_t k = first + 1; k < last; k++)
        if (!ladder_rung(ladder, k, part, &err)) return false;
    return true;
}

ContactMatrix *ladder_contact(Ladder *ladder, int32_t k, ContactPart part)
{
    Error err = {0};
    if (!made_contact(ladder, k, part) && ladder->rung[k] && (part == PART_WHOLE || ladder->half) &&
        !ladder_rung(ladder, k, part, &err))
        return NULL;
    return made_contact(ladder, k, part);
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

// Those matrices that are there.
static bool archive_contact(Ladder *ladder, int32_t k, const int64_t *last, Archive *archive,
                            Error *err)
{
    for (ContactPart part = 0; part < CONTACT_PARTS; part++) {
        bool kept = made_contact(ladder, k, part) != NULL;
        archive_flag(archive, &kept);
        if (kept && part != PART_WHOLE && !ladder->half) archive->failed = true;
        TRY(archive_check(archive, false, err));
        if (!kept) {
            drop_contact(ladder, k, part);
            continue;
        }
        TRY(ladder_rung(ladder, k, part, err));
        ContactMatrix *matrix = made_contact(ladder, k, part);
        if (!matrix) archive->failed = true;   // S is not its own mirror image
        TRY(archive_check(archive, false, err));
        contact_matrix_archive(matrix, last[part], archive);
    }
cleanup:
    return error_is_clean(err);
}

bool ladder_archive(Ladder *ladder, int64_t last, int64_t last_halved, Archive *archive, Error *err)
{
    const int64_t each[CONTACT_PARTS] = {last, last_halved, 0};   // no antisymmetric one is kept
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
        if (!archive_check(archive, false, err)) return false;
        if (!built && ladder->rung[k]) drop_rung(ladder, k);
        if (!built) continue;
        if (!archive_contact(ladder, k, each, archive, err)) return false;
    }
    return true;
}
