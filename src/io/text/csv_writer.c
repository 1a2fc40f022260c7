// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/text/csv_writer.h"

#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HEADING_SIZE = 160 };

static void begin_cell(TextWriter *csv)
{
    if (csv->in_row) fputc(',', csv->out);
    csv->in_row = true;
}

// RFC 4180, 2.6 and 2.7: a cell with a comma, a quote or a line end stands in quotes.
void csv_text(TextWriter *csv, const char *text)
{
    bool quoted = strpbrk(text, ",\"\n\r") != NULL;
    begin_cell(csv);
    if (quoted) fputc('"', csv->out);
    for (; *text; text++) {
        if (*text == '"') fputc('"', csv->out);   // a quote inside is doubled
        fputc(*text, csv->out);
    }
    if (quoted) fputc('"', csv->out);
}

void csv_heading(TextWriter *csv, const char *name, const char *unit)
{
    char text[HEADING_SIZE];
    snprintf(text, sizeof text, unit && *unit ? "%s (%s)" : "%s", name, unit);
    csv_text(csv, text);
}

void csv_number(TextWriter *csv, double value)
{
    char digits[NUMBER_TEXT_SIZE] = "";
    if (isfinite(value)) text_shortest(value, 6, digits);
    csv_text(csv, digits);
}

void csv_rounded(TextWriter *csv, double value)
{
    begin_cell(csv);
    if (isfinite(value)) fprintf(csv->out, "%.9g", value == 0 ? 0 : value);   // no -0
}

void csv_end_row(TextWriter *csv)
{
    fputc('\n', csv->out);
    csv->in_row = false;
}
