// SPDX-License-Identifier: GPL-2.0-or-later
#include "cli/study_run.h"

#include "cli/progress.h"
#include "cli/say.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int study_words_read(const Command *command, const char *ending, bool has_elements, int argc,
                     char **argv, StudyWords *words)
{
    char output[160];
    snprintf(output, sizeof output,
             "Folder for the table and the points (default: the study's name with %s, in the "
             "current folder)",
             ending);
    const Option options[] = {
        {"output", 'o', "DIR", output, .word = &words->folder},
        {"jobs", 'j', "N", "Points computed at a time (default: as many as there are cores)",
         .word = &words->jobs},
        {"slurm", 0, "WORDS",
         "Compute the points as Slurm job arrays, with these words for sbatch if any; -j N: at "
         "most N at a time",
         .flag = &words->has_slurm, .word = &words->slurm},
        {"set", 0, "KEY=VALUE", "Use this value for every point; may be given several times",
         .words = &words->settings},
        {"retry", 0, NULL, "Compute points again that failed before", .flag = &words->retry},
        {"fresh", 0, NULL, "Compute all points again", .flag = &words->fresh},
        {"quiet", 'q', NULL, "Print nothing but errors", .flag = &words->quiet},
        option_trust(&words->trust),
        {has_elements ? "element" : NULL, 0, NULL, NULL, .flag = &words->is_element},
        {0}};
    return options_read(command, options, argc, argv, &words->study);
}

// A line a point; on a terminal a last line with the progress of the whole.
static void tell_point(const SweepView *view, void *context)
{
    StudyRun *run = context;
    char left[32], what[ESTIMATE_SIZE + 128], value[ESTIMATE_SIZE];
    if (view->message && run->failures < FAILURES_SHOWN)
        snprintf(run->failed[run->failures++], sizeof run->failed[0], "%.190s: %.290s", view->words,
                 view->message);
    if (run->quiet) return;
    progress_format_left(view->seconds_left, left, sizeof left);
    if (run->bar) tell_over("", 0);
    amontons_estimate(view->value, view->bar, view->known_to, value);
    snprintf(what, sizeof what, "%.99s %s%s", view->quantity, value,
             view->warned ? "  warned" : "");
    if (view->message) snprintf(what, sizeof what, "FAILED");
    if (!view->reused)
        tell("%*d/%d  %s  %s  %.1f s  (%s left)\n", view->points < 100 ? 2 : 4, view->finished,
             view->points, view->words, what, view->seconds, left);
    if (run->bar) {
        tell("%d of %d points, %d failed, %s left", view->finished, view->points, view->failed,
             left);
        fflush(stderr);
    }
}

// The library checks the study.
int study_run_begin(const StudyWords *words, const char *ending, StudyRun *run)
{
    *run = (StudyRun){.quiet = words->quiet,
                      .bar = isatty(STDERR_FILENO),
                      .options = {.overrides = words->settings.list,
                                  .override_count = words->settings.count,
                                  .slurm = words->slurm,
                                  .retry = words->retry,
                                  .fresh = words->fresh,
                                  .trust = words->trust,
                                  .on_point = tell_point,
                                  .context = run}};
    if (words->folder && !*words->folder) return report_misuse("-o: the folder has no name");
    int status = words->jobs ? option_count("-j", words->jobs, 1, 1024, &run->options.jobs) : 0;
    if (status != 0) return status;
    default_folder(words->study, ending, run->folder, sizeof run->folder);
    run->options.folder = words->folder ? words->folder : run->folder;
    run->options.stop = stop_on_signals();
    stop_in_order();   // points are processes of their own
    if (!run->quiet) run->options.out = open_memstream(&run->answer, &run->answer_size);
    return 0;
}

void study_run_end(StudyRun *run)
{
    if (run->options.out) fclose(run->options.out);
    if (run->bar && !run->quiet) tell_over("", 0);
}

int study_run_status(StudyRun *run, bool done, const Error *err)
{
    if (done && run->failures > 0) {
        fflush(stdout);
        tell("amontons: points failed (--retry computes them again), the first of them:\n  %s\n",
             run->failed[0]);
    }
    free(run->answer);
    if (!done) return report_error(err);
    return run->failures > 0 ? amontons_error_exit_status(ERROR_COMPUTE) : 0;
}
