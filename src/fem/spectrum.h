// SPDX-License-Identifier: GPL-2.0-or-later
// The branches of all materials of a block as few matrices: branches of one relaxation time stretch
// alike wherever they are, and the stiffness of every branch is a sum of few shape matrices S_j,
//
//     M u'' + C u' + K u + sum_k K_k e_k = f + r,   e_k' = u' - e_k/tau_k,   K_k = sum_j g_kj S_j,
//
// e_k the stretch of the branches of time tau_k (docs/method.md, section 16). For a real rate s
// they are a stiffness: K + sum_k s tau_k/(1 + s tau_k) K_k. Called by fem/assembly, reduction and
// stepping.
#ifndef AMONTONS_FEM_SPECTRUM_H
#define AMONTONS_FEM_SPECTRUM_H

#include "base/error.h"
#include "base/hash.h"
#include "fem/material.h"

enum { SPECTRUM_SHAPES_MAX = 16, SPECTRUM_TIMES_MAX = 64 };

// The moduli of S_j, and the one material that it is of.
typedef struct SpectrumShape {
    int32_t region;
    Moduli moduli;   // 1; of K itself, stress
} SpectrumShape;

typedef struct Spectrum {
    int32_t shape_count, count;   // of S_j; of relaxation times; 0: no material has branches
    int32_t matrix_count;   // of S_j with a matrix of their own, the first ones; in a block of one
        // material the last may be K itself
    SpectrumShape shape[SPECTRUM_SHAPES_MAX];   // [shape_count]
    double time[SPECTRUM_TIMES_MAX];   // [count] tau_k
    // [count][shape_count] g_kj, stress; of K itself 1.
    double share[SPECTRUM_TIMES_MAX][SPECTRUM_SHAPES_MAX];
} Spectrum;

// dim: of the block. ERROR_INPUT: more than there is room for.
bool spectrum_find(const Materials *materials, int32_t dim, Spectrum *spectrum, Error *err);

// Branches that relax within `fastest` become viscosities of their materials, tau G_k and tau K_k.
// Returns whether there were any.
bool spectrum_fold(double fastest, Materials *materials, Spectrum *spectrum);

// A = m M + c C + k K stands for the rate s = c/k, at which branches resist, too: the factor of K_k
// in A, k s tau/(1 + s tau); 0 where c or k is.
static inline double spectrum_factor(double time, double damping, double stiffness)
{
    double product = stiffness * damping * time;
    return product > 0 ? product / (stiffness + damping * time) : 0;
}

// The factors of the shape matrices in A: weight [matrix_count]; returns what is added to that of
// K.
double spectrum_weights(const Spectrum *spectrum, double damping, double stiffness, double *weight);

// The same in other units: factors of stresses and times.
Spectrum spectrum_scaled(const Spectrum *spectrum, double share, double time);

void spectrum_hash(const Spectrum *spectrum, Hash *hash);

#endif
