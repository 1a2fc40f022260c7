// SPDX-License-Identifier: GPL-2.0-or-later
// Which precursors are enlarged, for histories written down by hand.
#include "render/view/zoom.h"

#include "cases.h"

#include <math.h>
#include <string.h>

enum { STEPS = 401 };

static double saw_U[STEPS], saw_mu[STEPS];

// mu climbs to 0.3 and falls to 0.1 at U = 1, 2 and 3; the history ends at U = 4.
static ResultView saw_tooth(void)
{
    for (int32_t k = 0; k < STEPS; ++k) {
        saw_U[k] = k / 100.0;
        saw_mu[k] = 0.1 + 0.2 * (saw_U[k] - floor(saw_U[k] - 1e-9));
        if (k == 0) saw_mu[k] = 0;
    }
    return (ResultView){.rows = STEPS, .U = saw_U, .mu = saw_mu};
}

static const ViewEvent three_cycles[] = {
    {VIEW_BOUNDED, 0.8, 0.81, 0}, {VIEW_LEADING, 1.0, 1.01, 0}, {VIEW_QUASI_STATIC, 1.02, 1.9, 0},
    {VIEW_BOUNDED, 1.7, 1.71, 0}, {VIEW_BOUNDED, 1.9, 1.91, 0}, {VIEW_LEADING, 2.0, 2.01, 0},
    {VIEW_LEADING, 3.0, 3.01, 0}, {VIEW_BOUNDED, 3.5, 3.51, 0}};
static const ViewPeak periodic[] = {{1.0, 0.3, false}, {2.0, 0.3, true}, {3.0, 0.3, true}};

static ResultView with_events(int32_t events, int32_t peaks)
{
    ResultView view = saw_tooth();
    view.event_count = events;
    view.events = (ViewEvent *)three_cycles;
    view.peak_count = peaks;
    view.peaks = (ViewPeak *)periodic;
    return view;
}

TEST(periodic_with_precursors_comes_first)
{
    ResultView view = with_events(8, 3);
    Zoom zoom = zoom_choose(&view);
    assert_true(zoom.found);
    assert_float_equal(zoom.U_slide, 2.0, 1e-12);   // 3.0 counts too, but has no precursors
    assert_true(zoom.U_low < 1.7 && zoom.U_low > 1.6);
    assert_true(zoom.U_high > 2.0 && zoom.U_high < 2.1);
}

// Where no cycle that counts has precursors, the first loading is shown if it has some; without any
// the last that counts.
TEST(precursors_come_before_periodic)
{
    const ViewEvent events[] = {{VIEW_BOUNDED, 0.8, 0.81, 0},
                                {VIEW_LEADING, 1.0, 1.01, 0},
                                {VIEW_LEADING, 2.0, 2.01, 0},
                                {VIEW_LEADING, 3.0, 3.01, 0}};
    ResultView view = with_events(4, 3);
    view.events = (ViewEvent *)events;
    Zoom zoom = zoom_choose(&view);
    assert_float_equal(zoom.U_slide, 1.0, 1e-12);
    assert_string_equal(zoom.words, "first loading");
    view.events = (ViewEvent *)events + 1;
    view.event_count = 3;
    assert_float_equal(zoom_choose(&view).U_slide, 3.0, 1e-12);
}

// With one or two slidings the run is one of the first loading.
TEST(few_slidings_show_the_first)
{
    const ViewEvent events[] = {{VIEW_LEADING, 1.0, 1.01, 0},
                                {VIEW_BOUNDED, 1.8, 1.81, 0},
                                {VIEW_LEADING, 2.0, 2.01, 0},
                                {VIEW_BOUNDED, 2.5, 2.51, 0}};
    ResultView view = with_events(4, 3);
    view.events = (ViewEvent *)events;
    assert_float_equal(zoom_choose(&view).U_slide, 1.0, 1e-12);
}

static Zoom asked(ResultView *view, const char *cycle)
{
    Error err = {0};
    assert_true(zoom_choose_cycle(view, cycle, &err));
    return zoom_choose(view);
}

TEST(a_cycle_that_is_asked_for)
{
    ResultView view = with_events(8, 3);
    Zoom first = asked(&view, "first");
    assert_true(first.U_slide == 1.0 && first.U_start == 0 && first.U_stop == 1.01);
    assert_true(first.cycle == 1 && first.cycles == 3);
    assert_ptr_equal(zoom_sliding(&view), &three_cycles[1]);
    Zoom second = asked(&view, "2");
    assert_true(second.U_slide == 2.0 && second.U_start == 1.01 && second.U_low < 1.7);
    assert_string_equal(second.words, "cycle 2 of 3");
    assert_true(asked(&view, "last").U_slide == 3.0);
    assert_string_equal(asked(&view, "all").words, "all cycles");
    assert_false(asked(&view, "all").found);
    assert_null(zoom_sliding(&view));
}

TEST(a_cycle_that_is_not_there)
{
    Error err = {0};
    ResultView view = with_events(8, 3);
    assert_false(zoom_choose_cycle(&view, "4", &err));
    assert_non_null(strstr(err.message, "the block slid 3 times"));
    err = (Error){0};
    assert_false(zoom_choose_cycle(&view, "second", &err));
    assert_non_null(strstr(err.message, "first, last, all"));
    err = (Error){0};
    assert_false(zoom_choose_cycle(&view, "", &err));
    view = saw_tooth();   // one that has not slid is in its first loading
    for (int32_t k = 0; k < STEPS; ++k) saw_mu[k] = 1e-3 * k;
    assert_false(asked(&view, "first").found);
    assert_false(asked(&view, "last").found);
}

TEST(without_peaks_precursors_decide)
{
    ResultView view = with_events(8, 0);   // no cycle counts: the first loading, which has some
    assert_float_equal(zoom_choose(&view).U_slide, 1.0, 1e-12);
    view.events = (ViewEvent *)three_cycles + 1;
    view.event_count = 7;
    assert_float_equal(zoom_choose(&view).U_slide, 2.0, 1e-12);
    view = with_events(2, 0);
    assert_float_equal(zoom_choose(&view).U_slide, 1.0, 1e-12);
}

TEST(without_precursors_the_last_of_the_cycle)
{
    ResultView view = with_events(2, 0);
    view.events = (ViewEvent *)three_cycles + 5;   // the slidings at 2 and 3
    Zoom zoom = asked(&view, "last");
    assert_float_equal(zoom.U_slide, 3.0, 1e-12);
    assert_true(zoom.U_low > 2.8 && zoom.U_low < 2.9);
}

// The last eight are shown, but of the first loading all.
TEST(many_precursors_are_cut)
{
    ViewEvent events[42] = {{VIEW_LEADING, 0.005, 0.006, 0}};
    for (int32_t k = 1; k < 41; ++k) events[k] = (ViewEvent){VIEW_BOUNDED, 0.02 * k, 0.02 * k, 0};
    events[41] = (ViewEvent){VIEW_LEADING, 0.82, 0.83, 0};
    ResultView view = saw_tooth();
    view.events = events;
    view.event_count = 42;
    Zoom zoom = asked(&view, "last");
    assert_true(zoom.U_low > 0.64 && zoom.U_low < 0.66);   // the last eight start at 0.66
    view.events = events + 1;
    view.event_count = 41;
    zoom = zoom_choose(&view);
    assert_true(zoom.U_low < 0.02);
}

TEST(without_tables_no_zoom)
{
    ResultView view = saw_tooth();
    assert_false(zoom_choose(&view).found);
}

TEST(bad_tables_do_no_harm)
{
    const ViewEvent events[] = {{-1, 0.5, 0.6, 0},
                                {VIEW_LEADING, NAN, NAN, 0},
                                {VIEW_BOUNDED, NAN, 0.9, 0},
                                {VIEW_LEADING, 1.0, NAN, 0}};
    const ViewPeak peaks[] = {{NAN, NAN, true}};
    ResultView view = saw_tooth();
    view.events = (ViewEvent *)events;
    view.event_count = 4;
    view.peaks = (ViewPeak *)peaks;
    view.peak_count = 1;
    Zoom zoom = zoom_choose(&view);
    assert_true(zoom.found);
    assert_float_equal(zoom.U_slide, 1.0, 1e-12);
    assert_true(zoom.U_high > zoom.U_low);
}
