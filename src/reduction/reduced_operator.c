// SPDX-License-Identifier: GPL-2.0-or-later
// For each A and each part of the bulk, normalised, the inverse of its interior block and the map
//
//     B = A_qq^-1 A_qb,   S = A_bb - A_bq B,   g = rhs_b - B' rhs_q,   v_q = A_qq^-1 rhs_q - B v_b
//
// are kept. A stage reads B twice (the second time what moves of it), half of A_qq^-1 and, for M v,
// M_qb. S on the border is the sum of the parts', and mirrored unknowns R are eliminated like all
// that is inside:
//
//     E = S_RR^-1 S_Rb,   S = S_bb - S_bR E,   g = g_b - E' g_R,   u_R = S_RR^-1 g_R - E u_b.
#include "reduction/reduced_operator.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/parallel.h"

#include <math.h>
#include <string.h>

struct ReducedOperator {
    const ReducedBulk *reduced;   // not owned
    double *local[REDUCED_PARTS_MAX], *image[REDUCED_PARTS_MAX];   // [count] of each, work; owned
    double *border;   // [interface + mirrored] work; owned
    bool at_rest[REDUCED_PARTS_MAX];   // the part is (reduced_operator_rest)
    bool large;   // a level of it is worth threads
};

// Entries of the parts' matrices on their borders from which on a level is worth threads.
enum { ENTRIES_LARGE = 250000 };

void reduced_operator_destroy(ReducedOperator *system)
{
    if (!system) return;
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) {
        memory_free_all(system->local[p], system->image[p]);
    }
    memory_free_all(system->border, system);
}

ReducedOperator *reduced_operator_create(const ReducedBulk *reduced, Error *err)
{
    int64_t entries = 0;
    ReducedOperator *system = NEW_ARRAY(ReducedOperator, 1, err);
    if (!system) goto cleanup;
    system->reduced = reduced;
    system->border = NEW_ARRAY(double, reduced->interface_count + reduced->mirrored, err);
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        system->local[p] = NEW_ARRAY(double, part->count, err);
        system->image[p] = NEW_ARRAY(double, part->count, err);
        entries += (int64_t)part->border_count * part->border_count;
    }
    system->large = entries >= ENTRIES_LARGE;
cleanup:
    if (error_is_clean(err)) return system;
    reduced_operator_destroy(system);
    return NULL;
}

// y = K x, C x, M x or S_j x, [count] each.
static void part_apply(const ReducedPart *part, BulkTerm term, const double *x, double *y)
{
    int32_t m = part->border_count, r = part->interior_count;
    DenseView coupling = {part->coupling, r, m};
    if (term == BULK_DAMPING) {
        dense_symmetric_apply(part->damping, part->count, x, y);
        return;
    }
    if (term >= BULK_SHAPE) {   // asked in every stage, where most of the interface is at rest
        memset(y, 0, (size_t)part->count * sizeof *y);
        dense_add_symmetric(part->shape[term - BULK_SHAPE], part->count, x, 1, y);
        return;
    }
    memset(y, 0, (size_t)m * sizeof *y);
    dense_add_symmetric(term == BULK_MASS ? part->mass : part->stiffness, m, x, 1, y);
    memcpy(y + m, x + m, (size_t)r * sizeof *y);
    if (term == BULK_STIFFNESS) return;
    for (int32_t k = 0; k < r; k++) y[m + k] *= part->masses[k];
    dense_add_nonzero(coupling, x, 1, y + m);
    if (r > 0) dense_apply_transposed(coupling, x + m, 1, 1, y);
}

// Normalised matrices times their scale; that of shapes is in the spectrum's shares.
void reduced_operator_apply(const ReducedOperator *system, BulkTerm term, const double *x,
                            double *y)
{
    const ReducedBulk *reduced = system->reduced;
    const double scale[] = {[BULK_STIFFNESS] = reduced->scales.stiffness,
                            [BULK_DAMPING] = reduced->scales.damping,
                            [BULK_MASS] = reduced->scales.mass,
                            [BULK_SHAPE] = 1};
    const double by = scale[term < BULK_SHAPE ? term : BULK_SHAPE];
    reduced_bulk_split(reduced, x, system->local);
    for (int p = 0; p < reduced->part_count; p++) {
        if (system->at_rest[p])
            memset(system->image[p], 0, (size_t)reduced->part[p].count * sizeof *y);
        else
            part_apply(&reduced->part[p], term, system->local[p], system->image[p]);
    }
    reduced_bulk_join(reduced, (const double *const *)system->image, y);
    for (int32_t k = 0; k < reduced->count; k++) y[k] *= by;
}

void reduced_operator_keep(const ReducedOperator *system, const bool *kept, const double *x,
                           double *out)
{
    const ReducedBulk *reduced = system->reduced;
    reduced_bulk_split(reduced, x, system->local);
    for (int p = 0; p < reduced->part_count; p++)
        if (!kept[p]) memset(system->local[p], 0, (size_t)reduced->part[p].count * sizeof *x);
    reduced_bulk_join(reduced, (const double *const *)system->local, out);
}

double reduced_operator_share_beside(const ReducedOperator *system, const bool *kept,
                                     const double *x)
{
    const ReducedBulk *reduced = system->reduced;
    double beside = 0, all = 0;
    reduced_bulk_split(reduced, x, system->local);
    for (int p = 0; p < reduced->part_count; p++) {
        double own = dense_max_abs(system->local[p], reduced->part[p].count);
        all = fmax(all, own);
        if (!kept[p]) beside = fmax(beside, own);
    }
    return all > 0 ? beside / all : 0;
}

void reduced_operator_rest(ReducedOperator *system, const bool *kept)
{
    for (int p = 0; p < system->reduced->part_count; p++) system->at_rest[p] = kept && !kept[p];
}

// --- A of a part --------------------------------------------------------------------------------

typedef struct CondensedPart {
    double *inverse;   // [interior^2] A_qq^-1; owned
    double *map;   // [interior * border] B; owned
    double *half;   // [interior] A_qq^-1 rhs_q; owned
} CondensedPart;

// Adds up a column of A without its part in K; mass: NULL is 0.
static void combine_column(OperatorTerms terms, const double *mass, const double *damping,
                           int64_t rows, double *out)
{
    for (int64_t row = 0; row < rows; row++)
        out[row] = terms.mass * (mass ? mass[row] : 0) + terms.damping * damping[row];
}

// Room for numbers all of which are written at once: large arrays are slow to zero.
static double *numbers(int64_t count, Error *err)
{
    return memory_bytes(count * (int64_t)sizeof(double), err);
}

// Fills schur [border^2] by the formulas at the head. weight: [shape_count] of the shape matrices
// in A. The inverse itself, not a factor: a product with it is one pass over memory for each of
// many right-hand sides, and A_qq is well conditioned (K_qq = 1).
static bool condensed_part_create(const ReducedPart *part, OperatorTerms terms,
                                  const double *weight, CondensedPart *condensed, double *schur,
                                  Error *err)
{
    int64_t m = part->border_count, r = part->interior_count, size = (m + r) * (m + r);
    const double *damping_values = part->damping;
    *condensed = (CondensedPart){0};
    double *resisting = part->shape_count > 0 ? numbers(size, err) : NULL;
    condensed->inverse = numbers(r * r, err);
    condensed->map = numbers(r * m, err);
    condensed->half = NEW_ARRAY(double, r, err);
    if (!error_is_clean(err)) goto cleanup;
    if (resisting) {   // c C + sum of the weighted shapes, in the place of C
        for (int64_t k = 0; k < size; k++) resisting[k] = terms.damping * part->damping[k];
        for (int32_t j = 0; j < part->shape_count; j++)
            for (int64_t k = 0; k < size; k++) resisting[k] += weight[j] * part->shape[j][k];
        terms.damping = 1;
        damping_values = resisting;
    }
    for (int64_t column = 0; column < r; column++) {
        const double *inside = damping_values + (m + column) * part->count + m;
        combine_column(terms, NULL, inside, r, condensed->inverse + column * r);
        condensed->inverse[column * (r + 1)] += terms.mass * part->masses[column] + terms.stiffness;
    }
    for (int64_t column = 0; column < m; column++) {
        const double *stiffness = part->stiffness + column * m;
        const double *damping = damping_values + column * part->count;
        combine_column(terms, part->coupling + column * r, damping + m, r,
                       condensed->map + column * r);
        combine_column(terms, part->mass + column * m, damping, m, schur + column * m);
        for (int64_t row = 0; row < m; row++)
            schur[column * m + row] += terms.stiffness * stiffness[row];
    }
    if (!dense_cholesky(condensed->inverse, (int32_t)r))
        FAIL(err, ERROR_COMPUTE, "the interior of the reduced bulk is not positive definite");
    dense_lower_divide(condensed->inverse, (int32_t)r, (int32_t)m, condensed->map);
    dense_subtract_square(dense_view(condensed->map, r, m), schur);
    dense_lower_divide_transposed(condensed->inverse, (int32_t)r, (int32_t)m, condensed->map);
    dense_invert_factored(condensed->inverse, (int32_t)r);
cleanup:
    memory_free(resisting);
    return error_is_clean(err);
}

static void condensed_part_destroy(CondensedPart *condensed)
{
    memory_free_all(condensed->inverse, condensed->map, condensed->half);
    *condensed = (CondensedPart){0};
}

static void condensed_part_condense(const ReducedPart *part, const CondensedPart *condensed,
                                    const double *rhs, double *g)
{
    int32_t m = part->border_count, r = part->interior_count;
    memcpy(g, rhs, (size_t)m * sizeof *g);
    dense_symmetric_apply(condensed->inverse, r, rhs + m, condensed->half);
    // B last: the expand reads it next.
    dense_apply_transposed((DenseView){condensed->map, r, m}, rhs + m, -1, 1, g);
}

static void condensed_part_expand(const ReducedPart *part, const CondensedPart *condensed,
                                  const double *border, double *v)
{
    int32_t m = part->border_count, r = part->interior_count;
    memcpy(v, border, (size_t)m * sizeof *v);
    memcpy(v + m, condensed->half, (size_t)r * sizeof *v);
    dense_add_nonzero((DenseView){condensed->map, r, m}, border, -1, v + m);
}

// --- A of the bulk ------------------------------------------------------------------------------

// Mirrored unknowns condensed out of an S on the border.
typedef struct MirroredDofs {
    double *follow;   // [mirrored * interface] E; owned
    double *lower;   // [mirrored^2] Cholesky factor of S_RR; owned
} MirroredDofs;

struct CondensedBulk {
    const ReducedOperator *system;   // not owned
    CondensedPart part[REDUCED_PARTS_MAX];
    MirroredDofs mirrored;   // owned, like the rest
    double *pushed;   // [interface + mirrored] g on the border, of mirrored unknowns S_RR^-1 g_R
};

void condensed_bulk_destroy(CondensedBulk *condensed)
{
    if (!condensed) return;
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) condensed_part_destroy(&condensed->part[p]);
    memory_free_all(condensed->mirrored.follow, condensed->mirrored.lower, condensed->pushed,
                    condensed);
}

typedef struct Condensing {
    CondensedBulk *condensed;
    OperatorTerms terms;   // normalised
    double weight[SPECTRUM_SHAPES_MAX];
    double *part[REDUCED_PARTS_MAX];   // [border_count^2] S of each; owned, like the columns
    Error error[REDUCED_PARTS_MAX];
    double *column[PARALLEL_WORKERS_MAX];   // [interface + mirrored] work
    double *schur;   // [interface^2]
} Condensing;

static void condense_part(void *context, int32_t p, int32_t worker)
{
    Condensing *all = context;
    const ReducedPart *part = &all->condensed->system->reduced->part[p];
    (void)worker;
    all->part[p] = numbers((int64_t)part->border_count * part->border_count, &all->error[p]);
    if (!all->part[p]) return;
    condensed_part_create(part, all->terms, all->weight, &all->condensed->part[p], all->part[p],
                          &all->error[p]);
}

// One column of the S on the border.
static void join_column(const Condensing *all, int64_t j, double *column)
{
    const ReducedBulk *reduced = all->condensed->system->reduced;
    memset(column, 0, (size_t)(reduced->interface_count + reduced->mirrored) * sizeof *column);
    for (int p = 0; p < reduced->part_count; p++)
        transform_add_square(&reduced->part[p].border, all->part[p], (int32_t)j, column);
}

// Factors S_RR; follow := L^-1 S_Rb.
static bool factor_mirrored(const Condensing *all, MirroredDofs *mirrored, Error *err)
{
    const ReducedBulk *reduced = all->condensed->system->reduced;
    int64_t m = reduced->interface_count, n = reduced->mirrored;
    double *column = all->column[0];
    mirrored->follow = numbers(n * m, err);
    mirrored->lower = numbers(n * n, err);
    if (!error_is_clean(err)) return false;
    for (int64_t j = 0; j < n; j++) {
        join_column(all, m + j, column);
        memcpy(mirrored->lower + j * n, column + m, (size_t)n * sizeof *column);
        for (int64_t i = 0; i < m; i++) mirrored->follow[i * n + j] = column[i];
    }
    if (!dense_cholesky(mirrored->lower, (int32_t)n))
        return FAULT(err, ERROR_COMPUTE, "mirror images of the interface are not held by it");
    dense_lower_divide(mirrored->lower, (int32_t)n, (int32_t)m, mirrored->follow);
    return true;
}

enum { COLUMNS_TOGETHER = 64 };   // of S, which are still in the cache when S_bR E is subtracted

// schur := S_bb - S_bR E, some columns of it.
static void join_columns(void *context, int32_t k, int32_t worker)
{
    const Condensing *all = context;
    const ReducedBulk *reduced = all->condensed->system->reduced;
    int64_t m = reduced->interface_count, n = reduced->mirrored;
    int64_t from = (int64_t)k * COLUMNS_TOGETHER, end = from + COLUMNS_TOGETHER;
    const double *half = all->condensed->mirrored.follow;
    if (end > m) end = m;
    for (int64_t j = from; j < end; j++) {
        join_column(all, j, all->column[worker]);
        memcpy(all->schur + j * m, all->column[worker], (size_t)m * sizeof *all->schur);
    }
    if (n > 0)
        dense_multiply_transposed(dense_view(half, n, m),
                                  dense_view(half + from * n, n, end - from), -1, 1,
                                  all->schur + from * m);
}

CondensedBulk *condensed_bulk_create(const ReducedOperator *system, OperatorTerms terms,
                                     double *schur, Error *err)
{
    const ReducedBulk *reduced = system->reduced;
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    Condensing all = {.condensed = NEW_ARRAY(CondensedBulk, 1, err), .schur = schur};
    CondensedBulk *condensed = all.condensed;
    if (!condensed) goto cleanup;
    condensed->system = system;
    condensed->pushed = NEW_ARRAY(double, m + n, err);
    for (int w = 0; w < PARALLEL_WORKERS_MAX; w++) all.column[w] = numbers(m + n, err);
    if (!error_is_clean(err)) goto cleanup;
    terms.stiffness +=
        spectrum_weights(&reduced->spectrum, terms.damping, terms.stiffness, all.weight);
    all.terms = (OperatorTerms){.mass = terms.mass * reduced->scales.mass,
                                .damping = terms.damping * reduced->scales.damping,
                                .stiffness = terms.stiffness * reduced->scales.stiffness};
    parallel_where(system->large, reduced->part_count, condense_part, &all);
    for (int p = 0; p < reduced->part_count && error_is_clean(err); p++) *err = all.error[p];
    if (!error_is_clean(err)) goto cleanup;
    TRY(factor_mirrored(&all, &condensed->mirrored, err));
    parallel_where(system->large, (m + COLUMNS_TOGETHER - 1) / COLUMNS_TOGETHER, join_columns,
                   &all);
    dense_lower_divide_transposed(condensed->mirrored.lower, n, m, condensed->mirrored.follow);
cleanup:
    memory_free_list((void *const *)all.part, REDUCED_PARTS_MAX);
    memory_free_list((void *const *)all.column, PARALLEL_WORKERS_MAX);
    if (error_is_clean(err)) return condensed;
    condensed_bulk_destroy(condensed);
    return NULL;
}

void condensed_bulk_condense(CondensedBulk *condensed, const double *rhs, double *g)
{
    const ReducedOperator *system = condensed->system;
    const ReducedBulk *reduced = system->reduced;
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    double *pushed = condensed->pushed;
    reduced_bulk_split(reduced, rhs, system->local);
    memset(pushed, 0, (size_t)(m + n) * sizeof *pushed);
    for (int p = 0; p < reduced->part_count; p++) {
        if (system->at_rest[p]) continue;
        condensed_part_condense(&reduced->part[p], &condensed->part[p], system->local[p],
                                system->image[p]);
        transform_apply(&reduced->part[p].border, system->image[p], pushed);
    }
    memcpy(g, pushed, (size_t)m * sizeof *g);
    dense_apply_transposed(dense_view(condensed->mirrored.follow, n, m), pushed + m, -1, 1, g);
    dense_lower_solve(condensed->mirrored.lower, n, pushed + m);
    dense_lower_solve_transposed(condensed->mirrored.lower, n, pushed + m);
}

void condensed_bulk_expand(CondensedBulk *condensed, const double *interface, double *v)
{
    const ReducedOperator *system = condensed->system;
    const ReducedBulk *reduced = system->reduced;
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    double *border = system->border;
    memcpy(border, interface, (size_t)m * sizeof *border);
    memcpy(border + m, condensed->pushed + m, (size_t)n * sizeof *border);
    dense_apply(dense_view(condensed->mirrored.follow, n, m), interface, -1, 1, border + m);
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        if (system->at_rest[p]) {
            memset(system->local[p], 0, (size_t)part->count * sizeof *v);
            continue;
        }
        transform_apply_transposed(&part->border, border, system->image[p]);
        condensed_part_expand(part, &condensed->part[p], system->image[p], system->local[p]);
    }
    reduced_bulk_join(reduced, (const double *const *)system->local, v);
}
