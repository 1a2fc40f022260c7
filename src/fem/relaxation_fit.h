// SPDX-License-Identifier: GPL-2.0-or-later
// A generalised Maxwell solid from what was measured of it: storage and loss modulus over angular
// frequency,
//
//     M'(w)  = M_0 + sum_k M_k (w tau_k)^2 / (1 + (w tau_k)^2)
//     M''(w) = eta w + sum_k M_k w tau_k / (1 + (w tau_k)^2),
//
// or a relaxation curve M(t) = M_0 + sum_k M_k exp(-t/tau_k). With given relaxation times the
// moduli are a linear least-squares problem whose unknowns are not negative (Lawson and Hanson,
// Solving Least Squares Problems, 1974, chapter 23; of relative differences, as moduli span
// decades). Called by scene/material_file.
#ifndef AMONTONS_FEM_RELAXATION_FIT_H
#define AMONTONS_FEM_RELAXATION_FIT_H

#include "base/error.h"

#include <stdint.h>

enum { RELAXATION_TERMS_MAX = 20, RELAXATION_POINTS_MAX = 1000 };

typedef struct RelaxationData {
    int32_t count;   // 2 to RELAXATION_POINTS_MAX
    bool over_time;   // a relaxation curve
    const double *at;   // [count] angular frequency, 1/time; over_time: time; above 0
    const double *storage;   // [count] M' or M(t), stress; above 0
    const double *loss;   // [count] M'', stress, above 0; NULL: over_time
} RelaxationData;

typedef struct RelaxationFit {
    double rest;   // M_0, of the long-time response, stress
    double viscosity;   // eta, stress * time
    int32_t count;
    double time[RELAXATION_TERMS_MAX];   // [count] ascending
    double modulus[RELAXATION_TERMS_MAX];   // [count] stress, above 0
    double misfit;   // root of the mean square of relative differences
    double worst;   // the largest of them
} RelaxationFit;

// Relaxation times are even over their logarithm, from a third of that of the fastest datum to
// three times that of the slowest; as few as leave no more misfit than half a per cent above the
// least that there is.
// has_viscosity: eta is found with them, what relaxes faster than the data tell; else it is 0.
// ERROR_INPUT: data that are not as above.
bool relaxation_fit(const RelaxationData *data, bool has_viscosity, RelaxationFit *fit, Error *err);

// M' and M'' at an angular frequency, and M(t).
void relaxation_moduli(const RelaxationFit *fit, double frequency, double *storage, double *loss);
double relaxation_at(const RelaxationFit *fit, double time);

// Least squares of A x - b with x >= 0: A [rows * columns] row by row, b [rows], x [columns].
// ERROR_INPUT: it does not settle.
bool least_squares_not_negative(const double *A, const double *b, int32_t rows, int32_t columns,
                                double *x, Error *err);

// Ratio of relaxation times at a temperature to those at the reference: a_T of Williams, Landel and
// Ferry (J. Am. Chem. Soc. 77, 1955), log10 a_T = -c1 (T - T_ref)/(c2 + T - T_ref). NaN: at or
// below T_ref - c2.
double wlf_shift(double c1, double c2, double reference, double temperature);

#endif
