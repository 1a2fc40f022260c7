// SPDX-License-Identifier: GPL-2.0-or-later
// The warnings of many runs, told together: sentences that differ in their numbers alone are of one
// kind. Filled by table, printed on the terminal.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_WARNED_H
#define AMONTONS_STUDY_SWEEP_SHOWING_WARNED_H

#include "amontons.h"

enum { WARNED_KINDS_MAX = 16, WARNED_NUMBERS_MAX = 8 };

typedef struct WarnedKind {
    char text[RUN_WARNING_SIZE];   // as the first run says it
    double low[WARNED_NUMBERS_MAX], high[WARNED_NUMBERS_MAX];   // of its numbers, in their order
    int32_t points;   // that have it
} WarnedKind;

typedef struct Warned {
    int32_t count;   // of kinds; what is of a later kind is of the last
    WarnedKind kinds[WARNED_KINDS_MAX];
    int32_t points;   // with a warning, all kinds
    uint32_t *of;   // [all points] bit k: has a warning of kind k; owned
    int32_t all;   // points
} Warned;

bool warned_make(int32_t points, Warned *warned, Error *err);
void warned_add(Warned *warned, int32_t point, const char *sentence);
// "8 of 36 points: slip is not resolved: ..." for each kind, and which points.
void warned_print(const Warned *warned, FILE *out);
void warned_destroy(Warned *warned);   // zeroed is fine

#endif
