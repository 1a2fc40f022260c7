// SPDX-License-Identifier: GPL-2.0-or-later
// Random numbers for tests: the same on every machine, seeded by the case (splitmix64).
#ifndef AMONTONS_TESTS_RANDOM_NUMBERS_H
#define AMONTONS_TESTS_RANDOM_NUMBERS_H

#include <stdint.h>

typedef struct Random {
    uint64_t state;
} Random;

static inline uint64_t random_bits(Random *random)
{
    uint64_t z = random->state += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

// In [low, high).
static inline double random_between(Random *random, double low, double high)
{
    return low + (high - low) * (double)(random_bits(random) >> 11) * 0x1p-53;
}

// 0 .. count - 1
static inline int32_t random_index(Random *random, int32_t count)
{
    return (int32_t)(random_bits(random) % (uint64_t)count);
}

#endif
