// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons model1d`: the 1D model of a block. Public, as amontons.h.
#ifndef AMONTONS_MODEL1D_H
#define AMONTONS_MODEL1D_H

#include "amontons.h"

#ifdef __cplusplus
extern "C" {
#endif

// One position of the quasi-static front in theory, and in the simulation when its rod has gone
// as far (NaN where it had slid by then).
typedef struct Model1dPoint {
    double front;   // l, length
    double U;   // displacement of the rod since sliding stopped, length
    double mu, mu_line;   // F_T / F_N: exactly; and mu_K + (mu_S - mu_K) l/L
    double omega_re, omega_im;   // omega_0 of the paper, off-diagonal terms neglected, 1/time
    double rate_re, rate_im;   // the rightmost rate with all terms, 1/time
    int32_t growing;   // how many omega_n have a positive real part
    double front_seen, mu_seen;   // simulated, at the same U
} Model1dPoint;

// Lengths are over L. NaN: not found; a length of the paper's formulas may be above 1.
typedef struct Model1dSummary {
    double range;   // kappa r: how far held points are felt
    // the paper's: Re omega_0 > 0; omega_0 > 0; its small-l law; mu_K + (mu_S - mu_K) min(l_c/L, 1)
    double l_sc, l_c, l_c_small, mu_c;
    // all terms kept; l_rod: an oscillation grows from V to v_c within half a period
    double l_sc_full, l_c_full, l_rod_full;
    double mu_c_full, mu_rod_full;   // the exact mu there (mu_S where there is no such l)
    bool simulated;   // what follows is set
    // the first peak: it starts from tau = mu_K p, as the theory does; and the periodic ones
    double first_mu, first_l_sc, first_l_c;
    double mu_M, mu_M_spread, l_sc_seen, l_c_seen;
    int32_t period, peaks, peaks_counted, bounded, leading;
    double quasi_static_error;   // |mu - theory| before anything was rapid, largest
    double energy_error, contact_error;   // relative, largest
    int64_t accepted, rejected;   // steps
    double seconds;
    char folder[AMONTONS_PATH_SIZE];
} Model1dSummary;

typedef void (*Model1dCallback)(const Model1dPoint *point, void *context);

typedef struct Model1dOptions {
    double alpha;   // part of H over which the shear stress varies: the paper's 0.2
    int32_t nodes;   // of the simulated line, 3 to 2000
    bool theory_only;
    const char *folder;   // for model1d.json, model1d.h5, history.h5; NULL: none
    bool overwrite;
    StepCallback on_step;   // of the simulation; NULL: none
    Model1dCallback on_point;   // of the finished table; NULL: none
    void *context;   // handed to both
    const volatile sig_atomic_t *stop;   // as in RunOptions
} Model1dOptions;
Model1dOptions amontons_model1d_options(void);   // alpha 0.2, 81 nodes, simulated, no folder

// The effective model with the block, the material, the friction and the rod of `scene`: theory,
// and a simulation up to the scene's end. ERROR_INPUT where the model does not apply.
bool amontons_model1d(const Scene *scene, const Model1dOptions *options, Model1dSummary *summary,
                      Error *err);

#ifdef __cplusplus
}
#endif

#endif
