// SPDX-License-Identifier: GPL-2.0-or-later
// How far a run is: a bar on a terminal, a line about every tenth otherwise, on standard error.
#ifndef AMONTONS_CLI_PROGRESS_H
#define AMONTONS_CLI_PROGRESS_H

#include "amontons.h"

#include <time.h>

typedef enum ProgressStyle { PROGRESS_QUIET, PROGRESS_LINES, PROGRESS_BAR } ProgressStyle;

typedef struct Progress {
    ProgressStyle style;
    struct timespec started;   // at the first step
    struct timespec drawn;   // the bar, last
    bool running;   // a step was seen
    bool bar_stands;   // the cursor is in the line of the bar
    bool uneven;   // steps were not all alike
    double step;   // the first one's, time
    bool slipped;   // there was a rapid event; the next two are of the first one, else 0
    double elapsed_then, fraction_then;   // s since the first step; part of the way
    int32_t tenths;   // lines: tenths of the run already printed
} Progress;

Progress progress_begin(bool quiet);   // looks whether standard error is a terminal

void progress_stage(const char *stage, void *progress);   // a StageCallback
void progress_step(const StepView *view, void *progress);   // a StepCallback

// Shows the progress of work that is not steps. part: so far, 0 to 1; what: "of the film".
void progress_part(Progress *progress, double part, const char *what);

// "1:05", "2:03:40"; "-:--" for NaN.
void progress_format_left(double seconds, char *text, size_t size);

// Clears the bar, so that something else can be printed.
void progress_end(Progress *progress);

#endif
