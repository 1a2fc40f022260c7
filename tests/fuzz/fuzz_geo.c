// SPDX-License-Identifier: GPL-2.0-or-later
// A .geo is searched before gmsh sees it. It lies in a folder of its own, so that what it
// includes is not another open file of the fuzzer.
#include "io/mesh/geo_script.h"
#include "io/mesh/geo_parameters.h"
#include "tests/fuzz/fuzz.h"

#include <stdio.h>

static char place[] = "/dev/shm/amontons_fuzz_XXXXXX", path[80];

static void remove_folder(void)
{
    unlink(path);
    rmdir(place);
}

static void write_script(const uint8_t *data, size_t size)
{
    if (!*path && (!mkdtemp(place) || atexit(remove_folder) != 0)) abort();
    snprintf(path, sizeof path, "%s/a", place);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    Error err = {0};
    GeoParameters known = {0};
    GeoScript script = {0};
    write_script(data, size);
    if (geo_script_read(path, &script, &err)) geo_parameters_read(path, &known, &err);
    for (int32_t line = 1; script.text && line < 100; line += 7) {
        const char *file = NULL;
        int32_t file_line = 0;
        geo_script_place(&script, line, &file, &file_line);
    }
    geo_parameters_destroy(&known);
    geo_script_destroy(&script);
    fuzz_check_freed(before);
    return 0;
}
