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

// That which is asked for now.
static void drop_contact(Ladder *ladder, int32_t k)
{
    contact_matrix_destroy(&ladder->contact[ladder->side][k]);
    memory_free(ladder->half_schur[ladder->side][k]);
    ladder->half_schur[ladder->side][k] = NULL;
}

static void drop_rung(Ladder *ladder, int32_t k)
{
    LadderSide side = ladder->side;
    for (ladder->side = 0; ladder->side < LADDER_SIDES; ladder->side++) drop_contact(ladder, k);
    ladder->side = side;
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

// Makes the matrix that the contact sees of a rung that is built with its S, which is freed where
// nobody else uses it.
static bool make_half(Ladder *ladder, int32_t k, Error *err)
{
    int64_t count = ladder->half->interface.count;
    double *schur = ladder->half_schur[ladder->side][k] = NEW_ARRAY(double, count *count, err);
    if (!schur) return false;
    if (!contact_half_matrix(ladder->half, interface_operator_schur(ladder->rung[k]),
                             ladder->side == LADDER_ODD, schur)) {
        ladder->side = LADDER_WHOLE;
        ladder->half = NULL;
        return true;
    }
    if (!ladder->contact[LADDER_WHOLE][k].schur) interface_operator_drop_schur(ladder->rung[k]);
    return contact_matrix_create(schur, (int32_t)count, &ladder->contact[ladder->side][k], err);
}

static ContactMatrix *contact_of(Ladder *ladder, int32_t k)
{
    ContactMatrix *matrix = &ladder->contact[ladder->side][k];
    return matrix->schur ? matrix : NULL;
}

// The operator is made anew where its S was dropped: seldom is more than one side asked for.
static bool build_rung(Ladder *ladder, int32_t k, Error *err)
{
    InterfaceOperator *rung = ladder->rung[k];
    if (!rung || !interface_operator_schur(rung)) {
        interface_operator_destroy(rung);
        ladder->rung[k] = interface_operator_create(ladder->system, rung_terms(ladder, k), err);
        if (!ladder->rung[k]) return false;
    }
    if (ladder->side != LADDER_WHOLE && !make_half(ladder, k, err)) return false;
    return ladder->side != LADDER_WHOLE ||
           contact_matrix_create(interface_operator_schur(ladder->rung[k]),
                                 ladder->system->interface_count, &ladder->contact[LADDER_WHOLE][k],
                                 err);
}

// The time of a factorisation is counted here, not in the step's.
InterfaceOperator *ladder_rung(Ladder *ladder, int32_t k, Error *err)
{
    if (!contact_of(ladder, k)) {
        double started = clock_seconds();
        int64_t before = memory_counters().allocations;
        if (!build_rung(ladder, k, err)) {
            drop_rung(ladder, k);
            error_context(err, "step %g", ladder_step(ladder, k));
        }
        ladder->seconds += clock_seconds() - started;
        ladder->allocations += memory_counters().allocations - before;
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
    ContactMatrix *made = contact_of(ladder, k);
    if (made || !ladder->rung[k]) return made;
    Error err = {0};
    return ladder_rung(ladder, k, &err) ? contact_of(ladder, k) : NULL;
}

ContactMatrix *ladder_contact_of(Ladder *ladder, int32_t k, LadderSide side)
{
    LadderSide asked = ladder->side;
    ladder->side = side;
    ContactMatrix *matrix = ladder_contact(ladder, k);
    ladder->side = ladder->half ? asked : LADDER_WHOLE;
    return matrix;
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

// Those matrices that are there, what the contact sees first of all.
static bool archive_contact(Ladder *ladder, int32_t k, const int64_t *last, Archive *archive,
                            Error *err)
{
    LadderSide asked = ladder->side;
    for (ladder->side = 0; ladder->side < LADDER_SIDES; ladder->side++) {
        bool kept = contact_of(ladder, k) != NULL;
        archive_flag(archive, &kept);
        if (kept && ladder->side != LADDER_WHOLE && !ladder->half) archive->failed = true;
        TRY(archive_check(archive, false, err));
        if (!kept) {
            drop_contact(ladder, k);
            continue;
        }
        TRY(ladder_rung(ladder, k, err));
        contact_matrix_archive(contact_of(ladder, k), last[ladder->side], archive);
    }
cleanup:
    ladder->side = asked;
    return error_is_clean(err);
}

bool ladder_archive(Ladder *ladder, int64_t last, int64_t last_halved, Archive *archive, Error *err)
{
    const int64_t each[LADDER_SIDES] = {last, last_halved, 0};   // that of what is odd is not kept
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
