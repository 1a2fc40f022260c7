// SPDX-License-Identifier: GPL-2.0-or-later
// For a response x at (b, i) and z at (c, j),
//
//     x' ((1 - b) K + b C + i M) z = r_x' z_b + t_x f'z
//     x' ((1 - c) K + c C + j M) z = r_z' x_b + t_z f'x
//
// are two equations for x'K z, x'C z, x'M z. So one product by the mesh is enough, where the points
// differ. (Without a third term this is how a Loewner matrix is made of samples: Mayo and Antoulas,
// Linear Algebra Appl. 425, 2007.)
#include "reduction/responses.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// The factor between two inertias, or the part of 1 between two viscosities, from which on two
// equations are as good as independent.
static const double FAR = 4;

// All products with a new block, as bits of their terms.
static unsigned all_products(const Responses *responses)
{
    return (1u << responses->term_count) - 1;
}

static void block_destroy(ResponseBlock *block)
{
    memory_free_all(block->boundary, block->reaction);
    *block = (ResponseBlock){0};
}

void responses_destroy(Responses *responses)
{
    for (int32_t k = 0; k <= responses->block_count; k++) block_destroy(&responses->blocks[k]);
    for (int32_t k = 0; k < responses->shelf_count; k++) memory_free(responses->shelves[k].field);
    memory_free(responses->unit_load);
    for (int32_t k = 0; k < PARALLEL_WORKERS_MAX; k++) memory_free(responses->room[k].image);
    *responses = (Responses){0};
}

bool responses_create(const BulkOperator *full, const BulkScales *scales, Responses *responses,
                      Error *err)
{
    const Bulk *bulk = full->bulk;
    *responses = (Responses){.full = full,
                             .scales = *scales,
                             .term_count = BULK_TERMS + bulk->spectrum.matrix_count,
                             .shelf_count = 2,
                             .shelf_of = {0, 1}};
    responses->unit_load = NEW_ARRAY(double, bulk->dof_count, err);
    for (int32_t k = 0; k < parallel_workers(); k++)
        responses->room[k].image =
            NEW_ARRAY(double, (int64_t)bulk->dof_count *RESPONSES_TOGETHER, err);
    if (!error_is_clean(err)) return false;
    // Without a load every response to it is 0, in any unit.
    double scale = scales->load > 0 ? scales->load : 1;
    for (int32_t k = 0; k < bulk->dof_count; k++) responses->unit_load[k] = bulk->load[k] / scale;
    return error_is_clean(err);
}

// Those that are multiplied by the same matrix (needed_products) stand together.
static int kind_of(ParameterPoint point)
{
    return point.viscosity < 0.5 ? 0 : 1;
}

ResponseBlock *responses_last(Responses *responses)
{
    return &responses->blocks[responses->block_count];
}

ResponseBlock *responses_next(Responses *responses, ParameterPoint point, int64_t columns,
                              Error *err)
{
    ResponseBlock *block = &responses->blocks[responses->block_count];
    int64_t rows = responses->full->interface_count + 1;
    responses_drop(responses);
    if (responses->block_count == RESPONSE_BLOCKS_MAX)
        FAIL(err, ERROR_LIBRARY, "more than %d points to reduce the bulk at", RESPONSE_BLOCKS_MAX);
    *block = (ResponseBlock){.point = point, .first = responses->count, .count = columns};

    // A response is kept on the shelf of its kind, where that has room. A new one has room for many
    // blocks; memory that is never written to is never there.
    int64_t dofs = responses->full->dof_count, m = responses->full->interface_count;
    int32_t *which = &responses->shelf_of[kind_of(point)];
    ResponseShelf *shelf = &responses->shelves[*which];
    if (shelf->filled + columns > shelf->room) {
        if (shelf->filled == 0) memory_free(shelf->field);
        if (shelf->filled > 0) *which = responses->shelf_count++;
        shelf = &responses->shelves[*which];
        *shelf = (ResponseShelf){.room = columns > m ? columns : m};
        shelf->field = memory_bytes(dofs * shelf->room * (int64_t)sizeof(double), err);
        if (!shelf->field) shelf->room = 0;
    }
    block->field = shelf->field ? shelf->field + shelf->filled * dofs : NULL;
    block->boundary = NEW_ARRAY(double, rows *columns, err);
    block->reaction = NEW_ARRAY(double, rows *columns, err);
cleanup:
    return error_is_clean(err) ? block : NULL;
}

void responses_replace(Responses *responses, int64_t columns, const double *field)
{
    ResponseBlock *next = responses_last(responses);
    int64_t rows = responses->full->interface_count + 1;
    memset(next->boundary, 0, (size_t)(rows * next->count) * sizeof *field);
    memcpy(next->field, field, (size_t)(responses->full->dof_count * columns) * sizeof *field);
    next->count = columns;
    next->formed = true;
}

void responses_keep(Responses *responses)
{
    const ResponseBlock *block = &responses->blocks[responses->block_count++];
    responses->count += block->count;
    responses->shelves[responses->shelf_of[kind_of(block->point)]].filled += block->count;
}

void responses_drop(Responses *responses)
{
    block_destroy(&responses->blocks[responses->block_count]);
}

// y = K x / E, C x / eta, M x / (rho L^2) or S_j x on the full mesh, of several columns.
static void apply(const Responses *responses, BulkTerm term, DenseView x, double *y)
{
    const Bulk *bulk = responses->full->bulk;
    double scale = term == BULK_STIFFNESS ? responses->scales.stiffness
                   : term == BULK_DAMPING ? responses->scales.damping
                   : term == BULK_MASS    ? responses->scales.mass
                                          : 1;
    int64_t count = (int64_t)x.rows * x.columns;
    if (term != BULK_MASS)
        sparse_apply_many(&bulk->pattern,
                          term == BULK_DAMPING     ? bulk->damping
                          : term == BULK_STIFFNESS ? bulk->stiffness
                                                   : bulk->shape[term - BULK_SHAPE],
                          x.values, x.columns, y);
    for (int64_t j = 0; term == BULK_MASS && j < x.columns; j++)
        bulk_apply_mass(bulk, x.values + j * x.rows, y + j * x.rows);
    for (int64_t k = 0; scale != 1 && k < count; k++) y[k] /= scale;
}

// The products by the mesh that two points need, as bits of their terms. M costs next to nothing
// and is enough where viscosities differ: what is lost then goes with the root of the quotient of
// inertias. Where only inertia differs it gives M, the point with less of it that of K and C which
// weighs more there, and the lighter one is multiplied. Shape matrices always multiply.
static unsigned needed_products(const Responses *responses, const ResponseBlock *one,
                                const ResponseBlock *other)
{
    ParameterPoint old = one->point, new = other->point;
    bool ascends = old.inertia < new.inertia;
    ParameterPoint low = ascends ? old : new, high = ascends ? new : old;
    unsigned mass = 1u << BULK_MASS, all = all_products(responses),
             shapes = all >> BULK_SHAPE << BULK_SHAPE;
    unsigned light = 1u << (low.viscosity < 0.5 ? BULK_DAMPING : BULK_STIFFNESS);
    if (one->formed || other->formed) return all;
    if (fabs(low.viscosity - high.viscosity) * FAR >= 1) return shapes | mass;
    bool apart = high.inertia > fmax(FAR * low.inertia, responses->inertia_least);
    return shapes | (apart ? light : mass | light);
}

// The product that each piece of the next block's columns goes through.
typedef struct Multiplication {
    const Responses *responses;
    double *const *gram;
    int32_t pieces;
    Error *errors;   // [PARALLEL_WORKERS_MAX]
} Multiplication;

static bool first_error(const Error *errors, Error *err)
{
    for (int32_t k = 0; k < PARALLEL_WORKERS_MAX && error_is_clean(err); k++) *err = errors[k];
    return error_is_clean(err);
}

// Blocks whose fields stand side by side: multiplied as one.
typedef struct Run {
    const double *field;
    int64_t columns;
    int32_t count;
    const ResponseBlock *blocks[RESPONSE_BLOCKS_MAX + 1];   // [count]
} Run;

// Puts the products of a run with `image`, the columns of the next block `from` on, into their
// places. Of the next block itself only rows from `from` on: the products are symmetric.
static void multiply_run(const Multiplication *all, Run *run, DenseView image, int64_t from,
                         double *product, double *gram)
{
    const Responses *responses = all->responses;
    const ResponseBlock *next = &responses->blocks[responses->block_count];
    int64_t rows = responses->count + next->count;
    dense_multiply_transposed(dense_view(run->field, image.rows, run->columns), image, 1, 0,
                              product);
    for (int32_t k = 0; k < run->count; k++) {
        const ResponseBlock *block = run->blocks[k];
        int64_t skipped = block == next ? from : 0, count = block->count - skipped;
        double *out = gram + from * rows + block->first + skipped;
        for (int64_t j = 0; j < image.columns; j++)
            memcpy(out + j * rows, product + j * run->columns, (size_t)count * sizeof *out);
        product += count;
    }
    *run = (Run){0};
}

// All blocks of a kind that need this product.
static void multiply_kind(const Multiplication *all, int kind, BulkTerm term,
                          const ResponseRoom *room, int64_t from, int64_t columns)
{
    const Responses *responses = all->responses;
    const ResponseBlock *next = &responses->blocks[responses->block_count];
    int64_t dofs = responses->full->dof_count;
    DenseView image = dense_view(room->image, dofs, columns);
    double *product = room->product, *gram = all->gram[term];
    Run run = {0};
    for (int32_t k = 0; k <= responses->block_count; k++) {
        const ResponseBlock *block = &responses->blocks[k];
        int64_t skipped = block == next ? from : 0;
        unsigned needed = needed_products(responses, block, next);
        if (!block->field || kind_of(block->point) != kind || !(needed & 1u << term)) continue;
        const double *field = block->field + skipped * dofs;
        bool beside = run.count > 0 && field == run.field + run.columns * dofs;
        if (run.count > 0 && !beside) multiply_run(all, &run, image, from, product, gram);
        if (run.count == 0) run.field = field;
        run.blocks[run.count++] = block;
        run.columns += block->count - skipped;
    }
    if (run.count > 0) multiply_run(all, &run, image, from, product, gram);
}

// Psi' image, into the first rows of gram.
static void multiply_statics(const Multiplication *all, BulkTerm term, const ResponseRoom *room,
                             int64_t from, int64_t columns, Error *err)
{
    const Responses *responses = all->responses;
    const ResponseBlock *next = &responses->blocks[responses->block_count];
    int64_t m = responses->full->interface_count, rows = responses->count + next->count;
    double *out = all->gram[term] + from * rows;
    if (!(needed_products(responses, &responses->blocks[0], next) & 1u << term)) return;
    if (!interface_operator_condense_many(responses->statics, room->image, (int32_t)columns,
                                          room->product, err))
        return;
    for (int64_t j = 0; j < columns; j++)
        memcpy(out + j * rows, room->product + j * m, (size_t)m * sizeof *out);
}

static void multiply_piece(void *context, int32_t piece, int32_t worker)
{
    const Multiplication *all = context;
    const Responses *responses = all->responses;
    const ResponseBlock *next = &responses->blocks[responses->block_count];
    const ResponseRoom *room = &responses->room[worker];
    int64_t dofs = responses->full->dof_count, from = next->count * piece / all->pieces;
    int64_t columns = next->count * (piece + 1) / all->pieces - from;
    unsigned needed = 0;
    for (int32_t k = 0; k <= responses->block_count; k++)
        needed |= needed_products(responses, &responses->blocks[k], next);
    for (int term = 0; term < responses->term_count; term++) {
        if (!(needed & 1u << term)) continue;
        apply(responses, (BulkTerm)term, dense_view(next->field + from * dofs, dofs, columns),
              room->image);
        if (responses->statics)
            multiply_statics(all, (BulkTerm)term, room, from, columns, &all->errors[worker]);
        for (int kind = 0; kind < 2; kind++)
            multiply_kind(all, kind, (BulkTerm)term, room, from, columns);
    }
}

// Solves the equations at the head for the products that are not `known`, in g at `at`; p, q: the
// factors of all terms at the older and at the new point; a, b: the right sides there.
static void complete_pair(int32_t terms, const double *p, const double *q, unsigned known, double a,
                          double b, double *const *g, int64_t at)
{
    int unknown[2] = {0}, count = 0;
    for (int term = 0; term < terms; term++) {
        if (known & 1u << term) {
            a -= p[term] * g[term][at];
            b -= q[term] * g[term][at];
        } else {
            unknown[count++] = term;
        }
    }
    int y = unknown[0], z = unknown[count - 1];
    if (count == 1) {
        g[y][at] = p[y] > q[y] ? a / p[y] : b / q[y];
        return;
    }
    double determinant = p[y] * q[z] - p[z] * q[y];
    g[y][at] = (q[z] * a - p[z] * b) / determinant;
    g[z][at] = (p[y] * b - q[y] * a) / determinant;
}

// The products of a block with the next one that the mesh was not asked for. a, b: [its count *
// added] work.
static void complete_block(const Responses *responses, const ResponseBlock *block, double *a,
                           double *b, double *const *gram)
{
    double p[BULK_TERMS_MAX], q[BULK_TERMS_MAX];
    const ResponseBlock *next = &responses->blocks[responses->block_count];
    int64_t m = responses->full->interface_count, rows = responses->count + next->count;
    unsigned known = needed_products(responses, block, next);
    const Spectrum *spectrum = &responses->full->bulk->spectrum;
    if (known == all_products(responses)) return;
    parameter_factors(block->point, &responses->scales, spectrum, p);
    parameter_factors(next->point, &responses->scales, spectrum, q);
    dense_multiply_transposed(dense_view(block->reaction, m + 1, block->count),
                              dense_view(next->boundary, m + 1, next->count), 1, 0, a);
    dense_multiply_transposed(dense_view(block->boundary, m + 1, block->count),
                              dense_view(next->reaction, m + 1, next->count), 1, 0, b);
    for (int64_t j = 0; j < next->count; j++) {
        for (int64_t i = block == next ? j : 0; i < block->count; i++) {
            int64_t at = j * rows + block->first + i, own = j * block->count + i;
            complete_pair(responses->term_count, p, q, known, a[own], b[own], gram, at);
        }
    }
}

bool responses_multiply(Responses *responses, double *const *gram, Error *err)
{
    const ResponseBlock *next = &responses->blocks[responses->block_count];
    int64_t dofs = responses->full->dof_count, m = responses->full->interface_count;
    int64_t rows = responses->count + next->count;
    // Two at least; the work of a piece falls with its number.
    int64_t most = 2 * RESPONSES_TOGETHER, pieces = 2 * ((next->count + most - 1) / most);
    Error errors[PARALLEL_WORKERS_MAX] = {0};
    Multiplication by_mesh = {responses, gram, (int32_t)(next->count > 1 ? pieces : 1), errors};
    double *a = NEW_ARRAY(double, rows * next->count, err);
    double *b = NEW_ARRAY(double, rows * next->count, err);
    for (int32_t k = 0; k < parallel_workers(); k++)
        responses->room[k].product = NEW_ARRAY(double, rows *RESPONSES_TOGETHER, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t j = 0; j < next->count; j++)
        next->boundary[j * (m + 1) + m] =
            dense_dot(next->field + j * dofs, responses->unit_load, (int32_t)dofs);
    parallel_for(by_mesh.pieces, multiply_piece, &by_mesh);
    if (!first_error(errors, err)) goto cleanup;
    for (int32_t k = 0; k <= responses->block_count; k++)
        complete_block(responses, &responses->blocks[k], a, b, gram);
    for (int term = 0; term < responses->term_count; term++)   // those of the block with itself
        for (int64_t j = 0; j < next->count; j++)
            for (int64_t i = 0; i < j; i++)
                gram[term][j * rows + next->first + i] = gram[term][i * rows + next->first + j];
cleanup:
    for (int32_t k = 0; k < PARALLEL_WORKERS_MAX; k++) {
        memory_free(responses->room[k].product);
        responses->room[k].product = NULL;
    }
    memory_free_all(a, b);
    return error_is_clean(err);
}

// --- Psi -----------------------------------------------------------------------------------------

void responses_release_statics(Responses *responses, const InterfaceOperator *statics)
{
    ResponseBlock *first = &responses->blocks[0];
    ResponseShelf *shelf = &responses->shelves[responses->shelf_of[kind_of(first->point)]];
    memory_free(shelf->field);
    *shelf = (ResponseShelf){0};
    first->field = NULL;
    responses->statics = statics;
}

// y += Psi c, some columns at a time.
static bool combine_statics(const Responses *responses, const double *c, int64_t columns, double *y,
                            Error *err)
{
    int64_t dofs = responses->full->dof_count, m = responses->full->interface_count;
    int64_t together = columns < RESPONSES_TOGETHER ? columns : RESPONSES_TOGETHER;
    double *motions = NEW_ARRAY(double, m *together, err);
    double *field = NEW_ARRAY(double, dofs *together, err);
    if (!motions || !field) goto cleanup;
    for (int64_t from = 0; from < columns; from += together) {
        int64_t count = columns - from < together ? columns - from : together;
        for (int64_t j = 0; j < count; j++)
            memcpy(motions + j * m, c + (from + j) * responses->count, (size_t)m * sizeof *c);
        TRY(interface_operator_respond(responses->statics, motions, (int32_t)count, field, err));
        for (int64_t j = 0; j < count; j++)
            dense_add_scaled(1, field + j * dofs, (int32_t)dofs, y + (from + j) * dofs);
    }
cleanup:
    memory_free_all(motions, field);
    return error_is_clean(err);
}

// Rows of `c` that belong to a block stand `count` apart.
bool responses_combine(const Responses *responses, const double *c, int64_t columns, double *y,
                       Error *err)
{
    const BulkOperator *full = responses->full;
    int64_t dofs = full->dof_count;
    for (int32_t k = 0; k < responses->block_count; k++) {
        const ResponseBlock *block = &responses->blocks[k];
        if (!block->field) continue;
        dense_multiply_rows(dense_view(block->field, dofs, block->count), c + block->first,
                            responses->count, columns, 1, y);
    }
    if (responses->statics && !combine_statics(responses, c, columns, y, err)) return false;
    for (int64_t j = 0; j < columns; j++)
        for (int32_t i = 0; i < full->interface_count; i++)
            y[j * dofs + full->interface_dofs[i]] = 0;
    return true;
}
