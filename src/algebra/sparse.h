// SPDX-License-Identifier: GPL-2.0-or-later
// Sparse symmetric matrices and their Cholesky factors (CHOLMOD behind it), with a chosen set of
// unknowns eliminated last. Called by fem/assembly (products) and reduction/interface_operator.
//
// With the border b ordered last and the interior i before it,
//
//     A = [ A_ii  A_ib ] = L L',   L = [ L_ii   0   ],   L_bb L_bb' = S = A_bb - A_bi A_ii^-1 A_ib:
//         [ A_bi  A_bb ]               [ L_bi  L_bb ]
//
// the factor holds the exact Schur complement of the interior. A solve splits at the border:
// condense (forward substitution) gives g = b_b - A_bi A_ii^-1 b_i, the caller finds x_b from
// S x_b = g + r in its own way, expand (backward substitution) gives all of x.
#ifndef AMONTONS_ALGEBRA_SPARSE_H
#define AMONTONS_ALGEBRA_SPARSE_H

#include "base/error.h"

#include <stdint.h>

// Symmetric, both triangles stored, compressed columns (or rows: the same).
typedef struct SparsePattern {
    int32_t size;
    int32_t *start;   // [size + 1]; owned
    int32_t *index;   // [start[size]] ascending in a column; owned
} SparsePattern;
void sparse_pattern_destroy(SparsePattern *pattern);
// Points in groups: those of group g are member[start[g] .. start[g + 1] - 1].
typedef struct PointGroups {
    int32_t points, count;
    int32_t *start, *member;   // not owned
} PointGroups;
// The pattern in which all points of a group are neighbours, each of `width` unknowns.
bool sparse_pattern_of_groups(const PointGroups *groups, int32_t width, SparsePattern *pattern,
                              Error *err);

// Index of the entry (row, column) among the values. Where the pattern has no such entry it is that
// of another entry of the row, which must have one.
int32_t sparse_entry(const SparsePattern *pattern, int32_t row, int32_t column);

// y = A x; values: [start[size]].
void sparse_apply(const SparsePattern *pattern, const double *values, const double *x, double *y);
// The same for `columns` columns of x and y, [size] each.
void sparse_apply_many(const SparsePattern *pattern, const double *values, const double *x,
                       int64_t columns, double *y);

// The fill-reducing order and symbolic factor of one pattern, which must outlive it. place:
// [3 * size] coordinates of each unknown, by which they are ordered; NULL: by the pattern alone.
typedef struct SparseAnalysis SparseAnalysis;
SparseAnalysis *sparse_analyse(const SparsePattern *pattern, const double *place,
                               const int32_t *border, int32_t border_count, Error *err);
// Another one, for another thread.
SparseAnalysis *sparse_analysis_copy(const SparseAnalysis *from, Error *err);
void sparse_analysis_destroy(SparseAnalysis *analysis);   // NULL is fine

typedef struct SparseFactor SparseFactor;   // of one matrix; the analysis must outlive it

// values: [start[size]] of the analysed pattern. ERROR_COMPUTE: not positive definite.
SparseFactor *sparse_factorise(SparseAnalysis *analysis, const double *values, Error *err);
void sparse_factor_destroy(SparseFactor *factor);   // NULL is fine

// schur := S, column-major [border_count * border_count], both triangles, in the order of `border`.
void sparse_schur(const SparseFactor *factor, double *schur);
// Its Cholesky factor, owned by the factor; 0 above the diagonal.
const double *sparse_schur_lower(const SparseFactor *factor);

// rhs: [size] -> g: [border_count]. Keeps the half-solved system for the expand that follows.
bool sparse_condense(SparseFactor *factor, const double *rhs, double *g, Error *err);
// x_border: [border_count] -> x: [size]; nothing is allocated after the first solve.
bool sparse_expand(SparseFactor *factor, const double *x_border, double *x, Error *err);
// The same for many columns at once, in a fraction of the time that one by one would take; two
// threads do half each. Neither knows of the other: g [border_count * count] from rhs [size *
// count], and x [size * count], with no right-hand side inside, from x_border [border_count *
// count].
bool sparse_condense_many(const SparseFactor *factor, const double *rhs, int32_t count, double *g,
                          Error *err);
bool sparse_expand_many(const SparseFactor *factor, const double *x_border, int32_t count,
                        double *x, Error *err);

#endif
