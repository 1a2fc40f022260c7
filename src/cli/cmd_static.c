// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons static`: one equilibrium, with the sums by which a user can judge it.
#include "cli/scene_words.h"

#include <stdio.h>

static error_t take_option(int key, char *word, struct argp_state *state)
{
    (void)word;
    if (key != ARGP_KEY_INIT) return ARGP_ERR_UNKNOWN;
    state->child_inputs[0] = state->input;
    return 0;
}

static void read_options(int argc, char **argv, SceneWords *words)
{
    static const struct argp argp = {
        .parser = take_option,
        .children = scene_words_child,
        .args_doc = "SCENE",
        .doc = "Finds the equilibrium of the block under the scene's load, rod.displacement and "
               "load.supports: unilateral contact, Coulomb friction with friction.mu_static, stick "
               "relative to the undeformed block."
               "\vWith -o it leaves static.json, static.h5 and static.vtu; without nothing is "
               "written. "
               "Example:\n\n"
               "  amontons static validation/freefem/friction.yaml -o friction"};
    options_parse(&argp, argc, argv, "amontons static", words);
}

// Sums, and last the balances by which to judge them. Forces are per width, in the scene's units.
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

// Without -o nothing is written: the lines printed are all.
int command_static(int argc, char **argv)
{
    SceneWords words = {0};
    Error err = {0};
    Scene *scene = NULL;
    StaticSummary summary;
    read_options(argc, argv, &words);
    int status = scene_words_check(&words, "static", "validation/freefem/friction.yaml");
    if (status == 0) status = scene_words_read(&words, &scene);
    if (status != 0) return status;
    bool done = amontons_static(scene, words.folder, words.overwrite, &summary, &err);
    if (done && !words.quiet) {
        print_summary(amontons_scene_title(scene), &summary);
        if (words.folder) printf("  results        %s\n", words.folder);
    }
    amontons_scene_destroy(scene);
    return done ? 0 : report_error(&err);
}
