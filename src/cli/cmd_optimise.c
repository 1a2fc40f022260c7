// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons optimise`: a line a point on standard error, the answer on standard output.
#include "amontons_optimise.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/point_lines.h"
#include "cli/say.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const CommandText text = {
    .name = "optimise",
    .argument = "STUDY",
    .what = "study",
    .example = "amontons optimise docs/examples/best_pads.yaml",
    .help =
        "Searches the best design. STUDY is a study as for `sweep`, with `search` in place of "
        "`cases`:\n\n"
        "  scene: pads.yaml\n"
        "  set: {accuracy: {mu: 4%, within: 60}}\n"
        "  search:\n"
        "    mesh.set.n: {whole: [1, 12]}\n"
        "    mesh.set.pad_height: {log: [0.01, 0.2]}\n"
        "    rod.height: {linear: [0.1, 0.4]}\n"
        "  where: [{value: = mesh.set.n * mesh.set.pad_height, most: 0.6}]\n"
        "  vary: {load.pressure: [0.003, 0.012]}\n"
        "  rank: {by: mu_hold, order: highest, refine: 1%}\n"
        "  best: {over: worst, designs: 40, seed: 1}\n"
        "\v`search` gives each key a range: linear, log (equal ratios are equally likely) or whole "
        "numbers. `where` is a list of limits: a design is computed only if the formula over the "
        "scene's numbers is between `least` and `most`. Each design is computed at all points of "
        "`vary`; what counts is the worst of them, or with `over: mean` their mean. `rank` says of "
        "what, and whether the highest or the lowest is best.\n\n"
        "`designs` are chosen one after the other, where values so far promise most (dlib's global "
        "search), as many at a time as there are processes. Those along each key through the best "
        "follow. With `refine` designs that may be the best are computed again, with half the "
        "error bar each time, until one is better than all others by the bars of both, or 1% is "
        "reached. At a bar of a few per cent a search is cheap, and the bar is told with the "
        "answer.\n\n"
        "All points are rows of DIR/sweep.csv; figures: course.png (values in the order of the "
        "search) and along_KEY.png. The same command goes on where it was stopped; the course of a "
        "search depends on `seed` and on -j.\n\n"
        "Exit status: 0 done, 1 some points failed or no design has a value, 2 the study is wrong. "
        "Example:\n\n"
        "  amontons optimise docs/examples/best_pads.yaml -o best-pads"};

typedef struct OptimiseWords {
    const char *study, *folder, *jobs, *slurm;
    OptionWords settings;
    bool has_slurm, retry, fresh, quiet, trusted;
} OptimiseWords;

static int read_words(int argc, char **argv, OptimiseWords *words)
{
    const Option options[] = {
        {"output", 'o', "DIR",
         "Folder for the table and the points (default: the study's name with -best, in the "
         "current folder)",
         .word = &words->folder},
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
        option_trust(&words->trusted),
        {0}};
    int status = options_read(&text, options, argc, argv, &words->study);
    if (words->trusted) trust_meshes();
    return status;
}

static int check_words(const OptimiseWords *words, SweepOptions *options)
{
    if (words->folder && !*words->folder) return report_misuse("-o: the folder has no name");
    return words->jobs ? option_count("-j", words->jobs, 1, 1024, &options->jobs) : 0;
}

// The answer is gathered in memory while points are reported, and printed when the last line of
// those has gone.
int command_optimise(int argc, char **argv)
{
    OptimiseWords words = {0};
    SweepOptions options = {.on_point = point_line};
    OptimiseSummary summary;
    Error err = {0};
    char folder[256];
    int status = read_words(argc, argv, &words);
    if (status == 0) status = check_words(&words, &options);
    if (status != 0) return status;
    options.stop = stop_on_signals();
    stop_in_order();   // points are processes of their own
    options.slurm = words.slurm;
    default_folder(words.study, "-best", folder, sizeof folder);
    options.folder = words.folder ? words.folder : folder;
    options.overrides = words.settings.list;
    options.override_count = words.settings.count;
    options.retry = words.retry;
    options.fresh = words.fresh;
    PointLines display = {.quiet = words.quiet, .bar = isatty(STDERR_FILENO)};
    options.context = &display;
    char *answer = NULL;
    size_t size = 0;
    if (!words.quiet) options.out = open_memstream(&answer, &size);
    bool done = amontons_optimise(words.study, &options, &summary, &err);
    if (options.out) fclose(options.out);
    if (display.bar && !display.quiet) tell_over("", 0);
    if (done && !words.quiet)
        say("%s%d points computed in %.1f s; table in %s: sweep.csv; figures/course.png\n", answer,
            summary.computed, summary.seconds, options.folder);
    if (done && display.failures > 0) {
        fflush(stdout);
        tell("amontons: points failed, the first of them:\n  %s\n", display.failed[0]);
    }
    free(answer);
    if (!done) return report_error(&err);
    return display.failures > 0 ? amontons_error_exit_status(ERROR_COMPUTE) : 0;
}
