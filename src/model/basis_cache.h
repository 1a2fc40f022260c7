// SPDX-License-Identifier: GPL-2.0-or-later
// Reduced bulks, kept on disk under what they depend on (reduction/reduction_block) and nothing
// else: one serves every length, pressure, density, viscosity (eta2/eta1 alike), velocity and
// friction law. Called by model/obtain.
//
//     CACHE/<name>.basis     sizes, reduced M, C, K and load, what it is off
//     CACHE/<name>.modes     u = modes [u_b; q], kept and read only where fields of the bulk are
//                            asked for
#ifndef AMONTONS_MODEL_BASIS_CACHE_H
#define AMONTONS_MODEL_BASIS_CACHE_H

#include "reduction/reduced_bulk.h"
#include "io/cache/store.h"

// Fills `reduced`, scales left at 0. *found: false when there is nothing, or nothing that is valid:
// `note` then says why. with_modes: the modes must be there too. name: empty for none.
bool basis_cache_load(const char *name, bool with_modes, ReducedBulk *reduced, bool *found,
                      char note[CACHE_NOTE_SIZE], Error *err);

// false: it could not be stored, `note` says why. Never an error.
bool basis_cache_store(const char *name, const ReducedBulk *reduced, char note[CACHE_NOTE_SIZE]);

#endif
