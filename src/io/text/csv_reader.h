// SPDX-License-Identifier: GPL-2.0-or-later
// A table of values as people and programs write them, and as io/text/csv_writer does (RFC 4180).
// The one reader of tables: of sweeps' tables by page/sweep_page, of what was measured by the
// figures, plots and fits, of surfaces by scene/profile.
//
// The first lines show what separates the cells: tabs, else semicolons, else commas, else blanks.
// The decimal sign is a point, or a comma in all of the file. Lines that are empty or begin with #
// or % are left out; if all of the first other line are numbers, the names may stand in the comment
// above it. A name stands once. Behind it may stand a unit: "U (mm)", "F_T [kN]", "t/s", "t in s",
// "U mm", "x_mm". Words of names may have capitals, and blanks or underscores between them.
#ifndef AMONTONS_IO_TEXT_CSV_READER_H
#define AMONTONS_IO_TEXT_CSV_READER_H

#include "base/error.h"

#include <stdint.h>

typedef struct CsvTable {
    int32_t rows, columns;   // rows: without the names
    const char **cells;   // [(rows + 1) * columns] the names first, "" where there are none; owned
    int32_t *line;   // [rows + 1] of the file, from 1; owned
    int32_t *byte;   // [(rows + 1) * columns] where in its line each cell begins, from 1; owned
    const char **units;   // [columns] of a row of units below the names; NULL: there is none; owned
    char separator;   // ',', ';', '\t' or ' '
    bool decimal_comma;
    bool named;   // there are names
    bool named_by_comment;   // they stand in a comment
    char *text;   // what the cells point into; owned
    char *path;   // owned
} CsvTable;

// ERROR_INPUT names file, line and place: there are no names, a row is shorter or longer than the
// first, a name stands twice, decimal points and commas are mixed.
bool csv_read(const char *path, CsvTable *table, Error *err);
// The same, where numbers alone are a table, too.
bool csv_read_bare(const char *path, CsvTable *table, Error *err);

const char *csv_name(const CsvTable *table, int32_t column);
const char *csv_cell(const CsvTable *table, int32_t row, int32_t column);   // column -1: ""
double csv_value(const CsvTable *table, int32_t row, int32_t column);   // NaN: no number, no cell

// ERROR_INPUT: "FILE:LINE:COLUMN: NAME: " and what is wrong there; row -1: of the name itself.
bool csv_refuse(const CsvTable *table, int32_t row, int32_t column, Error *err, const char *format,
                ...) __attribute__((format(printf, 5, 6)));
// The cell is a finite number.
bool csv_read_number(const CsvTable *table, int32_t row, int32_t column, double *value, Error *err);
// The column's cells are finite numbers, where asked above 0, or empty; ERROR_INPUT names file,
// line and cell of one that is not. A column below 0 has none.
bool csv_check(const CsvTable *table, int32_t column, bool positive, Error *err);

int32_t csv_column(const CsvTable *table, const char *name);   // as it stands; -1: there is none

// Unit behind a name; length 0: there is none.
typedef struct CsvUnit {
    const char *text;   // in the table
    int32_t length;
} CsvUnit;
enum { CSV_UNIT_SIZE = 40 };

// *column: the one called `name`, alone or with a unit behind it; -1: none. t, U, mu, F_T, F_N,
// hold are found by the words for them, too ("time", "friction force", "hold time"). ERROR_INPUT:
// two are.
bool csv_find(const CsvTable *table, const char *name, int32_t *column, CsvUnit *unit, Error *err);
// The same of a quantity that people call by one of these names, of which the last is NULL.
bool csv_find_any(const CsvTable *table, const char *const *names, int32_t *column, CsvUnit *unit,
                  Error *err);
// The name of a column without its unit, and the unit; length 0: it has none.
void csv_split(const CsvTable *table, int32_t column, int32_t *name_length, CsvUnit *unit);
// *column: the one that holds the errors of column `of`, with its own unit: NAME_error, NAME error,
// err, std, sd in the place of error, sigma_NAME; else one to its right that is called error, err,
// std, sd or +- alone; -1: there is none.
void csv_find_error(const CsvTable *table, int32_t of, int32_t *column, CsvUnit *unit);
// Finds the factor that converts numbers of the column to SI base units. dimension NULL: any.
// ERROR_INPUT: the unit is not of this dimension.
bool csv_to_si(const CsvTable *table, int32_t column, CsvUnit unit, const char *dimension,
               double *factor, Error *err);

// The same for a scene: 1 where the column has no unit. in_units: false: the scene has plain
// numbers, and a unit of a dimension other than "1" is ERROR_INPUT.
bool csv_to_scene(const CsvTable *table, int32_t column, CsvUnit unit, const char *dimension,
                  bool in_units, double *factor, Error *err);

void csv_destroy(CsvTable *table);   // zeroed is fine

#endif
