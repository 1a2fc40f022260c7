// SPDX-License-Identifier: GPL-2.0-or-later
// Dense linear algebra written out for tests, without BLAS: the judge of what algebra/dense,
// algebra/sparse and all above them compute. Column-major; arrays come from malloc and are freed
// here.
#ifndef AMONTONS_TESTS_DENSE_BY_HAND_H
#define AMONTONS_TESTS_DENSE_BY_HAND_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static inline double *hand_matrix(int32_t rows, int32_t columns)
{
    return calloc((size_t)rows * (size_t)columns + 1, sizeof(double));
}

// Gauss with partial pivoting: b [n * rhs] becomes a^-1 b; a is destroyed. false: singular.
static inline bool hand_solve(double *a, int32_t n, double *b, int32_t rhs)
{
    for (int32_t k = 0; k < n; k++) {
        int32_t pivot = k;
        for (int32_t i = k + 1; i < n; i++)
            if (fabs(a[k * n + i]) > fabs(a[k * n + pivot])) pivot = i;
        if (a[k * n + pivot] == 0) return false;
        for (int32_t j = 0; j < n + rhs; j++) {
            double *column = j < n ? a + j * n : b + (j - n) * n, swapped = column[k];
            column[k] = column[pivot];
            column[pivot] = swapped;
        }
        for (int32_t i = k + 1; i < n; i++) {
            double factor = a[k * n + i] / a[k * n + k];
            if (factor == 0) continue;
            for (int32_t j = k; j < n; j++) a[j * n + i] -= factor * a[j * n + k];
            for (int32_t j = 0; j < rhs; j++) b[j * n + i] -= factor * b[j * n + k];
        }
    }
    for (int32_t j = 0; j < rhs; j++) {
        for (int32_t k = n - 1; k >= 0; k--) {
            for (int32_t i = k + 1; i < n; i++) b[j * n + k] -= a[i * n + k] * b[j * n + i];
            b[j * n + k] /= a[k * n + k];
        }
    }
    return true;
}

static inline void hand_apply(const double *a, int32_t rows, int32_t columns, const double *x,
                              double *y)
{
    for (int32_t i = 0; i < rows; i++) y[i] = 0;
    for (int32_t j = 0; j < columns; j++)
        for (int32_t i = 0; i < rows; i++) y[i] += a[j * rows + i] * x[j];
}

// S = A_bb - A_bi A_ii^-1 A_ib for the listed border; schur: [count * count].
static inline void hand_schur(const double *a, int32_t n, const int32_t *border, int32_t count,
                              double *schur)
{
    int32_t inner = 0, *rest = malloc(((size_t)n + 1) * sizeof *rest);
    for (int32_t i = 0; i < n; i++) {
        bool held = false;
        for (int32_t j = 0; j < count; j++) held = held || border[j] == i;
        if (!held) rest[inner++] = i;
    }
    double *a_ii = hand_matrix(inner, inner), *x = hand_matrix(inner, count);
    for (int32_t j = 0; j < inner; j++)
        for (int32_t i = 0; i < inner; i++) a_ii[j * inner + i] = a[rest[j] * n + rest[i]];
    for (int32_t j = 0; j < count; j++)
        for (int32_t i = 0; i < inner; i++) x[j * inner + i] = a[border[j] * n + rest[i]];
    hand_solve(a_ii, inner, x, count);
    for (int32_t j = 0; j < count; j++) {
        for (int32_t i = 0; i < count; i++) {
            double sum = a[border[j] * n + border[i]];
            for (int32_t k = 0; k < inner; k++)
                sum -= a[rest[k] * n + border[i]] * x[j * inner + k];
            schur[j * count + i] = sum;
        }
    }
    free(rest);
    free(a_ii);
    free(x);
}

// Eigenvalues of a symmetric matrix, ascending, by Jacobi's rotations; a is destroyed.
static inline void hand_eigenvalues(double *a, int32_t n, double *values)
{
    for (int32_t sweep = 0; sweep < 30; sweep++) {
        for (int32_t p = 0; p < n; p++) {
            for (int32_t q = p + 1; q < n; q++) {
                double off = a[q * n + p];
                if (off == 0) continue;
                double theta = (a[q * n + q] - a[p * n + p]) / (2 * off);
                double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int32_t k = 0; k < n; k++) {
                    double kp = a[p * n + k], kq = a[q * n + k];
                    a[p * n + k] = c * kp - s * kq;
                    a[q * n + k] = s * kp + c * kq;
                }
                for (int32_t k = 0; k < n; k++) {
                    double pk = a[k * n + p], qk = a[k * n + q];
                    a[k * n + p] = c * pk - s * qk;
                    a[k * n + q] = s * pk + c * qk;
                }
            }
        }
    }
    for (int32_t i = 0; i < n; i++) {
        int32_t k = i;
        for (; k > 0 && values[k - 1] > a[i * n + i]; k--) values[k] = values[k - 1];
        values[k] = a[i * n + i];
    }
}

#endif
