// SPDX-License-Identifier: GPL-2.0-or-later
// A table of measurements: its cells, and what a fit makes of them.
#include "io/text/csv_reader.h"
#include "study/search/measurements.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>

static void look_through(const CsvTable *table)
{
    Error err = {0};
    size_t letters = 0;
    for (int32_t k = 0; k < table->columns; k++) {
        if (csv_column(table, csv_name(table, k)) > k) abort();
        csv_check(table, k, true, &err);
        for (int32_t row = 0; row < table->rows; row++) {
            letters += strlen(csv_cell(table, row, k));
            csv_value(table, row, k);
        }
    }
    if (letters > 1 << 20) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int64_t before = memory_counters().live;
    char fit[64];
    CsvTable table;
    Measurements measured = {0};
    Error err = {0}, other = {0};
    const char *path = fuzz_file(data, size);
    if (csv_read(path, &table, &err)) look_through(&table);
    csv_destroy(&table);
    Study *study = NEW_ARRAY(Study, 1, &other);
    snprintf(fit, sizeof fit, "measured: %s", path);
    if (yaml_parse("study", fit, 0, &study->file, &other)) {
        study->search.measured = yaml_look_up(study->file, "measured");
        measurements_read(study, &measured, &other);
    }
    measurements_destroy(&measured);
    yaml_destroy(study->file);
    memory_free(study);
    fuzz_check_freed(before);
    return 0;
}
