// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/far_field.h"

#include "base/dense.h"
#include "base/memory.h"

// Of what is allowed: a larger error of S and all is done on the whole bulk.
static const double ERROR_MAX = 0.15;

enum { FAR = -1, BESIDE = -1 };

typedef struct Filling {
    const Bulk *mesh;
    FarField *far;
    double unit;   // E
    int32_t *place;   // [dofs of the mesh] among the near ones; FAR
    int32_t *row_of;   // [near_count] of the coupling with the first layer; BESIDE: none
    int32_t *border;   // near ones that have such a row, ascending
    int32_t filled;   // entries of the bulk
} Filling;

void far_field_destroy(FarField *far)
{
    bulk_operator_destroy(&far->system);
    bulk_destroy(&far->bulk);
    memory_free(far->near);
    *far = (FarField){0};
}

static int32_t dof_of(const FarField *far, int32_t dof)
{
    return far->dofs ? far->dofs[dof] : dof;
}

static bool divide(Filling *work, Error *err)
{
    FarField *far = work->far;
    const FarBlock *block = far->block;
    int32_t dofs = far->mesh_dofs = work->mesh->dof_count;
    work->place = NEW_ARRAY(int32_t, dofs, err);
    far->near = NEW_ARRAY(int32_t, dofs, err);
    work->row_of = NEW_ARRAY(int32_t, dofs, err);
    work->border = NEW_ARRAY(int32_t, block->layers[0].coupling.count, err);
    if (!work->place || !far->near || !work->row_of || !work->border) return false;
    for (int32_t k = 0; k < block->layer_count; k++)
        for (int32_t i = 0; i < block->layers[k].size; i++)
            work->place[dof_of(far, block->layers[k].dofs[i])] = FAR;
    for (int32_t dof = 0; dof < dofs; dof++) {
        if (work->place[dof] == FAR) continue;
        work->place[dof] = far->near_count;
        work->row_of[far->near_count] = BESIDE;
        far->near[far->near_count++] = dof;
    }
    const FarCoupling *coupling = &block->layers[0].coupling;
    for (int32_t j = 0; j < coupling->count; j++)
        work->row_of[work->place[dof_of(far, coupling->rows[j])]] = j;
    for (int32_t i = 0, j = 0; i < far->near_count; i++)
        if (work->row_of[i] != BESIDE) work->border[j++] = i;
    return true;
}

static void add_entry(int32_t column, double stiffness, double damping, Filling *work)
{
    Bulk *bulk = &work->far->bulk;
    bulk->pattern.index[work->filled] = column;
    bulk->stiffness[work->filled] = stiffness;
    bulk->damping[work->filled++] = damping;
}

// Row j of a coupling: with all coordinates of layer k.
static void add_row(int32_t k, int64_t j, Filling *work)
{
    const FarLayer *layer = &work->far->block->layers[k];
    const FarCoupling *coupling = &layer->coupling;
    for (int64_t c = 0; c < layer->count; c++)
        add_entry(work->far->first[k] + (int32_t)c, coupling->stiffness[c * coupling->count + j],
                  coupling->damping[c * coupling->count + j], work);
}

static void fill_near(Filling *work)
{
    const Bulk *from = work->mesh;
    Bulk *bulk = &work->far->bulk;
    for (int32_t i = 0; i < work->far->near_count; i++) {
        int32_t row = work->far->near[i];
        for (int32_t at = from->pattern.start[row]; at < from->pattern.start[row + 1]; at++) {
            int32_t column = work->place[from->pattern.index[at]];
            if (column != FAR) add_entry(column, from->stiffness[at], from->damping[at], work);
        }
        if (work->row_of[i] != BESIDE) add_row(0, work->row_of[i], work);
        bulk->pattern.start[i + 1] = work->filled;
        bulk->mass[i] = from->mass[row];
        bulk->load[i] = from->load[row];
        bulk->held[i] = from->held[row];
    }
}

// Row c of a layer, columns ascending.
static void add_layer_row(int32_t k, int64_t c, Filling *work)
{
    const FarField *far = work->far;
    const FarLayer *layer = &far->block->layers[k];
    const FarCoupling *coupling = &layer->coupling;
    int64_t q = layer->count;
    for (int32_t j = 0; j < coupling->count; j++) {
        int64_t at = c * coupling->count + (k == 0 ? work->row_of[work->border[j]] : j);
        add_entry(k == 0 ? work->border[j] : far->first[k - 1] + j, coupling->stiffness[at],
                  coupling->damping[at], work);
    }
    for (int64_t d = 0; d < q; d++)
        add_entry(far->first[k] + (int32_t)d, d == c ? work->unit : 0,
                  (layer->damping[c * q + d] + layer->damping[d * q + c]) / 2, work);
    if (k + 1 < far->block->layer_count) add_row(k + 1, c, work);
}

static void fill_layer(int32_t k, Filling *work)
{
    const FarLayer *layer = &work->far->block->layers[k];
    Bulk *bulk = &work->far->bulk;
    for (int64_t c = 0; c < layer->count; c++) {
        int32_t row = work->far->first[k] + (int32_t)c;
        add_layer_row(k, c, work);
        bulk->pattern.start[row + 1] = work->filled;
        bulk->mass[row] = layer->mass[c];
        bulk->load[row] = layer->load[c];
    }
}

static bool fill(Filling *work, Error *err)
{
    FarField *far = work->far;
    Bulk *bulk = &far->bulk;
    int64_t size = far->near_count;
    int64_t entries = work->mesh->pattern.start[work->mesh->dof_count];   // at most, of those near
    for (int32_t k = 0; k < far->block->layer_count; k++) {
        const FarLayer *layer = &far->block->layers[k];
        int64_t q = layer->count;
        far->first[k] = (int32_t)size;
        size += q;
        entries += q * (2 * layer->coupling.count + q);
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
    fill_near(work);
    for (int32_t k = 0; k < far->block->layer_count; k++) fill_layer(k, work);
cleanup:
    return error_is_clean(err);
}

bool far_field_create(const Bulk *mesh, const int32_t *interface_dofs, int32_t interface_count,
                      double unit, FarField *far, Error *err)
{
    Filling work = {.mesh = mesh, .far = far, .unit = unit};
    int32_t *dofs = NEW_ARRAY(int32_t, interface_count, err);
    if (!dofs) goto cleanup;
    TRY(divide(&work, err));
    TRY(fill(&work, err));
    for (int32_t j = 0; j < interface_count; j++) dofs[j] = work.place[interface_dofs[j]];
    TRY(bulk_operator_create(&far->bulk, NULL, dofs, interface_count, &far->system, err));
cleanup:
    memory_free(dofs);
    memory_free(work.place);
    memory_free(work.row_of);
    memory_free(work.border);
    return error_is_clean(err);
}

bool far_field_measure(FarField *far, FarBlock *block, Error *err)
{
    bool done = far_samples_compare(&block->samples, &far->system, &block->error, err);
    // The whole bulk is tried then, and says what is wrong.
    if (err->code == ERROR_COMPUTE) error_clear(err);
    if (!done || !(block->error < ERROR_MAX)) block->layer_count = 0;
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
    for (int32_t k = 0; k < far->block->layer_count; k++) {
        const FarLayer *layer = &far->block->layers[k];
        memory_free(turned);
        memory_free(fields);
        turned = NEW_ARRAY(double, (int64_t)layer->count *columns, err);
        fields = NEW_ARRAY(double, (int64_t)layer->size *columns, err);
        if (!turned || !fields) goto cleanup;
        dense_multiply_rows(dense_view(layer->rotation, layer->count, layer->count),
                            motions + far->first[k], dofs, columns, 1, turned);
        dense_multiply(dense_view(layer->field, layer->size, layer->count),
                       dense_view(turned, layer->count, columns), 1, 0, fields);
        for (int64_t j = 0; j < columns; j++)
            for (int64_t i = 0; i < layer->size; i++)
                full[j * mesh + dof_of(far, layer->dofs[i])] = fields[j * layer->size + i];
    }
cleanup:
    memory_free(turned);
    memory_free(fields);
    return error_is_clean(err);
}
