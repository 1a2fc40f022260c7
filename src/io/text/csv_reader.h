// SPDX-License-Identifier: GPL-2.0-or-later
// A table of comma-separated values (RFC 4180), as io/text/csv_writer writes them. Called by
// page/sweep_page.
#ifndef AMONTONS_IO_TEXT_CSV_READER_H
#define AMONTONS_IO_TEXT_CSV_READER_H

#include "base/error.h"

#include <stdint.h>

typedef struct CsvTable {
    int32_t rows, columns;   // rows: without the first line, the names
    const char **cells;   // [(rows + 1) * columns] the names first; owned
    char *text;   // what the cells point into; owned
} CsvTable;

// ERROR_INPUT names the file and the line: a row is shorter or longer than the first.
bool csv_read(const char *path, CsvTable *table, Error *err);
const char *csv_name(const CsvTable *table, int32_t column);
const char *csv_cell(const CsvTable *table, int32_t row, int32_t column);
double csv_value(const CsvTable *table, int32_t row, int32_t column);   // NaN: no number, no cell
// The column's cells are finite numbers, where asked above 0, or empty; ERROR_INPUT names line and
// cell of one that is not. A column below 0 has none.
bool csv_check(const CsvTable *table, int32_t column, bool positive, Error *err);
int32_t csv_column(const CsvTable *table, const char *name);   // -1: there is none
void csv_destroy(CsvTable *table);   // zeroed is fine

#endif
