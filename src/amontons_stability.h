// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons stability`: growth rates of slow slip. Public, as amontons.h.
#ifndef AMONTONS_STABILITY_H
#define AMONTONS_STABILITY_H

#include "amontons.h"

#ifdef __cplusplus
extern "C" {
#endif

// One state of the quasi-static path, and how small disturbances of it grow.
typedef struct StabilityPoint {
    double front;   // l, length
    int32_t slipping;   // contact nodes that slip: more than front says where slip has
        // begun in several places
    double U, mu;   // displacement of the rod, length; F_T / F_N for V -> 0
    double mu_at_V;   // the same at the scene's V, at which slow slip already weakens friction
    double rate_re, rate_im;   // the rightmost lambda of exp(lambda t), 1/time
    double real_rate;   // the largest real one above 0, 1/time; 0: none
    double load;   // weakening over the resistance of viscosity, inertia and elasticity, pressure
        // held fixed; from 1 on slip accelerates without oscillating (it runs away)
    bool certified;   // viscosity alone outweighs the weakening
    double area;   // how much of the contact slips, over all of it
} StabilityPoint;

enum { STABILITY_PADS_MAX = 64, STABILITY_WHY_MAX = 7, STABILITY_WHY_SIZE = 400 };

// Resistance of a contact curve (pad) to slip in the state where slip runs away at the scene's V;
// l, drag and stiffness of the pad alone, everything else held.
typedef struct StabilityPad {
    char name[64];
    double length;   // sum of its nodes' weights, in space over its breadth
    double pressure;   // its load over its length, stress
    double slipping;   // how much of it slips, length
    double mode;   // how much it takes part: mean |slip| of the mode that grows,
        // over the largest of all pads
    double load;   // when all of it slips: weakening over its resistance; below 1 it
        // cannot run away alone
    double l_c;   // how much of it, from its trailing edge on, may slip before it
        // runs away alone, length; NaN: all of it
    double drag;   // viscous shear of its softest slip over the slip rate,
        // stress / velocity: eta1/2 over H for a layer of height H
    double stiffness;   // elastic shear of its softest slip over the slip, stress/length
    double critical_stiffness;   // of friction that remembers: a massless body on a stiffness below
        // it does not slip steadily at V, stress/length; NaN: friction has no memory, or weakens
        // with slip rate at once, which no spring stabilises
} StabilityPad;

// Lengths: where something is first lost, over L, between two positions of the front; NaN: nowhere.
// l_c and l_c_rod are 1 where the front crosses the block before. mu_c is that of V -> 0, all other
// mu are those at the scene's V (StabilityPoint.mu_at_V).
typedef struct StabilitySummary {
    double l_sc_certificate;   // the certificate of time stepping; at a contact node
    double l_sc;   // Re lambda > 0: oscillations grow
    double l_c_scan;   // real growth, pressure held fixed
    double l_c;   // real growth: slow slip turns into sliding however slow the rod
    double l_c_rod;   // at the scene's V already: an oscillation grows from V to v_c
        // within half a period, pi Re/Im > ln(v_c/V)
    double mu_sc;   // mu at l_sc; NaN: nothing oscillates
    double mu_snap;   // where a node first jumps instead of slipping on; NaN: none
    double mu_c, mu_rod;   // mu at l_c and at l_c_rod: mu_M for V -> 0, and for V
    double U_c, U_rod;   // U there, length
    double frequency;   // Im lambda at l_sc, 1/time
    double area_sc, area_c, area_c_rod;   // how much of the contact slips at l_sc, l_c and l_c_rod,
        // over all of it
    double element;   // mean distance of contact nodes, over L
    int32_t points;
    int32_t pad_count;
    StabilityPad pads[STABILITY_PADS_MAX];   // [pad_count] by number of the contact curve
    int32_t pad;   // the one that takes part most where slip runs away
    double steady_contact;   // how long a contact of that pad may be, at its mean pressure and with
        // the rest of its face free, so that no disturbance of slip on it grows, length; the pad's
        // own length: all of it; 0: however short it is one grows; NaN: nothing runs away
    double nucleation_length;   // of friction that remembers: how long a part in the middle of that
        // pad may be so that no disturbance of its steady slip at V grows, at the pad's mean
        // pressure and with all else held, length; NaN: all of it, or friction has no memory
    int32_t why_count;
    char why[STABILITY_WHY_MAX][STABILITY_WHY_SIZE];   // [why_count] sentences on the above
    int64_t path_steps;
    double seconds_before, seconds_path, seconds_growth;   // dynamic run; path; growth rates
    char folder[AMONTONS_PATH_SIZE];
} StabilitySummary;

typedef void (*StabilityCallback)(const StabilityPoint *point, void *context);

typedef struct StabilityOptions {
    int32_t slidings;   // the path begins when so many slidings, computed by time
        // stepping, have ended; 0: at the relaxed start
    bool whole;   // follow the front to the end, also beyond l_c
    bool at_end;   // no path: the one state in which the scene's run ends
    const char *folder;   // for stability.json and stability.h5; NULL: none
    bool overwrite;
    StepCallback on_step;   // of the time stepping before the path; NULL: none
    StabilityCallback on_point;   // of the path; NULL: none
    void *context;   // handed to both
    const volatile sig_atomic_t *stop;   // as in RunOptions
} StabilityOptions;

// Follows the quasi-static path of `scene` and computes the growth rates at each front position.
bool amontons_stability(const Scene *scene, const StabilityOptions *options,
                        StabilitySummary *summary, Error *err);

#ifdef __cplusplus
}
#endif

#endif
