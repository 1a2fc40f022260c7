// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/dt_levels.h"

#include "base/clock.h"
#include "base/memory.h"
#include "stepping/tableau.h"

#include <math.h>
#include <stddef.h>

void dt_levels_init(BulkOperator *system, double step_max, double step_min, DtLevels *dt_levels)
{
    *dt_levels = (DtLevels){.system = system, .step_max = step_max};
    double levels = floor(log2(step_max / step_min) * (1 + 1e-12)) + 1;
    dt_levels->level_count = (int32_t)fmin(fmax(levels, 1), DT_LEVELS_MAX);
}

static void drop_contact(DtLevels *dt_levels, int32_t k, ContactPart part)
{
    contact_matrix_destroy(&dt_levels->contact[part][k]);
    memory_free(dt_levels->half_schur[part][k]);
    dt_levels->half_schur[part][k] = NULL;
}

static void drop_level(DtLevels *dt_levels, int32_t k)
{
    for (ContactPart part = 0; part < CONTACT_PARTS; part++) drop_contact(dt_levels, k, part);
    interface_operator_destroy(dt_levels->level[k]);
    dt_levels->level[k] = NULL;
}

void dt_levels_drop_halves(DtLevels *dt_levels)
{
    for (int32_t k = 0; k < DT_LEVELS_MAX; k++)
        for (ContactPart part = 0; part < CONTACT_PARTS; part++)
            if (part != PART_WHOLE) drop_contact(dt_levels, k, part);
}

void dt_levels_drop(DtLevels *dt_levels, int32_t first, int32_t end)
{
    for (int32_t k = first; k < end; k++) drop_level(dt_levels, k);
}

void dt_levels_destroy(DtLevels *dt_levels)
{
    dt_levels_drop(dt_levels, 0, DT_LEVELS_MAX);
    *dt_levels = (DtLevels){0};
}

double dt_level_step(const DtLevels *dt_levels, int32_t k)
{
    return ldexp(dt_levels->step_max, -k);
}

double dt_level_reach(const DtLevels *dt_levels, int32_t k)
{
    return SDIRK2.gamma * dt_level_step(dt_levels, k);
}

int32_t dt_level_find(const DtLevels *dt_levels, double step)
{
    int32_t k = 0;
    while (k < dt_levels->level_count && dt_level_step(dt_levels, k) > step * (1 + 1e-12)) k++;
    return k;
}

static OperatorTerms level_terms(const DtLevels *dt_levels, int32_t k)
{
    double scaled = dt_level_reach(dt_levels, k);
    return (OperatorTerms){.mass = 1 / scaled, .damping = 1, .stiffness = scaled};
}

static ContactMatrix *made_contact(DtLevels *dt_levels, int32_t k, ContactPart part)
{
    ContactMatrix *matrix = &dt_levels->contact[part][k];
    return matrix->schur ? matrix : NULL;
}

// Makes the S that one side sees. Where S is not its own mirror image `half` becomes NULL.
static bool build_half(DtLevels *dt_levels, int32_t k, ContactPart part, Error *err)
{
    int64_t count = dt_levels->half->interface.count;
    double *schur = dt_levels->half_schur[part][k] =
        memory_bytes(count * count * (int64_t)sizeof(double), err);
    if (!schur) return false;
    if (contact_half_matrix(dt_levels->half, interface_operator_schur(dt_levels->level[k]),
                            part == PART_ANTISYMMETRIC, schur))
        return contact_matrix_create(schur, (int32_t)count, &dt_levels->contact[part][k], err);
    drop_contact(dt_levels, k, part);
    dt_levels->half = NULL;
    return true;
}

// The operator is made anew where its S was dropped. Levels that a run steps with get the matrices
// of both sides at once, as both are asked for once slip weakens; relaxing asks for one alone.
static bool build_level(DtLevels *dt_levels, int32_t k, ContactPart part, Error *err)
{
    InterfaceOperator *level = dt_levels->level[k];
    if (!level || !interface_operator_schur(level)) {
        interface_operator_destroy(level);
        level = dt_levels->level[k] =
            interface_operator_create(dt_levels->system, level_terms(dt_levels, k), err);
        if (!level) return false;
    }
    for (ContactPart half = PART_SYMMETRIC; part != PART_WHOLE && half < CONTACT_PARTS; half++) {
        bool wanted = half == part || k >= dt_levels->run_from;
        if (!wanted || !dt_levels->half || made_contact(dt_levels, k, half)) continue;
        if (!build_half(dt_levels, k, half, err)) return false;
    }
    bool whole = made_contact(dt_levels, k, PART_WHOLE) != NULL;
    if (part != PART_WHOLE && dt_levels->half) {
        // S itself is freed where nobody else uses it.
        if (!whole) memory_free(interface_operator_take_schur(level));
        return true;
    }
    return whole || contact_matrix_create(interface_operator_schur(level),
                                          dt_levels->system->interface_count,
                                          &dt_levels->contact[PART_WHOLE][k], err);
}

// The time of a factorisation is counted here, not in the step's.
InterfaceOperator *dt_level_operator(DtLevels *dt_levels, int32_t k, ContactPart part, Error *err)
{
    if (!dt_levels->half) part = PART_WHOLE;
    if (!made_contact(dt_levels, k, part)) {
        double started = clock_seconds();
        int64_t before = memory_counters().allocations;
        if (!build_level(dt_levels, k, part, err)) {
            drop_level(dt_levels, k);
            error_context(err, "step %g", dt_level_step(dt_levels, k));
        }
        dt_levels->seconds += clock_seconds() - started;
        dt_levels->allocations += memory_counters().allocations - before;
    }
    return dt_levels->level[k];
}

bool dt_levels_fill(DtLevels *dt_levels, ContactPart part)
{
    Error err = {0};
    int32_t first = 0, last = dt_levels->level_count - 1;
    while (first < last && !dt_levels->level[first]) first++;
    while (last > first && !dt_levels->level[last]) last--;
    for (int32_t k = first + 1; k < last; k++)
        if (!dt_level_operator(dt_levels, k, part, &err)) return false;
    return true;
}

ContactMatrix *dt_level_contact(DtLevels *dt_levels, int32_t k, ContactPart part)
{
    Error err = {0};
    if (!made_contact(dt_levels, k, part) && dt_levels->level[k] &&
        (part == PART_WHOLE || dt_levels->half) && !dt_level_operator(dt_levels, k, part, &err))
        return NULL;
    return made_contact(dt_levels, k, part);
}

// Uses the errors that were measured when the basis was made; the full mesh is not asked again.
double dt_levels_reduction_error(const DtLevels *dt_levels)
{
    double error = 0;
    for (int32_t k = 0; dt_levels->system && k < dt_levels->level_count; k++) {
        if (dt_levels->accepted[k] > 0)
            error = fmax(error, bulk_operator_error(dt_levels->system, level_terms(dt_levels, k)));
    }
    return error;
}

// Lists those matrices that are there.
static bool archive_contact(DtLevels *dt_levels, int32_t k, const int64_t *last, Archive *archive,
                            Error *err)
{
    for (ContactPart part = 0; part < CONTACT_PARTS; part++) {
        bool kept = made_contact(dt_levels, k, part) != NULL;
        archive_flag(archive, &kept);
        if (kept && part != PART_WHOLE && !dt_levels->half) archive->failed = true;
        TRY(archive_check(archive, false, err));
        if (!kept) {
            drop_contact(dt_levels, k, part);
            continue;
        }
        TRY(dt_level_operator(dt_levels, k, part, err));
        ContactMatrix *matrix = made_contact(dt_levels, k, part);
        if (!matrix) archive->failed = true;   // S is not its own mirror image
        TRY(archive_check(archive, false, err));
        contact_matrix_archive(matrix, last[part], archive);
    }
cleanup:
    return error_is_clean(err);
}

bool dt_levels_archive(DtLevels *dt_levels, int64_t last, int64_t last_halved, Archive *archive,
                       Error *err)
{
    const int64_t each[CONTACT_PARTS] = {last, last_halved, 0};   // no antisymmetric one is kept
    double longest = dt_levels->step_max;
    int32_t count = dt_levels->level_count;
    archive_section(archive, "dt_levels");
    archive_number(archive, &longest);
    archive_integer(archive, &count);
    if (longest != dt_levels->step_max || count != dt_levels->level_count) archive->failed = true;
    for (int32_t k = 0; k < dt_levels->level_count; k++) {
        bool built = dt_levels->level[k] != NULL;
        archive_count(archive, &dt_levels->accepted[k]);
        archive_flag(archive, &built);
        if (!archive_check(archive, false, err)) return false;
        if (!built && dt_levels->level[k]) drop_level(dt_levels, k);
        if (!built) continue;
        if (!archive_contact(dt_levels, k, each, archive, err)) return false;
    }
    return true;
}
