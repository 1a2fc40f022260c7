// SPDX-License-Identifier: GPL-2.0-or-later
// Products of matrices of algebra/dense, by columns in pieces where they are large.
#include "algebra/dense.h"
#include "base/parallel.h"

#include <cblas.h>

enum { PIECES_MAX = 8, PIECE_COLUMNS = 32 };   // at least: narrower ones read `a` for little

// c = factor op(a) b + keep c, op(a) = a or a'.
typedef struct Product {
    bool turned;
    DenseView a, b;
    int64_t b_stride;
    double factor, keep;
    double *c;
    int64_t c_stride;
    int32_t pieces;
} Product;

static void multiply_piece(void *context, int32_t k, int32_t worker)
{
    const Product *all = context;
    const DenseView *a = &all->a, *b = &all->b;
    int64_t from = (int64_t)b->columns * k / all->pieces;
    int64_t end = (int64_t)b->columns * (k + 1) / all->pieces;
    (void)worker;
    cblas_dgemm(CblasColMajor, all->turned ? CblasTrans : CblasNoTrans, CblasNoTrans,
                all->turned ? a->columns : a->rows, (int)(end - from),
                all->turned ? a->rows : a->columns, all->factor, a->values, a->rows,
                b->values + from * all->b_stride, (int)all->b_stride, all->keep,
                all->c + from * all->c_stride, (int)all->c_stride);
}

static void multiply(Product all)
{
    double operations = 2.0 * all.a.rows * all.a.columns * all.b.columns;
    int64_t pieces = operations < PARALLEL_OPERATIONS ? 1 : all.b.columns / PIECE_COLUMNS;
    if (!(operations > 0)) return;
    all.pieces = (int32_t)(pieces < 1 ? 1 : pieces < PIECES_MAX ? pieces : PIECES_MAX);
    parallel_for(all.pieces, multiply_piece, &all);
}

void dense_multiply_transposed_rows(DenseView a, DenseView b, double factor, double keep, double *c,
                                    int64_t stride)
{
    multiply((Product){true, a, b, b.rows, factor, keep, c, stride, 0});
}

void dense_multiply_transposed(DenseView a, DenseView b, double factor, double keep, double *c)
{
    if (a.rows == 0)   // BLAS takes no matrix without rows
        for (int64_t k = 0; k < (int64_t)a.columns * b.columns; k++)
            c[k] = keep == 0 ? 0 : keep * c[k];
    dense_multiply_transposed_rows(a, b, factor, keep, c, a.columns);
}

// Where there is nothing to sum over (a.columns 0) `c` is left as it is, not even scaled.
void dense_multiply(DenseView a, DenseView b, double factor, double keep, double *c)
{
    multiply((Product){false, a, b, b.rows, factor, keep, c, a.rows, 0});
}

void dense_multiply_rows(DenseView a, const double *b, int64_t stride, int64_t columns,
                         double factor, double *c)
{
    multiply(
        (Product){false, a, dense_view(b, a.columns, columns), stride, factor, 1, c, a.rows, 0});
}
