// SPDX-License-Identifier: GPL-2.0-or-later
// Preloaded by test_cli.py: an OpenBLAS that does not know the processor, and says that it has
// taken Prescott's kernels, unless OPENBLAS_CORETYPE was set when it was loaded. With
// UNKNOWN_ALWAYS=yes the variable does not help.
#include <stdlib.h>
#include <string.h>

static char name[64] = "Prescott";

char *openblas_get_corename(void);

__attribute__((constructor)) static void choose(void)
{
    const char *asked = getenv("OPENBLAS_CORETYPE");
    if (asked && !getenv("UNKNOWN_ALWAYS")) strncpy(name, asked, sizeof name - 1);
}

char *openblas_get_corename(void)
{
    return name;
}
