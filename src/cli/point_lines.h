// SPDX-License-Identifier: GPL-2.0-or-later
// A line on standard error for each point of a sweep or a search. Called by cmd_sweep and
// cmd_optimise.
#ifndef AMONTONS_CLI_POINT_LINES_H
#define AMONTONS_CLI_POINT_LINES_H

#include "amontons.h"

enum { FAILURES_SHOWN = 10 };

typedef struct PointLines {
    bool quiet, bar;   // a terminal: the last line is written over
    int32_t failures;
    char failed[FAILURES_SHOWN][500];
} PointLines;

void point_line(const SweepView *view, void *context);   // a SweepCallback; context: PointLines
// Those that failed, `failed` of `points`; folder: of the table.
void point_lines_failed(const PointLines *display, int32_t failed, int32_t points,
                        const char *folder);

#endif
