// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons optimise` and `amontons fit`: a line a point on standard error, the answer on standard
// output.
#include "amontons_optimise.h"
#include "cli/commands.h"
#include "cli/say.h"
#include "cli/study_run.h"

#include <string.h>

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
    return study_run_status(&run, done, &err);
}
