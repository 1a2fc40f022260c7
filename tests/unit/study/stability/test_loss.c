// SPDX-License-Identifier: GPL-2.0-or-later
// Where each margin is lost, on a line between two points or before a jump of the front.
#include "path_by_hand.h"

static const StabilitySummary *summarised(Rig *rig)
{
    stability_summarise(&rig->path, &rig->summary);
    return &rig->summary;
}

TEST(test_nothing_is_lost)
{
    Rig rig;
    start(&rig);
    const StabilitySummary *found = summarised(&rig);
    assert_true(isnan(found->l_sc) && isnan(found->l_c) && isnan(found->l_c_rod));
    assert_true(isnan(found->l_sc_certificate) && isnan(found->l_c_scan));
    assert_near("element", found->element, 0.1, 1e-15);
    assert_int_equal(found->points, POINTS);
    rig.options.at_end = true;   // one state has no path
    rig.points[0].rate_re = 1;
    assert_true(isnan(summarised(&rig)->l_sc));
}

// Without growth the block slides when its front comes to the end, at the largest mu on the way.
TEST(test_front_at_the_end)
{
    Rig rig;
    start(&rig);
    rig.path.at_end = true;
    rig.points[2].mu = 0.5;
    rig.points[2].mu_at_V = 0.45;
    const StabilitySummary *found = summarised(&rig);
    assert_near("l_c", found->l_c, 0.4, 1e-15);
    assert_near("mu", found->mu_c, 0.5, 0);
    assert_near("mu at V", found->mu_rod, 0.45, 0);
    assert_near("U", found->U_c, 0.2, 0);
}

// Re lambda -1, then 3: lost a quarter of the way to the next node, and U and mu with it.
TEST(test_between_two_points)
{
    Rig rig;
    start(&rig);
    rig.points[2].rate_re = 3;
    rig.points[3].certified = false;
    const StabilitySummary *found = summarised(&rig);
    assert_near("l_sc", found->l_sc, (0.4 + 0.25 * 0.2) / 2, 1e-15);
    assert_near("mu", found->mu_sc, 0.24 + 0.25 * 0.05, 1e-15);
    assert_near("frequency", found->frequency, 4, 0);
    assert_near("certificate", found->l_sc_certificate, 0.4, 1e-15);
    // From V to v_c, a factor of 10, in half a period: pi 3/4 = 2.36 against ln 10 = 2.30.
    assert_near("l_c at V", found->l_c_rod, 0.6 / 2, 1e-15);
    assert_near("mu there", found->mu_rod, rig.points[1].mu_at_V, 0);
}

// Where two slipping parts meet the front jumps: the state before is the last that was stable.
TEST(test_before_a_jump)
{
    Rig rig;
    start(&rig);
    rig.points[2].rate_re = 3;
    rig.points[2].slipping = 8;
    const StabilitySummary *found = summarised(&rig);
    assert_near("l_sc", found->l_sc, 0.6 / 2, 1e-15);
    assert_near("mu", found->mu_sc, rig.points[1].mu_at_V, 0);
}

// (Im lambda)^2 falls by 6 a step, from 8 over 2 to what would be -4: a third of the way.
TEST(test_birth_of_the_real_pair)
{
    Rig rig;
    start(&rig);
    for (int32_t k = 0; k < POINTS; k++) rig.points[k].rate_re = 1e-3;
    rig.points[1].rate_im = sqrt(8);
    rig.points[2].rate_im = sqrt(2);
    rig.points[3].rate_im = 0;
    assert_near("l_c", summarised(&rig)->l_c, (0.6 + 0.2 / 3) / 2, 1e-12);
    assert_near("mu", rig.summary.mu_c, 0.3 + 0.05 / 3, 1e-12);
    rig.points[1].slipping = 1;   // what came before the last two tells nothing: at the point
    assert_near("l_c", summarised(&rig)->l_c, 0.8 / 2, 1e-12);
    start(&rig);
    rig.points[0].rate_re = 1;   // real from the first point on
    rig.points[0].rate_im = 0;
    assert_near("l_c", summarised(&rig)->l_c, 0.1, 1e-12);
    assert_near("U", rig.summary.U_c, 0, 0);
}
