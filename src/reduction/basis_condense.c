// SPDX-License-Identifier: GPL-2.0-or-later
// With A_qq = L L' and Z = L^-1 [A_qb  load_q]: S = A_bb - Z_b' Z_b, the energy is Z_f' Z_f.
#include "reduction/basis.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/parallel.h"

#include <string.h>

enum {
    WIDE = 64,   // columns of a product
    STRETCH = 1024   // numbers that are added up at once
};

typedef struct Condensation {
    int64_t m, r;
    const double *lower;   // [r^2] L
    double *z;   // [r * (m + 1)]
    double *schur;   // [m^2]
} Condensation;

static void divide_columns(void *context, int32_t k, int32_t worker)
{
    const Condensation *all = context;
    int64_t from = (int64_t)k * WIDE, left = all->m + 1 - from;
    (void)worker;
    dense_lower_divide(all->lower, (int32_t)all->r, (int32_t)(left < WIDE ? left : WIDE),
                       all->z + from * all->r);
}

// Rows from a block's first column down.
static void square_columns(void *context, int32_t k, int32_t worker)
{
    const Condensation *all = context;
    int64_t from = (int64_t)k * WIDE, left = all->m - from, r = all->r;
    const double *z = all->z + from * r;
    (void)worker;
    dense_multiply_transposed_rows(dense_view(z, r, left),
                                   dense_view(z, r, left < WIDE ? left : WIDE), -1, 1,
                                   all->schur + from * (all->m + 1), all->m);
}

// out := sum of factor * term, those that are there, stretch by stretch in the cache.
static void combine(double *const *terms, int32_t term_count, const double *factor, int64_t count,
                    double *out)
{
    for (int64_t from = 0; from < count; from += STRETCH) {
        int64_t end = from + STRETCH < count ? from + STRETCH : count;
        memset(out + from, 0, (size_t)(end - from) * sizeof *out);
        for (int term = 0; term < term_count; term++) {
            const double *values = terms[term];
            double share = factor[term];
            for (int64_t i = from; values && share != 0 && i < end; i++)
                out[i] += share * values[i];
        }
    }
}

bool basis_condense(const Basis *basis, const double *factor, double *schur, double *energy,
                    bool *definite, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count;
    int32_t terms = basis->responses.term_count;
    double *interior = NEW_ARRAY(double, r *r, err), *z = NEW_ARRAY(double, r *(m + 1), err);
    double *beside = NEW_ARRAY(double, m *r, err);
    if (!interior || !z || !beside) goto cleanup;
    combine(basis->interior, terms, factor, r * r, interior);
    combine(basis->beside, terms, factor, m * r, beside);
    combine(basis->statics, terms, factor, m * m, schur);
    dense_transpose(dense_view(beside, m, r), z, r);
    memcpy(z + m * r, basis->load + m, (size_t)r * sizeof *z);
    if (!(*definite = dense_cholesky(interior, (int32_t)r))) goto cleanup;
    Condensation all = {m, r, interior, z, schur};
    parallel_for((int32_t)((m + WIDE) / WIDE), divide_columns, &all);
    parallel_for((int32_t)((m + WIDE - 1) / WIDE), square_columns, &all);
    dense_mirror(schur, m);
    *energy = dense_dot(z + m * r, z + m * r, (int32_t)r);
cleanup:
    memory_free_all(interior, z, beside);
    return error_is_clean(err);
}
