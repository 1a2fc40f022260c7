// SPDX-License-Identifier: GPL-2.0-or-later
// The progress bar must be cleared before the first line of the table is printed: both may go
// to one terminal.
#include "cli/point_table.h"

#include "cli/say.h"

#include <math.h>

PointTable point_table_begin(bool quiet)
{
    return (PointTable){.progress = progress_begin(quiet), .quiet = quiet};
}

void point_table_step(const StepView *view, void *table)
{
    progress_step(view, &((PointTable *)table)->progress);
}

bool point_table_line(PointTable *table, const char *head)
{
    if (table->quiet) return false;
    if (!table->begun) {
        progress_end(&table->progress);
        say("%s\n", head);
    }
    table->begun = true;
    return true;
}

void point_table_cell(double value, int width, int digits)
{
    if (isnan(value))
        say(" %*s", width, "-");
    else
        say(" %*.*g", width, digits, value);
}

void point_table_answer(const char *name, double value, const char *sentence)
{
    if (isnan(value))
        say("  %-22s %-8s %s\n", name, "none", sentence);
    else
        say("  %-22s %-8.4f %s\n", name, value, sentence);
}
