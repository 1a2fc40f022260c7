// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons sweep`, `amontons optimise` and `amontons fit`: a line a point on standard error, the
// ranked table or the answer on standard output, when the last of these lines has gone. With the
// hidden option --element a sweep is one of its own jobs on a cluster.
#include "amontons_optimise.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/say.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FAILURES_SHOWN = 10 };

typedef struct StudyWords {
    const char *study, *folder, *jobs, *slurm;
    OptionWords settings;
    bool has_slurm, is_element, retry, fresh, quiet, trust;
} StudyWords;

typedef struct StudyRun {
    SweepOptions options;   // to be handed to the library
    bool quiet, bar;   // a terminal: the last line is written over
    int32_t failures;
    char failed[FAILURES_SHOWN][500];
    char folder[256];   // where -o gives none
    char *answer;   // what the library wrote to options.out, once the run has ended; owned
    size_t answer_size;
} StudyRun;

// --- what the three share -----------------------------------------------------------------------

// ending: of the folder where -o gives none, "-sweep". has_elements: points may be jobs of a
// cluster that are this command with --element. Status 0 or 2.
static int study_words_read(const Command *command, const char *ending, bool has_elements, int argc,
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

// Signals are taken from here on; the library checks the study. Status 0 or 2.
static int study_run_begin(const StudyWords *words, const char *ending, StudyRun *run)
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

// The answer is whole, no line stands half written.
static void study_run_end(StudyRun *run)
{
    if (run->options.out) fclose(run->options.out);
    if (run->bar && !run->quiet) tell_over("", 0);
}

// --- sweep --------------------------------------------------------------------------------------

// Failed points are no error of the sweep, but its exit status shows them.
int command_sweep(const Command *command, int argc, char **argv)
{
    StudyWords words = {0};
    StudyRun run;
    SweepSummary summary;
    Error err = {0};
    int status = study_words_read(command, "-sweep", true, argc, argv, &words);
    if (status != 0) return status;
    if (words.is_element) {
        // A share of the points, in a job of a Slurm array, which a signal ends. Slurm puts into
        // the environment which element this process is, and keeps its exit status.
        const char *index = getenv("SLURM_ARRAY_TASK_ID");
        char *end = NULL;
        long element = index ? strtol(index, &end, 10) : -1;
        if (!index || !*index || *end || element < 0 || element > INT32_MAX || !words.folder)
            return report_misuse("--element is for jobs that `amontons sweep --slurm` submits");
        SweepOptions options = {.folder = words.folder,
                                .overrides = words.settings.list,
                                .override_count = words.settings.count,
                                .trust = words.trust};
        bool done = amontons_sweep_element(words.study, &options, (int32_t)element, &err);
        return done ? 0 : report_error(&err);
    }
    status = study_run_begin(&words, "-sweep", &run);
    if (status != 0) return status;
    bool done = amontons_sweep(words.study, &run.options, &summary, &err);
    study_run_end(&run);
    const char *folder = run.options.folder;
    if (done && !run.quiet) {
        char points[AMONTONS_PATH_SIZE + 8];
        say("%d points: %d computed in %.1f s", summary.points, summary.computed, summary.seconds);
        if (summary.reused) say(", %d computed before", summary.reused);
        if (summary.failed) say(", %d failed", summary.failed);
        snprintf(points, sizeof points, "%s/points", folder);
        say("\nTable in %s: sweep.csv and sweep.h5%s\n", folder,
            access(points, F_OK) == 0 ? "; each point's run.json in points/" : "");
        if (run.answer) say("%s", run.answer);
    }
    if (done && summary.failed > 0) {
        fflush(stdout);
        tell("amontons: %d of %d points failed (--retry computes them again):\n", summary.failed,
             summary.points);
        for (int32_t k = 0; k < run.failures; k++) tell("  %s\n", run.failed[k]);
        if (summary.failed > run.failures) tell("  ... and more, in %s/sweep.csv\n", folder);
        status = amontons_error_exit_status(ERROR_COMPUTE);
    }
    free(run.answer);
    return done ? status : report_error(&err);
}

// --- optimise, fit ------------------------------------------------------------------------------

int command_search(const Command *command, int argc, char **argv)
{
    bool fits = strcmp(command->name, "fit") == 0;
    const char *ending = fits ? "-fit" : "-best";
    StudyWords words = {0};
    StudyRun run;
    FitSummary fit = {0};
    OptimiseSummary best = {0};
    Error err = {0};
    int status = study_words_read(command, ending, false, argc, argv, &words);
    if (status == 0) status = study_run_begin(&words, ending, &run);
    if (status != 0) return status;
    bool done = fits ? amontons_fit(words.study, &run.options, &fit, &err)
                     : amontons_optimise(words.study, &run.options, &best, &err);
    study_run_end(&run);
    if (done && !run.quiet)
        say("%s%d points computed in %.1f s; table%s in %s: sweep.csv%s\n", run.answer,
            fits ? fit.computed : best.computed, fits ? fit.seconds : best.seconds, fits ? "s" : "",
            run.options.folder, fits ? ", fit.csv; figures/" : "; figures/course.png");
    if (done && run.failures > 0) {
        fflush(stdout);
        tell("amontons: points failed (--retry computes them again), the first of them:\n  %s\n",
             run.failed[0]);
    }
    free(run.answer);
    if (!done) return report_error(&err);
    return run.failures > 0 ? amontons_error_exit_status(ERROR_COMPUTE) : 0;
}
