// SPDX-License-Identifier: GPL-2.0-or-later
// A build of OpenBLAS for all processors (DYNAMIC_ARCH) chooses while it is loaded, where its
// variable goes before the processor. Other builds have one kind of kernels.
#include "base/kernels.h"

#include <cblas.h>
#include <stddef.h>
#include <strings.h>

// Kernels by the widest instructions that they use.
typedef enum KernelLevel { LEVEL_SSE, LEVEL_AVX, LEVEL_AVX2, LEVEL_AVX512 } KernelLevel;
static const char *const best_of[] = {
    [LEVEL_AVX] = "Sandybridge", [LEVEL_AVX2] = "Haswell", [LEVEL_AVX512] = "SkylakeX"};

// Kernels below the highest level; a kernel that is not here is of the highest, or of a later
// OpenBLAS.
static const struct {
    const char *name;
    KernelLevel level;
} known[] = {
    {"Prescott", LEVEL_SSE},   {"Core2", LEVEL_SSE},      {"Penryn", LEVEL_SSE},
    {"Dunnington", LEVEL_SSE}, {"Nehalem", LEVEL_SSE},    {"Atom", LEVEL_SSE},
    {"Nano", LEVEL_SSE},       {"Opteron", LEVEL_SSE},    {"Opteron_SSE3", LEVEL_SSE},
    {"Barcelona", LEVEL_SSE},  {"Bobcat", LEVEL_SSE},     {"Sandybridge", LEVEL_AVX},
    {"Bulldozer", LEVEL_AVX},  {"Piledriver", LEVEL_AVX}, {"Steamroller", LEVEL_AVX},
    {"Excavator", LEVEL_AVX2}, {"Haswell", LEVEL_AVX2},   {"Zen", LEVEL_AVX2},
};

// Level that processor and system allow. On other processors OpenBLAS's choice stays.
#ifdef __x86_64__
static KernelLevel level_of_processor(void)
{
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        return LEVEL_AVX512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return LEVEL_AVX2;
    return __builtin_cpu_supports("avx") ? LEVEL_AVX : LEVEL_SSE;
}
#else
static KernelLevel level_of_processor(void)
{
    return LEVEL_SSE;
}
#endif

const char *kernels_name(void)
{
    return openblas_get_corename();
}

const char *kernels_possible(void)
{
    const char *name = kernels_name();
    KernelLevel level = level_of_processor(), taken = LEVEL_AVX512;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcasecmp(name, known[k].name) == 0) taken = known[k].level;
    return taken < level ? best_of[level] : name;
}
