// SPDX-License-Identifier: GPL-2.0-or-later
// Memory that a run takes at most; what a computer has, base/system says. Called by model/obtain
// and run/info/forecast.
#ifndef AMONTONS_MODEL_MEMORY_H
#define AMONTONS_MODEL_MEMORY_H

#include <stdbool.h>

typedef struct MemorySizes {
    bool space;   // in three dimensions: else in two
    double unknowns;   // of the mesh
    double interface;   // of those on floor and rod
    bool one_side;   // contact is its own mirror image (contact/contact_half)
    double parts;   // that the block is reduced in (reduction/mirror)
    bool one_by_one;   // they are built one after another
    bool modes;   // they are kept, for fields and probes
} MemorySizes;

// Estimate of the largest memory that a run takes, bytes: on the reduced block and its reduction,
// or on the whole mesh. 0: not known, as on the whole mesh in the plane.
double memory_expected(const MemorySizes *sizes, bool reduced);

#endif
