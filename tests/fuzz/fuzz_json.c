// SPDX-License-Identifier: GPL-2.0-or-later
// run.json, of which sweeps and `amontons info` look up single values.
#include "io/text/json_reader.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const paths[] = {"status",
                                        "results.mu_M",
                                        "results.peaks.0.mu",
                                        "warnings.1",
                                        "results.drops.branches.2",
                                        "scene.mesh.set.nx",
                                        ""};
    char *text = malloc(size + 1), word[24];
    double value = 0;
    if (!text) return 0;
    memcpy(text, data, size);
    text[size] = 0;
    json_is_whole(text);
    for (size_t k = 0; k < sizeof paths / sizeof *paths; k++) {
        json_find_number(text, paths[k], &value);
        json_find_text(text, paths[k], word, sizeof word);
        json_may_hold(text, paths[k]);
        json_find_key(text, paths[k], (int32_t)(size % 4), word, sizeof word);
    }
    free(text);
    return 0;
}
