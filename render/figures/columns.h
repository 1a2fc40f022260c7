// SPDX-License-Identifier: GPL-2.0-or-later
// Columns of numbers in a csv file: the tables of what figures show.
#ifndef AMONTONS_RENDER_FIGURES_COLUMNS_H
#define AMONTONS_RENDER_FIGURES_COLUMNS_H

#include "base/error.h"

typedef struct Column {
    const char *name, *unit;   // unit: in SI; NULL: none
    const double *values;   // [rows]
} Column;

// Writes a csv file with a header of names. si: the header says units, as in "x (m)".
bool columns_write(const char *path, const Column *columns, int32_t count, int64_t rows, bool si,
                   Error *err);

#endif
