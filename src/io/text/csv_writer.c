// SPDX-License-Identifier: GPL-2.0-or-later
// Cells go to `path`.part, many at once; csv_finish gives it its name and reports the first
// failure, so that a caller who writes a thousand cells asks once.
#include "io/text/csv_writer.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/text/text_writer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HEADING_SIZE = 160 };

struct CsvWriter {
    TextWriter out;
    bool in_row;   // a cell stands on the line already
};

CsvWriter *csv_create(const char *path, Error *err)
{
    CsvWriter *csv = NEW_ARRAY(CsvWriter, 1, err);
    if (csv && text_writer_open(&csv->out, path, false, err)) return csv;
    memory_free(csv);
    return NULL;
}

static void begin_cell(CsvWriter *csv)
{
    if (csv->in_row) fputc(',', csv->out.out);
    csv->in_row = true;
}

// RFC 4180, 2.6 and 2.7: a cell with a comma, a quote or a line end stands in quotes.
void csv_text(CsvWriter *csv, const char *text)
{
    bool quoted = strpbrk(text, ",\"\n\r") != NULL;
    begin_cell(csv);
    if (quoted) fputc('"', csv->out.out);
    for (; *text; text++) {
        if (*text == '"') fputc('"', csv->out.out);   // a quote inside is doubled
        fputc(*text, csv->out.out);
    }
    if (quoted) fputc('"', csv->out.out);
}

void csv_heading(CsvWriter *csv, const char *name, const char *unit)
{
    char text[HEADING_SIZE];
    snprintf(text, sizeof text, unit && *unit ? "%s (%s)" : "%s", name, unit);
    csv_text(csv, text);
}

void csv_number(CsvWriter *csv, double value)
{
    char digits[NUMBER_TEXT_SIZE] = "";
    if (isfinite(value)) text_shortest(value, 6, digits);
    csv_text(csv, digits);
}

void csv_rounded(CsvWriter *csv, double value)
{
    begin_cell(csv);
    if (isfinite(value)) fprintf(csv->out.out, "%.9g", value == 0 ? 0 : value);   // no -0
}

void csv_end_row(CsvWriter *csv)
{
    fputc('\n', csv->out.out);
    csv->in_row = false;
}

bool csv_finish(CsvWriter *csv, Error *err)
{
    bool good = text_writer_finish(&csv->out, err);
    csv_abandon(csv);
    return good;
}

void csv_abandon(CsvWriter *csv)
{
    if (csv) text_writer_close(&csv->out);
    memory_free(csv);
}
