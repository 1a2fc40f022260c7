// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons sweep`: a line a point on standard error, the ranked table on standard output. With the
// hidden option --element it is one of its own jobs on a cluster.
#include "cli/progress.h"
#include "cli/scene_words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    SETTINGS_MAX = 180,
    FAILURES_SHOWN = 10,
    OPTION_SET = 1000,
    OPTION_RETRY,
    OPTION_FRESH,
    OPTION_SLURM,
    OPTION_ELEMENT
};

typedef struct SweepWords {
    const char *study, *folder, *jobs;
    const char *slurm;   // words for sbatch; NULL: not asked for
    const char *element;   // list of a Slurm array, in which this process computes one point
    const char *overrides[SETTINGS_MAX];
    int32_t override_count;
    bool retry, fresh, quiet, too_many_studies, too_many_overrides;
} SweepWords;

// What show_point keeps from call to call.
typedef struct SweepDisplay {
    bool quiet, bar;   // a terminal: the last line is written over
    int32_t failures;
    char failed[FAILURES_SHOWN][500];
} SweepDisplay;

// Gathers words; check_options judges them.
static error_t take_option(int key, char *word, struct argp_state *state)
{
    SweepWords *words = state->input;
    switch (key) {
    case 'o':
        words->folder = word;
        return 0;
    case 'j':
        words->jobs = word;
        return 0;
    case 'q':
        words->quiet = true;
        return 0;
    case OPTION_RETRY:
        words->retry = true;
        return 0;
    case OPTION_FRESH:
        words->fresh = true;
        return 0;
    case OPTION_SLURM:
        words->slurm = word ? word : "";
        return 0;
    case OPTION_ELEMENT:
        words->element = word;
        return 0;
    case OPTION_SET:
        if (words->override_count == SETTINGS_MAX)
            words->too_many_overrides = true;
        else
            words->overrides[words->override_count++] = word;
        return 0;
    case ARGP_KEY_ARG:
        if (words->override_count && strchr(word, '='))   // --set a=1 b=2
            return take_option(OPTION_SET, word, state);
        if (words->study) words->too_many_studies = true;
        words->study = word;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void read_options(int argc, char **argv, SweepWords *words)
{
    static const struct argp_option known[] = {
        {"output", 'o', "DIR", 0,
         "Folder for the table and the points (default: the study's name with -sweep, here)", 0},
        {"jobs", 'j', "N", 0, "Points computed at a time (default: as many as there are cores)", 0},
        {"slurm", OPTION_SLURM, "WORDS", OPTION_ARG_OPTIONAL,
         "Compute the points as Slurm job arrays, with these words for sbatch if any; -j N: at "
         "most "
         "N at a time",
         0},
        {"element", OPTION_ELEMENT, "FILE", OPTION_HIDDEN, NULL, 0},
        {"set", OPTION_SET, "KEY=VALUE", 0,
         "Use this value for every point; may be given several times", 0},
        {"retry", OPTION_RETRY, NULL, 0, "Compute points again that failed before", 0},
        {"fresh", OPTION_FRESH, NULL, 0, "Compute all points again", 0},
        {"quiet", 'q', NULL, 0, "Print nothing but errors", 0},
        {0}};
    static const struct argp argp = {
        .options = known,
        .parser = take_option,
        .args_doc = "STUDY",
        .doc =
            "Computes all points of the study file STUDY, each a run in a process of its own, and "
            "leaves one table, DIR/sweep.csv and DIR/sweep.h5. A study names a base scene and what "
            "is varied:\n\n"
            "  scene: fig1.yaml\n"
            "  set: {mesh.set.nx: 40, mesh.set.height: = 0.5 * mesh.set.length}\n"
            "  vary:\n"
            "    mesh.set.length: [0.25, 1, 4]\n"
            "    load.pressure: {log: [1e-4, 1e-2], points: 7}\n"
            "  record: [mu_M, period, results.mu_max]\n"
            "  rank: {by: mu_M, order: highest, top: 10, against: {mesh.set.length: 1}}\n"
            "  plot: {x: load.pressure, y: mu_M, series: mesh.set.length, log: x}\n"
            "\vFinished points are kept in DIR/points, one by one: the same command goes on where "
            "an interrupted one stopped, and computes only what is new when the study has "
            "changed. Each point ends when its peaks are periodic; no history is kept and no "
            "pictures are drawn, unless the study sets output.history: true and the like. "
            "`cases:` is a list of maps of keys, each taken with all that is varied; a value "
            "beginning with `=` is a formula over the scene's numbers. What `record` may name, "
            "beside paths in run.json: mu_M, spread, period, low, high, peaks, l_c, l_sc, steps, "
            "unsolved, solve_s, total_s, energy_error, contact_error, moment_error, "
            "reduction_error, mu_max, mu_trusted, mu_trusted_error, mu_falls, mu_falls_error, "
            "falls, falls_period, falls_enough, mu_falls_high, mu_first_pad, first_mu, "
            "contact_nodes, reduced_dofs.\n\n"
            "`rank` ends the sweep with its best points, here and in DIR/ranking.csv, and with "
            "DIR/figures/ranking.png: `by` names a result as `record` does, `order` is highest "
            "or lowest, `top` how many are shown, `against` what a gain is measured from: first "
            "(the study's first point), best, or keys, which name the same point with these "
            "values. `low` and `high` bound mu_M: its own peaks, or all but the first where they "
            "do not repeat; by mu_trusted they are two standard errors of it to either side; who "
            "is as good as the first lies within the first's bounds. `plot` "
            "draws "
            "DIR/figures/plot.png: `x` and `y` each a result or a key that varies, `series` a key, "
            "`log`: x, y, both or none.\n\n"
            "With --slurm each point is an element of a job array; the sweep waits for them, from "
            "a "
            "login node for instance, and Ctrl-C cancels them. DIR and this program must be seen "
            "by "
            "all nodes. Partition, time and memory are given as sbatch takes them, by its own "
            "variables (SBATCH_PARTITION, SBATCH_TIMELIMIT, ...) or here: "
            "--slurm=\"--partition=short --time=10 --mem=1G\". A point needs one core. What an "
            "element "
            "printed stands in DIR/slurm; one that Slurm ended is a failed point, with Slurm's "
            "reason.\n\n"
            "Exit status: 0 all points done, 1 some failed (listed; the others are in the table), "
            "2 the study is wrong. Example:\n\n"
            "  amontons sweep validation/paper/fig2a.yaml -j 2 -o fig2a"};
    options_parse(&argp, argc, argv, "amontons sweep", words);
}

// In a job of a Slurm array: one point.
// list: the file that the sweep wrote for the array; Slurm says in the environment which element
// this process is. The exit status is what Slurm sees of it.
static int run_element(const char *list)
{
    const char *index = getenv("SLURM_ARRAY_TASK_ID");
    char *end = NULL;
    Error err = {0};
    long element = index ? strtol(index, &end, 10) : -1;
    if (!index || !*index || *end || element < 0 || element > INT32_MAX)
        return report_misuse("--element is for jobs that `amontons sweep --slurm` submits");
    return amontons_sweep_element(list, (int32_t)element, &err) ? 0 : report_error(&err);
}

// What can be wrong with words alone; the study itself is the library's to judge. The exit status.
static int check_options(const SweepWords *words, SweepOptions *options)
{
    if (!words->study)
        return report_misuse("sweep needs a study, as in `amontons sweep "
                             "validation/paper/fig2a.yaml`");
    if (words->too_many_studies) return report_misuse("sweep takes one study");
    if (words->too_many_overrides) return report_misuse("more than 180 settings by --set");
    if (words->folder && !*words->folder) return report_misuse("-o: the folder has no name");
    return words->jobs ? option_count("-j", words->jobs, 1, 1024, &options->jobs) : 0;
}

// A line a point; on a terminal a last line that says how far everything is.
static void show_point(const SweepView *view, void *context)
{
    SweepDisplay *display = context;
    char left[32], what[64];
    if (view->message && display->failures < FAILURES_SHOWN)
        snprintf(display->failed[display->failures++], sizeof display->failed[0], "%.190s: %.290s",
                 view->words, view->message);
    if (display->quiet) return;
    progress_format_left(view->seconds_left, left, sizeof left);
    if (display->bar) fprintf(stderr, "\r\033[K");
    if (view->message)
        snprintf(what, sizeof what, "FAILED");
    else
        snprintf(what, sizeof what, "mu_M %.4f", view->mu_M);
    if (!view->reused)
        fprintf(stderr, "%*d/%d  %s  %s  %.1f s  (%s left)\n", view->points < 100 ? 2 : 4,
                view->finished, view->points, view->words, what, view->seconds, left);
    if (display->bar) {
        fprintf(stderr, "%d of %d points, %d failed, %s left", view->finished, view->points,
                view->failed, left);
        fflush(stderr);
    }
}

// Failed points are no error of the sweep, but its exit status tells of them. ranked: text or NULL.
static int close_sweep(const SweepDisplay *display, const char *folder, const char *ranked,
                       const SweepSummary *summary)
{
    if (!display->quiet) {
        printf("%d points: %d computed in %.1f s", summary->points, summary->computed,
               summary->seconds);
        if (summary->reused) printf(", %d known before", summary->reused);
        if (summary->failed) printf(", %d failed", summary->failed);
        printf("\nTable in %s: sweep.csv and sweep.h5; each point's run.json in points/\n", folder);
        if (ranked) fputs(ranked, stdout);
    }
    if (summary->failed == 0) return 0;
    fflush(stdout);
    fprintf(stderr, "amontons: %d of %d points failed (--retry computes them again):\n",
            summary->failed, summary->points);
    for (int32_t k = 0; k < display->failures; k++) fprintf(stderr, "  %s\n", display->failed[k]);
    if (summary->failed > display->failures)
        fprintf(stderr, "  ... and more, in %s/sweep.csv\n", folder);
    return error_exit_status(ERROR_COMPUTE);
}

// The ranking is gathered in memory while points are reported on standard error, and printed when
// the last line of those has gone.
int command_sweep(int argc, char **argv)
{
    SweepWords words = {0};
    SweepOptions options = {.on_point = show_point};
    SweepSummary summary;
    Error err = {0};
    char folder[256];
    read_options(argc, argv, &words);
    if (words.element) return run_element(words.element);   // ends by a signal at once
    int status = check_options(&words, &options);
    if (status != 0) return status;
    options.stop = stop_on_signals();
    options.slurm = words.slurm;
    default_folder(words.study, "-sweep", folder, sizeof folder);
    options.folder = words.folder ? words.folder : folder;
    options.overrides = words.overrides;
    options.override_count = words.override_count;
    options.retry = words.retry;
    options.fresh = words.fresh;
    SweepDisplay display = {.quiet = words.quiet, .bar = isatty(STDERR_FILENO)};
    options.context = &display;
    char *ranked = NULL;   // shown below the line that is written over
    size_t size = 0;
    if (!words.quiet) options.out = open_memstream(&ranked, &size);
    bool done = amontons_sweep(words.study, &options, &summary, &err);
    if (options.out) fclose(options.out);
    if (display.bar && !display.quiet) fprintf(stderr, "\r\033[K");
    status = done ? close_sweep(&display, options.folder, ranked, &summary) : report_error(&err);
    free(ranked);
    return status;
}
