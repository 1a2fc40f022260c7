// SPDX-License-Identifier: GPL-2.0-or-later
// Identifies the sources that compute a number: beside what was asked for, it depends on these.
// Whoever keeps numbers for later (caches, saved states, rows of a sweep) keeps this hash with
// them, and takes none that has another. Two builds of the same sources have the same hash,
// whatever is in their pages, pictures and tests.
#ifndef AMONTONS_BASE_COMPUTATION_H
#define AMONTONS_BASE_COMPUTATION_H

#include "base/hash.h"

// A hash to go on with, or to write as a word. Answers with other kernels of linear algebra agree
// within their bars (docs/reliability.md): rows and states may be gone on with on another
// processor.
Hash computation_hash(void);
// The same with the kernels, for caches, as the same scene gives the same bits with and without
// them.
Hash computation_hash_bits(void);

#endif
