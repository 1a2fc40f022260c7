// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/computation.h"

#include "base/kernels.h"
#include "computing_sources.h"

Hash computation_hash(void)
{
    Hash hash = hash_start();
    hash_text(&hash, COMPUTING_SOURCES);
    return hash;
}

Hash computation_hash_bits(void)
{
    Hash hash = computation_hash();
    hash_text(&hash, kernels_name());
    return hash;
}
