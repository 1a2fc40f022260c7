// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons model1d`: theory beside simulation, a line a position of the front, then the lengths
// and coefficients by each way of finding them.
#include "cli/point_table.h"
#include "cli/scene_words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_ALPHA = OPTION_OWN, OPTION_POINTS, OPTION_THEORY };

typedef struct Model1dWords {
    SceneWords common;
    const char *alpha, *points;
    bool theory_only;
} Model1dWords;

// Gathers words; check_words judges them.
static error_t take_option(int key, char *word, struct argp_state *state)
{
    Model1dWords *words = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &words->common;
        return 0;
    case OPTION_ALPHA:
        words->alpha = word;
        return 0;
    case OPTION_POINTS:
        words->points = word;
        return 0;
    case OPTION_THEORY:
        words->theory_only = true;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void read_options(int argc, char **argv, Model1dWords *words)
{
    static const struct argp_option known[] = {
        {"theory", OPTION_THEORY, NULL, 0, "Formulas only, no simulation", 0},
        {"alpha", OPTION_ALPHA, "NUMBER", 0,
         "The part of H over which the shear stress varies (default: the paper's 0.2)", 0},
        {"points", OPTION_POINTS, "N", 0, "Nodes of the simulated line (default: 81)", 0},
        {0}};
    static const struct argp argp = {
        .options = known,
        .parser = take_option,
        .children = scene_words_child,
        .args_doc = "SCENE",
        .doc =
            "The paper's effective model in one dimension, with block, material, friction and rod "
            "of the scene file SCENE: a line whose pressure grows as 2 P x/L. Prints, for each "
            "position l of the quasi-static front, the adiabatic solution and how disturbances of "
            "it grow, beside what a simulation of the line shows when its rod has gone as far."
            "\vThe simulation starts where sliding has just stopped (U = 0) and ends with the "
            "scene's time.until. Its steps are those of `amontons run`, and `amontons render` "
            "draws them. With -o it leaves model1d.json, model1d.h5 and that history.h5. "
            "Example:\n\n"
            "  amontons model1d validation/paper/fig1.yaml --set load.pressure=0.03 -o line"};
    options_parse(&argp, argc, argv, "amontons model1d", words);
}

// The words of --alpha and --points as `options`. The exit status.
static int check_words(const Model1dWords *words, Model1dOptions *options)
{
    char *end = NULL;
    int status = scene_words_check(&words->common, "model1d", "validation/paper/fig1.yaml");
    if (status != 0) return status;
    if (words->alpha) {
        options->alpha = strtod(words->alpha, &end);
        if (*words->alpha == 0 || *end || !(options->alpha > 0 && options->alpha <= 10))
            return report_misuse("--alpha %s: a number above 0 up to 10 is allowed", words->alpha);
    }
    if (!words->points) return 0;
    if (words->theory_only) return report_misuse("--points has no meaning with --theory");
    return option_count("--points", words->points, 3, 2000, &options->nodes);
}

// A Model1dCallback; `l seen` and `mu seen` are empty where nothing was simulated.
static void show_point(const Model1dPoint *point, void *table)
{
    if (!point_table_line(table, "         l            U        mu   mu line  Re omega_0  "
                                 "Im omega_0   Re lambda   Im lambda  growing    l seen   mu seen"))
        return;
    printf("%10.5g %12.6g %9.5f %9.5f %11.4g %11.4g %11.4g %11.4g %8d", point->front, point->U,
           point->mu, point->mu_line, point->omega_re, point->omega_im, point->rate_re,
           point->rate_im, point->growing);
    point_table_cell(point->front_seen, 9, 5);
    point_table_cell(point->mu_seen, 9, 5);
    printf("\n");
}

// Twice: as the paper has it, and with the terms that it leaves out.
static void print_theory(const Model1dSummary *summary)
{
    printf("\nTheory, as in the paper (off-diagonal terms neglected)\n");
    point_table_answer("l_sc/L", summary->l_sc, "Re omega_0 > 0: oscillations grow");
    point_table_answer("l_c/L", summary->l_c,
                       summary->l_c > 1
                           ? "omega_0 real and > 0: not on this line, slow slip crosses it"
                           : "omega_0 real and > 0: slow slip turns into sliding");
    point_table_answer("l_c/L, l << L", summary->l_c_small, "the law (L P)^(-1/3)");
    point_table_answer("mu_M", summary->mu_c, "mu_K + (mu_S - mu_K) l_c/L");
    printf("Theory, all terms kept\n");
    point_table_answer("l_sc/L", summary->l_sc_full, "oscillations grow");
    point_table_answer("l_c/L", summary->l_c_full, "slow slip runs away, however slow the rod");
    point_table_answer("l_c/L at V", summary->l_rod_full,
                       "slip at V grows to v_c within half an oscillation");
    point_table_answer("mu_M, V -> 0", summary->mu_c_full, "mu at l_c; mu_S where there is none");
    point_table_answer("mu_M at V", summary->mu_rod_full, "mu at l_c at V");
}

// The first sliding starts from tau = mu_K p, as theory does; the periodic ones start from what
// sliding left, and differ by that.
static void print_steps(const Model1dSummary *summary)
{
    printf("Simulation\n");
    point_table_answer("first l_sc/L", summary->first_l_sc, "the certificate is lost");
    point_table_answer("first l_c/L", summary->first_l_c,
                       "sliding begins; from tau = mu_K p, as theory");
    point_table_answer("first mu_M", summary->first_mu, "its peak");
    point_table_answer("periodic l_c/L", summary->l_c_seen,
                       "later peaks start from what sliding left");
    point_table_answer("periodic mu_M", summary->mu_M, "");
    point_table_answer("spread of mu_M", summary->mu_M_spread, "largest less smallest that counts");
    printf("  %-22s %d, of which %d count, period %d; %d bounded rapid events\n", "peaks",
           summary->peaks, summary->peaks_counted, summary->period, summary->bounded);
    printf("  %-22s %-8.1e before anything was rapid\n", "mu against theory",
           summary->quasi_static_error);
    printf("  %-22s %-8.1e complementarity %.1e\n", "energy ledger", summary->energy_error,
           summary->contact_error);
    printf("  %-22s %lld accepted, %lld rejected\n", "steps", (long long)summary->accepted,
           (long long)summary->rejected);
}

static void print_answers(const Model1dSummary *summary)
{
    print_theory(summary);
    if (summary->simulated) print_steps(summary);
    printf("  %-22s %.1f s\n", "time taken", summary->seconds);
    if (*summary->folder)
        printf("Results in %s: model1d.json, model1d.h5%s\n", summary->folder,
               summary->simulated ? " and the steps in history.h5" : "");
}

// The table is printed while it is made, answers when all is known.
int command_model1d(int argc, char **argv)
{
    Model1dWords words = {0};
    Model1dOptions options = amontons_model1d_options();
    Model1dSummary summary;
    Error err = {0};
    Scene *scene = NULL;
    read_options(argc, argv, &words);
    int status = check_words(&words, &options);
    if (status == 0) status = scene_words_read(&words.common, &scene);
    if (status != 0) return status;
    bool quiet = words.common.quiet;
    PointTable table = point_table_begin(quiet);
    options.folder = words.common.folder;
    options.overwrite = words.common.overwrite;
    options.theory_only = words.theory_only;
    options.on_step = point_table_step;
    options.on_point = show_point;
    options.context = &table;
    options.stop = stop_on_signals();
    bool done = amontons_model1d(scene, &options, &summary, &err);
    progress_end(&table.progress);
    if (!done)
        status = report_error(&err);
    else if (!quiet)
        print_answers(&summary);
    amontons_scene_destroy(scene);
    return status;
}
