// SPDX-License-Identifier: GPL-2.0-or-later
// What is looked for in a .geo before gmsh sees it.
#include "io/geo_commands.h"
#include "io/geo_parameters.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    Error err = {0};
    GeoParameters known = {0};
    const char *path = fuzz_file(data, size);
    if (geo_commands_refuse(path, true, &err)) geo_parameters_read(path, &known, &err);
    geo_parameters_destroy(&known);
    fuzz_check_freed(before);
    return 0;
}
