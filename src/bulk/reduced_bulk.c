// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/reduced_bulk.h"

#include "base/dense_halves.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

void reduced_bulk_destroy(ReducedBulk *reduced)
{
    if (reduced->storage) {
        memory_free(reduced->storage);
    } else {
        memory_free(reduced->mass);
        memory_free(reduced->damping);
        memory_free(reduced->stiffness);
        memory_free(reduced->viscous);
        memory_free(reduced->load);
    }
    memory_free(reduced->modes);
    *reduced = (ReducedBulk){0};
}

// Rows that are turned together.
enum { PIECE = 256 };

// What turning takes; q: [r * r].
typedef struct Turn {
    double *q, *inner, *piece;   // [r^2], [r^2], [2 * PIECE * r]; owned
    double *vectors;   // [2 * r + what dense_tridiagonalise works in]; owned
    int64_t r;
} Turn;

// x [rows * r] := x Q
static void turn_columns(const Turn *turn, double *x, int64_t rows)
{
    int64_t r = turn->r;
    DenseView q = {turn->q, (int32_t)r, (int32_t)r};
    for (int64_t first = 0; first < rows; first += PIECE) {
        int64_t count = rows - first < PIECE ? rows - first : PIECE;
        size_t bytes = (size_t)count * sizeof *x;
        double *turned = turn->piece + PIECE * r;
        for (int64_t j = 0; j < r; j++)
            memcpy(turn->piece + j * count, x + j * rows + first, bytes);
        dense_multiply_halves((DenseView){turn->piece, (int32_t)count, (int32_t)r}, q, 1, 0,
                              turned);
        for (int64_t j = 0; j < r; j++) memcpy(x + j * rows + first, turned + j * count, bytes);
    }
}

// The interior's rows and columns of a symmetric matrix [count^2], both triangles.
static void turn_matrix(const Turn *turn, const ReducedBulk *reduced, double *matrix)
{
    int64_t m = reduced->interface_count, r = turn->r, all = reduced->count;
    turn_columns(turn, matrix + m * all, all);
    for (int64_t k = 0; k < r; k++)
        for (int64_t j = 0; j < r; j++) turn->inner[j * r + k] = matrix[(m + k) * all + m + j];
    turn_columns(turn, turn->inner, r);
    for (int64_t k = 0; k < r; k++) {
        for (int64_t j = 0; j < m; j++) matrix[j * all + m + k] = matrix[(m + k) * all + j];
        for (int64_t j = 0; j <= k; j++)
            matrix[(m + k) * all + m + j] = matrix[(m + j) * all + m + k] = turn->inner[j * r + k];
    }
}

static bool turn_create(const ReducedBulk *reduced, Turn *turn, Error *err)
{
    int64_t r = reduced->interior_count;
    *turn = (Turn){.r = r};
    turn->q = NEW_ARRAY(double, r *r, err);
    turn->inner = NEW_ARRAY(double, r *r, err);
    turn->piece = NEW_ARRAY(double, 2 * PIECE * r, err);
    turn->vectors = NEW_ARRAY(double, 2 * r + dense_eigen_work((int32_t)r), err);
    return error_is_clean(err);
}

static void turn_destroy(Turn *turn)
{
    memory_free(turn->q);
    memory_free(turn->inner);
    memory_free(turn->piece);
    memory_free(turn->vectors);
}

// M_qq = Q T Q' (Householder: LAPACK Users' Guide, 3rd ed., 2.4.4).
bool reduced_bulk_narrow(ReducedBulk *reduced, double *columns, int64_t rows, Error *err)
{
    Turn turn;
    int64_t m = reduced->interface_count, r = reduced->interior_count, all = reduced->count;
    double *mass = reduced->mass + m * (all + 1);
    TRY(turn_create(reduced, &turn, err));
    for (int64_t j = 0; j < r; j++)
        memcpy(turn.q + j * r, mass + j * all, (size_t)r * sizeof *mass);
    double *diagonal = turn.vectors, *beside = diagonal + r, *work = beside + r;
    if (!dense_tridiagonalise(turn.q, (int32_t)r, diagonal, beside, work))
        FAIL(err, ERROR_LIBRARY, "the reduced mass cannot be made tridiagonal");
    turn_matrix(&turn, reduced, reduced->mass);
    turn_matrix(&turn, reduced, reduced->damping);
    turn_columns(&turn, columns, rows);
    DenseView q = {turn.q, (int32_t)r, (int32_t)r};
    dense_apply_transposed(q, reduced->load + m, 1, 0, turn.inner);
    memcpy(reduced->load + m, turn.inner, (size_t)r * sizeof(double));
    for (int64_t j = 0; j < r; j++) {
        memset(mass + j * all, 0, (size_t)r * sizeof *mass);
        mass[j * all + j] = diagonal[j];
        if (j > 0) mass[j * all + j - 1] = beside[j - 1];
        if (j + 1 < r) mass[j * all + j + 1] = beside[j];
    }
cleanup:
    turn_destroy(&turn);
    return error_is_clean(err);
}

void reduced_bulk_recover(const ReducedBulk *reduced, const double *state, double *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply(modes, state, 1, 0, full);
}

void reduced_bulk_recover_each(const ReducedBulk *reduced, int32_t count,
                               const double *const *states, double *const *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply_each(modes, count, states, full);
}

// Between two levels the error is not measured; it stays below the larger of theirs, or little
// above (a test asks at random: 1.2 times as large, of two materials).
static const double BETWEEN = 1.5;

double reduced_bulk_error(const ReducedBulk *reduced, double inertia)
{
    const ReductionErrors *errors = &reduced->errors;
    if (errors->count == 0) return 0;
    int32_t above = 0;
    while (above < errors->count - 1 && errors->inertia[above] < inertia) above++;
    double below = above > 0 ? errors->error[above - 1] : 0;
    return BETWEEN * fmax(below, errors->error[above]);
}
