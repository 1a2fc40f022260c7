// SPDX-License-Identifier: GPL-2.0-or-later
// What a number depends on beside what was asked for: which sources compute it. Whoever keeps
// numbers for later (caches, saved states, rows of a sweep) keeps this with them, and takes none
// that has another. Two builds of the same sources have the same, whatever is in their pages,
// pictures and tests.
#ifndef AMONTONS_BASE_COMPUTATION_H
#define AMONTONS_BASE_COMPUTATION_H

#include "base/hash.h"

Hash computation_hash(void);   // to go on with, or to write as a word

#endif
