// SPDX-License-Identifier: GPL-2.0-or-later
// Modes are formed, made orthonormal and multiplied by the mesh.
#include "reduction/basis_renew.h"

#include "base/dense_threaded.h"
#include "base/memory.h"
#include "reduction/basis_extension.h"

#include <string.h>

bool basis_form(const GrowingBasis *basis, const double *turn, int64_t columns, double *field,
                Error *err)
{
    const Responses *responses = &basis->responses;
    int64_t dofs = basis->full_dofs, m = basis->interface_count, r = basis->interior_count;
    int64_t rows = responses->count, others = rows - m;
    double *all = NEW_ARRAY(double, rows *columns, err),
           *part = NEW_ARRAY(double, rows *columns, err);
    if (!all || !part) goto cleanup;
    DenseView turned = dense_view(turn, r, columns);
    dense_multiply_threaded(dense_view(basis->parts, m, r), turned, -1, 0, part);
    for (int64_t j = 0; j < columns; j++)
        memcpy(all + j * rows, part + j * m, (size_t)m * sizeof *all);
    if (basis->mix)
        dense_multiply_threaded(dense_view(basis->mix, others, r), turned, 1, 0, part);
    else
        memcpy(part, turn, (size_t)(r * columns) * sizeof *part);
    for (int64_t j = 0; j < columns; j++)
        memcpy(all + j * rows + m, part + j * others, (size_t)others * sizeof *all);
    responses_combine(responses, 1, all, columns, field);
    // The interface's part is 0, to the last bit.
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < m; i++) field[j * dofs + responses->full->interface_dofs[i]] = 0;
cleanup:
    memory_free(all);
    memory_free(part);
    return error_is_clean(err);
}

// Columns `first` on of a [rows * count] become a turn; `turn` [count * columns].
static bool turn_last(double *a, int64_t rows, int64_t first, DenseView turn, Error *err)
{
    double *turned = NEW_ARRAY(double, rows *turn.columns, err);
    if (!turned) return false;
    dense_multiply_threaded(dense_view(a, rows, turn.rows), turn, 1, 0, turned);
    memcpy(a + rows * first, turned, (size_t)(rows * turn.columns) * sizeof *a);
    memory_free(turned);
    return true;
}

// Columns of Phi turn by the mesh: X' (K, C, M) of them into `gram`, and f' of them.
static bool multiply_by_mesh(const GrowingBasis *basis, const double *turn, Extension *x,
                             Error *err)
{
    const Responses *responses = &basis->responses;
    int64_t dofs = basis->full_dofs, r = basis->interior_count, columns = 0;
    double *field = NEW_ARRAY(double, dofs *RESPONSES_TOGETHER, err);
    double *image = NEW_ARRAY(double, dofs *RESPONSES_TOGETHER, err);
    if (!field || !image) goto cleanup;
    for (int64_t from = 0; from < x->added; from += columns) {
        columns = x->added - from < RESPONSES_TOGETHER ? x->added - from : RESPONSES_TOGETHER;
        memset(field, 0, (size_t)(dofs * columns) * sizeof *field);
        TRY(basis_form(basis, turn + from * r, columns, field, err));
        for (int term = 0; term < BULK_TERMS; term++)
            responses_project(responses, (BulkTerm)term, field, columns, image,
                              x->gram[term] + from * responses->count);
        dense_apply_transposed(dense_view(field, dofs, columns), responses->unit_load, 1, 0,
                               x->load + from);
    }
cleanup:
    memory_free(field);
    memory_free(image);
    return error_is_clean(err);
}

// Rows and columns beyond the first `kept` go.
static void cut_square(double *square, int64_t size, int64_t kept)
{
    for (int64_t j = 1; j < kept; j++)
        memmove(square + j * kept, square + j * size, (size_t)kept * sizeof *square);
}

// The basis without its columns from `first` on; their parts and mix stay.
static void cut(GrowingBasis *basis, int64_t first)
{
    for (int term = 0; term < BULK_TERMS; term++)
        cut_square(basis->interior[term], basis->interior_count, first);
    cut_square(basis->lower, basis->interior_count, first);
    basis->interior_count = (int32_t)first;
}

// L^-T's columns from `first` on.
static double *orthonormal(const GrowingBasis *basis, int64_t first, Error *err)
{
    int64_t r = basis->interior_count, added = r - first;
    double *turn = NEW_ARRAY(double, r *added, err);
    if (!turn) return NULL;
    for (int64_t j = 0; j < added; j++) turn[j * r + first + j] = 1;
    dense_lower_divide_transposed(basis->lower, (int32_t)r, (int32_t)added, turn);
    return turn;
}

bool basis_renew(GrowingBasis *basis, int32_t first, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count, added = r - first;
    int64_t rows = basis->responses.count, others = rows - m;
    Extension x = {0};
    double *all = NEW_ARRAY(double, r *added, err), *turn = orthonormal(basis, first, err);
    if (!all || !turn) goto cleanup;
    TRY(extension_create(basis, rows, first, added, &x, err));
    TRY(extension_spell_out_mix(basis, err));
    TRY(multiply_by_mesh(basis, turn, &x, err));
    TRY(turn_last(basis->mix, others, first, dense_view(turn, r, added), err));
    TRY(turn_last(basis->parts, m, first, dense_view(turn, r, added), err));
    x.count = r;   // their products with themselves, too
    for (int term = 0; term < BULK_TERMS; term++) {
        extension_take_rows(x.gram[term], rows, added, 0, m, x.statics);
        extension_take_rows(x.gram[term], rows, added, m, others, x.others);
        if (term != BULK_STIFFNESS)
            memcpy(x.beside[term], x.statics, (size_t)(m * added) * sizeof *all);
        extension_of_modes(basis, &x, others, all);
        extension_take_rows(all, r, added, 0, first, x.old[term]);
        extension_take_rows(all, r, added, first, added, x.own[term]);
    }
    x.count = first;
    cut(basis, first);
    if (!extension_factor(basis, &x))
        FAIL(err, ERROR_COMPUTE, "the responses of the interior are not independent");
    TRY(extension_take_up(basis, &x, err));
cleanup:
    memory_free(all);
    memory_free(turn);
    extension_destroy(&x);
    return error_is_clean(err);
}
