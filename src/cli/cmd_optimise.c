// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons optimise`: a line a point on standard error, the answer on standard output.
#include "amontons_optimise.h"
#include "cli/commands.h"
#include "cli/say.h"
#include "cli/study_run.h"

static const char ENDING[] = "-best";
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
        "`vary`; what counts is the worst of them, with `over: mean` or `deviation` their mean or "
        "standard deviation, and with `over: front` each by itself, and other results that `rank` has "
        "under `also: {RESULT: highest}`: the answer is then all designs that no other is better "
        "than in each. `rank` says of "
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

int command_optimise(int argc, char **argv)
{
    StudyWords words = {0};
    StudyRun run;
    OptimiseSummary summary;
    Error err = {0};
    int status = study_words_read(&text, ENDING, false, argc, argv, &words);
    if (status == 0) status = study_run_begin(&words, ENDING, &run);
    if (status != 0) return status;
    bool done = amontons_optimise(words.study, &run.options, &summary, &err);
    study_run_end(&run);
    if (done && !run.quiet)
        say("%s%d points computed in %.1f s; table in %s: sweep.csv; figures/course.png\n",
            run.answer, summary.computed, summary.seconds, run.options.folder);
    return study_run_status(&run, done, &err);
}
