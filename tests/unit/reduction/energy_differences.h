// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef AMONTONS_TESTS_ENERGY_DIFFERENCES_H
#define AMONTONS_TESTS_ENERGY_DIFFERENCES_H

#include "dense_by_hand.h"
#include "near.h"

// The least and the largest eigenvalue of `wanted`^-1 (value - wanted), by Gauss and Jacobi:
// relative differences in the energy norm of `wanted`, with their sign.
static inline void energy_differences(const double *value, const double *wanted, int32_t n,
                                      double *least, double *largest)
{
    double *lower = hand_matrix(n, n), *a = hand_matrix(n, n), *values = hand_matrix(n, 1);
    memcpy(lower, wanted, (size_t)(n * n) * sizeof *lower);
    for (int32_t j = 0; j < n; j++) {   // Cholesky: lower, columns
        for (int32_t k = 0; k < j; k++)
            for (int32_t i = j; i < n; i++) lower[j * n + i] -= lower[k * n + i] * lower[k * n + j];
        double root = sqrt(lower[j * n + j]);
        assert_true(root > 0);
        for (int32_t i = j; i < n; i++) lower[j * n + i] /= root;
    }
    for (int32_t k = 0; k < n * n; k++) a[k] = value[k] - wanted[k];
    for (int side = 0; side < 2; side++) {   // a := L^-1 a, transposed: twice gives L^-1 a L^-T
        for (int32_t j = 0; j < n; j++) {
            for (int32_t i = 0; i < n; i++) {
                for (int32_t k = 0; k < i; k++) a[j * n + i] -= lower[k * n + i] * a[j * n + k];
                a[j * n + i] /= lower[i * n + i];
            }
        }
        for (int32_t j = 0; j < n; j++) {
            for (int32_t i = 0; i < j; i++) {
                double swapped = a[j * n + i];
                a[j * n + i] = a[i * n + j];
                a[i * n + j] = swapped;
            }
        }
    }
    hand_eigenvalues(a, n, values);
    *least = values[0];
    *largest = values[n - 1];
    free(lower);
    free(a);
    free(values);
}

#endif
