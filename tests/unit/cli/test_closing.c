// SPDX-License-Identifier: GPL-2.0-or-later
// The closing lines of a run, for answers that few runs come to; times in words.
#include "cli/closing.h"

#include "cli/progress.h"
#include "near.h"
#include "result_place.h"

static char *text = NULL;
static size_t size = 0;

// Returns what closing_print writes; valid until the next call.
static const char *closing(const char *title, const RunSummary *summary)
{
    FILE *usual = stdout;
    free(text);
    stdout = open_memstream(&text, &size);
    closing_print(title, summary);
    fclose(stdout);
    stdout = usual;
    return text;
}

static void assert_says(const char *said, const char *words)
{
    if (!strstr(said, words)) fail_msg("'%s' is not in\n%s", words, said);
}

static RunSummary no_answers(void)
{
    return (RunSummary){.mu_M = NAN,
                        .mu_M_is = "none: it stands",
                        .mu_steady = NAN,
                        .mu_hold = NAN,
                        .mu_M_error = NAN,
                        .mu_hold_error = NAN,
                        .mu_M_known_to = NAN,
                        .mu_hold_known_to = NAN,
                        .mu_max_known_to = NAN,
                        .mu_M_spread = NAN,
                        .mu_M_parts = {NAN, NAN, NAN},
                        .mu_hold_parts = {NAN, NAN, NAN},
                        .critical_length = NAN,
                        .slip_cells = NAN};
}

TEST(test_program)
{
    RunSummary summary = no_answers();
    const char *said = closing("", &summary);
    assert_null(strstr(said, "velocity steps"));
    assert_null(strstr(said, "holds   "));
    summary.velocity_steps = 2;
    summary.holds = 1;
    summary.direct_effect[0] = summary.level_change[0] = NAN;
    summary.slip_distance[0] = summary.healing[0] = NAN;
    said = closing("", &summary);
    assert_says(said, "velocity steps  2: mu was not steady before\n");
    assert_says(said, "holds           1: no line of healing: it takes two of other lengths");
    summary.direct_effect[0] = 0.01;
    summary.direct_effect[1] = 0.0002;
    assert_says(closing("", &summary), "2: direct effect 0.0100 +- 0.0002 per ln(V2/V1)\n");
    summary.level_change[0] = -0.005;
    summary.level_change[1] = 0.0001;
    summary.slip_distance[0] = 0.05;
    summary.slip_distance[1] = 0.001;
    said = closing("", &summary);
    assert_says(said,
                "0.0002, change -0.0050 +- 0.0001 per ln(V2/V1); slip distance 0.05 +- 0.001");
    summary.healing[0] = 0.0345;
    summary.healing[1] = 0.0003;
    assert_says(closing("", &summary), "1: healing 0.0345 +- 0.0003 per decade of time\n");
}

TEST(test_static_friction)
{
    RunSummary summary = no_answers();
    const char *said = closing("", &summary);
    assert_true(strncmp(said, "done\n", 5) == 0);
    assert_says(said, "mu_M            none: it stands");   // the words of answers/answers
    assert_says(said, "critical length not reached");
    assert_null(strstr(said, "Results in"));
    summary.peaks = 3;
    summary.bar_runs = 4;
    summary.bar_ended = "no time for more";
    said = closing("A", &summary);
    assert_says(said, "not every run of the error bar came to slide as a whole");
    assert_says(said, "largest load ratio of the run in full, on the last mesh\n");
    summary.bar_runs = 0;
    summary.leading = 1;
    assert_says(closing("A", &summary), "not known: no sliding of the whole block counts");
    summary.peaks = 0;
    assert_says(closing("A", &summary), "as a whole did not slide from rest");
    assert_says(closing("A", &summary), "slidings        1 of the whole block\n");
    summary.peaks = 3;
    summary.mu_M_is = "steady sliding";
    summary.mu_M = summary.mu_steady = 0.375;
    summary.mu_M_known_to = 0.0004;
    assert_says(closing("A", &summary),
                "mu_M            0.3750, one mesh: known to about 0.1 %: F_T/F_N of steady "
                "sliding");
    summary.mu_M_is = "peaks";
    summary.mu_M = 0.254;
    summary.mu_M_known_to = 0.005;
    assert_says(closing("A", &summary), "mu_steady       0.375: F_T/F_N at the end of the run, "
                                        "where the block slides steadily\n");
    summary.mu_steady = NAN;
    summary.peaks_counted = 1;
    said = closing("A", &summary);
    assert_true(strncmp(said, "A: done\n", 8) == 0);
    assert_says(said,
                "mu_M            0.254, one mesh: known to about 2 %: static friction, mean of the "
                "last 1 of 3 peaks");
    assert_says(
        said, "(what finer meshes change as a rule; --to 1% gives an error bar)\n                  "
              "on this mesh 0.2540\n");
    summary.mu_M_spread = 0.01;
    assert_says(closing("", &summary), "peaks differ by at most 0.01; not periodic yet\n");
    summary.period = 1;
    assert_says(closing("", &summary), "peaks differ by at most 0.01\n");
    summary.period = 2;
    summary.mu_M_error = 0.002;   // of its peaks: no error bar
    said = closing("", &summary);
    assert_says(said, "mu_M            0.254, one mesh: known to about 2 %: static");
    assert_null(strstr(said, "+-"));
    assert_says(said, "on this mesh 0.2540 (drops 0.002); the peaks differ by at most 0.01 and "
                      "repeat after 2 slidings\n");
    summary.mu_M_known_to = NAN;
    said = closing("", &summary);
    assert_says(said, "mu_M            0.25, one mesh, and how far it is known is not: static");
    assert_says(said, "cells are too long for slip: finer ones may change any digit\n");
}

TEST(test_what_holds)
{
    RunSummary summary = no_answers();
    assert_says(closing("", &summary), "mu_hold         none: the load did not drop");
    summary.drops = 7;
    summary.run_in = "part of the contact has not slipped";
    summary.run_in_drift = 0.0025;
    summary.run_in_drops_left = 57;
    assert_says(closing("", &summary),
                "mu_hold         none yet: run-in still going on (part of the contact has not "
                "slipped, +0.25 % a drop, over after at most 57 more): give a later time.until\n");
    summary.mu_hold = 0.2;
    summary.mu_hold_known_to = 0.01;
    summary.run_in = "trend";
    summary.run_in_drift = -0.01;
    summary.run_in_drops_left = NAN;
    assert_says(closing("", &summary),
                "0.20, one mesh: known to about 5 %, so far: what the contact holds, the lowest "
                "tenth of 7 load ratios at which "
                "the load dropped\n                  run-in still going on (trend, -1 % a drop)");
    summary.run_in = NULL;
    const char *said = closing("", &summary);
    assert_says(
        said,
        "0.20, one mesh: known to about 5 %, so far: what the contact holds, the lowest tenth");
    assert_says(said, "what finer meshes change as a rule");   // there is no mu_M that says it
    assert_says(said, "too few to say");
    summary.drops = 1;
    assert_says(closing("", &summary), "the one load ratio at which the load dropped\n");
    summary.drops = 7;
    summary.drops_enough = true;
    assert_says(closing("", &summary), "which do not repeat");
    summary.drop_period = 1;
    said = closing("", &summary);
    assert_says(said, "the lowest of 7 load ratios");
    assert_null(strstr(said, "which repeat"));
    summary.drop_period = 3;
    assert_says(closing("", &summary), "which repeat after 3\n");
    summary.slip_cells = 1;
    assert_says(closing("", &summary), "resolution      1 cell of the contact slipped");
    summary.slip_cells = 2.5;
    summary.slip_length = 0.125;
    snprintf(summary.slip_pad, sizeof summary.slip_pad, "pad_2");
    assert_says(closing("", &summary), "2.5 cells of the contact slipped where slow slip turned "
                                       "fast, on pad_2 over 0.125");
}

TEST(test_error_bars)
{
    RunSummary summary = no_answers();
    summary.bar_runs = 4;
    summary.bar_meshes = 1;
    summary.bar_nodes = 21;
    summary.bar_wanted = 0.01;
    summary.bar_window = 0.02;
    summary.bar_ended = "no time for more";
    const char *said = closing("", &summary);
    assert_says(said, "error bar       not known, 1.0 % asked for: no time for more");
    assert_says(said, "from 4 runs on 1 mesh of up to 21 contact nodes, at pressures within 2 %");
    summary.mu_hold = 0.2;
    summary.mu_hold_error = 0.003;
    said = closing("", &summary);
    assert_says(said, "error bar       1.5 % of mu_hold");
    assert_says(said, "0.2000 +- 0.0030: what the contact holds, by the runs behind");   // no part
    summary.mu_hold_parts[1] = 0.001;
    assert_says(closing("", &summary),
                "0.2000 +- 0.0030 (branches 0.001): what the contact holds, by the runs behind");
    summary.mu_M = 0.25;
    summary.mu_M_known_to = 0.03;
    summary.bar_meshes = 2;
    said = closing("", &summary);
    assert_says(said, "0.25 (its error is not known): static friction");
    assert_says(said, "on 2 meshes");
    summary.mu_M_error = 0.005;
    summary.mu_M_parts[0] = 0.004;
    summary.mu_M_parts[2] = 0.003;
    said = closing("", &summary);
    assert_says(said, "0.2500 +- 0.0050 (mesh 0.004, drops 0.003): static friction");
    assert_says(said, "error bar       2.0 % of mu_M");
}

// Files are named where they are.
TEST(test_files)
{
    char place[PLACE_SIZE];
    RunSummary summary = no_answers();
    place_make(place);
    snprintf(summary.folder, sizeof summary.folder, "%s", place);
    summary.figures = 2;
    summary.field_files = 3;
    summary.critical_length = 0.5;
    place_write(place, "run.json", "{}");
    place_write(place, "fields.pvd", "");
    const char *said = closing("", &summary);
    assert_says(said, "critical length 0.50 of the block's length");
    assert_says(said, "run.json        scene, answers");
    assert_says(said, "fields.pvd      3 times of the whole block");
    assert_null(strstr(said, "history.h5"));
    assert_null(strstr(said, "figures/"));   // the folder is not there
    mkdir(place_path(place, "figures"), 0777);
    place_write(place, "figures/b.png", "");
    place_write(place, "figures/a.png", "");
    place_write(place, "figures/a.json", "");
    place_write(place, "figures/png", "");
    said = closing("", &summary);
    assert_says(said, "  figures/a.png\n  figures/b.png\n");
    assert_null(strstr(said, "a.json"));
    assert_null(strstr(said, "figures/png"));
    place_remove(place);
}

TEST(test_times)
{
    static const struct {
        double seconds;
        const char *words;
    } cases[] = {{NAN, "-:--"}, {0, "0:00"}, {65, "1:05"}, {3599, "59:59"}, {7420, "2:03:40"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char words[32];
        progress_format_left(cases[k].seconds, words, sizeof words);
        assert_string_equal(words, cases[k].words);
    }
}

FIXTURE(group_end)
{
    free(text);
    return 0;
}

GROUP_BETWEEN(NULL, group_end);
