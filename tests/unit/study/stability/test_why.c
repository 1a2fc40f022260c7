// SPDX-License-Identifier: GPL-2.0-or-later
// Which sentences follow from the numbers of a summary.
#include "path_by_hand.h"

// Two pads, the second decides at mu 0.3; all of it slips, with what `words` say besides.
static void decide(Rig *rig)
{
    start(rig);
    rig->path.grows = true;
    rig->pads[NODES - 1] = 1;
    rig->summary =
        (StabilitySummary){.pad_count = 2,
                           .pad = 1,
                           .pads = {{.name = "left", .length = 1, .mode = 0.05},
                                    {.name = "right", .length = 1, .slipping = 1, .load = 2}},
                           .l_c_rod = 0.3,
                           .mu_rod = 0.3,
                           .mu_sc = NAN,
                           .mu_snap = NAN,
                           .l_c_scan = 0.3,
                           .l_sc = 0.3};
}

static void expect(Rig *rig, int32_t count, const char *words)
{
    rig->summary.why_count = 0;
    stability_explain(&rig->path, &rig->summary);
    bool found = false;
    for (int32_t k = 0; k < rig->summary.why_count; k++)
        found |= strstr(rig->summary.why[k], words) != NULL;
    if (!found) fail_msg("nobody says: %s", words);
    assert_int_equal(rig->summary.why_count, count);
}

TEST(test_what_decides)
{
    Rig rig;
    decide(&rig);
    expect(&rig, 1, "Slip runs away once all of right slips, at mu 0.3000.");
    rig.summary.pads[1].slipping = 0.25;
    expect(&rig, 1, "on right when 0.25 of it slips, at mu 0.3000");
    rig.summary.steady_contact = 0.125;
    rig.summary.pads[1].pressure = 0.006;
    expect(&rig, 2,
           "A contact shorter than 0.12 (0.12 of this pad) at the same mean pressure, 0.006");
    rig.summary.steady_contact = 1;
    expect(&rig, 2, "With its load spread evenly, slip on this pad would be steady");
    rig.summary.pad_count = 1;
    rig.summary.pad = 0;
    expect(&rig, 2, "when its front has come to 0.300 L, at mu 0.3000");
}

TEST(test_whether_alone)
{
    Rig rig;
    decide(&rig);
    rig.summary.pads[1].load = 0.75;
    expect(&rig, 2, "weakening would be only 0.75 of what it resists");
    rig.summary.pads[0].mode = 0.5;
    expect(&rig, 2, "(weakening is 0.75 of what it resists): slip of left takes part.");
}

TEST(test_what_else_is_said)
{
    Rig rig;
    decide(&rig);
    rig.summary.mu_sc = 0.25;
    expect(&rig, 2, "From mu 0.2500 on (l_sc) oscillations grow");
    rig.summary.mu_snap = 0.28;
    rig.path.snap_node = NODES - 1;
    expect(&rig, 3, "At mu 0.2800 a node of right, at x = 2, reaches mu_S");
    rig.path.snap_node = 0;
    expect(&rig, 3, "a node of left, at x = 0,");
    rig.summary.l_c_scan = 0.1;
    expect(&rig, 4, "l_c (scan) is shorter than l_sc");
    rig.summary.steady_contact = 1;   // as much as can be said without memory
    expect(&rig, 5, "would be steady");
    FrictionNode nodes[NODES] = {0};
    rig.path.nodes = nodes;
    rig.summary.pads[1].critical_stiffness = 1.25;
    rig.summary.pads[1].stiffness = 0.5;
    rig.summary.nucleation_length = NAN;
    expect(&rig, 5,
           "steady on a stiffness above 1.25 (critical); that of right, all else held, is 0.5.");
    rig.summary.nucleation_length = 0.75;
    expect(&rig, 5, "grows on a part longer than 0.75 (nucleation length)");
    rig.summary.pads[1].critical_stiffness = NAN;
    expect(&rig, 4, "l_c (scan) is shorter than l_sc");
}

TEST(test_nothing_runs_away)
{
    Rig rig;
    decide(&rig);
    rig.path.grows = false;
    expect(&rig, 1, "The path ended before anything ran away.");
    rig.path.at_end = true;
    expect(&rig, 1, "all of the contact slips: it then slides, at mu 0.3000");
    rig.options.at_end = true;
    rig.summary.why_count = 0;
    stability_explain(&rig.path, &rig.summary);
    assert_int_equal(rig.summary.why_count, 0);
}
