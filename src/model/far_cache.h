// SPDX-License-Identifier: GPL-2.0-or-later
// The modes of what is far above the line that a block stands on (reduction/upper_block,
// reduction/far_block), kept on disk under what they depend on: the mesh above the line over L,
// materials as a basis has them, load pattern, the rod's nodes, tolerance. A design whose contact
// or pads are others and whose upper block is the same takes them from here. Called by
// model/obtain.
//
//     CACHE/<name>.upper     layers, what K, C, M and f are for them, what S is off
//     CACHE/<name>.field     the modes themselves, kept and read only where fields of the bulk
//                            are asked for
#ifndef AMONTONS_MODEL_FAR_CACHE_H
#define AMONTONS_MODEL_FAR_CACHE_H

#include "reduction/upper_block.h"
#include "reduction/far_block.h"
#include "io/cache/store.h"

typedef struct FarCacheDef {
    const UpperBlock *upper;
    FarFieldDef far;
    bool with_fields;
    bool keep;   // read and written; false: the cache is left alone
} FarCacheDef;

// From the cache, *found, or made, and kept there; of processes that need it at once one makes it.
// `note`: why a cached one was not used or kept.
bool far_cache_obtain(const FarCacheDef *def, FarBlock *block, bool *found,
                      char note[CACHE_NOTE_SIZE], Error *err);

#endif
