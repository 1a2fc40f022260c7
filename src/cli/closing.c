// SPDX-License-Identifier: GPL-2.0-or-later
// What a user wants to know first stands first: mu_M, and whether to trust it. Only files that are
// there are named.
#include "cli/closing.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Where parts of the block slide on their own, the force may fall below mu_M; falls that do not
// repeat are said with their errors.
static void print_falls(const RunSummary *summary)
{
    const double same = 0.01;
    bool is_known = summary->fall_period > 0 ||
                    summary->falls < 4;   // else mu_M is not settled either
    if (isnan(summary->mu_trusted)) return;
    if (is_known && summary->mu_trusted > (1 - same) * summary->mu_M) return;
    if (summary->fall_period > 0) {
        printf(
            "  to trust        %.4f: here the force falls by 5 %% or more, though not all slides;\n"
            "                  the lowest of %d falls that repeat after %d\n",
            summary->mu_trusted, summary->falls, summary->fall_period);
        return;
    }
    if (!summary->falls_enough) {
        printf(
            "  to trust        %.4f so far: one in ten of %d falls by 5 %% or more came earlier, "
            "too few to say;\n"
            "                  they do not repeat yet, and 30 with their mean within 2 %% are "
            "enough:\n"
            "                  give a later time.until\n",
            summary->mu_trusted, summary->falls);
        return;
    }
    printf("  to trust        %.4f +- %.4f: one in ten falls of the force by 5 %% or more comes "
           "earlier;\n"
           "                  they do not repeat, and the mean of %d is %.4f +- %.4f\n",
           summary->mu_trusted, summary->mu_trusted_error, summary->falls, summary->mu_falls,
           summary->mu_falls_error);
}

// Each number with what bounds it: how many peaks it comes from, by how much they differ, whether
// they repeat.
static void print_answers(const RunSummary *summary)
{
    if (isnan(summary->mu_M))
        printf("  mu_M            none: the block as a whole did not slide in this run\n");
    else if (isnan(summary->mu_M_spread))
        printf("  mu_M            %.4f, from one of %d peaks: spread not known\n", summary->mu_M,
               summary->peaks);
    else
        printf("  mu_M            %.4f, the mean of the last %d of %d peaks; they differ by %.4f\n",
               summary->mu_M, summary->peaks_counted, summary->peaks, summary->mu_M_spread);
    if (summary->peaks > 2 && summary->period == 0)
        printf("                  not periodic yet: after the first, peaks lie in %.4f to %.4f\n",
               summary->mu_low, summary->mu_high);
    if (summary->period > 1)
        printf("                  repeats after %d slidings: %.4f to %.4f, run.json: branches\n",
               summary->period, summary->mu_low, summary->mu_high);
    print_falls(summary);
    printf("  precursors      %d quasi-static, %d bounded rapid, %d leading rapid\n",
           summary->quasi_static, summary->bounded, summary->leading);
    if (isnan(summary->critical_length))
        printf("  critical length not reached: no slow slip turned fast\n");
    else
        printf("  critical length %.3f of the block's length\n", summary->critical_length);
    printf("  largest errors  energy %.1e, moment %.1e, contact %.1e (relative)\n",
           summary->energy_error, summary->moment_error, summary->complementarity_error);
    const RunCounters *counters = &summary->counters;
    printf("  steps           %lld accepted, %lld repeated (%lld: could have grown, %lld: no "
           "solution)\n",
           (long long)counters->accepted,
           (long long)(counters->rejected + counters->unsolved_retries),
           (long long)counters->rejected_uncertified, (long long)counters->unsolved_retries);
    printf("  time taken      %.1f s (solving %.1f, output %.1f)\n", summary->seconds_total,
           summary->seconds_solve, summary->seconds_output);
}

// A filter for scandir.
static int is_picture(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot && strcmp(dot, ".png") == 0;
}

// By what lies in the folder, not by what was asked for: a picture that could not be drawn is not
// named.
static void print_pictures(const char *folder)
{
    char figures[AMONTONS_PATH_SIZE + 16];
    struct dirent **entries = NULL;
    snprintf(figures, sizeof figures, "%s/figures", folder);
    int count = scandir(figures, &entries, is_picture, alphasort);
    for (int i = 0; i < count; i++) {
        printf("  figures/%s\n", entries[i]->d_name);
        free(entries[i]);
    }
    if (count >= 0) free(entries);
}

// A line for a file that is there.
static void print_file(const char *folder, const char *name, const char *sentence)
{
    char path[AMONTONS_PATH_SIZE + 32];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (access(path, F_OK) == 0) printf("  %-15s %s\n", name, sentence);
}

// title may be empty. Nothing about files where the run wrote none.
void closing_print(const char *title, const RunSummary *summary)
{
    printf("%s%sdone\n", title, *title ? ": " : "");
    print_answers(summary);
    if (!*summary->folder) return;
    char fields[80];
    snprintf(fields, sizeof fields, "%d times of the whole block; open it in ParaView",
             summary->field_files);
    printf("Results in %s:\n", summary->folder);
    print_file(summary->folder, "run.json", "scene, answers, errors and timing in numbers");
    print_file(summary->folder, "history.h5", "time series, and the interface at every step");
    if (summary->field_files > 0) print_file(summary->folder, "fields.pvd", fields);
    if (summary->figures > 0) print_pictures(summary->folder);
}

// Phases as amontons.h has them; some are parts of others, so that their shares do not add up to
// 100.
void closing_print_profile(const RunSummary *summary)
{
    printf("%-18s %10s %6s %10s\n", "Where time went", "seconds", "%", "count");
    double total = summary->seconds_total > 0 ? summary->seconds_total : 1;
    for (int32_t k = 0; k < summary->phase_count; k++) {
        const RunPhase *phase = &summary->phases[k];
        printf("  %-16s %10.4f %6.1f %10lld  %s\n", phase->name, phase->seconds,
               100 * phase->seconds / total, (long long)phase->count, phase->note);
    }
}
