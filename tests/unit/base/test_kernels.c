// SPDX-License-Identifier: GPL-2.0-or-later
// OpenBLAS's kernels follow the processor, whatever OpenBLAS took, unless the user chose. What the
// processor can do is read from the system, not asked of it again.
#include "base/kernels.h"

#include "algebra/dense.h"
#include "near.h"

#include <stdlib.h>
#include <string.h>

void gotoblas_dynamic_init(void) __attribute__((weak));
void gotoblas_dynamic_quit(void) __attribute__((weak));

static char *asked;   // by who runs the test

// As OpenBLAS does it when it is loaded, on a processor for which it takes `name`.
static void take(const char *name)
{
    gotoblas_dynamic_quit();
    setenv("OPENBLAS_CORETYPE", name, 1);
    gotoblas_dynamic_init();
    unsetenv("OPENBLAS_CORETYPE");
    assert_string_equal(kernels_name(), name);
}

FIXTURE(can_choose)
{
    if (!gotoblas_dynamic_init) return 0;
    const char *was = getenv("OPENBLAS_CORETYPE");
    asked = was ? strdup(was) : NULL;
    return 0;
}

FIXTURE(take_back)
{
    if (asked) setenv("OPENBLAS_CORETYPE", asked, 1);
    free(asked);
    return 0;
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

static const char *best_here(void)
{
    if (processor_has("avx512vl") && processor_has("avx512dq") && processor_has("avx512bw"))
        return "SkylakeX";
    if (processor_has("avx2") && processor_has("fma")) return "Haswell";
    return processor_has("avx") ? "Sandybridge" : NULL;
}

static void assert_multiplies(void)
{
    double lower[4] = {2, 1, 0, 3}, square[4];
    dense_lower_square(lower, 2, square);   // L L'
    assert_near("1, 1", square[0], 4, 1e-15);
    assert_near("2, 1", square[1], 2, 1e-15);
    assert_near("2, 2", square[3], 10, 1e-15);
}

// On a processor that OpenBLAS does not know it takes Prescott's.
TEST(test_unknown_processor)
{
    const char *best = best_here();
    if (!gotoblas_dynamic_init || !best) skip();
    unsetenv("OPENBLAS_CORETYPE");
    take("Prescott");
    assert_string_equal(kernels_possible(), best);
    kernels_follow_processor();
    assert_string_equal(kernels_name(), best);
    assert_string_equal(kernels_possible(), best);
    assert_null(getenv("OPENBLAS_CORETYPE"));
    assert_multiplies();
    kernels_follow_processor();   // once more: nothing is left to do
    assert_string_equal(kernels_name(), best);
}

// What is as good as the processor stays: OpenBLAS knows it better.
TEST(test_known_processor)
{
    const char *best = best_here();
    if (!gotoblas_dynamic_init || !best) skip();
    unsetenv("OPENBLAS_CORETYPE");
    if (strcmp(best, "Haswell") == 0) {
        take("Zen");
        kernels_follow_processor();
        assert_string_equal(kernels_name(), "Zen");
    } else {
        take(best);
        kernels_follow_processor();
        assert_string_equal(kernels_name(), best);
    }
}

TEST(test_choice_of_the_user)
{
    if (!gotoblas_dynamic_init || !best_here()) skip();
    take("Nehalem");
    setenv("OPENBLAS_CORETYPE", "NEHALEM", 1);
    kernels_follow_processor();
    assert_string_equal(kernels_name(), "Nehalem");
    assert_string_equal(kernels_possible(), best_here());
    setenv("OPENBLAS_CORETYPE", "Nehalm", 1);   // there are none of that name: no choice
    kernels_follow_processor();
    assert_string_equal(kernels_name(), best_here());
    assert_string_equal(getenv("OPENBLAS_CORETYPE"), "Nehalm");
    assert_multiplies();
}

GROUP_BETWEEN(can_choose, take_back);
