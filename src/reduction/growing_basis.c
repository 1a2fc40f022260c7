// SPDX-License-Identifier: GPL-2.0-or-later
// What is left of a response is a difference of nearly equal energies. Its products come from
// those of the responses, so that columns as long as the mesh are multiplied once; where too many
// digits are lost new modes are multiplied by the mesh.
#include "reduction/growing_basis.h"

#include "base/dense_threaded.h"
#include "base/memory.h"
#include "reduction/basis_extension.h"
#include "reduction/basis_renew.h"

#include <math.h>
#include <string.h>

void basis_destroy(GrowingBasis *basis)
{
    responses_destroy(&basis->responses);
    for (int term = 0; term < BULK_TERMS; term++) {
        memory_free(basis->statics[term]);
        memory_free(basis->beside[term]);
        memory_free(basis->interior[term]);
    }
    memory_free(basis->lower);
    memory_free(basis->load);
    memory_free(basis->parts);
    memory_free(basis->mix);
    *basis = (GrowingBasis){0};
}

bool basis_create(const BulkOperator *full, const BulkScales *scales, GrowingBasis *basis,
                  Error *err)
{
    int64_t m = full->interface_count;
    *basis = (GrowingBasis){.full_dofs = full->dof_count, .interface_count = full->interface_count};
    for (int term = 0; term < BULK_TERMS; term++)
        basis->statics[term] = NEW_ARRAY(double, m *m, err);
    basis->load = NEW_ARRAY(double, m, err);
    return error_is_clean(err) && responses_create(full, scales, &basis->responses, err);
}

// Products of Y = X_next - Psi parts, with parts what X_next is on the interface.
static void take_out_statics(const GrowingBasis *basis, const ResponseBlock *next, Extension *x)
{
    int64_t m = x->m, added = x->added, others = next->first - m, rows = next->first + added;
    extension_take_rows(next->boundary, m + 1, added, 0, m, x->parts);
    DenseView parts = dense_view(x->parts, m, added);
    for (int term = 0; term < BULK_TERMS; term++) {
        DenseView known = dense_view(basis->statics[term], m, m);
        DenseView statics = dense_view(x->statics, m, added);
        extension_take_rows(x->gram[term], rows, added, m, others, x->others);
        extension_take_rows(x->gram[term], rows, added, m + others, added, x->own[term]);
        for (int64_t j = 0; term == BULK_STIFFNESS && j < added; j++)
            x->largest = fmax(x->largest, x->own[term][j * (added + 1)]);
        if (term == BULK_STIFFNESS)
            dense_multiply_threaded(known, parts, 1, 0, x->statics);
        else
            extension_take_rows(x->gram[term], rows, added, 0, m, x->statics);
        extension_of_modes(basis, x, others, x->old[term]);
        dense_multiply_transposed_threaded(parts, statics, -1, 1, x->own[term]);
        if (term == BULK_STIFFNESS) continue;
        memcpy(x->beside[term], x->statics, (size_t)(m * added) * sizeof(double));
        dense_multiply_threaded(known, parts, -1, 1, x->beside[term]);
        dense_multiply_transposed_threaded(dense_view(basis->beside[term], m, x->count), parts, -1,
                                           1, x->old[term]);
        dense_multiply_transposed_threaded(dense_view(x->beside[term], m, added), parts, -1, 1,
                                           x->own[term]);
    }
    for (int64_t j = 0; j < added; j++) x->load[j] = next->boundary[j * (m + 1) + m];
    dense_apply_transposed(parts, basis->load, -1, 1, x->load);
}

bool basis_extend(GrowingBasis *basis, Error *err)
{
    const ResponseBlock *next = &basis->responses.blocks[basis->responses.block_count];
    int64_t m = basis->interface_count, count = basis->interior_count;
    Extension x = {0};
    TRY(extension_create(basis, next->first + next->count, count, next->count, &x, err));
    TRY(responses_multiply(&basis->responses, x.gram, err));
    take_out_statics(basis, next, &x);
    if (!extension_factor(basis, &x))
        TRY(extension_drop_dependent(basis, &x, err));
    else if (basis->mix)
        TRY(extension_grow_mix(basis, next->count, NULL, next->count, err));
    responses_keep(&basis->responses);
    if (x.added == 0) goto cleanup;
    TRY(extension_append(&basis->parts, m, count, x.parts, x.added, err));
    TRY(extension_take_up(basis, &x, err));
    if (x.loss > basis->loss_max) TRY(basis_renew(basis, (int32_t)count, err));
cleanup:
    extension_destroy(&x);
    return error_is_clean(err);
}

bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    int64_t m = basis->interface_count;
    const double *schur = interface_operator_schur(statics);
    double *boundary = NEW_ARRAY(double, m *m, err);
    ResponseBlock *next = responses_next(&basis->responses, (ParameterPoint){0, 0}, m, err);
    if (!boundary || !next) goto cleanup;
    for (int64_t j = 0; j < m; j++) {
        boundary[j * m + j] = next->boundary[j * (m + 1) + j] = 1;
        memcpy(next->reaction + j * (m + 1), schur + j * m, (size_t)m * sizeof *schur);
    }
    TRY(interface_operator_respond(statics, boundary, (int32_t)m, next->field, err));
    TRY(responses_multiply(&basis->responses, basis->statics, err));
    // Inside the block K Psi = 0, so that Psi'K Psi is S_K.
    memcpy(basis->statics[BULK_STIFFNESS], schur, (size_t)(m * m) * sizeof *schur);
    for (int64_t j = 0; j < m; j++) basis->load[j] = next->boundary[j * (m + 1) + m];
    responses_keep(&basis->responses);
    next = responses_next(&basis->responses, (ParameterPoint){0, 0}, 1, err);
    if (!next) goto cleanup;
    TRY(interface_operator_respond_held(statics, basis->responses.unit_load, next->field,
                                        next->reaction, err));
    for (int64_t i = 0; i < m; i++) next->reaction[i] = -next->reaction[i];
    next->reaction[m] = 1;
    if (dense_max_abs(next->field, basis->full_dofs) > 0) TRY(basis_extend(basis, err));
cleanup:
    memory_free(boundary);
    return error_is_clean(err);
}
