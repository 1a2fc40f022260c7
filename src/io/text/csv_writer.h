// SPDX-License-Identifier: GPL-2.0-or-later
// Writes rows of comma-separated values (RFC 4180). Called by study/sweep/showing/table, by
// study/sweep/showing/rank and by the tables of render/.
#ifndef AMONTONS_IO_TEXT_CSV_WRITER_H
#define AMONTONS_IO_TEXT_CSV_WRITER_H

#include "io/text/text_writer.h"

#include <stdint.h>

void csv_text(TextWriter *csv, const char *text);   // a cell, quoted where it must be
// A heading, "name (unit)"; unit NULL or empty: the name alone.
void csv_heading(TextWriter *csv, const char *name, const char *unit);
// A cell with as few digits, 6 at least, as give the same double again; empty when not finite.
void csv_number(TextWriter *csv, double value);
// A cell with nine digits at most, faster than the shortest text: of a long table.
void csv_rounded(TextWriter *csv, double value);
void csv_end_row(TextWriter *csv);

#endif
