// SPDX-License-Identifier: GPL-2.0-or-later
// The three answers first, with what bounds each. Only files that exist are named.
#include "cli/closing.h"

#include "cli/say.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char INDENT[] = "                  ";

// Prints a value with the error bar that was asked for, or NaN. Of a run on one mesh alone also
// what finer meshes change as a rule.
static void print_estimate(const char *name, double value, double bar, double known_to, bool alone)
{
    char text[ESTIMATE_SIZE], words[ESTIMATE_SIZE];
    amontons_estimate(value, bar, known_to, text);
    say("  %-15s %s", name, text);
    if (!alone || isnan(value)) return;
    amontons_known_to(value, known_to, words);
    say(", %s", words);
}

static void print_known_to(double known_to)
{
    if (isnan(known_to))
        say("%scells are too long for slip: finer ones may change any digit\n", INDENT);
    else
        say("%s(what finer meshes change as a rule; --to 1%% gives an error bar)\n", INDENT);
}

// Prints the result of a run without an error bar to four decimals, and the error that its finite
// number of drops leaves.
static void print_on_this_mesh(double value, double drops)
{
    say("%son this mesh %.4f", INDENT, value);
    if (!isnan(drops)) say(" (drops %.2g)", drops);
}

// Prints the parts of an error bar: mesh, branches, drops.
static void print_parts(double error, const double parts[3])
{
    static const char *const names[] = {"mesh", "branches", "drops"};
    const char *separator = " (";
    if (isnan(error)) {
        say(" (its error is not known)");
        return;
    }
    for (int32_t k = 0; k < 3; k++) {
        if (isnan(parts[k])) continue;
        say("%s%s %.2g", separator, names[k], parts[k]);
        separator = ", ";
    }
    if (*separator == ',') say(")");
}

static const char STEADY[] = "steady sliding";   // what mu_M then is

// "none yet: ..." while run-in goes on, with how long it may take.
static void print_run_in(const RunSummary *summary)
{
    say("run-in still going on (%s", summary->run_in);
    if (!isnan(summary->run_in_drift)) say(", %+.2g %% a drop", 100 * summary->run_in_drift);
    if (!isnan(summary->run_in_drops_left))
        say(", over after at most %.0f more", summary->run_in_drops_left);
    say("): give a later time.until\n");
}

// The macroscopic static friction coefficient, from how many peaks, and whether they repeat.
static void print_mu_M(const RunSummary *summary)
{
    if (isnan(summary->mu_M)) {
        // The last of several meshes may well have a mu_M.
        bool some = summary->bar_runs > 0 && summary->peaks > 0;
        say("  mu_M            %s\n",
            some ? "none: not every run of the error bar came to slide as a whole"
                 : summary->mu_M_is);
        return;
    }
    bool bar = summary->bar_runs > 0, steady = strcmp(summary->mu_M_is, STEADY) == 0;
    print_estimate("mu_M", summary->mu_M, bar ? summary->mu_M_error : (double)NAN,
                   summary->mu_M_known_to, !bar);
    if (bar) print_parts(summary->mu_M_error, summary->mu_M_parts);
    if (steady)
        say(": F_T/F_N of %s; the block slides slowly as a whole, no sliding was fast\n", STEADY);
    else if (bar)
        say(": static friction\n");
    if (steady || bar) return;
    say(": static friction, mean of the last %d of %d peaks, each before the whole block slid\n",
        summary->peaks_counted, summary->peaks);
    print_known_to(summary->mu_M_known_to);
    print_on_this_mesh(summary->mu_M, summary->mu_M_error);
    if (!isnan(summary->mu_M_spread)) {
        say("; the peaks differ by at most %.2g", summary->mu_M_spread);
        if (summary->period > 1) say(" and repeat after %d slidings", summary->period);
        say("%s", summary->period > 0 ? "" : "; not periodic yet");
    }
    say("\n");
}

// The holding coefficient: parts of a block that slide on their own make the load drop below mu_M.
static void print_mu_hold(const RunSummary *summary)
{
    if (isnan(summary->mu_hold)) {
        say("  mu_hold         none%s", summary->drops > 0 && summary->run_in ? " yet: " : ": ");
        if (summary->drops > 0 && summary->run_in)
            print_run_in(summary);
        else
            say("the load did not drop in this run\n");
        return;
    }
    bool bar = summary->bar_runs > 0;
    print_estimate("mu_hold", summary->mu_hold, bar ? summary->mu_hold_error : (double)NAN,
                   summary->mu_hold_known_to, !bar);
    if (bar) print_parts(summary->mu_hold_error, summary->mu_hold_parts);
    if (bar && !summary->drops_enough) {   // of the last of its runs, which need not go on so long
        say(": what the contact holds, by the runs behind the error bar\n");
        return;
    }
    say("%s: what the contact holds, ", summary->drops_enough ? "" : ", so far");
    if (summary->drops == 1)
        say("the one load ratio at which the load dropped\n");
    else
        say("the %s of %d load ratios at which the load dropped\n",
            summary->drop_period > 0 ? "lowest" : "lowest tenth", summary->drops);

    // Say if the load drops behind it repeat.
    if (summary->drop_period > 1)
        say("%swhich repeat after %d\n", INDENT, summary->drop_period);
    else if (summary->drop_period == 0 && summary->drops_enough)
        say("%swhich do not repeat\n", INDENT);
    else if (summary->run_in) {
        say(INDENT);
        print_run_in(summary);
    } else if (!summary->drops_enough)
        say("%stoo few to say: give a later time.until, until they repeat, or until 30 have\n"
            "%sa mean known to 2 %%\n",
            INDENT, INDENT);
    if (bar) return;
    if (isnan(summary->mu_M)) print_known_to(summary->mu_hold_known_to);
    print_on_this_mesh(summary->mu_hold, summary->mu_hold_error);
    say("\n");
}

// Prints the results of a program with jumps of the rod's velocity. run.json says why one is
// missing.
static void print_program(const RunSummary *summary)
{
    const double *direct = summary->direct_effect, *change = summary->level_change;
    const double *distance = summary->slip_distance, *healing = summary->healing;
    if (summary->velocity_steps > 0) {
        say("  velocity steps  %d: ", summary->velocity_steps);
        if (isnan(direct[0]))
            say("mu was not steady before");
        else
            say("direct effect %.4f +- %.2g", direct[0], direct[1]);
        if (!isnan(change[0])) say(", change %.4f +- %.2g", change[0], change[1]);
        say("%s", isnan(direct[0]) ? "" : " per ln(V2/V1)");
        if (!isnan(distance[0])) say("; slip distance %.3g +- %.2g", distance[0], distance[1]);
        say("\n");
    }
    if (summary->holds == 0) return;
    say("  holds           %d: ", summary->holds);
    if (isnan(healing[0]))
        say("no line of healing: it takes two of other lengths from steady sliding\n");
    else
        say("healing %.4f +- %.2g per decade of time\n", healing[0], healing[1]);
}

// Prints how an error bar that was asked for was found.
static void print_bar(const RunSummary *summary)
{
    bool slides = !isnan(summary->mu_M);
    double part = slides ? summary->mu_M_error / summary->mu_M
                         : summary->mu_hold_error / summary->mu_hold;
    if (isnan(part))
        say("  error bar       not known, %.1f %% asked for: %s\n", 100 * summary->bar_wanted,
            summary->bar_ended);
    else
        say("  error bar       %.1f %% of %s, %.1f %% asked for: %s\n", 100 * part,
            slides ? "mu_M" : "mu_hold", 100 * summary->bar_wanted, summary->bar_ended);
    if (summary->bar_runs == 0) return;   // the first of them was cut short
    say("                  from %d run%s on %d mesh%s of up to %d contact nodes, at pressures "
        "within %g %%\n",
        summary->bar_runs, summary->bar_runs == 1 ? "" : "s", summary->bar_meshes,
        summary->bar_meshes == 1 ? "" : "es", summary->bar_nodes, 100 * summary->bar_window);
    if (summary->bar_goes_on)
        say("%seach goes on until its own answer is known: periodic, slidings and mu_below of "
            "time.until do not end it\n",
            INDENT);
    double off = fabs(summary->bar_own_mu_M - summary->mu_M);   // NaN: one of them has none
    if (!summary->bar_goes_on && !(off > summary->mu_M_error)) return;
    say("%smu_M and mu_hold are of those runs, which go further than this one; the rest is of this "
        "one",
        INDENT);
    if (isnan(summary->bar_own_mu_M))
        say(", which has no mu_M of its own\n");
    else
        say(", whose own mu_M is %.4f\n", summary->bar_own_mu_M);
}

// Prints what an experiment measures, from F = 0 to the first sliding; below it the mean of the
// later cycles that count.
static void print_first_loading(const RunSummary *summary)
{
    char text[ESTIMATE_SIZE], words[ESTIMATE_SIZE];
    bool slid = !isnan(summary->first_mu);
    if (slid) {
        bool bar = summary->bar_runs > 0;
        amontons_estimate(summary->first_mu, bar ? summary->first_mu_error : (double)NAN,
                          summary->first_mu_known_to, text);
        say("  first loading   slid at F_T/F_N = %s", text);
        if (!bar) {
            amontons_known_to(summary->first_mu, summary->first_mu_known_to, words);
            say(", %s", words);
        }
        say(", at U = %.4g, after ", summary->first_U);
    } else {
        say("  first loading   has not slid as a whole so far; ");
    }
    say("%d precursor%s", summary->first_precursors, summary->first_precursors == 1 ? "" : "s");
    if (summary->first_precursors > 0)
        say(" of up to %.2f of the block's length", summary->first_longest);
    if (slid && !isnan(summary->first_critical_length))
        say("; critical length %.2f", summary->first_critical_length);
    else if (slid && summary->first_precursors > 0)
        say("; slip turned fast elsewhere than behind a slow front");
    say("\n");
    if (isnan(summary->later_precursors)) return;
    say("%slater cycles: %.2g precursors each", INDENT, summary->later_precursors);
    if (summary->later_precursors > 0) say(", the longest %.2f", summary->later_longest);
    say("\n");
}

// A filter for scandir.
static int is_picture(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot && strcmp(dot, ".png") == 0;
}

// A line for a file that is there.
static void print_file(const char *folder, const char *name, const char *sentence)
{
    char path[AMONTONS_PATH_SIZE + 32];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (access(path, F_OK) == 0) say("  %-15s %s\n", name, sentence);
}

// Names the files of the result that are there, and its pictures.
static void print_files(const RunSummary *summary)
{
    char fields[80];
    snprintf(fields, sizeof fields, "%d times of the whole block; open it in ParaView",
             summary->field_files);
    say("Results in %s:\n", summary->folder);
    print_file(summary->folder, "run.json", "scene, answers, errors and timing in numbers");
    print_file(summary->folder, "history.h5", "time series, and the interface at every step");
    if (summary->field_files > 0) print_file(summary->folder, "fields.pvd", fields);

    if (summary->figures > 0) {
        // The pictures are those in the folder, not those asked for: one that could not be drawn is
        // not named.
        char figures[AMONTONS_PATH_SIZE + 16];
        struct dirent **entries = NULL;
        snprintf(figures, sizeof figures, "%s/figures", summary->folder);
        int count = scandir(figures, &entries, is_picture, alphasort);
        for (int i = 0; i < count; i++) {
            say("  figures/%s\n", entries[i]->d_name);
            free(entries[i]);
        }
        if (count >= 0) free(entries);
    }
}

// title may be empty. Nothing about files where the run wrote none.
void closing_print(const char *title, const RunSummary *summary)
{
    say("%s%sdone\n", title, *title ? ": " : "");
    print_mu_M(summary);
    if (!isnan(summary->mu_steady) && strcmp(summary->mu_M_is, STEADY) != 0)
        say("  mu_steady       %.3f: F_T/F_N at the end of the run, where the block slides "
            "steadily\n",
            summary->mu_steady);
    print_mu_hold(summary);
    if (summary->bar_runs > 0) print_bar(summary);
    print_estimate("mu_max", summary->mu_max, NAN, summary->mu_max_known_to,
                   summary->bar_runs == 0);
    say(", the largest load ratio of the run%s\n",
        summary->bar_runs > 0 ? " in full, on the last mesh" : "");

    // Forces of the whole block, in the units of the scene: newtons in SI.
    double load = summary->normal_force;
    if (!isnan(load)) {
        say("  forces          F_N %.4g", load);
        if (!isnan(summary->mu_M)) say(", F_T %.4g at mu_M", load * summary->mu_M);
        if (!isnan(summary->mu_hold)) say(", F_T %.4g at mu_hold", load * summary->mu_hold);
        say(", F_T %.4g at mu_max (N in an SI scene)\n", load * summary->mu_max);
    }
    print_first_loading(summary);
    say("  precursors      %d quasi-static, %d bounded rapid (faster than 2.5 V, over 5 %% of the "
        "contact)\n",
        summary->quasi_static, summary->bounded);
    if (summary->slight > 0)
        say("%sbesides %d rapid event%s not counted: slip that rings, single nodes, or slip that "
            "never came to a trailing end\n",
            INDENT, summary->slight, summary->slight == 1 ? "" : "s");
    say("  slidings        %d of the whole block\n", summary->leading);
    if (*summary->pads_order_first)
        say("  pads let go     %s: before the first of these slidings\n",
            summary->pads_order_first);
    if (*summary->pads_order && summary->leading > 1)
        say("%s%s: before the last\n", INDENT, summary->pads_order);
    if (!isnan(summary->base_slip))
        say("  base            deforms; the block slid over it by %.2g %% of the contact's "
            "length\n",
            100 * summary->base_slip);
    bool of_first = summary->peaks == 1 && isnan(summary->first_critical_length);
    if (!isnan(summary->critical_length) && !of_first)
        say("  critical length %.2f of the block's length\n", summary->critical_length);
    else if (summary->peaks_counted > 0)
        say("  critical length not known: slip did not turn fast behind a slow front from the "
            "trailing end\n");
    else if (summary->peaks > 0)
        say("  critical length not known: no sliding of the whole block counts\n");
    else
        say("  critical length not reached: the block as a whole did not slide%s\n",
            summary->leading > 0 ? " from rest" : "");

    // Cells over which slow slip turned fast; on pads also where, and over which length.
    if (!isnan(summary->slip_cells)) {
        say("  resolution      %.3g cell%s of the contact slipped where slow slip turned fast",
            summary->slip_cells, summary->slip_cells == 1 ? "" : "s");
        if (*summary->slip_pad) say(", on %s over %.3g", summary->slip_pad, summary->slip_length);
        say("\n");
    }
    print_program(summary);
    if (*summary->mesh_moved) say("  mesh            %s\n", summary->mesh_moved);
    say("  largest errors  energy %.1e, moment %.1e, contact %.1e (relative)\n",
        summary->energy_error, summary->moment_error, summary->complementarity_error);
    const RunCounters *counters = &summary->counters;
    say("  steps           %lld accepted, %lld repeated (%lld: error too large, %lld: slip could "
        "have grown, %lld: no solution)\n",
        (long long)counters->accepted,
        (long long)counters->rejected + (long long)counters->unsolved_retries,
        (long long)counters->rejected - (long long)counters->rejected_uncertified,
        (long long)counters->rejected_uncertified, (long long)counters->unsolved_retries);
    say("  time taken      %.1f s (solving %.1f, output %.1f)\n", summary->seconds_total,
        summary->seconds_solve, summary->seconds_output);

    if (*summary->folder) print_files(summary);
}
