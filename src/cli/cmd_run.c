// SPDX-License-Identifier: GPL-2.0-or-later
#include "cli/closing.h"
#include "cli/commands.h"
#include "cli/progress.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { OVERRIDES_MAX = 200, OPTION_OVERWRITE = 1000, OPTION_SET, OPTION_PROFILE };

typedef struct Options {
    const char *scene;
    const char *folder;
    const char *overrides[OVERRIDES_MAX];
    int32_t override_count;
    bool overwrite, quiet, profile, too_many_scenes, too_many_overrides;
} Options;

// A signal can reach nothing but a variable of the file.
static volatile sig_atomic_t stop_wanted = 0;

static void want_stop(int signal_number)
{
    (void)signal_number;
    stop_wanted = 1;
}

// The first Ctrl-C ends the run in order; a second one ends the program.
static void catch_signals(void)
{
    struct sigaction action = {.sa_handler = want_stop, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

static void add_override(Options *options, const char *word)
{
    if (options->override_count == OVERRIDES_MAX)
        options->too_many_overrides = true;
    else
        options->overrides[options->override_count++] = word;
}

// `--set a=1 b=2`: words behind a --set that have a `=` and are no file are settings too.
static void take_word(Options *options, const char *word)
{
    bool is_setting = options->override_count && strchr(word, '=') && access(word, F_OK) != 0;
    if (is_setting)
        add_override(options, word);
    else if (options->scene)
        options->too_many_scenes = true;
    else
        options->scene = word;
}

static error_t take_option(int key, char *word, struct argp_state *state)
{
    Options *options = state->input;
    switch (key) {
    case 'o':
        options->folder = word;
        return 0;
    case OPTION_SET:
        add_override(options, word);
        return 0;
    case OPTION_OVERWRITE:
        options->overwrite = true;
        return 0;
    case OPTION_PROFILE:
        options->profile = true;
        return 0;
    case 'q':
        options->quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        take_word(options, word);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void read_options(int argc, char **argv, Options *options)
{
    static const struct argp_option known[] = {
        {"output", 'o', "DIR", 0,
         "The result folder (default: the scene's name with -result, here)", 0},
        {"set", OPTION_SET, "KEY=VALUE", 0,
         "Use this value in the place of the scene's; may be given several times", 0},
        {"overwrite", OPTION_OVERWRITE, NULL, 0, "Replace an earlier result in DIR", 0},
        {"profile", OPTION_PROFILE, NULL, 0,
         "Say at the end where the time went, and what was skipped and why", 0},
        {"quiet", 'q', NULL, 0, "Print nothing but errors", 0},
        {0}};
    static const struct argp argp = {
        .options = known,
        .parser = take_option,
        .args_doc = "SCENE",
        .doc = "Simulates the scene file SCENE: meshes, lets the block relax under its load, moves "
               "the rod until the scene's end, and leaves run.json, history.h5, fields and "
               "pictures in the result folder."
               "\vValues are written as in the scene: --set load.pressure=0.006, "
               "--set output.figures=[], --set output.fields=none; `amontons info keys` lists all "
               "keys. Ctrl-C ends the run after the present step and keeps its results. "
               "Example:\n\n"
               "  amontons run validation/paper/fig1.yaml --set mesh.set.nx=40 -o coarse"};
    options_parse(&argp, argc, argv, "amontons run", options);
}

static int check_options(const Options *options)
{
    if (!options->scene)
        return report_misuse("run needs a scene, as in `amontons run validation/paper/fig1.yaml`");
    if (options->too_many_scenes) return report_misuse("run takes one scene");
    if (options->too_many_overrides) return report_misuse("more than 200 settings by --set");
    if (options->folder && !*options->folder) return report_misuse("-o: the folder has no name");
    return 0;
}

// "validation/paper/fig1.yaml" gives "fig1-result".
static void default_folder(const char *scene, char *folder, size_t size)
{
    const char *slash = strrchr(scene, '/'), *name = slash ? slash + 1 : scene;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    snprintf(folder, size, "%.*s-result", (int)(length < 200 ? length : 200), name);
}

static int run_scene(const Scene *scene, const Options *options, const char *folder)
{
    Error err = {0};
    RunSummary summary = {0};
    Progress progress = progress_begin(options->quiet);
    RunOptions run = {.folder = folder,
                      .overwrite = options->overwrite,
                      .on_step = progress_step,
                      .context = &progress,
                      .stop = &stop_wanted};
    const char *warning = amontons_scene_warning(scene);
    if (warning && !options->quiet) fprintf(stderr, "amontons: warning: %s\n", warning);
    catch_signals();
    bool done = amontons_run(scene, &run, &summary, &err);
    progress_end(&progress);
    if (!done) return report_error(&err);
    if (!options->quiet) closing_print(amontons_scene_title(scene), &summary);
    if (options->profile) closing_print_profile(&summary);
    return 0;
}

int command_run(int argc, char **argv)
{
    Options options = {0};
    Error err = {0};
    Scene *scene = NULL;
    char folder[256];
    read_options(argc, argv, &options);
    int status = check_options(&options);
    if (status != 0) return status;
    default_folder(options.scene, folder, sizeof folder);
    if (!amontons_scene_read(options.scene, options.overrides, options.override_count, &scene,
                             &err))
        return report_error(&err);
    status = run_scene(scene, &options, options.folder ? options.folder : folder);
    amontons_scene_destroy(scene);
    return status;
}
