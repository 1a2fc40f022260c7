// SPDX-License-Identifier: GPL-2.0-or-later
// Products of matrices of base/dense, by columns in pieces where they are large.
#include "base/dense.h"
#include "base/parallel.h"

#include <cblas.h>
#include <string.h>

enum { PIECES_MAX = 8, PIECE_COLUMNS = 32 };   // at least: narrower ones read `a` for little

// c = factor op(a) b + keep c, c [rows * columns], summed over `depth`.
typedef struct Product {
    CBLAS_TRANSPOSE turned;
    int64_t rows, columns, depth;
    DenseView a;
    const double *b;
    int64_t b_stride;
    double factor, keep;
    double *c;
    int64_t c_stride;
    int32_t pieces;
} Product;

static void multiply_piece(void *context, int32_t k, int32_t worker)
{
    const Product *all = context;
    int64_t from = all->columns * k / all->pieces, end = all->columns * (k + 1) / all->pieces;
    (void)worker;
    cblas_dgemm(CblasColMajor, all->turned, CblasNoTrans, (int)all->rows, (int)(end - from),
                (int)all->depth, all->factor, all->a.values, all->a.rows,
                all->b + from * all->b_stride, (int)all->b_stride, all->keep,
                all->c + from * all->c_stride, (int)all->c_stride);
}

static void multiply(Product all)
{
    if (all.rows == 0 || all.columns == 0 || all.depth == 0) return;
    bool few = 2.0 * (double)all.rows * (double)all.columns * (double)all.depth <
               PARALLEL_OPERATIONS;
    int64_t pieces = few ? 1 : all.columns / PIECE_COLUMNS;
    all.pieces = (int32_t)(pieces < 1 ? 1 : pieces < PIECES_MAX ? pieces : PIECES_MAX);
    parallel_for(all.pieces, multiply_piece, &all);
}

void dense_multiply_transposed_rows(DenseView a, DenseView b, double factor, double keep, double *c,
                                    int64_t stride)
{
    multiply((Product){.turned = CblasTrans,
                       .rows = a.columns,
                       .columns = b.columns,
                       .depth = a.rows,
                       .a = a,
                       .b = b.values,
                       .b_stride = b.rows,
                       .factor = factor,
                       .keep = keep,
                       .c = c,
                       .c_stride = stride});
}

void dense_multiply_transposed(DenseView a, DenseView b, double factor, double keep, double *c)
{
    if (a.rows == 0)   // BLAS takes no matrix without rows
        for (int64_t k = 0; k < (int64_t)a.columns * b.columns; k++)
            c[k] = keep == 0 ? 0 : keep * c[k];
    dense_multiply_transposed_rows(a, b, factor, keep, c, a.columns);
}

static void multiply_rows(DenseView a, DenseView b, double factor, double keep, double *c,
                          int64_t b_stride)
{
    multiply((Product){.turned = CblasNoTrans,
                       .rows = a.rows,
                       .columns = b.columns,
                       .depth = a.columns,
                       .a = a,
                       .b = b.values,
                       .b_stride = b_stride,
                       .factor = factor,
                       .keep = keep,
                       .c = c,
                       .c_stride = a.rows});
}

// Where there is nothing to sum over (a.columns 0) `c` is left as it is, not even scaled.
void dense_multiply(DenseView a, DenseView b, double factor, double keep, double *c)
{
    multiply_rows(a, b, factor, keep, c, b.rows);
}

void dense_multiply_rows(DenseView a, const double *b, int64_t stride, int64_t columns,
                         double factor, double *c)
{
    multiply_rows(a, dense_view(b, a.columns, columns), factor, 1, c, stride);
}
