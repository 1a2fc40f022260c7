// SPDX-License-Identifier: GPL-2.0-or-later
// Four numbers at once, and functions that are compiled twice: for any processor of its kind, and
// for those x86 processors that have AVX2 and FMA; which one runs is decided when the program is
// loaded. Used by algebra/dense and algebra/sparse_expand.
#ifndef AMONTONS_ALGEBRA_LANES_H
#define AMONTONS_ALGEBRA_LANES_H

enum { LANE = 4 };
typedef double Lane __attribute__((vector_size(LANE * sizeof(double)), aligned(sizeof(double))));

// Sanitizers are not ready yet when the choice is made.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&      \
    !defined(__clang__) && __GNUC__ >= 12
#define FOR_EACH_PROCESSOR __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define FOR_EACH_PROCESSOR
#endif

// Stands before a loop of at most four rounds: what it works on stays in registers.
#define UNROLLED _Pragma("GCC unroll 4")

// Marks a function that is called with constants and compiled once for each of them.
#define WITH_CONSTANTS static inline __attribute__((always_inline))

#endif
