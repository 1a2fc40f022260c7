// SPDX-License-Identifier: GPL-2.0-or-later
// The contact along x at chosen moments, as numbers. Called by figure_data.
#ifndef AMONTONS_RENDER_FIGURES_FIGURE_PROFILE_H
#define AMONTONS_RENDER_FIGURES_FIGURE_PROFILE_H

#include "render/view/result_view.h"

enum { PROFILES_MAX = 8, PROFILE_WORDS_SIZE = 100 };

typedef enum ProfileQuantity {
    PROFILE_PRESSURE,   // p, stress
    PROFILE_SHEAR,   // tau; in space its size, stress
    PROFILE_RATIO,   // tau/p, 1; NaN where open
    PROFILE_SLIP,   // along the drive since the first moment; since the rod's start if it is alone
    PROFILE_AREA,   // of the real contacts over that when the rod started, 1; 0 where open
    PROFILE_GAP,   // between block and floor, length; 0 where they touch
    PROFILE_QUANTITIES
} ProfileQuantity;

typedef struct Profiles {
    int32_t count;   // moments
    int32_t nodes;
    int64_t row[PROFILES_MAX];   // [count] of the history
    char words[PROFILES_MAX][PROFILE_WORDS_SIZE];   // when that was
    // [count * nodes] each; gap and area NULL where the history has none; owned
    double *values[PROFILE_QUANTITIES];
    double *status;   // [count * nodes] 0: open; owned
    bool opens;   // some node is open at one of the moments
} Profiles;

// at: "U=0.01,U=0.02", "t=12", or "mu=0.2", all moments at which F_T/F_N rises through it, the last
// ones; NULL: around the last sliding of the whole block (else the last rapid event): before it at
// the load that is left after it, just before it, and after it. Without an event the largest
// F_T/F_N and the end.
bool profiles_read(ResultView *view, const char *at, Profiles *profiles, Error *err);
void profiles_destroy(Profiles *profiles);   // zeroed is fine

#endif
