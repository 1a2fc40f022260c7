// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/far_field.h"

#include "algebra/dense.h"
#include "base/memory.h"

// Part of the allowed error: with a larger error of S all is done on the whole bulk.
static const double ERROR_MAX = 0.15;

void far_field_destroy(FarField *far)
{
    bulk_operator_destroy(&far->system);
    bulk_destroy(&far->bulk);
    transform_destroy(&far->modes);
    memory_free(far->stiffness);
    *far = (FarField){0};
}

// As modes with which K/E is 1 and M diagonal.
static bool append_patch(const Bulk *mesh, const PatchModes *modes, Transform *by, Error *err)
{
    int64_t q = modes->count, size = modes->size;
    double *work = NEW_ARRAY(double, DENSE_EIGEN_WORK(modes->count), err);
    double *values = NEW_ARRAY(double, q, err);
    double *stiffness = NEW_ARRAY(double, q *q, err), *mass = NEW_ARRAY(double, q *q, err);
    double *turned = NEW_ARRAY(double, size *q, err);
    if (!error_is_clean(err)) goto cleanup;
    DenseView field = dense_view(modes->field, size, q), whole = dense_view(turned, size, q);
    dense_multiply_transposed(field, dense_view(modes->image, size, q), 1, 0, stiffness);
    for (int64_t j = 0; j < q; j++)
        for (int64_t i = 0; i < size; i++)
            turned[j * size + i] = mesh->mass[modes->dofs[i]] * modes->field[j * size + i];
    dense_multiply_transposed(field, whole, 1, 0, mass);
    if (!dense_eigen_pair(mass, stiffness, modes->count, values, work))
        FAIL(err, ERROR_COMPUTE, "modes are not independent");
    dense_multiply(field, dense_view(mass, q, q), 1, 0, turned);
    dense_transpose(whole, transform_append(by, modes->dofs, modes->size, modes->count), q);
cleanup:
    memory_free_all(work, values, stiffness, mass, turned);
    return error_is_clean(err);
}

bool far_field_create(const Bulk *mesh, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarField *far, Error *err)
{
    FarPatches patches = {0};
    FarSamples samples = {.patches = &patches};
    BulkOperator whole = {0};
    int32_t *dofs = NEW_ARRAY(int32_t, interface_count, err);
    *far = (FarField){0};
    if (!dofs) goto cleanup;
    TRY(far_patches_create(&mesh->pattern, interface_dofs, interface_count, &patches, err));
    if (patches.count == 0) goto cleanup;
    TRY(bulk_operator_create(mesh, NULL, interface_dofs, interface_count, &whole, err));
    bool taken = far_samples_take(&whole, def, &samples, err);
    far->stiffness = samples.stiffness;
    far->slowest = samples.slowest;
    if (!taken) goto cleanup;

    // Near unknowns as they are, then each patch's modes.
    int64_t entries = mesh->dof_count;
    for (int32_t p = 0; p < patches.count; p++)
        entries += (int64_t)patches.modes[p].size * patches.modes[p].count;
    TRY(transform_create(mesh->dof_count, mesh->dof_count, entries, &far->modes, err));
    for (int32_t dof = 0; dof < mesh->dof_count; dof++)
        if (patches.of[dof] == NO_PATCH) *transform_append(&far->modes, &dof, 1, 1) = 1;
    for (int32_t p = 0; p < patches.count; p++)
        TRY(append_patch(mesh, &patches.modes[p], &far->modes, err));
    far_patches_destroy(&patches);
    TRY(bulk_transform(mesh, &far->modes, &far->bulk, err));
    for (int32_t j = 0; j < interface_count; j++)
        dofs[j] = transform_column(&far->modes, interface_dofs[j]);
    TRY(bulk_operator_create(&far->bulk, NULL, dofs, interface_count, &far->system, err));
    TRY(far_samples_compare(&samples, &whole, &far->system, &far->error, err));
    far->used = far->error < ERROR_MAX;
cleanup:
    // The whole bulk is tried then, and says what is wrong.
    if (err->code == ERROR_COMPUTE) error_clear(err);
    bulk_operator_destroy(&whole);
    far_patches_destroy(&patches);
    memory_free(dofs);
    if (!error_is_clean(err)) error_context(err, "far from the interface");
    return error_is_clean(err);
}
