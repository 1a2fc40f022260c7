// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/basis_extension.h"

#include "base/dense_threaded.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// The squared length of what is left of a response below which it is rounding.
static const double DEPENDENT_LIMIT = 1e-12;

enum { INVERSE_STEPS = 8 };   // to the smallest eigenvalue, within some per cent

void extension_destroy(Extension *x)
{
    for (int term = 0; term < BULK_TERMS; term++) {
        memory_free(x->gram[term]);
        memory_free(x->beside[term]);
        memory_free(x->old[term]);
        memory_free(x->own[term]);
    }
    double *const owned[] = {x->statics, x->others, x->parts, x->load, x->lower, x->along};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) memory_free(owned[k]);
}

// responses: with those of the next block.
bool extension_create(const GrowingBasis *basis, int64_t responses, int64_t count, int64_t added,
                      Extension *x, Error *err)
{
    int64_t m = basis->interface_count;
    *x = (Extension){.m = m, .count = count, .added = added};
    for (int term = 0; term < BULK_TERMS; term++) {
        x->gram[term] = NEW_ARRAY(double, responses *added, err);
        if (term != BULK_STIFFNESS) x->beside[term] = NEW_ARRAY(double, m *added, err);
        x->old[term] = NEW_ARRAY(double, count *added, err);
        x->own[term] = NEW_ARRAY(double, added *added, err);
    }
    x->statics = NEW_ARRAY(double, m *added, err);
    x->others = NEW_ARRAY(double, (responses - m) * added, err);
    x->parts = NEW_ARRAY(double, m *added, err);
    x->load = NEW_ARRAY(double, added, err);
    x->lower = NEW_ARRAY(double, added *added, err);
    x->along = NEW_ARRAY(double, count *added, err);
    return error_is_clean(err);
}

// out [count * columns] := rows `first` on of a [rows * columns].
void extension_take_rows(const double *a, int64_t rows, int64_t columns, int64_t first,
                         int64_t count, double *out)
{
    for (int64_t j = 0; j < columns; j++)
        memcpy(out + j * count, a + j * rows + first, (size_t)count * sizeof *out);
}

// Phi'Z [count * added] from rows of X'Z.
void extension_of_modes(const GrowingBasis *basis, const Extension *x, int64_t others, double *out)
{
    DenseView statics = dense_view(x->statics, x->m, x->added);
    if (basis->mix)
        dense_multiply_transposed_threaded(dense_view(basis->mix, others, x->count),
                                           dense_view(x->others, others, x->added), 1, 0, out);
    else
        memcpy(out, x->others, (size_t)(x->count * x->added) * sizeof *out);
    dense_multiply_transposed_threaded(dense_view(basis->parts, x->m, x->count), statics, -1, 1,
                                       out);
}

// Of L L', from above.
static double smallest_eigenvalue(const double *lower, int32_t n, double *work)
{
    double size = 0;
    for (int32_t k = 0; k < n; k++) work[k] = fmod(0.6180339887498949 * (k + 1.0), 1) - 0.5;
    for (int32_t step = 0; step < INVERSE_STEPS; step++) {
        double before = sqrt(dense_dot(work, work, n));
        dense_lower_solve(lower, n, work);
        dense_lower_solve_transposed(lower, n, work);
        size = before / sqrt(dense_dot(work, work, n));
        for (int32_t k = 0; k < n; k++) work[k] *= size / before;
    }
    return size;
}

// Rows of the factor of K that belong to the new columns. false: they are not independent.
bool extension_factor(const GrowingBasis *basis, Extension *x)
{
    int64_t count = x->count, added = x->added;
    memcpy(x->along, x->old[BULK_STIFFNESS], (size_t)(count * added) * sizeof(double));
    memcpy(x->lower, x->own[BULK_STIFFNESS], (size_t)(added * added) * sizeof(double));
    if (count > 0) {
        dense_lower_divide(basis->lower, (int32_t)count, (int32_t)added, x->along);
        DenseView along = dense_view(x->along, count, added);
        dense_multiply_transposed_threaded(along, along, -1, 1, x->lower);
    }
    if (!dense_cholesky(x->lower, (int32_t)added)) return false;
    // `gram` is done with.
    double least = smallest_eigenvalue(x->lower, (int32_t)added, x->gram[0]);
    x->loss = x->largest / least;
    return least > DEPENDENT_LIMIT * x->largest;
}

// a [rows * columns] into the upper left corner of a new one, [new_rows * new_columns], zero
// elsewhere.
bool extension_grow(double **a, int64_t rows, int64_t columns, int64_t new_rows,
                    int64_t new_columns, Error *err)
{
    double *grown = NEW_ARRAY(double, new_rows *new_columns, err);
    if (!grown) return false;
    for (int64_t j = 0; j < columns; j++)
        memcpy(grown + j * new_rows, *a + j * rows, (size_t)rows * sizeof *grown);
    memory_free(*a);
    *a = grown;
    return true;
}

// The mix as a matrix; as the unit matrix before.
bool extension_spell_out_mix(GrowingBasis *basis, Error *err)
{
    int64_t r = basis->interior_count;
    if (basis->mix) return true;
    basis->mix = NEW_ARRAY(double, r *r, err);
    for (int64_t j = 0; basis->mix && j < r; j++) basis->mix[j * (r + 1)] = 1;
    return basis->mix;
}

// Columns behind those that are there.
bool extension_append(double **a, int64_t rows, int64_t count, const double *columns, int64_t added,
                      Error *err)
{
    double *grown = memory_resize(*a, rows * count, rows * (count + added), sizeof *grown, err);
    if (!grown) return false;
    *a = grown;
    memcpy(grown + rows * count, columns, (size_t)(rows * added) * sizeof *grown);
    return true;
}

// A square matrix with the new columns, both triangles.
static bool extend_square(double **square, const Extension *x, const double *old, const double *own,
                          Error *err)
{
    int64_t count = x->count, added = x->added, size = count + added;
    if (!extension_grow(square, count, count, size, size, err)) return false;
    for (int64_t j = 0; j < added; j++) {
        double *column = *square + (count + j) * size;
        memcpy(column, old + j * count, (size_t)count * sizeof *column);
        for (int64_t i = 0; i < count; i++) (*square)[i * size + count + j] = column[i];
        for (int64_t i = 0; i < added; i++)
            column[count + i] = (own[j * added + i] + own[i * added + j]) / 2;
    }
    return true;
}

// Of the factor, whose upper triangle is of no use.
static bool extend_lower(GrowingBasis *basis, const Extension *x, Error *err)
{
    int64_t count = x->count, added = x->added, size = count + added;
    if (!extension_grow(&basis->lower, count, count, size, size, err)) return false;
    for (int64_t i = 0; i < count; i++)
        for (int64_t j = 0; j < added; j++)
            basis->lower[i * size + count + j] = x->along[j * count + i];
    for (int64_t j = 0; j < added; j++)
        memcpy(basis->lower + (count + j) * (size + 1), x->lower + j * (added + 1),
               (size_t)(added - j) * sizeof(double));
    return true;
}

bool extension_take_up(GrowingBasis *basis, const Extension *x, Error *err)
{
    int64_t m = x->m, count = x->count, added = x->added;
    for (int term = 0; term < BULK_TERMS; term++) {
        TRY(extend_square(&basis->interior[term], x, x->old[term], x->own[term], err));
        if (term != BULK_STIFFNESS)
            TRY(extension_append(&basis->beside[term], m, count, x->beside[term], added, err));
    }
    TRY(extend_lower(basis, x, err));
    TRY(extension_append(&basis->load, 1, m + count, x->load, added, err));
    basis->interior_count = (int32_t)(count + added);
cleanup:
    return error_is_clean(err);
}

// a [rows * added] := a R, R [added * kept].
static bool turn(double **a, int64_t rows, DenseView rotation, Error *err)
{
    double *turned = NEW_ARRAY(double, rows *rotation.columns, err);
    if (!turned) return false;
    dense_multiply_threaded(dense_view(*a, rows, rotation.rows), rotation, 1, 0, turned);
    memory_free(*a);
    *a = turned;
    return true;
}

// Rows and columns for the next `responses`, of which the columns of `rotation` are new modes;
// NULL: all of them.
bool extension_grow_mix(GrowingBasis *basis, int64_t responses, const double *rotation,
                        int64_t kept, Error *err)
{
    int64_t others = basis->responses.count - basis->interface_count, rows = others + responses;
    int64_t r = basis->interior_count;
    if (!extension_grow(&basis->mix, others, r, rows, r + kept, err)) return false;
    for (int64_t j = 0; j < kept; j++) {
        double *column = basis->mix + (r + j) * rows + others;
        if (rotation)
            memcpy(column, rotation + j * responses, (size_t)responses * sizeof *column);
        else
            column[j] = 1;
    }
    return true;
}

// What of the new columns is not rounding: eigenvectors of what is left of their energy in K.
bool extension_drop_dependent(GrowingBasis *basis, Extension *x, Error *err)
{
    int64_t added = x->added, count = x->count, kept = 0;
    double *left = NEW_ARRAY(double, added *added, err), *values = NEW_ARRAY(double, added, err);
    double *work = NEW_ARRAY(double, dense_eigen_work((int32_t)added), err);
    if (!left || !values || !work) goto cleanup;
    DenseView along = dense_view(x->along, count, added);
    memcpy(left, x->own[BULK_STIFFNESS], (size_t)(added * added) * sizeof *left);
    if (count > 0) dense_multiply_transposed(along, along, -1, 1, left);
    if (!dense_eigen(left, (int32_t)added, values, work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: the responses of the interior are not independent");
    while (kept < added && values[added - 1 - kept] > DEPENDENT_LIMIT * x->largest) kept++;
    for (int64_t j = added - kept; j < added; j++)
        for (int64_t i = 0; i < added; i++) left[j * added + i] /= sqrt(values[j]);
    DenseView rotation = dense_view(left + (added - kept) * added, added, kept);
    TRY(extension_spell_out_mix(basis, err));
    TRY(extension_grow_mix(basis, added, rotation.values, kept, err));
    for (int term = 0; term < BULK_TERMS; term++) {
        if (term != BULK_STIFFNESS) TRY(turn(&x->beside[term], x->m, rotation, err));
        TRY(turn(&x->old[term], count, rotation, err));
        double *half = x->gram[0];
        dense_multiply(dense_view(x->own[term], added, added), rotation, 1, 0, half);
        dense_multiply_transposed(rotation, dense_view(half, added, kept), 1, 0, x->own[term]);
    }
    TRY(turn(&x->parts, x->m, rotation, err));
    memcpy(values, x->load, (size_t)added * sizeof *values);
    dense_apply_transposed(rotation, values, 1, 0, x->load);
    x->added = kept;
    if (kept > 0 && !extension_factor(basis, x))
        FAIL(err, ERROR_COMPUTE, "the responses of the interior are not independent");
cleanup:
    memory_free(left);
    memory_free(values);
    memory_free(work);
    return error_is_clean(err);
}
