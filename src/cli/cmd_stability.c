// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons stability`: the quasi-static path as a table, a line a position of the front, and below
// it where stability is lost.
#include "amontons_stability.h"
#include "cli/commands.h"
#include "cli/point_table.h"
#include "cli/say.h"
#include "cli/options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SLIDINGS_STANDARD = 2 };   // the second peak already belongs to the periodic regime

// A StabilityCallback.
static void show_point(const StabilityPoint *point, void *table)
{
    if (!point_table_line(table, "         l  slipping            U        mu    Re lambda    "
                                 "Im lambda    real rate      load  certified"))
        return;
    say("%10.5g %9d %12.6g %9.5f %12.4g %12.4g", point->front, point->slipping, point->U, point->mu,
        point->rate_re, point->rate_im);
    point_table_cell(point->real_rate > 0 ? point->real_rate : NAN, 12, 4);
    say(" %9.4f  %s\n", point->load, point->certified ? "yes" : "no");
    fflush(stdout);
}

// The sentences, then the numbers. `none`: the path ended before.
static void print_answers(const StabilitySummary *summary)
{
    say("\n");
    for (int32_t k = 0; k < summary->why_count; k++) {
        // Lines of at most 80 columns, from the second on indented.
        size_t column = 0;
        for (const char *word = summary->why[k]; *word;) {
            size_t length = strcspn(word, " ");
            if (column + 1 + length > 80) column = (size_t)say("\n   ") - 1;
            column += (size_t)say(" %.*s", (int)length, word);
            word += length + strspn(word + length, " ");
        }
        say("\n");
    }
    say("\n");
    point_table_answer("l_sc/L", summary->l_sc, "an oscillation grows");
    point_table_answer("l_sc/L (certificate)", summary->l_sc_certificate,
                       "viscosity alone no longer outweighs the weakening");
    point_table_answer("l_c/L", summary->l_c,
                       "a disturbance grows without oscillating, however slow the rod");
    point_table_answer("l_c/L at V", summary->l_c_rod,
                       "a disturbance grows from V to v_c in half an oscillation");
    if (summary->area_c_rod < 1 || summary->area_sc < 1) {
        point_table_answer("A_sc/A", summary->area_sc, "how much of the contact slips at l_sc");
        point_table_answer("A_c/A at V", summary->area_c_rod, "the same at l_c at V");
    }
    point_table_answer("l_c/L (scan)", summary->l_c_scan, "as l_c, pressures held fixed");
    point_table_answer("mu at l_sc", summary->mu_sc, "oscillations grow; at V");
    point_table_answer("mu at a jump", summary->mu_snap,
                       "where a node goes from rest to fast slip at once; at V");
    point_table_answer("mu_M, V -> 0", summary->mu_c, "mu at l_c");
    point_table_answer("mu_M at V", summary->mu_rod,
                       "mu at l_c at V, less what slow slip at V weakens friction");
    double critical = summary->pads[summary->pad].critical_stiffness;
    if (!isnan(critical)) {
        point_table_answer("critical stiffness", critical,
                           "of a body below it slip at V is not steady; memory of friction");
        point_table_answer("nucleation length", summary->nucleation_length,
                           "slip on a longer part grows, all else held");
    }
    say("  (the front moves from node to node, %.4f L apart)\n", summary->element);

    // Print how stable each pad is alone, and which of them slides.
    bool several = summary->pad_count > 1;
    if (several)
        say("\n%-16s %10s %9s %9s %9s %9s %10s %10s\n", "pad, at l_c at V", "pressure", "slips",
            "in mode", "load", "l_c alone", "drag", "stiffness");
    for (int32_t p = 0; several && p < summary->pad_count; p++) {
        const StabilityPad *pad = &summary->pads[p];
        say("%-16s %10.4g %9.3f %9.3f %9.3f ", pad->name, pad->pressure,
            pad->slipping / pad->length, pad->mode, pad->load);
        point_table_cell(pad->l_c / pad->length, 8, 3);
        say(" %10.4g %10.4g\n", pad->drag, pad->stiffness);
    }
    if (several)
        say("  slips, l_c alone: over the pad's length. load: weakening over the resistance of the "
            "pad when all\n"
            "  of it slips and the others hold; from 1 on it is unstable alone, below 1 only with "
            "others.\n");
    say("  time taken             %.1f s (before the path %.1f, path %.1f, growth rates %.1f)\n",
        summary->seconds_before + summary->seconds_path + summary->seconds_growth,
        summary->seconds_before, summary->seconds_path, summary->seconds_growth);
    if (*summary->folder)
        say("Results in %s: stability.json, and the growing modes in stability.h5\n",
            summary->folder);
}

// With --from end one state's line is the whole answer: there is no path to sum up.
int command_stability(const Command *command, int argc, char **argv)
{
    SceneWords words = {0};
    const char *from = NULL, *slidings = NULL;
    StabilityOptions options = {0};
    StabilitySummary summary;
    Error err = {0};
    Scene *scene = NULL;
    const Option own[] = {
        {"from", 0, "STATE",
         "Where the path begins: `sliding`, when the block has come to rest after sliding (the "
         "default), or `start`, the relaxed block. `end`: no path; the growth rates of the one "
         "state in which the scene's run ends",
         .word = &from},
        {"slidings", 0, "N",
         "With --from sliding: after how many of them, computed by time stepping (default: 2). "
         "Where the block does not slide as a whole, drops of the force by 5 % count",
         .word = &slidings},
        {"whole", 0, NULL, "Follow the front to the end of the block, beyond l_c",
         .flag = &options.whole},
        {0}};
    int status = scene_words_read(command, own, argc, argv, &words);
    if (status != 0) return status;
    options.at_end = from && strcmp(from, "end") == 0;
    bool start = options.at_end || (from && strcmp(from, "start") == 0);
    if (from && !start && strcmp(from, "sliding") != 0)
        return report_misuse("--from %s: allowed are sliding, start and end", from);
    if (start && slidings) return report_misuse("--slidings has no meaning with --from %s", from);
    if (options.at_end && options.whole)
        return report_misuse("--whole has no meaning with --from end, which follows no path");
    options.slidings = start ? 0 : SLIDINGS_STANDARD;
    if (slidings) status = option_count("--slidings", slidings, 1, 1000, &options.slidings);
    if (status == 0) status = scene_words_open(&words, &scene);
    if (status != 0) return status;

    PointTable table = point_table_begin(words.quiet);
    options.folder = words.folder;
    options.overwrite = words.overwrite;
    options.on_step = point_table_step;
    options.on_point = show_point;
    options.context = &table;
    options.stop = stop_on_signals();
    bool done = amontons_stability(scene, &options, &summary, &err);
    progress_end(&table.progress);
    if (!done)
        status = report_error(&err);
    else if (!words.quiet && !options.at_end)
        print_answers(&summary);
    amontons_scene_destroy(scene);
    return status;
}
