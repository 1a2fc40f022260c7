// SPDX-License-Identifier: GPL-2.0-or-later
#include "cli/point_lines.h"

#include "cli/progress.h"
#include "cli/say.h"

#include <stdio.h>

// A line a point; on a terminal a last line with the progress of the whole.
void point_line(const SweepView *view, void *context)
{
    PointLines *display = context;
    char left[32], what[ESTIMATE_SIZE + 128], value[ESTIMATE_SIZE];
    if (view->message && display->failures < FAILURES_SHOWN)
        snprintf(display->failed[display->failures++], sizeof display->failed[0], "%.190s: %.290s",
                 view->words, view->message);
    if (display->quiet) return;
    progress_format_left(view->seconds_left, left, sizeof left);
    if (display->bar) tell_over("", 0);
    amontons_estimate(view->value, view->bar, view->known_to, value);
    snprintf(what, sizeof what, "%.99s %s%s", view->quantity, value,
             view->warned ? "  warned" : "");
    if (view->message) snprintf(what, sizeof what, "FAILED");
    if (!view->reused)
        tell("%*d/%d  %s  %s  %.1f s  (%s left)\n", view->points < 100 ? 2 : 4, view->finished,
             view->points, view->words, what, view->seconds, left);
    if (display->bar) {
        tell("%d of %d points, %d failed, %s left", view->finished, view->points, view->failed,
             left);
        fflush(stderr);
    }
}

void point_lines_failed(const PointLines *display, int32_t failed, int32_t points,
                        const char *folder)
{
    tell("amontons: %d of %d points failed (--retry computes them again):\n", failed, points);
    for (int32_t k = 0; k < display->failures; k++) tell("  %s\n", display->failed[k]);
    if (failed > display->failures) tell("  ... and more, in %s/sweep.csv\n", folder);
}
