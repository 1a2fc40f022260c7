// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/plot_file.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    Error err = {0};
    Plot *plot = NEW_ARRAY(Plot, 1, &err);
    plot_file_read(fuzz_file(data, size), plot, &err);
    plot_destroy(plot);
    memory_free(plot);
    fuzz_check_freed(before);
    return 0;
}
