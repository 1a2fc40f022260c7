// SPDX-License-Identifier: GPL-2.0-or-later
// Shared by the fuzz targets. A target reads a text or bytes as the program would, in memory; it
// may refuse them, and must neither crash nor keep memory. `tests/fuzz/run` runs them with
// libFuzzer and sanitizers, CTest replays the corpus.
#ifndef AMONTONS_TESTS_FUZZ_H
#define AMONTONS_TESTS_FUZZ_H

#include "base/memory.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// A file in memory that holds the bytes; its name lasts until the next call.
static inline const char *fuzz_file(const uint8_t *data, size_t size)
{
    static int descriptor = -1;
    static char name[40];
    if (descriptor < 0) descriptor = memfd_create("fuzz", MFD_CLOEXEC);
    snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
    if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, data, size, 0) != (ssize_t)size)
        abort();
    return name;
}

// Ends the program when arrays are left over. before: memory_counters().live
static inline void fuzz_check_freed(int64_t before)
{
    if (memory_counters().live == before) return;
    fprintf(stderr, "%lld arrays are not freed\n", (long long)(memory_counters().live - before));
    abort();
}

#endif
