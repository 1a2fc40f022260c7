// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/far_block.h"

#include "base/dense.h"
#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

// Unknowns outside a patch that share elements with it: near, then of each patch before it.
typedef struct Border {
    int32_t count;
    int32_t *dofs;   // [count] owned
    int32_t group_count;
    int32_t *start;   // [group_count + 1] owned
} Border;

typedef struct Building {
    const Bulk *bulk;
    FarBlock *block;
    FarPatches patches;
    Border *borders;   // [patches.count]
} Building;

void far_block_destroy(FarBlock *block)
{
    memory_free(block->patches);
    memory_free(block->couplings);
    memory_free(block->indices);
    memory_free(block->numbers);
    memory_free(block->stiffness);
    far_samples_destroy(&block->samples);
    *block = (FarBlock){0};
}

static double *take(double **numbers, int64_t count)
{
    double *taken = *numbers;
    *numbers += count;
    return taken;
}

// Room for all that the sizes of patches and couplings say.
static bool make_room(FarBlock *block, Error *err)
{
    int64_t indices = 0, numbers = 0;
    for (int32_t p = 0; p < block->patch_count; p++) {
        int64_t q = block->patches[p].count, size = block->patches[p].size;
        indices += size;
        numbers += q * (size + 2 * q + 2);
    }
    for (int32_t c = 0; c < block->coupling_count; c++) {
        const FarCoupling *coupling = &block->couplings[c];
        if (coupling->before == NO_PATCH) indices += coupling->count;
        numbers += 2 * (int64_t)coupling->count * block->patches[coupling->patch].count;
    }
    block->indices = NEW_ARRAY(int32_t, indices, err);
    block->numbers = NEW_ARRAY(double, numbers, err);
    return error_is_clean(err);
}

static bool lay_out(FarBlock *block, Error *err)
{
    if (!make_room(block, err)) return false;
    int32_t *indices = block->indices;
    double *numbers = block->numbers;
    for (int32_t p = 0; p < block->patch_count; p++) {
        FarPatch *patch = &block->patches[p];
        int64_t q = patch->count;
        patch->dofs = indices;
        indices += patch->size;
        patch->field = take(&numbers, patch->size * q);
        patch->rotation = take(&numbers, q * q);
        patch->damping = take(&numbers, q * q);
        patch->mass = take(&numbers, q);
        patch->load = take(&numbers, q);
    }
    for (int32_t c = 0; c < block->coupling_count; c++) {
        FarCoupling *coupling = &block->couplings[c];
        int64_t entries = (int64_t)coupling->count * block->patches[coupling->patch].count;
        if (coupling->before == NO_PATCH) {
            coupling->rows = indices;
            indices += coupling->count;
        }
        coupling->stiffness = take(&numbers, entries);
        coupling->damping = take(&numbers, entries);
    }
    return true;
}

static void building_destroy(Building *work)
{
    for (int32_t p = 0; work->borders && p < work->patches.count; p++) {
        memory_free(work->borders[p].dofs);
        memory_free(work->borders[p].start);
    }
    memory_free(work->borders);
    far_patches_destroy(&work->patches);
}

// --- what the matrices are for the modes ------------------------------------------------------

// Rotation F = field * rotation, with which K/E is 1 to rounding and M diagonal: eigenvectors z of
// (L^-1 M L^-T) z = mass z, K/E = L L', and L^-T z.
static bool rotate(double *stiffness, double *mass, int32_t q, double *values, Error *err)
{
    double *work = NEW_ARRAY(double, dense_eigen_work(q), err);
    if (!work) goto cleanup;
    if (!dense_cholesky(stiffness, q)) FAIL(err, ERROR_COMPUTE, "modes are not independent");
    dense_divide_both_sides(stiffness, q, mass);
    if (!dense_eigen(mass, q, values, work)) FAIL(err, ERROR_LIBRARY, "LAPACK: no modes");
    for (int32_t j = 0; j < q; j++)
        dense_lower_solve_transposed(stiffness, q, mass + (int64_t)j * q);
cleanup:
    memory_free(work);
    return error_is_clean(err);
}

static bool project(Building *work, int32_t p, Error *err)
{
    FarPatch *patch = &work->block->patches[p];
    const PatchModes *modes = &work->patches.modes[p];
    int64_t q = modes->count, size = modes->size;
    double *stiffness = NEW_ARRAY(double, q *q, err), *damping = NEW_ARRAY(double, q *q, err);
    double *half = NEW_ARRAY(double, q *q, err), *sum = NEW_ARRAY(double, q, err);
    double *load = NEW_ARRAY(double, size, err);
    if (!error_is_clean(err)) goto cleanup;
    double *const square[] = {
        [BULK_STIFFNESS] = stiffness, [BULK_DAMPING] = damping, [BULK_MASS] = patch->rotation};
    TRY(patch_modes_project(modes, work->bulk->mass, square, err));
    TRY(rotate(stiffness, patch->rotation, (int32_t)q, patch->mass, err));
    DenseView rotation = dense_view(patch->rotation, q, q);
    dense_multiply(dense_view(damping, q, q), rotation, 1, 0, half);
    dense_multiply_transposed(rotation, dense_view(half, q, q), 1, 0, patch->damping);
    for (int64_t i = 0; i < size; i++) load[i] = work->bulk->load[modes->dofs[i]];
    dense_apply_transposed(dense_view(modes->field, size, q), load, 1, 0, sum);
    dense_apply_transposed(rotation, sum, 1, 0, patch->load);
    memcpy(patch->dofs, modes->dofs, (size_t)size * sizeof *patch->dofs);
    memcpy(patch->field, modes->field, (size_t)(size * q) * sizeof *patch->field);
cleanup:
    memory_free(stiffness);
    memory_free(damping);
    memory_free(half);
    memory_free(sum);
    memory_free(load);
    return error_is_clean(err);
}

// By patch, near first, then by unknown.
static int by_patch(const void *left, const void *right, void *of)
{
    int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
    const int32_t *patch = of;
    if (patch[a] != patch[b]) return patch[a] < patch[b] ? -1 : 1;
    return (a > b) - (a < b);
}

// seen: [dofs] below p.
static bool list_border(Building *work, int32_t p, int32_t *seen, Error *err)
{
    const SparsePattern *pattern = &work->bulk->pattern;
    const PatchModes *modes = &work->patches.modes[p];
    const int32_t *of = work->patches.of;
    Border *border = &work->borders[p];
    int32_t entries = 0;
    for (int32_t i = 0; i < modes->size; i++)
        entries += pattern->start[modes->dofs[i] + 1] - pattern->start[modes->dofs[i]];
    border->dofs = NEW_ARRAY(int32_t, entries, err);
    border->start = NEW_ARRAY(int32_t, (int64_t)entries + 1, err);
    if (!border->dofs || !border->start) return false;
    for (int32_t i = 0; i < modes->size; i++) {
        int32_t row = modes->dofs[i];
        for (int32_t at = pattern->start[row]; at < pattern->start[row + 1]; at++) {
            int32_t other = pattern->index[at];
            if (of[other] >= p || seen[other] == p) continue;
            seen[other] = p;
            border->dofs[border->count++] = other;
        }
    }
    qsort_r(border->dofs, (size_t)border->count, sizeof *border->dofs, by_patch, work->patches.of);
    for (int32_t j = 0; j < border->count; j++)
        if (j == 0 || of[border->dofs[j]] != of[border->dofs[j - 1]])
            border->start[border->group_count++] = j;
    border->start[border->group_count] = border->count;
    return true;
}

// values [border->count * columns]: rows of the bulk's matrix times F of patch p, not rotated.
static void multiply_border(const Building *work, int32_t p, const double *matrix, double *values)
{
    const Border *border = &work->borders[p];
    int64_t count = border->count;
    const SparsePattern *pattern = &work->bulk->pattern;
    const PatchModes *modes = &work->patches.modes[p];
    for (int64_t j = 0; j < count; j++) {
        int32_t row = border->dofs[j];
        for (int32_t at = pattern->start[row]; at < pattern->start[row + 1]; at++) {
            if (work->patches.of[pattern->index[at]] != p) continue;
            const double *moved = modes->field + work->patches.place[pattern->index[at]];
            for (int64_t c = 0; c < modes->count; c++)
                values[c * count + j] += matrix[at] * moved[c * modes->size];
        }
    }
}

// out [coordinates of patch `before` * columns] := its modes' rows of the border, [values.rows]
// of them from `rows` on, times `values`.
static bool project_rows(const Building *work, int32_t before, const int32_t *rows,
                         DenseView values, double *out, Error *err)
{
    const PatchModes *modes = &work->patches.modes[before];
    int64_t p = modes->count, q = values.columns, count = values.rows;
    double *moved = NEW_ARRAY(double, count *p, err), *half = NEW_ARRAY(double, p *q, err);
    if (!moved || !half) goto cleanup;
    for (int64_t c = 0; c < p; c++)
        for (int64_t j = 0; j < count; j++)
            moved[c * count + j] = modes->field[c * modes->size + work->patches.place[rows[j]]];
    dense_multiply_transposed(dense_view(moved, count, p), values, 1, 0, half);
    dense_multiply_transposed(dense_view(work->block->patches[before].rotation, p, p),
                              dense_view(half, p, q), 1, 0, out);
cleanup:
    memory_free(moved);
    memory_free(half);
    return error_is_clean(err);
}

// Couplings `first` on, of patch p, by one of the bulk's matrices.
static bool couple(const Building *work, int32_t p, int32_t first, BulkTerm term, Error *err)
{
    const Border *border = &work->borders[p];
    const FarPatch *patch = &work->block->patches[p];
    const Bulk *bulk = work->bulk;
    int64_t count = border->count, q = patch->count;
    double *values = NEW_ARRAY(double, count *q, err), *turned = NEW_ARRAY(double, count *q, err);
    double *part = NEW_ARRAY(double, count *q, err);
    if (!values || !turned || !part) goto cleanup;
    multiply_border(work, p, term == BULK_STIFFNESS ? bulk->stiffness : bulk->damping, values);
    dense_multiply(dense_view(values, count, q), dense_view(patch->rotation, q, q), 1, 0, turned);
    for (int32_t g = 0; g < border->group_count; g++) {
        const FarCoupling *coupling = &work->block->couplings[first + g];
        const int32_t *rows = border->dofs + border->start[g];
        int64_t here = border->start[g + 1] - border->start[g];
        double *out = term == BULK_STIFFNESS ? coupling->stiffness : coupling->damping;
        double *taken = coupling->before == NO_PATCH ? out : part;
        for (int64_t c = 0; c < q; c++)
            memcpy(taken + c * here, turned + c * count + border->start[g],
                   (size_t)here * sizeof *taken);
        if (coupling->before == NO_PATCH)
            memcpy(coupling->rows, rows, (size_t)here * sizeof *rows);
        else
            TRY(project_rows(work, coupling->before, rows, dense_view(part, here, q), out, err));
    }
cleanup:
    memory_free(values);
    memory_free(turned);
    memory_free(part);
    return error_is_clean(err);
}

static bool list_borders(Building *work, int32_t *couplings, Error *err)
{
    int32_t dofs = work->bulk->dof_count;
    int32_t *seen = NEW_ARRAY(int32_t, dofs, err);
    work->borders = NEW_ARRAY(Border, work->patches.count, err);
    if (!seen || !work->borders) goto cleanup;
    for (int32_t k = 0; k < dofs; k++) seen[k] = -1;
    *couplings = 0;
    for (int32_t p = 0; p < work->patches.count; p++) {
        TRY(list_border(work, p, seen, err));
        *couplings += work->borders[p].group_count;
    }
cleanup:
    memory_free(seen);
    return error_is_clean(err);
}

// Sizes of patches and couplings from the modes that were found.
static void list_sizes(const Building *work)
{
    FarBlock *block = work->block;
    FarCoupling *coupling = block->couplings;
    for (int32_t p = 0; p < block->patch_count; p++) {
        const Border *border = &work->borders[p];
        block->patches[p].size = work->patches.modes[p].size;
        block->patches[p].count = work->patches.modes[p].count;
        for (int32_t g = 0; g < border->group_count; g++, coupling++) {
            coupling->patch = p;
            coupling->before = work->patches.of[border->dofs[border->start[g]]];
            coupling->count = coupling->before == NO_PATCH
                                  ? border->start[g + 1] - border->start[g]
                                  : work->patches.modes[coupling->before].count;
        }
    }
}

static bool fill_block(Building *work, Error *err)
{
    FarBlock *block = work->block;
    int32_t couplings = 0;
    TRY(list_borders(work, &couplings, err));
    block->patch_count = work->patches.count;
    block->patches = NEW_ARRAY(FarPatch, block->patch_count, err);
    block->couplings = NEW_ARRAY(FarCoupling, couplings, err);
    if (!error_is_clean(err)) goto cleanup;
    block->coupling_count = couplings;
    list_sizes(work);
    TRY(lay_out(block, err));
    for (int32_t p = 0; p < block->patch_count; p++) TRY(project(work, p, err));
    for (int32_t p = 0, first = 0; p < block->patch_count; p++) {
        TRY(couple(work, p, first, BULK_STIFFNESS, err));
        TRY(couple(work, p, first, BULK_DAMPING, err));
        first += work->borders[p].group_count;
    }
cleanup:
    return error_is_clean(err);
}

static bool replace(const int32_t *interface_dofs, int32_t m, const FarFieldDef *def,
                    Building *work, Error *err)
{
    FarBlock *block = work->block;
    FarSamples *samples = &block->samples;
    samples->patches = &work->patches;
    TRY(far_samples_take(work->bulk, interface_dofs, m, def, samples, err));
    TRY(fill_block(work, err));
    block->stiffness = samples->stiffness;
    samples->stiffness = NULL;
cleanup:
    samples->patches = NULL;
    return error_is_clean(err);
}

bool far_block_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarBlock *block, Error *err)
{
    Building work = {.bulk = bulk, .block = block};
    *block = (FarBlock){0};
    TRY(far_patches_create(&bulk->pattern, interface_dofs, interface_count, &work.patches, err));
    if (work.patches.count > 0) TRY(replace(interface_dofs, interface_count, def, &work, err));
cleanup:
    // The whole bulk is tried then, and says what is wrong.
    if (err->code == ERROR_COMPUTE) {
        block->patch_count = 0;
        error_clear(err);
    }
    building_destroy(&work);
    if (!error_is_clean(err)) error_context(err, "far from the interface");
    return error_is_clean(err);
}
