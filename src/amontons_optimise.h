// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons optimise`: the best design of a study that searches. Public, as amontons.h.
#ifndef AMONTONS_OPTIMISE_H
#define AMONTONS_OPTIMISE_H

#include "amontons.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { OPTIMISE_WORDS_SIZE = 512 };

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

#ifdef __cplusplus
}
#endif

#endif
