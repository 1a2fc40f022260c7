// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons run`: one simulation, with progress while it goes on and its answers at the end.
#include "cli/closing.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/scene_words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SETTING_SIZE = 80 };

static const CommandText text = {
    .name = "run",
    .argument = "SCENE",
    .what = "scene",
    .example = "amontons run validation/paper/fig1.yaml",
    .help =
        "Simulates the scene file SCENE: makes the mesh, lets the block relax under its load, "
        "moves the rod until the end of the scene (time.until), and writes run.json, history.h5, "
        "fields and pictures into the result folder (without -o: the scene's name with -result, "
        "in the current folder)."
        " With --to 1% the mesh is refined and runs are repeated until the error bar of mu_M is 1 "
        "% "
        "or less; the bar then holds the error of the mesh, of branches that coexist, and of the "
        "finite number of slidings."
        "\vValues are written as in the scene: --set load.pressure=0.006, "
        "--set output.figures=[], --set output.fields=none; `amontons info keys` lists all keys. "
        "A .geo is refined by its parameter `refine`, any other mesh by splitting its cells. "
        "Ctrl-C ends the run after the present step and keeps its results. Example:\n\n"
        "  amontons run validation/paper/fig1.yaml --set mesh.set.nx=40 -o coarse\n"
        "  amontons run validation/paper/fig1.yaml --to 1% --within 5min"};

// A line for each mesh, above the progress bar.
static void show_level(const LevelView *view, void *context)
{
    char next[80] = "", bar[48] = "", left[32];
    progress_end(context);
    if (!isnan(view->mesh)) snprintf(bar, sizeof bar, " +- %.1g", view->bar);
    progress_format_left(view->seconds_next, left, sizeof left);
    if (!isnan(view->seconds_next))
        snprintf(next, sizeof next, "; a finer one would take about %s", left);
    fprintf(stderr, "mesh %d: %d contact nodes, %s = %.4f%s from %d run%s in %.1f s%s\n",
            view->level, view->contact_nodes, view->answer, view->value, bar, view->runs,
            view->runs == 1 ? "" : "s", view->seconds, next);
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

// --to and --within become values of the scene, which `words` points at. to, within: NULL where not
// given. Status 0 or 2.
static int ask_accuracy(const char *to, const char *within, char settings[2][SETTING_SIZE],
                        SceneWords *words)
{
    OptionWords *list = &words->settings;
    if (within && !to)
        return report_misuse("--within: needs --to, the error bar wanted (--to 1%%)");
    if (within && !(seconds_of(within) > 0))
        return report_misuse("--within: found `%.40s`; allowed: a time such as 300s, 5min or 1h",
                             within);
    if (list->count + 2 > OPTION_WORDS_MAX) return report_misuse("--to: too many --set before it");
    if (to) {
        snprintf(settings[0], SETTING_SIZE, "accuracy.mu=%.50s", to);
        list->list[list->count++] = settings[0];
    }
    if (within) {
        snprintf(settings[1], SETTING_SIZE, "accuracy.within=%.17g", seconds_of(within));
        list->list[list->count++] = settings[1];
    }
    return 0;
}

// Warnings are printed also after a failure: they may explain it. The exit status.
static int run_scene(const Scene *scene, const SceneWords *words, bool profile)
{
    Error err = {0};
    RunSummary summary = {0};
    Progress progress = progress_begin(words->quiet);
    RunOptions run = {.folder = words->folder,
                      .overwrite = words->overwrite,
                      .on_step = progress_step,
                      .on_level = words->quiet ? NULL : show_level,
                      .context = &progress,
                      .stop = stop_on_signals()};
    bool done = amontons_run(scene, &run, &summary, &err);
    progress_end(&progress);
    report_warnings(&summary.warnings);
    if (!done) return report_error(&err);
    if (!words->quiet) closing_print(amontons_scene_title(scene), &summary);
    if (profile) closing_print_profile(&summary);
    return 0;
}

// Without -o the folder is named after the scene, and made in the current folder.
int command_run(int argc, char **argv)
{
    SceneWords words = {0};
    Scene *scene = NULL;
    bool profile = false;
    char folder[256];
    const char *to = NULL, *within = NULL;
    char settings[2][SETTING_SIZE];
    const Option own[] = {
        {"to", 0, "PERCENT", "Refine until the error bar of mu_M is at most this (--to 1%)",
         .word = &to},
        {"within", 0, "TIME",
         "With --to: begin no mesh or run that would end later (300s, 5min, 1h)", .word = &within},
        {"profile", 0, NULL, "Print at the end where the time went, and what was skipped and why",
         .flag = &profile},
        {0}};
    int status = scene_words_read(&text, own, argc, argv, &words);
    if (status == 0) status = ask_accuracy(to, within, settings, &words);
    if (status == 0) status = scene_words_open(&words, &scene);
    if (status != 0) return status;
    default_folder(words.scene, "-result", folder, sizeof folder);
    if (!words.folder) words.folder = folder;
    status = run_scene(scene, &words, profile);
    amontons_scene_destroy(scene);
    return status;
}
