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
static const CommandText text = {
    .name = "sweep",
    .argument = "STUDY",
    .what = "study",
    .example = "amontons sweep validation/paper/fig2a.yaml",
    .help =
        "Computes all points of the study file STUDY, each of them a run, in processes of their "
        "own, and writes one table, DIR/sweep.csv and DIR/sweep.h5. A study names a scene and what "
        "is "
        "varied in it:\n\n"
        "  scene: fig1.yaml\n"
        "  set: {mesh.set.nx: 40, mesh.set.height: = 0.5 * mesh.set.length}\n"
        "  vary:\n"
        "    mesh.set.length: [0.25, 1, 4]\n"
        "    load.pressure: {log: [1e-4, 1e-2], points: 7}\n"
        "  record: [mu_M, period, results.mu_max]\n"
        "  rank: {by: mu_M, order: highest, top: 10, against: {mesh.set.length: 1}}\n"
        "  plot: {x: load.pressure, y: mu_M, series: mesh.set.length, log: x}\n"
        "\v`set` changes keys of the scene for all points; a value that begins with `=` is a "
        "formula over the scene's numbers. `vary` takes every combination of its values. `cases` "
        "is a list of maps of keys, each combined with all of `vary`.\n\n"
        "`record` names the columns of the table: paths in run.json, or mu_M, mu_M_error, spread, "
        "period, low, high, peaks, l_c, l_sc, slip_cells, steps, unsolved, solve_s, total_s, "
        "energy_error, contact_error, moment_error, "
        "reduction_error, mu_max, mu_hold, mu_hold_error, mu_drops, mu_drops_error, "
        "drops, drops_period, drops_enough, run_in_over, mu_steady, mu_first_pad, first_mu, "
        "contact_nodes, reduced_dofs.\n\n"
        "`rank` prints the best points at the end, and writes DIR/ranking.csv and "
        "DIR/figures/ranking.png: `by` is a name as in `record`, `order` is highest or lowest, "
        "`top` how many are printed, `against` what the gain is measured from: first (the first "
        "point), best, or keys: then the same point with these values. `+-` is the error of "
        "the number before it. Where the difference of two points is within their errors, their "
        "order is `not decided`; `refine: 0.5%` computes such points again, with accuracy.mu "
        "halved until the order is decided or 0.5% is reached. `plot` draws DIR/figures/plot.png: "
        "`x` and `y` each a result, a key that varies, or a formula over such, as in = "
        "load.pressure * mesh.set.length; `series` a key, `log`: x, y, both or none. With `color` "
        "(and `contours`) it draws a map, DIR/figures/map.png. `panels` draws a frame for each "
        "value of a key, `with` names folders of other sweeps to show beside; a list draws several "
        "plots, told apart by `name`. `amontons render DIR --plot` draws others later.\n\n"
        "Each point ends when its peaks are periodic, and keeps no history and no pictures, "
        "unless the study sets output.history: true and the like; with `keep: table` it leaves no "
        "folder either. Finished points stay in "
        "DIR/points: the same command continues an interrupted sweep, and computes only what is "
        "new when the study has changed.\n\n"
        "With --slurm each point is an element of a job array. The sweep waits for them, on a "
        "login node for instance; Ctrl-C cancels them. All nodes must see DIR and this program. "
        "Partition, time and memory are given by the variables of sbatch (SBATCH_PARTITION, "
        "SBATCH_TIMELIMIT, ...) or here: --slurm=\"--partition=short --time=10 --mem=1G\". A point "
        "needs one core. The output of an element is in DIR/slurm; an element that Slurm ended is "
        "a failed point, with Slurm's reason. With `keep: table` an element computes as many "
        "points as "
        "take four minutes; what it left undone the same command goes on with.\n\n"
        "Exit status: 0 all points done, 1 some failed (listed; the others are in the table), "
        "2 the study is wrong. Example:\n\n"
        "  amontons sweep validation/paper/fig2a.yaml -j 2 -o fig2a"};

// One point, in a job of a Slurm array. list: the file that the sweep wrote for the array; Slurm
// puts into the environment which element this process is, and keeps its exit status.
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

int command_sweep(int argc, char **argv)
{
    StudyWords words = {0};
    StudyRun run;
    SweepSummary summary;
    Error err = {0};
    int status = study_words_read(&text, ENDING, true, argc, argv, &words);
    if (status == 0 && words.is_element) return run_element(words.study);   // a signal ends it
    if (status == 0) status = study_run_begin(&words, ENDING, &run);
    if (status != 0) return status;
    bool done = amontons_sweep(words.study, &run.options, &summary, &err);
    study_run_end(&run);
    status = done ? close_sweep(&run, &summary) : report_error(&err);
    free(run.answer);
    return status;
}
