// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/computation.h"

#include "computing_sources.h"

// Not in it: versions and kernels of linear algebra, between which answers agree as
// docs/reliability.md says. What is to separate kept numbers from then on is added here.
Hash computation_hash(void)
{
    Hash hash = hash_start();
    hash_text(&hash, COMPUTING_SOURCES);
    return hash;
}
