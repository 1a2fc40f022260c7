// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/far_field.h"

#include "base/dense.h"
#include "base/memory.h"

// Of what is allowed: a larger error of S and all is done on the whole bulk.
static const double ERROR_MAX = 0.15;

enum { FAR = -1 };

typedef struct Filling {
    const Bulk *mesh;
    FarField *far;
    double unit;   // E
    int32_t *place;   // [dofs of the mesh] among the near ones; FAR
    int32_t *cursor;   // [dofs of the bulk] where the next entry of a row goes
} Filling;

void far_field_destroy(FarField *far)
{
    bulk_operator_destroy(&far->system);
    bulk_destroy(&far->bulk);
    memory_free(far->near);
    memory_free(far->first);
    *far = (FarField){0};
}

static bool divide(Filling *work, Error *err)
{
    FarField *far = work->far;
    const FarBlock *block = far->block;
    int32_t dofs = far->mesh_dofs = work->mesh->dof_count;
    work->place = NEW_ARRAY(int32_t, dofs, err);
    far->near = NEW_ARRAY(int32_t, dofs, err);
    far->first = NEW_ARRAY(int32_t, block->patch_count + 1, err);
    if (!error_is_clean(err)) return false;
    for (int32_t p = 0; p < block->patch_count; p++)
        for (int32_t i = 0; i < block->patches[p].size; i++)
            work->place[block->patches[p].dofs[i]] = FAR;
    for (int32_t dof = 0; dof < dofs; dof++) {
        if (work->place[dof] == FAR) continue;
        work->place[dof] = far->near_count;
        far->near[far->near_count++] = dof;
    }
    far->first[0] = far->near_count;
    for (int32_t p = 0; p < block->patch_count; p++)
        far->first[p + 1] = far->first[p] + block->patches[p].count;
    return true;
}

// Where row i of a coupling stands among the unknowns.
static int32_t row_of(const Filling *work, const FarCoupling *coupling, int64_t i)
{
    if (coupling->before == NO_PATCH) return work->place[coupling->rows[i]];
    return work->far->first[coupling->before] + (int32_t)i;
}

// Entries of each row, in pattern.start[row + 1].
static void count_entries(const Filling *work)
{
    const FarField *far = work->far;
    const FarBlock *block = far->block;
    const SparsePattern *from = &work->mesh->pattern;
    int32_t *count = far->bulk.pattern.start + 1;
    for (int32_t i = 0; i < far->near_count; i++)
        for (int32_t at = from->start[far->near[i]]; at < from->start[far->near[i] + 1]; at++)
            count[i] += work->place[from->index[at]] != FAR;
    for (int32_t p = 0; p < block->patch_count; p++)
        for (int32_t c = far->first[p]; c < far->first[p + 1]; c++)
            count[c] += block->patches[p].count;
    for (int32_t k = 0; k < block->coupling_count; k++) {
        const FarCoupling *coupling = &block->couplings[k];
        int32_t p = coupling->patch;
        for (int32_t i = 0; i < coupling->count; i++)
            count[row_of(work, coupling, i)] += block->patches[p].count;
        for (int32_t c = far->first[p]; c < far->first[p + 1]; c++) count[c] += coupling->count;
    }
}

static bool make_room(Filling *work, Error *err)
{
    Bulk *bulk = &work->far->bulk;
    int64_t size = work->far->first[work->far->block->patch_count], entries = 0;
    *bulk = (Bulk){.dof_count = (int32_t)size,
                   .pattern = {.size = (int32_t)size, .start = NEW_ARRAY(int32_t, size + 1, err)},
                   .mass = NEW_ARRAY(double, size, err),
                   .load = NEW_ARRAY(double, size, err),
                   .held = NEW_ARRAY(uint8_t, size, err),
                   .area = work->mesh->area};
    work->cursor = NEW_ARRAY(int32_t, size, err);
    if (!error_is_clean(err)) goto cleanup;
    count_entries(work);
    for (int64_t i = 0; i < size; i++) {
        work->cursor[i] = (int32_t)entries;
        entries += bulk->pattern.start[i + 1];
        if (entries > INT32_MAX) FAIL(err, ERROR_COMPUTE, "too many modes are left");
        bulk->pattern.start[i + 1] = (int32_t)entries;
    }
    bulk->pattern.index = NEW_ARRAY(int32_t, entries, err);
    bulk->stiffness = NEW_ARRAY(double, entries, err);
    bulk->damping = NEW_ARRAY(double, entries, err);
cleanup:
    return error_is_clean(err);
}

static void add_entry(Filling *work, int32_t row, int32_t column, double stiffness, double damping)
{
    Bulk *bulk = &work->far->bulk;
    int32_t at = work->cursor[row]++;
    bulk->pattern.index[at] = column;
    bulk->stiffness[at] = stiffness;
    bulk->damping[at] = damping;
}

static void fill_near(Filling *work)
{
    const Bulk *from = work->mesh;
    Bulk *bulk = &work->far->bulk;
    for (int32_t i = 0; i < work->far->near_count; i++) {
        int32_t row = work->far->near[i];
        for (int32_t at = from->pattern.start[row]; at < from->pattern.start[row + 1]; at++) {
            int32_t column = work->place[from->pattern.index[at]];
            if (column != FAR) add_entry(work, i, column, from->stiffness[at], from->damping[at]);
        }
        bulk->mass[i] = from->mass[row];
        bulk->load[i] = from->load[row];
        bulk->held[i] = from->held[row];
    }
}

// A block above the diagonal (rows before columns) or what faces it below.
static void fill_coupling(Filling *work, const FarCoupling *coupling, bool above)
{
    const FarField *far = work->far;
    int64_t count = coupling->count;
    int32_t first = far->first[coupling->patch], end = far->first[coupling->patch + 1];
    for (int32_t i = 0; i < coupling->count; i++) {
        int32_t row = row_of(work, coupling, i);
        for (int32_t c = first; c < end; c++) {
            int64_t at = (c - first) * count + i;
            add_entry(work, above ? row : c, above ? c : row, coupling->stiffness[at],
                      coupling->damping[at]);
        }
    }
}

static void fill_patch(Filling *work, int32_t p)
{
    const FarPatch *patch = &work->far->block->patches[p];
    Bulk *bulk = &work->far->bulk;
    int64_t q = patch->count;
    int32_t first = work->far->first[p];
    for (int64_t c = 0; c < q; c++) {
        int32_t row = first + (int32_t)c;
        for (int64_t d = 0; d < q; d++)
            add_entry(work, row, first + (int32_t)d, d == c ? work->unit : 0,
                      (patch->damping[c * q + d] + patch->damping[d * q + c]) / 2);
        bulk->mass[row] = patch->mass[c];
        bulk->load[row] = patch->load[c];
    }
}

// Columns of each row ascend: near ones first, then those of patch after patch.
static bool fill(Filling *work, Error *err)
{
    const FarBlock *block = work->far->block;
    if (!make_room(work, err)) return false;
    fill_near(work);
    // Below the diagonal each row is its patch's own, and its couplings stand in order.
    for (int32_t k = 0; k < block->coupling_count; k++)
        fill_coupling(work, &block->couplings[k], false);
    for (int32_t p = 0, k = 0; p < block->patch_count; p++) {
        fill_patch(work, p);
        for (; k < block->coupling_count && block->couplings[k].patch == p; k++)
            fill_coupling(work, &block->couplings[k], true);
    }
    return true;
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
    memory_free(work.cursor);
    return error_is_clean(err);
}

bool far_field_measure(FarField *far, FarBlock *block, Error *err)
{
    bool done = far_samples_compare(&block->samples, &far->system, &block->error, err);
    // The whole bulk is tried then, and says what is wrong.
    if (err->code == ERROR_COMPUTE) error_clear(err);
    if (!done || !(block->error < ERROR_MAX)) block->patch_count = 0;
    return error_is_clean(err);
}

bool far_field_expand(const FarField *far, const double *reduced, int32_t columns, double *full,
                      Error *err)
{
    int64_t dofs = far->bulk.dof_count, mesh = far->mesh_dofs;
    double *turned = NULL, *fields = NULL;
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < far->near_count; i++)
            full[j * mesh + far->near[i]] = reduced[j * dofs + i];
    for (int32_t p = 0; p < far->block->patch_count; p++) {
        const FarPatch *patch = &far->block->patches[p];
        memory_free(turned);
        memory_free(fields);
        turned = NEW_ARRAY(double, (int64_t)patch->count *columns, err);
        fields = NEW_ARRAY(double, (int64_t)patch->size *columns, err);
        if (!turned || !fields) goto cleanup;
        dense_multiply_rows(dense_view(patch->rotation, patch->count, patch->count),
                            reduced + far->first[p], dofs, columns, 1, turned);
        dense_multiply(dense_view(patch->field, patch->size, patch->count),
                       dense_view(turned, patch->count, columns), 1, 0, fields);
        for (int64_t j = 0; j < columns; j++)
            for (int64_t i = 0; i < patch->size; i++)
                full[j * mesh + patch->dofs[i]] = fields[j * patch->size + i];
    }
cleanup:
    memory_free(turned);
    memory_free(fields);
    return error_is_clean(err);
}
