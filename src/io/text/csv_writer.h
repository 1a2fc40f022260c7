// SPDX-License-Identifier: GPL-2.0-or-later
// Writes rows of comma-separated values (RFC 4180) into a file, atomically: the final name appears
// when all is on disk. Called by study/sweep/showing/table and study/sweep/showing/rank.
#ifndef AMONTONS_IO_TEXT_CSV_WRITER_H
#define AMONTONS_IO_TEXT_CSV_WRITER_H

#include "base/error.h"

#include <stdint.h>

typedef struct CsvWriter CsvWriter;

// The first failure is kept and reported by finish.
CsvWriter *csv_create(const char *path, Error *err);
void csv_text(CsvWriter *csv, const char *text);   // a cell, quoted where it must be
// A heading, "name (unit)"; unit NULL or empty: the name alone.
void csv_heading(CsvWriter *csv, const char *name, const char *unit);
// A cell with as few digits, 6 at least, as give the same double again; empty when not finite.
void csv_number(CsvWriter *csv, double value);
// A cell with nine digits at most, faster than the shortest text: of a long table.
void csv_rounded(CsvWriter *csv, double value);
void csv_end_row(CsvWriter *csv);
bool csv_finish(CsvWriter *csv, Error *err);   // fsync, rename; frees `csv` either way
void csv_abandon(CsvWriter *csv);   // frees it and leaves no file; NULL is fine

#endif
