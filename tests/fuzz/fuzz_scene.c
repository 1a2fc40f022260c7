// SPDX-License-Identifier: GPL-2.0-or-later
#include "amontons.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    Error err = {0};
    Scene *scene = NULL;
    amontons_scene_read(fuzz_file(data, size), NULL, 0, &scene, &err);
    amontons_scene_destroy(scene);
    fuzz_check_freed(before);
    return 0;
}
