// SPDX-License-Identifier: GPL-2.0-or-later
// A bar is one line written over with \r and cleared to its end (ESC [K); it is never longer than
// the terminal is wide, because a line that wraps cannot be written over.
#include "cli/progress.h"

#include "cli/options.h"
#include "cli/say.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum {
    WIDTH_DEFAULT = 80,
    WIDTH_MAX = 160,
    STATE_WIDTH = 58,   // of the text beside the bar; the bar's length must not flicker with it
    BAR_MIN = 6,
    BAR_MAX = 40,
};

// The time left is printed once this part of the way and this time, s, have passed since the
// reference moment.
static const double GONE_LEAST = 0.02, SECONDS_LEAST = 0.2;

static const double LOG_INTERVAL = 10;   // s between lines in a log, of runs behind an error bar
static const double draw_interval = 0.1;   // s: the eye sees no more, and a terminal costs time

static double seconds_between(const struct timespec *from, const struct timespec *to)
{
    return (double)(to->tv_sec - from->tv_sec) + 1e-9 * (double)(to->tv_nsec - from->tv_nsec);
}

// Asked each time: terminals may be resized during a run.
static int32_t terminal_width(void)
{
    struct winsize size = {0};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return WIDTH_DEFAULT;
    return size.ws_col < WIDTH_MAX ? size.ws_col : WIDTH_MAX;
}

// "0:12", "1:02:03"; "-:--" for NaN; at most a thousand hours.
void progress_format_left(double seconds, char *text, size_t size)
{
    if (isnan(seconds)) {
        snprintf(text, size, "-:--");
        return;
    }
    long whole = seconds < 3.6e6 ? (long)(seconds + 0.5) : 3600000;
    if (whole >= 3600)
        snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    else
        snprintf(text, size, "%ld:%02ld", whole / 60, whole % 60);
}

// Writes over the line that stands there; its end is cut off in a narrow terminal.
static void draw_line(const char *line)
{
    tell_over(line, terminal_width() - 1);
}

// A bar on a terminal, a line each tenth of the way elsewhere, nothing with --quiet. All goes to
// standard error: standard output is for answers.
Progress progress_begin(bool quiet)
{
    Progress progress = {.style = PROGRESS_LINES};
    if (quiet) progress.style = PROGRESS_QUIET;
    if (!quiet && isatty(STDERR_FILENO)) progress.style = PROGRESS_BAR;
    if (progress.style == PROGRESS_BAR) {
        tell("preparing ...");
        fflush(stderr);
        progress.bar_stands = true;
    }
    return progress;
}

// On a terminal only: a log has no use for what is over before it is read.
void progress_stage(const char *stage, void *context)
{
    Progress *progress = context;
    if (progress->style != PROGRESS_BAR || progress->running) return;
    char line[WIDTH_MAX];
    snprintf(line, sizeof line, "%s ...", stage);
    draw_line(line);
    progress->bar_stands = true;
}

// Seconds since the first call; the clock starts with it.
static double begin_clock(Progress *progress, const struct timespec *now)
{
    if (!progress->running) progress->started = *now;
    progress->running = true;
    return seconds_between(&progress->started, now);
}

// True if a bar is drawn now, or a line printed.
static bool is_due(const Progress *progress, double part, const struct timespec *now)
{
    if (progress->style == PROGRESS_LINES) return (int32_t)(10 * part) > progress->tenths;
    return progress->drawn.tv_sec == 0 || seconds_between(&progress->drawn, now) >= draw_interval;
}

static void show(Progress *progress, double part, const char *state, const struct timespec *now)
{
    progress->tenths = (int32_t)(10 * part);
    if (progress->style == PROGRESS_LINES) {
        tell("%3d %%  %s\n", 10 * progress->tenths, state);
        return;
    }

    //     [######............]  33 %  U 0.00198/0.006  mu 0.2034  dt 0.012  3 events  0:12 left
    //
    // In a narrow terminal the bar goes first, then the end of the text.
    int32_t width = terminal_width() - 1, percent = (int32_t)(100 * part);
    int32_t bar = width - STATE_WIDTH - (int32_t)strlen("[] 100 %  ");
    char line[2 * WIDTH_MAX], marks[BAR_MAX + 3] = "";
    if (bar > BAR_MAX) bar = BAR_MAX;
    if (bar >= BAR_MIN) {
        int32_t filled = (int32_t)(part * bar);
        marks[0] = '[';
        memset(marks + 1, '.', (size_t)bar);
        memset(marks + 1, '#', (size_t)(filled < bar ? filled : bar));
        marks[bar + 1] = ']';
    }
    snprintf(line, sizeof line, "%s %3d %%  %s", marks, percent, state);
    draw_line(line);
    progress->drawn = *now;
    progress->bar_stands = true;
}

// The clock starts at the first step: mesh and relaxation are not steps, and would spoil the time
// left.
void progress_step(const StepView *view, void *context)
{
    Progress *progress = context;
    char state[WIDTH_MAX];
    struct timespec now;
    stop_in_order();
    if (progress->style == PROGRESS_QUIET) return;
    clock_gettime(CLOCK_MONOTONIC, &now);
    char left[40] = "", time[32], so_far[40] = "", end[32] = "";
    if (view->mesh > 0) {
        // A run behind an error bar, on a terminal in place of the line before, in a log every now
        // and then: "mesh 2, run 1, 12 %  U 0.00123  3 events  mu_M so far 0.329  0:12 left". It
        // ends once its answer is known, sooner than the way that it may go.
        bool bar = progress->style == PROGRESS_BAR, first = progress->drawn.tv_sec == 0;
        if (seconds_between(&progress->drawn, &now) < (bar ? draw_interval : LOG_INTERVAL)) return;
        progress->drawn = now;
        if (first && !bar) return;   // short runs say nothing but the result of each mesh
        bool slid = !isnan(view->mu_M);
        double mu = slid ? view->mu_M : view->mu_hold;
        if (!isnan(mu))
            snprintf(so_far, sizeof so_far, "  %s so far %.3f", slid ? "mu_M" : "mu_hold", mu);
        progress_format_left(view->seconds_left, time, sizeof time);
        if (!isnan(view->seconds_left)) snprintf(left, sizeof left, "  %s left", time);
        snprintf(state, sizeof state, "mesh %d, run %d, %.0f %%  U %.4g  %d event%s%s%s",
                 view->mesh, view->run, 100 * view->fraction, view->U, view->events,
                 view->events == 1 ? "" : "s", so_far, left);
        if (bar)
            draw_line(state);
        else
            tell("%s\n", state);
        progress->bar_stands = bar;
        return;
    }

    // The time left follows from the way since the first rapid event, as loading up to that takes
    // next to nothing; while steps are all alike, from the way since the start.
    double elapsed = begin_clock(progress, &now);
    if (view->step_size > 0 && progress->step == 0) progress->step = view->step_size;
    if (view->step_size > 0 && view->step_size != progress->step) progress->uneven = true;
    if (!progress->slipped && view->events > 0) {
        progress->slipped = true;
        progress->elapsed_then = elapsed;
        progress->fraction_then = view->fraction;
    }
    if (!is_due(progress, view->fraction, &now)) return;

    // "U 0.00123/0.006  mu 0.2034  dt 0.012  3 events  0:12 left", the last where it is known.
    double gone = view->fraction - progress->fraction_then, took = elapsed - progress->elapsed_then;
    bool known = (progress->slipped || !progress->uneven) && gone >= GONE_LEAST;
    progress_format_left(took / gone * (1 - view->fraction), time, sizeof time);
    if (known && took >= SECONDS_LEAST) snprintf(left, sizeof left, "  %s left", time);
    if (view->fraction > 0) snprintf(end, sizeof end, "/%.4g", view->U / view->fraction);
    snprintf(state, sizeof state, "U %.4g%s  mu %.4f  dt %.2g  %d event%s%s", view->U, end,
             view->mu, view->step_size, view->events, view->events == 1 ? "" : "s", left);

    show(progress, view->fraction, state, &now);
}

// "[####....]  33 %  of the film  0:12 left"
void progress_part(Progress *progress, double part, const char *what)
{
    char state[WIDTH_MAX], left[40] = "", time[32];
    struct timespec now;
    if (progress->style == PROGRESS_QUIET) return;
    clock_gettime(CLOCK_MONOTONIC, &now);
    double elapsed = begin_clock(progress, &now);
    if (!is_due(progress, part, &now)) return;
    progress_format_left(elapsed * (1 - part) / part, time, sizeof time);
    if (elapsed > SECONDS_LEAST) snprintf(left, sizeof left, "  %s left", time);
    snprintf(state, sizeof state, "%s%s", what, left);
    show(progress, part, state, &now);
}

// The line is cleared for what is printed next. Called also after a failure; a second time it does
// nothing.
void progress_end(Progress *progress)
{
    if (progress->bar_stands) {
        tell_over("", 0);
    }
    progress->bar_stands = false;
}
