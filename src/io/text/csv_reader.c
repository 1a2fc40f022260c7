// SPDX-License-Identifier: GPL-2.0-or-later
// Cells are cut out of the text in place: a quoted one only gets shorter.
#include "io/text/csv_reader.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/text_file.h"

#include <math.h>
#include <string.h>

enum { SIZE_MAX_CSV = 1 << 30 };

static const char BLANKS[] = " \t";

// The cell that begins at *at, with a zero byte behind it; *at becomes the beginning of the next
// one. *ends: the row does. A quote that is never closed takes the rest of the text.
static char *take_cell(char **at, bool *ends)
{
    char *cell = *at, *from = *at, *to = *at;
    bool quoted = *from == '"';
    if (quoted) ++from;
    while (*from && (quoted || !strchr(",\r\n", *from))) {
        if (quoted && *from == '"' && from[1] != '"') {
            quoted = false;
            ++from;
            continue;
        }
        if (quoted && *from == '"') ++from;   // doubled
        *to++ = *from++;
    }
    if (*from == '\r' && from[1] == '\n') ++from;
    *ends = *from != ',';
    *at = *from ? from + 1 : from;
    *to = 0;
    return cell;
}

static bool add_cell(CsvTable *table, int32_t *count, int32_t *room, const char *cell, Error *err)
{
    if (!memory_grow(&table->cells, *count, room, sizeof *table->cells, err)) return false;
    table->cells[(*count)++] = cell;
    return error_is_clean(err);
}

bool csv_read(const char *path, CsvTable *table, Error *err)
{
    int32_t size = 0, count = 0, room = 0, width = 0, line = 1;
    *table = (CsvTable){0};
    TRY(text_file_read(path, SIZE_MAX_CSV, &table->text, &size, err));
    for (char *at = table->text; *at;) {
        bool ends = false;
        TRY(add_cell(table, &count, &room, take_cell(&at, &ends), err));
        ++width;
        if (!ends) continue;
        if (table->columns == 0) table->columns = width;
        if (width != table->columns)
            FAIL(err, ERROR_INPUT, "%s: row %d has %d cells, the first has %d", path, line, width,
                 table->columns);
        width = 0;
        ++line;
    }
    if (count == 0 || width > 0)
        FAIL(err, ERROR_INPUT, "%s: no table, or one that is cut off", path);
    table->rows = count / table->columns - 1;
cleanup:
    if (!error_is_clean(err)) csv_destroy(table);
    return error_is_clean(err);
}

const char *csv_name(const CsvTable *table, int32_t column)
{
    return table->cells[column];
}

const char *csv_cell(const CsvTable *table, int32_t row, int32_t column)
{
    return column < 0 ? "" : table->cells[(int64_t)(row + 1) * table->columns + column];
}

double csv_value(const CsvTable *table, int32_t row, int32_t column)
{
    const char *cell = csv_cell(table, row, column);
    double value = NAN;
    cell += strspn(cell, BLANKS);
    int32_t used = text_number(cell, &value);
    return used > 0 && !cell[(size_t)used + strspn(cell + used, BLANKS)] ? value : (double)NAN;
}

bool csv_check(const CsvTable *table, int32_t column, bool positive, Error *err)
{
    for (int32_t row = 0; column >= 0 && row < table->rows; ++row) {
        const char *cell = csv_cell(table, row, column);
        double value = csv_value(table, row, column);
        if (!cell[strspn(cell, BLANKS)] || (isfinite(value) && (!positive || value > 0))) continue;
        FAIL(err, ERROR_INPUT,
             "line %d, %s: `%.40s` is no number%s; what is not known is left empty", row + 2,
             csv_name(table, column), cell, positive ? " above 0" : "");
    }
cleanup:
    return error_is_clean(err);
}

int32_t csv_column(const CsvTable *table, const char *name)
{
    for (int32_t k = 0; k < table->columns; ++k)
        if (strcmp(table->cells[k], name) == 0) return k;
    return -1;
}

void csv_destroy(CsvTable *table)
{
    memory_free_all(table->cells, table->text);
    *table = (CsvTable){0};
}
