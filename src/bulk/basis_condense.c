// SPDX-License-Identifier: GPL-2.0-or-later
// With A_qq = L L' and Z = L^-1 [A_qb  load_q]: S = A_bb - Z_b' Z_b, the energy is Z_f' Z_f.
#include "bulk/basis_condense.h"

#include "base/dense.h"
#include "base/memory.h"
#include "base/share.h"
#include "bulk/interface_operator.h"

#include <string.h>

// Rows `first` to `first + rows` of a column of A, but for its part in K.
static void fill_column(const ReducedBulk *reduced, const double *factor, int64_t column,
                        int64_t first, int64_t rows, double *out)
{
    const double *mass = reduced->mass + column * reduced->count + first;
    const double *damping = reduced->damping + column * reduced->count + first;
    double i = factor[BULK_MASS], c = factor[BULK_DAMPING];
    for (int64_t row = 0; row < rows; row++) out[row] = i * mass[row] + c * damping[row];
}

enum {
    WIDE = 64,   // columns of a product
    ALONE = 20000   // entries of Z below which a thread takes as long as it saves
};

typedef struct Condensation {
    int64_t m, r;
    const double *lower;   // [r^2] L
    double *z;   // [r * (m + 1)]
    double *schur;   // [m^2]
} Condensation;

static void divide_half(void *context, int32_t which)
{
    const Condensation *all = context;
    int64_t half = all->m / 2, first = which ? half : 0, end = which ? all->m + 1 : half;
    dense_lower_divide(all->lower, (int32_t)all->r, (int32_t)(end - first),
                       all->z + first * all->r);
}

// Rows from a block's first column down.
static void square_half(void *context, int32_t which)
{
    const Condensation *all = context;
    int64_t m = all->m, r = all->r;
    for (int64_t from = which * WIDE; from < m; from += 2 * WIDE) {
        int64_t columns = m - from < WIDE ? m - from : WIDE;
        const double *z = all->z + from * r;
        dense_multiply_transposed_rows(dense_view(z, r, m - from), dense_view(z, r, columns), -1, 1,
                                       all->schur + from * (m + 1), m);
    }
}

static void in_two(void (*half)(void *context, int32_t which), Condensation *all)
{
    if (all->m * all->r >= ALONE) {
        share_in_two(half, all);
    } else {
        half(all, 0);
        half(all, 1);
    }
}

bool basis_condense(const ReducedBulk *reduced, const double *factor, double *schur, double *energy,
                    bool *definite, Error *err)
{
    int64_t m = reduced->interface_count, r = reduced->interior_count;
    double k = factor[BULK_STIFFNESS];
    double *interior = NEW_ARRAY(double, r *r, err), *z = NEW_ARRAY(double, r *(m + 1), err);
    if (!interior || !z) goto cleanup;
    for (int64_t j = 0; j < r; j++) {
        fill_column(reduced, factor, m + j, m, r, interior + j * r);
        interior[j * r + j] += k;
    }
    for (int64_t j = 0; j < m; j++) {
        fill_column(reduced, factor, j, m, r, z + j * r);
        fill_column(reduced, factor, j, 0, m, schur + j * m);
    }
    dense_add_scaled(k, reduced->stiffness, (int32_t)(m * m), schur);
    memcpy(z + m * r, reduced->load + m, (size_t)r * sizeof *z);
    if (!(*definite = dense_cholesky(interior, (int32_t)r))) goto cleanup;
    Condensation all = {m, r, interior, z, schur};
    in_two(divide_half, &all);
    in_two(square_half, &all);
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < j; i++) schur[j * m + i] = schur[i * m + j];
    *energy = dense_dot(z + m * r, z + m * r, (int32_t)r);
cleanup:
    memory_free(interior);
    memory_free(z);
    return error_is_clean(err);
}
