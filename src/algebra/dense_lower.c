// SPDX-License-Identifier: GPL-2.0-or-later
// Triangular matrices of algebra/dense, which says what all these do.
#include "algebra/dense.h"

#include <cblas.h>
#include <stddef.h>

enum { SQUARE_WIDE = 128 };   // columns of L L' at once

// LAPACK's, as in algebra/dense.
void dsygst_(const int *itype, const char *uplo, const int *n, double *a, const int *lda,
             const double *b, const int *ldb, int *info, size_t uplo_size);

// The strictly upper triangle of `lower` is not looked at, here and in what follows but for its
// square.
void dense_lower_apply(const double *lower, int32_t n, double *x)
{
    if (n > 0)
        cblas_dtrmv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, n, lower, n, x, 1);
}

void dense_lower_apply_transposed(const double *lower, int32_t n, double *x)
{
    if (n > 0) cblas_dtrmv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, n, lower, n, x, 1);
}

void dense_lower_solve_transposed(const double *lower, int32_t n, double *x)
{
    if (n > 0) cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, n, lower, n, x, 1);
}

void dense_lower_solve(const double *lower, int32_t n, double *x)
{
    if (n > 0)
        cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, n, lower, n, x, 1);
}

// Column by column no further than L goes, and from the diagonal down: a sixth of a general
// product.
void dense_lower_square(const double *lower, int32_t n, double *c)
{
    for (int32_t from = 0; from < n; from += SQUARE_WIDE) {
        int32_t columns = n - from < SQUARE_WIDE ? n - from : SQUARE_WIDE;
        const double *rows = lower + from;
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n - from, columns, from + columns, 1,
                    rows, n, rows, n, 0, c + (int64_t)from * (n + 1), n);
    }
    dense_mirror(c, n);
}

void dense_lower_divide(const double *lower, int32_t n, int32_t columns, double *b)
{
    if (n > 0 && columns > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, columns,
                    1.0, lower, n, b, n);
}

void dense_lower_divide_transposed(const double *lower, int32_t n, int32_t columns, double *b)
{
    if (n > 0 && columns > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, n, columns, 1.0,
                    lower, n, b, n);
}

void dense_lower_multiply(const double *lower, int32_t n, int32_t columns, double *b)
{
    if (n > 0 && columns > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, columns,
                    1.0, lower, n, b, n);
}

// dsygst: half the operations of two triangular solves, as it keeps to one triangle. Turns a x =
// lambda L L' x into a symmetric problem of its own.
void dense_divide_both_sides(const double *lower, int32_t n, double *a)
{
    int info = 0, from_both_sides = 1;
    if (n > 0) dsygst_(&from_both_sides, "L", &n, a, &n, lower, &n, &info, 1);
}
