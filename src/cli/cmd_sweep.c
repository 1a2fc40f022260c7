// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons sweep`: a line a point on standard error, the ranked table on standard output. With the
// hidden option --element it is one of its own jobs on a cluster.
#include "cli/commands.h"
#include "cli/say.h"
#include "cli/study_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char ENDING[] = "-sweep";

// A share of the points, in a job of a Slurm array. Slurm puts into the environment which element
// this process is, and keeps its exit status.
static int run_element(const StudyWords *words)
{
    const char *index = getenv("SLURM_ARRAY_TASK_ID");
    char *end = NULL;
    Error err = {0};
    long element = index ? strtol(index, &end, 10) : -1;
    if (!index || !*index || *end || element < 0 || element > INT32_MAX || !words->folder)
        return report_misuse("--element is for jobs that `amontons sweep --slurm` submits");
    SweepOptions options = {.folder = words->folder,
                            .overrides = words->settings.list,
                            .override_count = words->settings.count,
                            .trust = words->trust};
    bool done = amontons_sweep_element(words->study, &options, (int32_t)element, &err);
    return done ? 0 : report_error(&err);
}

// Failed points are no error of the sweep, but its exit status shows them.
static int close_sweep(const StudyRun *run, const SweepSummary *summary)
{
    char points[AMONTONS_PATH_SIZE + 8];
    const char *folder = run->options.folder;
    if (!run->quiet) {
        say("%d points: %d computed in %.1f s", summary->points, summary->computed,
            summary->seconds);
        if (summary->refined) say(" (%d again, to decide ranks)", summary->refined);
        if (summary->reused) say(", %d computed before", summary->reused);
        if (summary->failed) say(", %d failed", summary->failed);
        snprintf(points, sizeof points, "%s/points", folder);
        say("\nTable in %s: sweep.csv and sweep.h5%s\n", folder,
            access(points, F_OK) == 0 ? "; each point's run.json in points/" : "");
        if (run->answer) say("%s", run->answer);
    }
    if (summary->failed == 0) return 0;
    fflush(stdout);
    tell("amontons: %d of %d points failed (--retry computes them again):\n", summary->failed,
         summary->points);
    for (int32_t k = 0; k < run->failures; k++) tell("  %s\n", run->failed[k]);
    if (summary->failed > run->failures) tell("  ... and more, in %s/sweep.csv\n", folder);
    return amontons_error_exit_status(ERROR_COMPUTE);
}

int command_sweep(const Command *command, int argc, char **argv)
{
    StudyWords words = {0};
    StudyRun run;
    SweepSummary summary;
    Error err = {0};
    int status = study_words_read(command, ENDING, true, argc, argv, &words);
    if (status == 0 && words.is_element) return run_element(&words);   // a signal ends it
    if (status == 0) status = study_run_begin(&words, ENDING, &run);
    if (status != 0) return status;
    bool done = amontons_sweep(words.study, &run.options, &summary, &err);
    study_run_end(&run);
    status = done ? close_sweep(&run, &summary) : report_error(&err);
    free(run.answer);
    return status;
}
