// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons run`: one simulation, with progress while it goes on and its answers at the end.
#include "cli/closing.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/scene_words.h"

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
        "\vValues are written as in the scene: --set load.pressure=0.006, "
        "--set output.figures=[], --set output.fields=none; `amontons info keys` lists all keys. "
        "With time.accuracy=standard and a mesh of 80 elements along the block mu_M is within 1 %, "
        "with draft and 40 elements within 3 %, where l_c is at least six elements from either "
        "end. Ctrl-C ends the run after the present step and keeps its results. Example:\n\n"
        "  amontons run validation/paper/fig1.yaml --set mesh.set.nx=40 -o coarse"};

// Warnings are printed also after a failure: they may explain it. The exit status.
static int run_scene(const Scene *scene, const SceneWords *words, bool profile)
{
    Error err = {0};
    RunSummary summary = {0};
    Progress progress = progress_begin(words->quiet);
    RunOptions run = {.folder = words->folder,
                      .overwrite = words->overwrite,
                      .on_step = progress_step,
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
    const Option own[] = {{"profile", 0, NULL,
                           "Print at the end where the time went, and what was skipped and why",
                           .flag = &profile},
                          {0}};
    int status = scene_words_read(&text, own, argc, argv, &words);
    if (status == 0) status = scene_words_open(&words, &scene);
    if (status != 0) return status;
    default_folder(words.scene, "-result", folder, sizeof folder);
    if (!words.folder) words.folder = folder;
    status = run_scene(scene, &words, profile);
    amontons_scene_destroy(scene);
    return status;
}
