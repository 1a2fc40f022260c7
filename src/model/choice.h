// SPDX-License-Identifier: GPL-2.0-or-later
// Whether reducing pays: what a run is expected to cost on a reduced block and on the full mesh, by
// counts alone, so that the same scene is always stepped in the same way. Called by model/obtain.
#ifndef AMONTONS_MODEL_CHOICE_H
#define AMONTONS_MODEL_CHOICE_H

#include "scene/scene.h"

typedef struct ChoiceSizes {
    bool space;   // in three dimensions: else in two
    double unknowns;   // of the mesh
    double interface;   // of those on floor and rod
    double stages;   // of the run (model/stages)
    double parts;   // that it is likely reduced in (reduction/mirror)
    double runs;   // that the basis will serve, this one too
    bool several;   // the block is of several materials
    bool held;   // the basis is in the cache
} ChoiceSizes;

// Processor seconds; meshing and output come to either way.
typedef struct ExpectedCost {
    double reduction;   // building the basis, where it is not held
    double reduced;   // factors and stages on it
    double full;   // factors and stages on the mesh
    double bytes_reduced, bytes_full;   // of memory that either way takes at most; 0: not known
} ExpectedCost;

ExpectedCost choice_expect(const ChoiceSizes *sizes);

// A basis that is held costs nothing; the runs that share one share its cost. Never beyond the
// memory that a basis may take.
bool choice_reduces(const ChoiceSizes *sizes, const ExpectedCost *cost);

#endif
