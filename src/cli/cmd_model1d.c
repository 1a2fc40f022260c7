// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons model1d`: theory beside simulation, a line a position of the front, then the lengths
// and coefficients by each way of finding them.
#include "amontons_model1d.h"
#include "cli/commands.h"
#include "cli/point_table.h"
#include "cli/say.h"
#include "cli/options.h"

#include <stdlib.h>

// A Model1dCallback; `l seen` and `mu seen` are empty where nothing was simulated.
static void show_point(const Model1dPoint *point, void *table)
{
    if (!point_table_line(table, "         l            U        mu   mu line  Re omega_0  "
                                 "Im omega_0   Re lambda   Im lambda  growing    l seen   mu seen"))
        return;
    say("%10.5g %12.6g %9.5f %9.5f %11.4g %11.4g %11.4g %11.4g %8d", point->front, point->U,
        point->mu, point->mu_line, point->omega_re, point->omega_im, point->rate_re, point->rate_im,
        point->growing);
    point_table_cell(point->front_seen, 9, 5);
    point_table_cell(point->mu_seen, 9, 5);
    say("\n");
}

// The table is printed while it is made, answers when all is known.
int command_model1d(const Command *command, int argc, char **argv)
{
    SceneWords words = {0};
    const char *alpha = NULL, *points = NULL;
    char *end = NULL;
    Model1dOptions options = amontons_model1d_options();
    Model1dSummary summary;
    Error err = {0};
    Scene *scene = NULL;
    const Option own[] = {
        {"theory", 0, NULL, "Formulas only, no simulation", .flag = &options.theory_only},
        {"alpha", 0, "NUMBER",
         "The part of H over which the shear stress varies (default: the paper's 0.2)",
         .word = &alpha},
        {"points", 0, "N", "Nodes of the simulated line (default: 81)", .word = &points},
        {0}};
    int status = scene_words_read(command, own, argc, argv, &words);
    if (status != 0) return status;
    if (alpha) {
        options.alpha = strtod(alpha, &end);
        if (!*alpha || *end || !(options.alpha > 0 && options.alpha <= 10))
            return report_misuse("--alpha %s: a number above 0 up to 10 is allowed", alpha);
    }
    if (points && options.theory_only)
        return report_misuse("--points has no meaning with --theory");
    if (points) status = option_count("--points", points, 3, 2000, &options.nodes);
    if (status == 0) status = scene_words_open(&words, &scene);
    if (status != 0) return status;
    bool quiet = words.quiet;
    PointTable table = point_table_begin(quiet);
    options.folder = words.folder;
    options.overwrite = words.overwrite;
    options.on_step = point_table_step;
    options.on_point = show_point;
    options.context = &table;
    options.stop = stop_on_signals();
    bool done = amontons_model1d(scene, &options, &summary, &err);
    progress_end(&table.progress);
    amontons_scene_destroy(scene);
    if (!done) return report_error(&err);
    if (quiet) return 0;

    // Theory as in the paper, and with the terms that it neglects.
    say("\nTheory, as in the paper (off-diagonal terms neglected)\n");
    point_table_answer("l_sc/L", summary.l_sc, "Re omega_0 > 0: oscillations grow");
    point_table_answer("l_c/L", summary.l_c,
                       summary.l_c > 1 ? "omega_0 real and > 0: longer than the line, never reached"
                                       : "omega_0 real and > 0: slow slip turns into sliding");
    point_table_answer("l_c/L, l << L", summary.l_c_small, "the law (L P)^(-1/3)");
    point_table_answer("mu_M", summary.mu_c, "mu_K + (mu_S - mu_K) l_c/L");
    say("Theory, all terms kept\n");
    point_table_answer("l_sc/L", summary.l_sc_full, "oscillations grow");
    point_table_answer("l_c/L", summary.l_c_full,
                       "a disturbance grows without oscillating, however slow the rod");
    point_table_answer("l_c/L at V", summary.l_rod_full,
                       "a disturbance grows from V to v_c in half an oscillation");
    point_table_answer("mu_M, V -> 0", summary.mu_c_full, "mu at l_c; mu_S where there is none");
    point_table_answer("mu_M at V", summary.mu_rod_full, "mu at l_c at V");

    // In the simulation the first sliding starts from tau = mu_K p, as in theory; the periodic ones
    // from the stress that sliding left, and differ by that.
    if (summary.simulated) {
        say("Simulation\n");
        point_table_answer("first l_sc/L", summary.first_l_sc, "the certificate is lost");
        point_table_answer("first l_c/L", summary.first_l_c,
                           "sliding begins; start from tau = mu_K p, as in theory");
        point_table_answer("first mu_M", summary.first_mu, "its peak");
        point_table_answer("periodic l_c/L", summary.l_c_seen,
                           "later peaks start from the stress that sliding left");
        point_table_answer("periodic mu_M", summary.mu_M, "");
        point_table_answer("spread of mu_M", summary.mu_M_spread,
                           "largest less smallest of the peaks that count");
        say("  %-22s %d, of which %d count, period %d; %d bounded rapid events\n", "peaks",
            summary.peaks, summary.peaks_counted, summary.period, summary.bounded);
        say("  %-22s %-8.1e before the first rapid event\n", "mu against theory",
            summary.quasi_static_error);
        say("  %-22s %-8.1e complementarity %.1e\n", "energy ledger", summary.energy_error,
            summary.contact_error);
        say("  %-22s %lld accepted, %lld rejected\n", "steps", (long long)summary.accepted,
            (long long)summary.rejected);
    }
    say("  %-22s %.1f s\n", "time taken", summary.seconds);
    if (*summary.folder)
        say("Results in %s: model1d.json, model1d.h5%s\n", summary.folder,
            summary.simulated ? " and the steps in history.h5" : "");
    return 0;
}
