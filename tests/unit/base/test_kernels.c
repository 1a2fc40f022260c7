// SPDX-License-Identifier: GPL-2.0-or-later
// Which kernels the processor could run, whatever OpenBLAS has taken. What the processor can do is
// read from the system, not asked of it again; OpenBLAS's word is ours.
#include "base/kernels.h"

#include "near.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static char taken[32];

// In place of OpenBLAS's.
char *openblas_get_corename(void);
char *openblas_get_corename(void)
{
    return taken;
}

// " avx2 " in the first line of flags of /proc/cpuinfo.
static bool processor_has(const char *flag)
{
    char line[8192], word[32];
    bool found = false;
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(word, sizeof word, " %s ", flag);
    while (file && fgets(line, sizeof line, file)) {
        if (strncmp(line, "flags", 5) != 0) continue;
        *strchr(line, '\n') = ' ';
        found = strstr(line, word);
        break;
    }
    if (file) fclose(file);
    return found;
}

// NULL: another kind of processor, also where that is emulated and /proc/cpuinfo tells of the host.
static const char *best_here(void)
{
#ifndef __x86_64__
    return NULL;
#endif
    if (processor_has("avx512vl") && processor_has("avx512dq") && processor_has("avx512bw"))
        return "SkylakeX";
    if (processor_has("avx2") && processor_has("fma")) return "Haswell";
    return processor_has("avx") ? "Sandybridge" : NULL;
}

static void assert_possible(const char *name, const char *possible)
{
    snprintf(taken, sizeof taken, "%s", name);
    assert_string_equal(kernels_name(), name);
    assert_string_equal(kernels_possible(), possible);
}

// Kernels for a processor that OpenBLAS does not know, or a choice of less.
TEST(test_less_than_the_processor_can)
{
    const char *best = best_here();
    if (!best) skip();
    assert_possible("Prescott", best);
    assert_possible("NEHALEM", best);
}

// Kernels that are as good stay: OpenBLAS knows better. So do those of a later OpenBLAS.
TEST(test_as_good_as_the_processor)
{
    const char *best = best_here();
    if (!best) skip();
    assert_possible(best, best);
    assert_possible("Cooperlake", "Cooperlake");
    assert_possible("of a later one", "of a later one");
    if (strcmp(best, "Haswell") == 0) assert_possible("Zen", "Zen");
}
