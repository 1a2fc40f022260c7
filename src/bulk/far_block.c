// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/far_block.h"

#include "base/dense.h"
#include "base/memory.h"

#include <string.h>

// Elements between the interface and the first layer, and the layers' own depths together; below
// FAR_SHARE of all unknowns nothing is replaced.
enum { FAR_DISTANCE = 20 };
static const double FAR_SHARE = 0.4;

// Unknowns before a layer that share elements with it.
typedef struct Border {
    int32_t count;
    int32_t *dofs;   // ascending; owned
} Border;

typedef struct Building {
    const Bulk *bulk;
    FarBlock *block;
    int32_t *layer, *place;   // [dofs] which layer, -1: near; where in it
    FarMotions motions[FAR_LAYERS_MAX];
} Building;

void far_block_destroy(FarBlock *block)
{
    for (int32_t k = 0; k < FAR_LAYERS_MAX; k++) memory_free(block->layers[k].field);
    memory_free(block->indices);
    memory_free(block->matrices);
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

bool far_block_lay_out(FarBlock *block, Error *err)
{
    FarLayer *layers = block->layers;
    block->index_count = layers[0].coupling.count;
    block->number_count = 0;
    for (int32_t k = 0; k < block->layer_count; k++) {
        int64_t q = layers[k].count;
        block->index_count += layers[k].size;
        block->number_count += 2 * q * (q + 1 + layers[k].coupling.count);
    }
    block->indices = NEW_ARRAY(int32_t, block->index_count, err);
    block->matrices = NEW_ARRAY(double, block->number_count, err);
    if (!block->indices || !block->matrices) return false;
    int32_t *indices = block->indices;
    double *numbers = block->matrices;
    for (int32_t k = 0; k < block->layer_count; k++) {
        FarLayer *layer = &layers[k];
        int64_t q = layer->count, border = layer->coupling.count * q;
        layer->dofs = indices;
        indices += layer->size;
        layer->rotation = take(&numbers, q * q);
        layer->damping = take(&numbers, q * q);
        layer->mass = take(&numbers, q);
        layer->load = take(&numbers, q);
        layer->coupling.stiffness = take(&numbers, border);
        layer->coupling.damping = take(&numbers, border);
    }
    layers[0].coupling.rows = indices;
    return true;
}

static void building_destroy(Building *work)
{
    memory_free(work->layer);
    memory_free(work->place);
    for (int32_t k = 0; k < FAR_LAYERS_MAX; k++) far_motions_destroy(&work->motions[k]);
}

// distance: [size] in elements from the interface, -1: out of reach. *farthest of them.
static bool find_distances(const SparsePattern *pattern, const int32_t *interface_dofs, int32_t m,
                           int32_t *distance, int32_t *farthest, Error *err)
{
    int32_t *list = NEW_ARRAY(int32_t, pattern->size, err), end = 0;
    if (!list) return false;
    for (int32_t k = 0; k < pattern->size; k++) distance[k] = -1;
    for (int32_t j = 0; j < m; j++) {
        distance[interface_dofs[j]] = 0;
        list[end++] = interface_dofs[j];
    }
    for (int32_t at = 0; at < end; at++) {
        *farthest = distance[list[at]];
        for (int32_t k = pattern->start[list[at]]; k < pattern->start[list[at] + 1]; k++) {
            int32_t other = pattern->index[k];
            if (distance[other] >= 0) continue;
            distance[other] = *farthest + 1;
            list[end++] = other;
        }
    }
    memory_free(list);
    return true;
}

// -1: near. A layer that would be thinner than half of its depth belongs to the one before.
static int32_t layer_of(int32_t distance, int32_t farthest)
{
    if (distance >= 0 && distance <= FAR_DISTANCE) return -1;
    int32_t layer = 0, depth = FAR_DISTANCE, end = 2 * FAR_DISTANCE;
    while ((distance < 0 || distance > end) && farthest > end + depth &&
           layer < FAR_LAYERS_MAX - 1) {
        depth *= 2;
        end += depth;
        layer++;
    }
    return layer;
}

// The unknowns of each layer, in the order of the bulk.
static bool divide(const int32_t *interface_dofs, int32_t m, Building *work, Error *err)
{
    FarBlock *block = work->block;
    int32_t dofs = work->bulk->dof_count, farthest = 0, far = 0;
    block->dof_count = dofs;
    work->layer = NEW_ARRAY(int32_t, dofs, err);
    work->place = NEW_ARRAY(int32_t, dofs, err);
    if (!work->layer || !work->place) return false;
    TRY(find_distances(&work->bulk->pattern, interface_dofs, m, work->layer, &farthest, err));
    for (int32_t k = 0; k < dofs; k++) {
        int32_t layer = work->layer[k] = layer_of(work->layer[k], farthest);
        if (layer < 0) continue;
        work->place[k] = work->motions[layer].size++;
        if (layer >= block->layer_count) block->layer_count = layer + 1;
        far++;
    }
    if (far < FAR_SHARE * dofs) block->layer_count = 0;
    for (int32_t k = 0; k < block->layer_count; k++)
        work->motions[k].dofs = NEW_ARRAY(int32_t, work->motions[k].size, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t k = 0; block->layer_count > 0 && k < dofs; k++)
        if (work->layer[k] >= 0) work->motions[work->layer[k]].dofs[work->place[k]] = k;
cleanup:
    return error_is_clean(err);
}

// --- what the matrices are for the motions ------------------------------------------------------

// Rotation F = field * rotation, with which K/E is 1 to rounding and M diagonal: eigenvectors z of
// (L^-1 M L^-T) z = mass z, K/E = L L', and L^-T z.
static bool rotate(double *stiffness, double *mass, int32_t q, double *values, Error *err)
{
    double *work = NEW_ARRAY(double, dense_eigen_work(q), err);
    if (!work) goto cleanup;
    if (!dense_cholesky(stiffness, q)) FAIL(err, ERROR_COMPUTE, "motions are not independent");
    dense_divide_both_sides(stiffness, q, mass);
    if (!dense_eigen(mass, q, values, work)) FAIL(err, ERROR_LIBRARY, "LAPACK: no modes");
    for (int32_t j = 0; j < q; j++)
        dense_lower_solve_transposed(stiffness, q, mass + (int64_t)j * q);
cleanup:
    memory_free(work);
    return error_is_clean(err);
}

static bool project(Building *work, int32_t k, Error *err)
{
    FarLayer *layer = &work->block->layers[k];
    const FarMotions *motions = &work->motions[k];
    int64_t q = motions->count, size = motions->size;
    double *stiffness = NEW_ARRAY(double, q *q, err), *damping = NEW_ARRAY(double, q *q, err);
    double *half = NEW_ARRAY(double, q *q, err), *sum = NEW_ARRAY(double, q, err);
    double *load = NEW_ARRAY(double, size, err);
    if (!error_is_clean(err)) goto cleanup;
    double *const square[] = {
        [BULK_STIFFNESS] = stiffness, [BULK_DAMPING] = damping, [BULK_MASS] = layer->rotation};
    TRY(far_motions_project(motions, work->bulk->mass, square, err));
    TRY(rotate(stiffness, layer->rotation, (int32_t)q, layer->mass, err));
    DenseView rotation = dense_view(layer->rotation, q, q);
    dense_multiply(dense_view(damping, q, q), rotation, 1, 0, half);
    dense_multiply_transposed(rotation, dense_view(half, q, q), 1, 0, layer->damping);
    for (int64_t i = 0; i < size; i++) load[i] = work->bulk->load[motions->dofs[i]];
    dense_apply_transposed(dense_view(motions->field, size, q), load, 1, 0, sum);
    dense_apply_transposed(rotation, sum, 1, 0, layer->load);
cleanup:
    memory_free(stiffness);
    memory_free(damping);
    memory_free(half);
    memory_free(sum);
    memory_free(load);
    return error_is_clean(err);
}

static bool list_border(const Building *work, int32_t k, Border *border, Error *err)
{
    const SparsePattern *pattern = &work->bulk->pattern;
    border->dofs = NEW_ARRAY(int32_t, pattern->size, err);
    if (!border->dofs) return false;
    for (int32_t row = 0; row < pattern->size; row++) {
        if (work->layer[row] != k - 1) continue;
        int32_t at = pattern->start[row], end = pattern->start[row + 1];
        while (at < end && work->layer[pattern->index[at]] != k) at++;
        if (at < end) border->dofs[border->count++] = row;
    }
    return true;
}

// values [border->count * columns]: rows of the bulk's matrix times F of layer k, not rotated.
static void multiply_border(const Building *work, int32_t k, const double *matrix,
                            const Border *border, double *values)
{
    const int32_t *dofs = border->dofs;
    int64_t count = border->count;
    const SparsePattern *pattern = &work->bulk->pattern;
    const FarMotions *motions = &work->motions[k];
    for (int64_t j = 0; j < count; j++) {
        for (int32_t at = pattern->start[dofs[j]]; at < pattern->start[dofs[j] + 1]; at++) {
            if (work->layer[pattern->index[at]] != k) continue;
            const double *moved = motions->field + work->place[pattern->index[at]];
            for (int64_t c = 0; c < motions->count; c++)
                values[c * count + j] += matrix[at] * moved[c * motions->size];
        }
    }
}

// The same with both rotated: of near unknowns, as they are, or of the layer's before.
static bool couple(const Building *work, int32_t k, const double *matrix, const Border *border,
                   double *coupling, Error *err)
{
    const int32_t *dofs = border->dofs;
    int64_t count = border->count;
    const FarLayer *layer = &work->block->layers[k];
    const FarMotions *before = &work->motions[k] - 1;
    int64_t q = work->motions[k].count, p = k == 0 ? count : before->count;
    double *values = NEW_ARRAY(double, count *q, err), *moved = NEW_ARRAY(double, count *p, err);
    double *turned = NEW_ARRAY(double, count *q, err), *half = NEW_ARRAY(double, p *q, err);
    if (!error_is_clean(err)) goto cleanup;
    multiply_border(work, k, matrix, border, values);
    double *out = k == 0 ? coupling : turned;
    dense_multiply(dense_view(values, count, q), dense_view(layer->rotation, q, q), 1, 0, out);
    if (k == 0) goto cleanup;
    for (int64_t c = 0; c < p; c++)
        for (int64_t j = 0; j < count; j++)
            moved[c * count + j] = before->field[c * before->size + work->place[dofs[j]]];
    dense_multiply_transposed(dense_view(moved, count, p), dense_view(turned, count, q), 1, 0,
                              half);
    dense_multiply_transposed(dense_view(layer[-1].rotation, p, p), dense_view(half, p, q), 1, 0,
                              coupling);
cleanup:
    memory_free(values);
    memory_free(moved);
    memory_free(turned);
    memory_free(half);
    return error_is_clean(err);
}

static bool find_coupling(const Building *work, int32_t k, const Border *border, Error *err)
{
    FarCoupling *coupling = &work->block->layers[k].coupling;
    TRY(couple(work, k, work->bulk->stiffness, border, coupling->stiffness, err));
    TRY(couple(work, k, work->bulk->damping, border, coupling->damping, err));
    if (k == 0) memcpy(coupling->rows, border->dofs, (size_t)border->count * sizeof *border->dofs);
cleanup:
    return error_is_clean(err);
}

// Moves the fields of the motions into the layers, when nothing else is asked of them.
static void keep_fields(Building *work)
{
    for (int32_t k = 0; k < work->block->layer_count; k++) {
        work->block->layers[k].field = work->motions[k].field;
        work->motions[k].field = NULL;
    }
}

// Sizes and layers from the motions that were found.
static bool fill_block(Building *work, Error *err)
{
    FarBlock *block = work->block;
    Border borders[FAR_LAYERS_MAX] = {0};
    for (int32_t k = 0; k < block->layer_count; k++) {
        TRY(list_border(work, k, &borders[k], err));
        block->layers[k].size = work->motions[k].size;
        block->layers[k].count = work->motions[k].count;
        block->layers[k].coupling.count = k == 0 ? borders[k].count : work->motions[k - 1].count;
    }
    TRY(far_block_lay_out(block, err));
    for (int32_t k = 0; k < block->layer_count; k++) {
        memcpy(block->layers[k].dofs, work->motions[k].dofs,
               (size_t)work->motions[k].size * sizeof(int32_t));
        TRY(project(work, k, err));
        TRY(find_coupling(work, k, &borders[k], err));
    }
    keep_fields(work);
cleanup:
    for (int32_t k = 0; k < block->layer_count; k++) memory_free(borders[k].dofs);
    return error_is_clean(err);
}

static bool replace(const int32_t *interface_dofs, int32_t m, const FarFieldDef *def,
                    Building *work, Error *err)
{
    FarBlock *block = work->block;
    FarMotions *layers[FAR_LAYERS_MAX];
    FarSamples *samples = &block->samples;
    samples->distance = FAR_DISTANCE;
    samples->layer_count = block->layer_count;
    samples->layers = layers;
    for (int32_t k = 0; k < block->layer_count; k++) layers[k] = &work->motions[k];
    TRY(far_samples_take(work->bulk, interface_dofs, m, def, samples, err));
    TRY(fill_block(work, err));
    block->stiffness = samples->stiffness;
    samples->stiffness = NULL;
cleanup:
    samples->layers = NULL;
    return error_is_clean(err);
}

bool far_block_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarBlock *block, Error *err)
{
    Building work = {.bulk = bulk, .block = block};
    *block = (FarBlock){0};
    TRY(divide(interface_dofs, interface_count, &work, err));
    if (block->layer_count > 0) TRY(replace(interface_dofs, interface_count, def, &work, err));
cleanup:
    // The whole bulk is tried then, and says what is wrong.
    if (err->code == ERROR_COMPUTE) {
        block->layer_count = 0;
        error_clear(err);
    }
    building_destroy(&work);
    if (!error_is_clean(err)) error_context(err, "far from the interface");
    return error_is_clean(err);
}
