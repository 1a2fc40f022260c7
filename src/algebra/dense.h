// SPDX-License-Identifier: GPL-2.0-or-later
// Small dense matrices, column-major, through BLAS and LAPACK.
#ifndef AMONTONS_ALGEBRA_DENSE_H
#define AMONTONS_ALGEBRA_DENSE_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

// Ends BLAS's threads: at these sizes they gain nothing, and beside another process they cost twice
// as much.
void dense_use_one_thread(void);
// The same, and OpenBLAS has the buffer that its products are packed in: it takes one at the first
// call and keeps it; where there is no room it asks again for ever. ERROR_MEMORY: there is none.
bool dense_begin(Error *err);

// Cholesky factor in place of a symmetric `a` [n * n]; the lower triangle is read and written.
// false: `a` is not positive definite (nothing else can go wrong).
bool dense_cholesky(double *a, int32_t n);
// Is `a` [n * n], of which the lower triangle is read, positive definite? Factors it in single
// precision, with `shift` times each of its diagonal entries added to it, in half the time of a
// factor. DENSE_YES: shift < 0 and there is one. DENSE_NO: a diagonal entry is not above 0, or
// x'a x < 0 along the direction x in which the factor breaks down, which mostly shows where shift >
// 0. Else DENSE_UNSURE. work: [n * (n + 2)].
typedef enum DenseAnswer { DENSE_UNSURE, DENSE_YES, DENSE_NO } DenseAnswer;
DenseAnswer dense_definite_single(const double *a, int32_t n, double shift, float *work);

// LU with partial pivoting in place, then one right-hand side in place. pivots: [n].
// false: singular to working precision.
bool dense_lu(double *a, int32_t n, int32_t *pivots);
// The sign of the determinant of a factored matrix: 1, -1 or 0.
int dense_lu_sign(const double *lu, int32_t n, const int32_t *pivots);
void dense_lu_solve(const double *lu, int32_t n, const int32_t *pivots, double *b);
// Works in single precision, in half the time: some six digits, which are enough for steps whose
// residual is of double precision. work: [n].
bool dense_lu_single(float *a, int32_t n, int32_t *pivots);
void dense_lu_single_solve(const float *lu, int32_t n, const int32_t *pivots, double *b,
                           float *work);

// y = a x with the lower triangle of a symmetric `a` [n * n].
void dense_symmetric_apply(const double *a, int32_t n, const double *x, double *y);

// x := L x and x := L' x with the lower triangle of `lower` [n * n].
void dense_lower_apply(const double *lower, int32_t n, double *x);
void dense_lower_apply_transposed(const double *lower, int32_t n, double *x);
// x := L^-1 x and x := L^-T x
void dense_lower_solve(const double *lower, int32_t n, double *x);
void dense_lower_solve_transposed(const double *lower, int32_t n, double *x);

// c = L L' (all of c is written); lower, 0 above its diagonal, c: [n * n], distinct.
void dense_lower_square(const double *lower, int32_t n, double *c);

// Inverse, both triangles, of a symmetric positive definite `a` [n * n] from its Cholesky factor.
bool dense_invert_factored(double *a, int32_t n);

// y += factor x
void dense_add_scaled(double factor, const double *x, int32_t n, double *y);

// b := L b, L^-1 b and L^-T b, of `columns` columns of n.
void dense_lower_multiply(const double *lower, int32_t n, int32_t columns, double *b);
void dense_lower_divide(const double *lower, int32_t n, int32_t columns, double *b);
void dense_lower_divide_transposed(const double *lower, int32_t n, int32_t columns, double *b);

// Columns of a sparse factor as one dense panel [height * count]: the triangle L of `count` rows,
// and below it the other rows, R. For `columns` right sides, whose values for one unknown stand
// side by side, own [columns * count] and below [columns * (height - count)]: own := L^-1 own, then
// below := R own; and back, own := L^-T (own - R' below).
void dense_panel_forward(const double *panel, int32_t height, int32_t count, int32_t columns,
                         double *own, double *below);
void dense_panel_backward(const double *panel, int32_t height, int32_t count, int32_t columns,
                          double *own, const double *below);

// a := L^-1 a L^-T with a Cholesky factor `lower`; of the symmetric `a` [n * n] the lower triangle
// is read and written.
void dense_divide_both_sides(const double *lower, int32_t n, double *a);

// Doubles in the work array of each function below that finds eigenvalues; a constant where n is
// one. dstedc asks for 1 + 4 n + n^2 numbers and 3 + 5 n integers beside its vectors and three
// numbers a row, dsygvd for less, dgeev for 4 n at least.
#define DENSE_EIGEN_WORK(n) (4 + 12 * (int64_t)(n) + 2 * (int64_t)(n) * (n))

// Eigenvalues, ascending, and orthonormal eigenvectors (columns, in place) of a symmetric `a` [n *
// n]. values: [n]; work: [DENSE_EIGEN_WORK(n)], here and below.
bool dense_eigen(double *a, int32_t n, double *values, double *work);

// The same, with the vectors of eigenvalues above `least` alone, which are the last columns of `a`.
// The columns before them hold nothing of use.
bool dense_eigen_above(double *a, int32_t n, double least, double *values, double *work);

// Values, and vectors (columns) in the place of `a`, of a y = value b y, y'b y = 1, a and b
// symmetric [n * n]. b is destroyed; false also: it is not positive definite.
bool dense_eigen_pair(double *a, double *b, int32_t n, double *values, double *work);

// Eigenvalues (re, im: [n]) and right eigenvectors of a general `a` [n * n], which is destroyed. A
// complex pair takes two columns of `vectors` [n * n], real and imaginary part of the one with im >
// 0. work: [DENSE_EIGEN_WORK(n)].
bool dense_eigen_general(double *a, int32_t n, double *re, double *im, double *vectors,
                         double *work);

// A general matrix: column-major, `rows` long columns, no gaps.
typedef struct DenseView {
    const double *values;
    int32_t rows, columns;
} DenseView;
static inline DenseView dense_view(const double *values, int64_t rows, int64_t columns)
{
    return (DenseView){values, (int32_t)rows, (int32_t)columns};
}

// c = factor a' b + keep c, c = factor a b + keep c; c has the rows and columns that follow.
void dense_multiply_transposed(DenseView a, DenseView b, double factor, double keep, double *c);
void dense_multiply(DenseView a, DenseView b, double factor, double keep, double *c);
// c -= a'a of a symmetric c, whose lower triangle is read; both are written.
void dense_subtract_square(DenseView a, double *c);
// c += a b'
void dense_multiply_by_transposed(DenseView a, DenseView b, double *c);
// c or b may be rows of a larger matrix, whose columns are `stride` apart: c = factor a' b + keep
// c, and c += factor a b, b [a.columns * columns].
void dense_multiply_transposed_rows(DenseView a, DenseView b, double factor, double keep, double *c,
                                    int64_t stride);
void dense_multiply_rows(DenseView a, const double *b, int64_t stride, int64_t columns,
                         double factor, double *c);
// y = factor a x + keep y, y = factor a' x + keep y
void dense_apply(DenseView a, const double *x, double factor, double keep, double *y);
void dense_apply_transposed(DenseView a, const double *x, double factor, double keep, double *y);
// y += factor a x where much of x is 0: columns that meet a 0 are not read. Runs of columns and of
// every second one, as where unknowns of two directions take turns, go through BLAS together.
void dense_add_nonzero(DenseView a, const double *x, double factor, double *y);
// The same of a symmetric `a` [n * n], both triangles given: of its lower triangle alone, where
// most of x is not 0.
void dense_add_symmetric(const double *a, int32_t n, const double *x, double factor, double *y);
// y = a x for `count` vectors, the same bits as one by one: `a` comes from memory once.
void dense_apply_each(DenseView a, int32_t count, const double *const *x, double *const *y);

// out := a', [a.columns * a.rows] with columns `stride` apart.
void dense_transpose(DenseView a, double *out, int64_t stride);
// a [n * n]: its lower triangle into the upper one.
void dense_mirror(double *a, int64_t n);

double dense_dot(const double *x, const double *y, int32_t n);
double dense_max_abs(const double *x, int32_t n);

#endif
