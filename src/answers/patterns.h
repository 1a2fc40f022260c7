// SPDX-License-Identifier: GPL-2.0-or-later
// Which pads slide together at the load drops of a run, and whether two meshes differ in it. Coarse
// meshes may agree on mu of a regime that finer ones do not have: two pads that slide by turns
// there, and each by itself here. Filled by run/accuracy, read by answers/error_bars.
#ifndef AMONTONS_ANSWERS_PATTERNS_H
#define AMONTONS_ANSWERS_PATTERNS_H

#include "record/drops.h"

enum { PATTERNS_MAX = 32 };

typedef struct Pattern {
    uint64_t pads;   // bit p: pad p slid over all its length; of more than 64 pads some share a bit
    int32_t drops;   // load drops with it
} Pattern;

typedef struct Patterns {
    int32_t count;
    Pattern list[PATTERNS_MAX];   // [count] those that were seen first
    int32_t drops;   // load drops in all
} Patterns;

void patterns_add(Patterns *patterns, uint64_t pads);
// Adds the load drops from number `first` of the list on.
void patterns_add_drops(Patterns *patterns, const Drops *drops, int32_t first);

// One of them has a pattern that the other lacks, and that is no chance: if the pattern were
// equally likely in all drops of both, it would be so in fewer than 5 of 100 cases (Fisher's exact
// test).
bool patterns_differ(const Patterns *one, const Patterns *other);

#endif
