// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons run`: one simulation, with progress while it goes on and its answers at the end.
#include "amontons_simulation.h"
#include "cli/closing.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/say.h"
#include "cli/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SETTING_SIZE = 80 };

// A line for each mesh, above the progress bar.
static void show_level(const LevelView *view, void *context)
{
    char next[80] = "", left[32], value[ESTIMATE_SIZE], answer[80] = "no load drop in any run";
    progress_end(context);
    amontons_estimate(view->value, view->bar, view->known_to, value);
    progress_format_left(view->seconds_next, left, sizeof left);
    if (!isnan(view->seconds_next))
        snprintf(next, sizeof next, "; a finer one would take about %s", left);
    if (!isnan(view->value)) snprintf(answer, sizeof answer, "%s = %s", view->answer, value);
    tell("mesh %d: %d contact nodes, %d run%s in %.1f s; so far %s%s\n", view->level,
         view->contact_nodes, view->runs, view->runs == 1 ? "" : "s", view->seconds, answer, next);
}

// "5min", "300s" or "300" as seconds; NaN: it is neither.
static double seconds_of(const char *word)
{
    static const struct {
        const char *name;
        double seconds;
    } units[] = {{"", 1}, {"s", 1}, {"min", 60}, {"h", 3600}};
    char *end = NULL;
    double number = strtod(word, &end);
    while (*end == ' ') end++;
    for (size_t k = 0; end != word && k < sizeof units / sizeof *units; k++)
        if (strcmp(end, units[k].name) == 0 && number > 0) return number * units[k].seconds;
    return NAN;
}

// Says how large the run would be. The exit status.
static int show_forecast(const Scene *scene)
{
    Error err = {0};
    RunForecast size;
    if (!amontons_forecast(scene, &size, &err)) return report_error(&err);
    say("%d elements, %d contact nodes, %d unknowns\n", size.elements, size.contact_nodes,
        size.unknowns);
    if (*size.mesh_moved) say("mesh %s\n", size.mesh_moved);
    say("%s\n", !size.reduced ? "not reduced: steps are those of the whole mesh"
                : size.held   ? "reduced before stepping; the reduction is in the cache"
                              : "reduced before stepping; the reduction is not in the cache");
    say("%.2g s of processor time for the mesh\n", size.mesh);
    if (size.memory > 0) say("about %.2g GB of memory\n", size.memory / 1e9);
    return 0;
}

// Without -o the folder is named after the scene, and made in the current folder.
int command_run(const Command *command, int argc, char **argv)
{
    SceneWords words = {0};
    OptionWords *settings = &words.settings;
    const char *to = NULL, *within = NULL, *extend = NULL, *checkpoint = NULL;   // NULL: not given
    bool resume = false, dry = false;
    Scene *scene = NULL;
    Error err = {0};
    char folder[256], own_settings[3][SETTING_SIZE] = {"", "", ""};
    const Option own[] = {
        {"to", 0, "PERCENT", "Refine until the error bar of mu_M is at most this (--to 1%)",
         .word = &to},
        {"within", 0, "TIME",
         "With --to: begin no mesh or run that would end later (300s, 5min, 1h); a "
         "mesh that takes no more than a sixtieth of it confirms the bar",
         .word = &within},
        {"resume", 0, NULL, "Go on with the run in DIR that was cut off", .flag = &resume},
        {"extend", 0, "END", "Go on with the run in DIR beyond its end, to U=0.02 or t=500",
         .word = &extend},
        {"dry-run", 0, NULL, "Make the mesh, say how large the run would be, and end",
         .flag = &dry},
        {"checkpoint", 0, "TIME", "Between two checkpoints (10s)", .word = &checkpoint},
        {0}};
    int status = scene_words_read(command, own, argc, argv, &words);
    if (status != 0) return status;

    // Options that contradict each other or make no sense are refused.
    if (settings->count + 3 > OPTION_WORDS_MAX) return report_misuse("too many --set");
    if (checkpoint && !(seconds_of(checkpoint) > 0))
        return report_misuse("--checkpoint: found `%.40s`; allowed: a time such as 30s or 5min",
                             checkpoint);
    if (within && !to)
        return report_misuse("--within: needs --to, the error bar wanted (--to 1%%)");
    if (within && !(seconds_of(within) > 0))
        return report_misuse("--within: found `%.40s`; allowed: a time such as 300s, 5min or 1h",
                             within);
    char *end = (char *)to;
    if (to && strtod(to, &end) == 0 && end != to)
        return report_misuse("--to: found `%.40s`; allowed: an error bar above 0, such as 1%%; "
                             "without --to the scene is run as it is",
                             to);
    if (extend && strncmp(extend, "U=", 2) != 0 && strncmp(extend, "t=", 2) != 0)
        return report_misuse("--extend: found `%.40s`; allowed: where the run is to end, U=0.02 or "
                             "t=500",
                             extend);
    resume = resume || extend;
    if (resume && words.overwrite)
        return report_misuse("--overwrite removes what --resume and --extend would go on from");

    // The error bar wanted, the time for it, and `--extend U=0.02` (the scene's end alone; whatever
    // else would end it does not) become settings, behind those of --set.
    if (to) snprintf(own_settings[0], SETTING_SIZE, "accuracy.mu=%.50s", to);
    if (within)
        snprintf(own_settings[1], SETTING_SIZE, "accuracy.within=%.17g", seconds_of(within));
    if (extend)
        snprintf(own_settings[2], SETTING_SIZE, "time.until={%c: %.50s}", *extend, extend + 2);
    for (int32_t k = 0; k < 3; k++)
        if (*own_settings[k]) settings->list[settings->count++] = own_settings[k];
    status = scene_words_open(&words, &scene);
    if (status != 0) return status;
    if (dry) {
        status = show_forecast(scene);
        amontons_scene_destroy(scene);
        return status;
    }

    // The run. Warnings are printed also after a failure: they may explain it.
    default_folder(words.scene, "-result", folder, sizeof folder);
    RunSummary summary = {0};
    Progress progress = progress_begin(words.quiet);
    RunOptions run = {.folder = words.folder ? words.folder : folder,
                      .overwrite = words.overwrite,
                      .resume = resume,
                      .checkpoint_every = checkpoint ? seconds_of(checkpoint) : 0,
                      .on_step = progress_step,
                      .on_level = words.quiet ? NULL : show_level,
                      .on_stage = progress_stage,
                      .context = &progress,
                      .stop = stop_on_signals()};
    bool done = amontons_run(scene, &run, &summary, &err);
    progress_end(&progress);
    report_warnings(&summary.warnings);
    if (done && !words.quiet) closing_print(amontons_scene_title(scene), &summary);
    if (!done) status = report_error(&err);
    amontons_scene_destroy(scene);
    return status;
}
