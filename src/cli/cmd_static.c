// SPDX-License-Identifier: GPL-2.0-or-later
#include "cli/commands.h"

#include <stdio.h>
#include <string.h>

enum { OVERRIDES_MAX = 200, OPTION_OVERWRITE = 1000, OPTION_SET };

typedef struct Options {
    const char *scene;
    const char *folder;
    const char *overrides[OVERRIDES_MAX];
    int32_t override_count;
    bool overwrite, quiet, too_many_scenes, too_many_overrides;
} Options;

static void take_setting(Options *options, const char *word)
{
    if (options->override_count == OVERRIDES_MAX)
        options->too_many_overrides = true;
    else
        options->overrides[options->override_count++] = word;
}

static error_t take_option(int key, char *word, struct argp_state *state)
{
    Options *options = state->input;
    switch (key) {
    case 'o':
        options->folder = word;
        return 0;
    case OPTION_SET:
        take_setting(options, word);
        return 0;
    case OPTION_OVERWRITE:
        options->overwrite = true;
        return 0;
    case 'q':
        options->quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        if (options->scene) options->too_many_scenes = true;
        options->scene = word;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void read_options(int argc, char **argv, Options *options)
{
    static const struct argp_option known[] = {
        {"output", 'o', "DIR", 0, "Write static.json, static.h5 and static.vtu into DIR", 0},
        {"set", OPTION_SET, "KEY=VALUE", 0,
         "Use this value in the place of the scene's; may be given several times", 0},
        {"overwrite", OPTION_OVERWRITE, NULL, 0, "Replace an earlier result in DIR", 0},
        {"quiet", 'q', NULL, 0, "Print nothing but errors", 0},
        {0}};
    static const struct argp argp = {
        .options = known,
        .parser = take_option,
        .args_doc = "SCENE",
        .doc = "Finds the equilibrium of the block under the scene's load, rod.displacement and "
               "load.supports: unilateral contact, Coulomb friction with friction.mu_static, stick "
               "relative to the undeformed block."
               "\vWithout -o nothing is written. Example:\n\n"
               "  amontons static validation/freefem/friction.yaml -o friction"};
    options_parse(&argp, argc, argv, "amontons static", options);
}

static int check_options(const Options *options)
{
    if (!options->scene)
        return report_misuse("static needs a scene, as in `amontons static "
                             "validation/freefem/friction.yaml`");
    if (options->too_many_scenes) return report_misuse("static takes one scene");
    if (options->too_many_overrides) return report_misuse("more than 200 settings by --set");
    if (options->folder && !*options->folder) return report_misuse("-o: the folder has no name");
    return 0;
}

static void print_summary(const char *title, const StaticSummary *summary)
{
    printf("%s\n\n", *title ? title : "equilibrium");
    printf("  contact        %d nodes: %d stick, %d slip, %d open\n", summary->contact_nodes,
           summary->sticking, summary->slipping, summary->open);
    printf("  on the block   F_z %.6g, F_x %.6g from the plane, moment of the pressure %.6g\n",
           summary->normal_force, summary->shear_force, summary->pressure_moment);
    if (summary->rod_nodes > 0)
        printf("  rod            %.6g on %d nodes, resultant at z = %.6g\n", summary->rod_force,
               summary->rod_nodes, summary->rod_height);
    printf("  energy         elastic %.6g, work of the loads %.6g\n", summary->elastic_energy,
           summary->load_work);
    printf("  errors         equations %.1e, forces %.1e, moments %.1e, contact %.1e\n",
           summary->residual, summary->force_balance, summary->moment_balance,
           summary->complementarity);
}

int command_static(int argc, char **argv)
{
    Options options = {0};
    Error err = {0};
    Scene *scene = NULL;
    StaticSummary summary;
    read_options(argc, argv, &options);
    int status = check_options(&options);
    if (status != 0) return status;
    if (!amontons_scene_read(options.scene, options.overrides, options.override_count, &scene,
                             &err))
        return report_error(&err);
    bool done = amontons_static(scene, options.folder, options.overwrite, &summary, &err);
    if (done && !options.quiet) {
        print_summary(amontons_scene_title(scene), &summary);
        if (options.folder) printf("  results        %s\n", options.folder);
    }
    amontons_scene_destroy(scene);
    return done ? 0 : report_error(&err);
}
