// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons run`: one simulation, with progress while it goes on and its answers at the end.
#include "cli/closing.h"
#include "cli/progress.h"
#include "cli/scene_words.h"

#include <stdio.h>

enum { OPTION_PROFILE = OPTION_OWN };

typedef struct Options {
    SceneWords words;
    bool profile;
} Options;

// The words common to all commands on a scene go to scene_words, the first child of the parser.
static error_t take_option(int key, char *word, struct argp_state *state)
{
    (void)word;
    Options *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &options->words;
        return 0;
    case OPTION_PROFILE:
        options->profile = true;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void read_options(int argc, char **argv, Options *options)
{
    static const struct argp_option known[] = {
        {"profile", OPTION_PROFILE, NULL, 0,
         "Say at the end where the time went, and what was skipped and why", 0},
        {0}};
    static const struct argp argp = {
        .options = known,
        .parser = take_option,
        .children = scene_words_child,
        .args_doc = "SCENE",
        .doc = "Simulates the scene file SCENE: meshes, lets the block relax under its load, moves "
               "the rod until the scene's end, and leaves run.json, history.h5, fields and "
               "pictures in the result folder (without -o: the scene's name with -result, here)."
               "\vValues are written as in the scene: --set load.pressure=0.006, "
               "--set output.figures=[], --set output.fields=none; `amontons info keys` lists all "
               "keys. time.accuracy=standard has mu_M within 1 % on a mesh of 80 cells along the "
               "block, draft within 3 % on 40, where l_c lies six cells or more from either end. "
               "Ctrl-C ends the run after the present step and keeps its results. Example:\n\n"
               "  amontons run validation/paper/fig1.yaml --set mesh.set.nx=40 -o coarse"};
    options_parse(&argp, argc, argv, "amontons run", options);
}

// Warnings come also where the run failed: they may say why. The exit status.
static int run_scene(const Scene *scene, const Options *options, const char *folder)
{
    Error err = {0};
    RunSummary summary = {0};
    Progress progress = progress_begin(options->words.quiet);
    RunOptions run = {.folder = folder,
                      .overwrite = options->words.overwrite,
                      .on_step = progress_step,
                      .context = &progress,
                      .stop = stop_on_signals()};
    bool done = amontons_run(scene, &run, &summary, &err);
    progress_end(&progress);
    report_warnings(&summary.warnings);
    if (!done) return report_error(&err);
    if (!options->words.quiet) closing_print(amontons_scene_title(scene), &summary);
    if (options->profile) closing_print_profile(&summary);
    return 0;
}

// Without -o the folder is named after the scene and lies here, where the user is, not where the
// scene is.
int command_run(int argc, char **argv)
{
    Options options = {0};
    Scene *scene = NULL;
    char folder[256];
    read_options(argc, argv, &options);
    const SceneWords *words = &options.words;
    int status = scene_words_check(words, "run", "validation/paper/fig1.yaml");
    if (status != 0) return status;
    default_folder(words->scene, "-result", folder, sizeof folder);
    status = scene_words_read(words, &scene);
    if (status == 0) status = run_scene(scene, &options, words->folder ? words->folder : folder);
    amontons_scene_destroy(scene);
    return status;
}
