// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons optimise`: a line a point on standard error, the answer on standard output.
#include "amontons_optimise.h"
#include "cli/commands.h"
#include "cli/say.h"
#include "cli/study_run.h"
#include "cli_help.h"

static const char ENDING[] = "-best";
static const CommandText text = {.name = "optimise",
                                 .argument = "STUDY",
                                 .what = "study",
                                 .example = "amontons optimise docs/examples/best_pads.yaml",
                                 .help = optimise_txt};

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
