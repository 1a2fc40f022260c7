// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/far_field.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// Elements between the interface and the first layer, and the layers' own depths together; below
// FAR_SHARE of all unknowns nothing is replaced.
enum { FAR_DISTANCE = 20 };
static const double FAR_SHARE = 0.4;

// Of what is allowed: a larger error of S and all is done on the whole mesh.
static const double ERROR_MAX = 0.15;

// Between the near unknowns, or a layer, and the layer beyond.
typedef struct Coupling {
    int32_t count;
    int32_t *rows;   // [count] unknowns of the bulk that is left, ascending; owned, as what follows
    double *stiffness, *damping;   // [count * coordinates of the layer beyond]
} Coupling;

// Unknowns of the mesh before a layer that share elements with it.
typedef struct Border {
    int32_t count;
    int32_t *dofs;   // ascending; owned
} Border;

// What K and C make of it.
typedef struct Assembly {
    const Bulk *mesh;
    FarField *far;
    double unit;   // E
    int32_t *layer, *place;   // [dofs of the mesh] which layer, -1: near; where in it
    double *damping[FAR_LAYERS_MAX], *mass[FAR_LAYERS_MAX], *load[FAR_LAYERS_MAX];
    Coupling couplings[FAR_LAYERS_MAX];   // between it and what is before it
} Assembly;

void far_field_destroy(FarField *far)
{
    bulk_operator_destroy(&far->system);
    bulk_destroy(&far->bulk);
    memory_free(far->near);
    memory_free(far->stiffness);
    for (int32_t k = 0; k < FAR_LAYERS_MAX; k++) {
        far_motions_destroy(&far->layers[k].motions);
        memory_free(far->layers[k].rotation);
    }
    *far = (FarField){0};
}

static void assembly_destroy(Assembly *work)
{
    memory_free(work->layer);
    memory_free(work->place);
    for (int32_t k = 0; k < FAR_LAYERS_MAX; k++) {
        memory_free(work->damping[k]);
        memory_free(work->mass[k]);
        memory_free(work->load[k]);
        memory_free(work->couplings[k].rows);
        memory_free(work->couplings[k].stiffness);
        memory_free(work->couplings[k].damping);
    }
}

// --- layers -------------------------------------------------------------------------------------

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

static bool divide(const int32_t *interface_dofs, int32_t m, Assembly *work, Error *err)
{
    FarField *far = work->far;
    int32_t dofs = work->mesh->dof_count, farthest = 0;
    far->mesh_dofs = dofs;
    work->layer = NEW_ARRAY(int32_t, dofs, err);
    work->place = NEW_ARRAY(int32_t, dofs, err);
    far->near = NEW_ARRAY(int32_t, dofs, err);
    if (!work->layer || !work->place || !far->near) return false;
    TRY(find_distances(&work->mesh->pattern, interface_dofs, m, work->layer, &farthest, err));
    for (int32_t k = 0; k < dofs; k++) {
        int32_t layer = work->layer[k] = layer_of(work->layer[k], farthest);
        work->place[k] = layer < 0 ? far->near_count : far->layers[layer].motions.size++;
        if (layer < 0) far->near[far->near_count++] = k;
        if (layer >= far->layer_count) far->layer_count = layer + 1;
    }
    if (dofs - far->near_count < FAR_SHARE * dofs) far->layer_count = 0;
    for (int32_t k = 0; k < far->layer_count; k++) {
        FarMotions *motions = &far->layers[k].motions;
        motions->dofs = NEW_ARRAY(int32_t, motions->size, err);
    }
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t k = 0; far->layer_count > 0 && k < dofs; k++)
        if (work->layer[k] >= 0) far->layers[work->layer[k]].motions.dofs[work->place[k]] = k;
cleanup:
    return error_is_clean(err);
}

// --- the bulk that is left ----------------------------------------------------------------------

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

static bool project(Assembly *work, int32_t k, Error *err)
{
    FarLayer *layer = &work->far->layers[k];
    const FarMotions *motions = &layer->motions;
    int64_t q = motions->count, size = motions->size;
    double *stiffness = NEW_ARRAY(double, q *q, err), *damping = NEW_ARRAY(double, q *q, err);
    double *half = NEW_ARRAY(double, q *q, err), *sum = NEW_ARRAY(double, q, err);
    double *load = NEW_ARRAY(double, size, err);
    layer->rotation = NEW_ARRAY(double, q *q, err);
    work->mass[k] = NEW_ARRAY(double, q, err);
    work->damping[k] = NEW_ARRAY(double, q *q, err);
    work->load[k] = NEW_ARRAY(double, q, err);
    if (!error_is_clean(err)) goto cleanup;
    double *const square[] = {
        [BULK_STIFFNESS] = stiffness, [BULK_DAMPING] = damping, [BULK_MASS] = layer->rotation};
    TRY(far_motions_project(motions, work->mesh->mass, square, err));
    TRY(rotate(stiffness, layer->rotation, (int32_t)q, work->mass[k], err));
    DenseView rotation = dense_view(layer->rotation, q, q);
    dense_multiply(dense_view(damping, q, q), rotation, 1, 0, half);
    dense_multiply_transposed(rotation, dense_view(half, q, q), 1, 0, work->damping[k]);
    for (int64_t i = 0; i < size; i++) load[i] = work->mesh->load[motions->dofs[i]];
    dense_apply_transposed(dense_view(motions->field, size, q), load, 1, 0, sum);
    dense_apply_transposed(rotation, sum, 1, 0, work->load[k]);
cleanup:
    memory_free(stiffness);
    memory_free(damping);
    memory_free(half);
    memory_free(sum);
    memory_free(load);
    return error_is_clean(err);
}

static bool list_border(const Assembly *work, int32_t k, Border *border, Error *err)
{
    const SparsePattern *pattern = &work->mesh->pattern;
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

// values [border->count * columns]: rows of the matrix of the mesh times F of layer k, not rotated.
static void multiply_border(const Assembly *work, int32_t k, const double *matrix,
                            const Border *border, double *values)
{
    const int32_t *dofs = border->dofs;
    int64_t count = border->count;
    const SparsePattern *pattern = &work->mesh->pattern;
    const FarMotions *motions = &work->far->layers[k].motions;
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
static bool couple(const Assembly *work, int32_t k, const double *matrix, const Border *border,
                   double **coupling, Error *err)
{
    const int32_t *dofs = border->dofs;
    int64_t count = border->count;
    const FarLayer *layer = &work->far->layers[k], *before = layer - 1;
    int64_t q = layer->motions.count, p = k == 0 ? count : before->motions.count;
    double *values = NEW_ARRAY(double, count *q, err), *moved = NEW_ARRAY(double, count *p, err);
    double *turned = NEW_ARRAY(double, count *q, err), *half = NEW_ARRAY(double, p *q, err);
    *coupling = NEW_ARRAY(double, p *q, err);
    if (!error_is_clean(err)) goto cleanup;
    multiply_border(work, k, matrix, border, values);
    double *out = k == 0 ? *coupling : turned;
    dense_multiply(dense_view(values, count, q), dense_view(layer->rotation, q, q), 1, 0, out);
    if (k == 0) goto cleanup;
    for (int64_t c = 0; c < p; c++)
        for (int64_t j = 0; j < count; j++)
            moved[c * count + j] =
                before->motions.field[c * before->motions.size + work->place[dofs[j]]];
    dense_multiply_transposed(dense_view(moved, count, p), dense_view(turned, count, q), 1, 0,
                              half);
    dense_multiply_transposed(dense_view(before->rotation, p, p), dense_view(half, p, q), 1, 0,
                              *coupling);
cleanup:
    memory_free(values);
    memory_free(moved);
    memory_free(turned);
    memory_free(half);
    return error_is_clean(err);
}

static bool find_coupling(Assembly *work, int32_t k, Error *err)
{
    Coupling *coupling = &work->couplings[k];
    const FarLayer *before = &work->far->layers[k] - 1;
    Border border = {0};
    TRY(list_border(work, k, &border, err));
    coupling->count = k == 0 ? border.count : before->motions.count;
    coupling->rows = NEW_ARRAY(int32_t, coupling->count, err);
    if (!coupling->rows) goto cleanup;
    for (int32_t j = 0; j < coupling->count; j++)
        coupling->rows[j] = k == 0 ? work->place[border.dofs[j]] : before->first + j;
    TRY(couple(work, k, work->mesh->stiffness, &border, &coupling->stiffness, err));
    TRY(couple(work, k, work->mesh->damping, &border, &coupling->damping, err));
cleanup:
    memory_free(border.dofs);
    return error_is_clean(err);
}

static void add_entry(int32_t column, double stiffness, double damping, int32_t *filled, Bulk *bulk)
{
    bulk->pattern.index[*filled] = column;
    bulk->stiffness[*filled] = stiffness;
    bulk->damping[(*filled)++] = damping;
}

// Row j of a coupling: with all coordinates of layer k.
static void add_row(const Assembly *work, int32_t k, int64_t j, int32_t *filled, Bulk *bulk)
{
    const Coupling *coupling = &work->couplings[k];
    const FarLayer *layer = &work->far->layers[k];
    for (int64_t c = 0; c < layer->motions.count; c++)
        add_entry(layer->first + (int32_t)c, coupling->stiffness[c * coupling->count + j],
                  coupling->damping[c * coupling->count + j], filled, bulk);
}

static int32_t fill_near(const Assembly *work, Bulk *bulk)
{
    const Bulk *from = work->mesh;
    const Coupling *coupling = &work->couplings[0];
    int32_t filled = 0, next = 0;
    for (int32_t i = 0; i < work->far->near_count; i++) {
        int32_t row = work->far->near[i];
        for (int32_t at = from->pattern.start[row]; at < from->pattern.start[row + 1]; at++) {
            int32_t column = from->pattern.index[at];
            if (work->layer[column] < 0)
                add_entry(work->place[column], from->stiffness[at], from->damping[at], &filled,
                          bulk);
        }
        if (next < coupling->count && coupling->rows[next] == i)
            add_row(work, 0, next++, &filled, bulk);
        bulk->pattern.start[i + 1] = filled;
        bulk->mass[i] = from->mass[row];
        bulk->load[i] = from->load[row];
        bulk->held[i] = from->held[row];
    }
    return filled;
}

static void fill_layer(const Assembly *work, int32_t k, int32_t *filled, Bulk *bulk)
{
    const FarLayer *layer = &work->far->layers[k];
    const Coupling *coupling = &work->couplings[k];
    int64_t q = layer->motions.count;
    for (int64_t c = 0; c < q; c++) {
        int32_t row = layer->first + (int32_t)c;
        for (int64_t j = 0; j < coupling->count; j++)
            add_entry(coupling->rows[j], coupling->stiffness[c * coupling->count + j],
                      coupling->damping[c * coupling->count + j], filled, bulk);
        for (int64_t d = 0; d < q; d++)
            add_entry(layer->first + (int32_t)d, d == c ? work->unit : 0,
                      (work->damping[k][c * q + d] + work->damping[k][d * q + c]) / 2, filled,
                      bulk);
        if (k + 1 < work->far->layer_count) add_row(work, k + 1, c, filled, bulk);
        bulk->pattern.start[row + 1] = *filled;
        bulk->mass[row] = work->mass[k][c];
        bulk->load[row] = work->load[k][c];
    }
}

static bool build_bulk(Assembly *work, Error *err)
{
    FarField *far = work->far;
    Bulk *bulk = &far->bulk;
    int64_t size = far->near_count;
    int64_t entries = work->mesh->pattern.start[work->mesh->dof_count];   // at most, of those near
    for (int32_t k = 0; k < far->layer_count; k++) {
        int64_t q = far->layers[k].motions.count;
        far->layers[k].first = (int32_t)size;
        size += q;
        TRY(project(work, k, err));
        TRY(find_coupling(work, k, err));
        entries += q * (2 * work->couplings[k].count + q);
    }
    *bulk = (Bulk){.dof_count = (int32_t)size,
                   .pattern = {.size = (int32_t)size,
                               .start = NEW_ARRAY(int32_t, size + 1, err),
                               .index = NEW_ARRAY(int32_t, entries, err)},
                   .stiffness = NEW_ARRAY(double, entries, err),
                   .damping = NEW_ARRAY(double, entries, err),
                   .mass = NEW_ARRAY(double, size, err),
                   .load = NEW_ARRAY(double, size, err),
                   .held = NEW_ARRAY(uint8_t, size, err),
                   .area = work->mesh->area};
    if (!error_is_clean(err)) goto cleanup;
    int32_t filled = fill_near(work, bulk);
    for (int32_t k = 0; k < far->layer_count; k++) fill_layer(work, k, &filled, bulk);
cleanup:
    return error_is_clean(err);
}

static bool replace(const int32_t *interface_dofs, int32_t m, const FarFieldDef *def,
                    Assembly *work, Error *err)
{
    FarField *far = work->far;
    FarMotions *layers[FAR_LAYERS_MAX];
    FarSamples samples = {
        .distance = FAR_DISTANCE, .layer_count = far->layer_count, .layers = layers};
    for (int32_t k = 0; k < far->layer_count; k++) layers[k] = &far->layers[k].motions;
    int32_t *place = NEW_ARRAY(int32_t, m, err);
    if (!place) goto cleanup;
    TRY(far_samples_take(work->mesh, interface_dofs, m, def, &samples, err));
    TRY(build_bulk(work, err));
    for (int32_t j = 0; j < m; j++) place[j] = work->place[interface_dofs[j]];
    TRY(bulk_operator_create(&far->bulk, NULL, place, m, &far->system, err));
    far->stiffness = samples.stiffness;
    samples.stiffness = NULL;
    TRY(far_samples_compare(&samples, &far->system, &far->error, err));
    if (!(far->error < ERROR_MAX)) far->layer_count = 0;
cleanup:
    memory_free(place);
    far_samples_destroy(&samples);
    return error_is_clean(err);
}

bool far_field_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarField *far, Error *err)
{
    Assembly work = {.mesh = bulk, .far = far, .unit = def->scales.stiffness};
    *far = (FarField){0};
    TRY(divide(interface_dofs, interface_count, &work, err));
    if (far->layer_count > 0) TRY(replace(interface_dofs, interface_count, def, &work, err));
cleanup:
    // The whole mesh is tried then, and says what is wrong.
    if (err->code == ERROR_COMPUTE) {
        far->layer_count = 0;
        error_clear(err);
    }
    assembly_destroy(&work);
    if (!error_is_clean(err)) error_context(err, "far from the interface");
    return error_is_clean(err);
}

bool far_field_expand(const FarField *far, const double *motions, int32_t columns, double *full,
                      Error *err)
{
    int64_t dofs = far->bulk.dof_count, mesh = far->mesh_dofs;
    double *turned = NULL, *fields = NULL;
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < far->near_count; i++)
            full[j * mesh + far->near[i]] = motions[j * dofs + i];
    for (int32_t k = 0; k < far->layer_count; k++) {
        const FarLayer *layer = &far->layers[k];
        const FarMotions *of = &layer->motions;
        memory_free(turned);
        memory_free(fields);
        turned = NEW_ARRAY(double, (int64_t)of->count *columns, err);
        fields = NEW_ARRAY(double, (int64_t)of->size *columns, err);
        if (!turned || !fields) goto cleanup;
        dense_multiply_rows(dense_view(layer->rotation, of->count, of->count),
                            motions + layer->first, dofs, columns, 1, turned);
        dense_multiply(dense_view(of->field, of->size, of->count),
                       dense_view(turned, of->count, columns), 1, 0, fields);
        for (int64_t j = 0; j < columns; j++)
            for (int64_t i = 0; i < of->size; i++)
                full[j * mesh + of->dofs[i]] = fields[j * of->size + i];
    }
cleanup:
    memory_free(turned);
    memory_free(fields);
    return error_is_clean(err);
}
