// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/reading/study.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    Error err = {0};
    Study *study = NEW_ARRAY(Study, 1, &err);
    study_read(fuzz_file(data, size), NULL, 0, false, study, &err);
    study_destroy(study);
    memory_free(study);
    fuzz_check_freed(before);
    return 0;
}
