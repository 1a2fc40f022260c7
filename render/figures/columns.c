// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/columns.h"

#include "io/text/csv_writer.h"

#include <stddef.h>

bool columns_write(const char *path, const Column *columns, int32_t count, int64_t rows, bool si,
                   Error *err)
{
    TextWriter *csv = text_writer_create(path, false, err);
    if (!csv) return false;
    for (int32_t k = 0; k < count; ++k)
        csv_heading(csv, columns[k].name, si ? columns[k].unit : NULL);
    csv_end_row(csv);
    for (int64_t row = 0; row < rows; ++row) {
        for (int32_t k = 0; k < count; ++k) csv_rounded(csv, columns[k].values[row]);
        csv_end_row(csv);
    }
    return text_writer_finish(csv, err);
}
