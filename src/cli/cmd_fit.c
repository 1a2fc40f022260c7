// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons fit`: a line a point on standard error, the answer on standard output.
#include "amontons_optimise.h"
#include "cli/commands.h"
#include "cli/say.h"
#include "cli/study_run.h"

static const char ENDING[] = "-fit";
static const CommandText text = {
    .name = "fit",
    .argument = "STUDY",
    .what = "study",
    .example = "amontons fit docs/examples/viscosity.yaml",
    .help =
        "Finds the numbers of a scene that measurements speak for, and how well. STUDY is a study "
        "as for `optimise`, with `fit` in place of `best` and `vary`:\n\n"
        "  scene: block.yaml\n"
        "  search:\n"
        "    material.eta1: {log: [0.2, 5]}\n"
        "    friction.critical_velocity: {log: [1e-4, 1e-3]}\n"
        "  fit: {measured: measured.csv, sure: 95%}\n"
        "\vA table of measurements has a column for each key of the scene that differs between "
        "them (load.pressure, mesh.set.length), one for each result (mu_M, l_c, ... as `record` of "
        "a sweep names them), and beside each, with `_error` behind its name, one standard "
        "deviation. A row is one condition; cells may be empty. A curve has a row a point: "
        "series/mu with its error is read where series/rod_displacement first comes to the value "
        "given (series of history.h5; the study sets output.history: true).\n\n"
        "Designs are chosen as by `optimise`, where the misfit may be small: the sum of squares of "
        "found less measured over both errors, with half of what the program's value is known to "
        "as its own. Each result is then taken as a polynomial of the keys through these designs, "
        "which smooths the scatter of runs; designs at the ends of the regions follow, until these "
        "stay. A key's region is where the misfit, least over the other keys, is at most as far "
        "above its least as chance would have it (`sure`: 68%, 90%, 95% or 99%). Products of keys "
        "say what the data do not tell apart.\n\n"
        "DIR has sweep.csv (all points), fit.csv (a row a measurement) and figures: "
        "profile_KEY.png, region_KEY_KEY.png, measured.png. The same command goes on where it was "
        "stopped.\n\n"
        "Exit status: 0 done, 1 some points failed or too few designs have what was measured, 2 "
        "the "
        "study or a table is wrong. Example:\n\n"
        "  amontons fit docs/examples/viscosity.yaml -o viscosity"};

int command_fit(int argc, char **argv)
{
    StudyWords words = {0};
    StudyRun run;
    FitSummary summary;
    Error err = {0};
    int status = study_words_read(&text, ENDING, false, argc, argv, &words);
    if (status == 0) status = study_run_begin(&words, ENDING, &run);
    if (status != 0) return status;
    bool done = amontons_fit(words.study, &run.options, &summary, &err);
    study_run_end(&run);
    if (done && !run.quiet)
        say("%s%d points computed in %.1f s; tables in %s: sweep.csv, fit.csv; figures/\n",
            run.answer, summary.computed, summary.seconds, run.options.folder);
    return study_run_status(&run, done, &err);
}
