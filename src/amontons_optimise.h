// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons optimise` and `amontons fit`: the best design of a study that searches, and the numbers
// that measurements speak for. Public, as amontons.h.
#ifndef AMONTONS_OPTIMISE_H
#define AMONTONS_OPTIMISE_H

#include "amontons.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { OPTIMISE_WORDS_SIZE = 512, FIT_KEYS_MAX = 12, FIT_KEY_SIZE = 96 };

typedef struct OptimiseSummary {
    int32_t designs, computed;   // with a value; points computed
    double value, bar;   // of the best design, of what the study ranks by; NaN: none
    bool decided;   // no other design that was tried may be better, with the bars of both
    double start_value, start_bar;   // of the scene as it is; NaN: it is no design of the search
    char best[OPTIMISE_WORDS_SIZE];   // "mesh.set.n=4 mesh.set.pad_height=0.0823"
    double seconds;
} OptimiseSummary;

// Chooses designs of the study file `path` one after the other, computes each at all points of its
// `vary`, as a sweep does, and leaves the sweep's table of all of them, with figures of the search.
// `options->out` gets the answer in words. The same call goes on where an earlier one was stopped,
// as nothing is computed twice. ERROR_INTERRUPT: stopped, table written; ERROR_COMPUTE: no design
// came to a value.
bool amontons_optimise(const char *path, const SweepOptions *options, OptimiseSummary *summary,
                       Error *err);

typedef struct FitParameter {
    char key[FIT_KEY_SIZE];   // of the scene
    double value, low, high;   // the best, and its region: the profile of the misfit
    bool low_open, high_open;   // the region goes on beyond the range that was searched
} FitParameter;

typedef struct FitSummary {
    int32_t parameter_count, measurements;
    FitParameter parameters[FIT_KEYS_MAX];
    int32_t designs, computed;   // with all that was measured; points computed
    double misfit;   // sum of squares of (found - measured), each over its errors
    double widened;   // regions, as the misfit is above what errors explain; 1: it is not
    double own_share;   // of the errors' squares, the program's own: 0 to 1, the mean
    double seconds;
} FitSummary;

// Chooses values of the keys that the study file `path` searches, computes them under all
// conditions that were measured, and finds which agree with the measurements. The rest as above.
bool amontons_fit(const char *path, const SweepOptions *options, FitSummary *summary, Error *err);

#ifdef __cplusplus
}
#endif

#endif
