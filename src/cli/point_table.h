// SPDX-License-Identifier: GPL-2.0-or-later
// A table on standard output that grows a line a point, after the progress (on standard error) of
// the steps that come before it, and the answers below it. Called by cmd_stability and cmd_model1d.
#ifndef AMONTONS_CLI_POINT_TABLE_H
#define AMONTONS_CLI_POINT_TABLE_H

#include "cli/progress.h"

typedef struct PointTable {
    Progress progress;
    bool quiet;   // nothing is printed
    bool begun;   // the head is printed
} PointTable;

PointTable point_table_begin(bool quiet);
void point_table_step(const StepView *view, void *table);   // a StepCallback

// Is called before each line: prints `head` before the first one. False: no line is wanted.
bool point_table_line(PointTable *table, const char *head);

// " 0.25" to the right of `width` columns, with `digits` significant ones; "-" for NaN.
void point_table_cell(double value, int width, int digits);

// "  l_c/L    0.3125   sentence", below the table; "none" for NaN.
void point_table_answer(const char *name, double value, const char *sentence);

#endif
