// SPDX-License-Identifier: GPL-2.0-or-later
// Between the steps of a history, and which part of it is filmed: a history of five steps written
// out.
#include "render/film/film_times.h"

#include "near.h"

static double t[] = {0, 10, 12, 20, 40}, U[] = {0, 1, 1.2, 2, 4};
static double mu[] = {0, 0.3, 0.1, 0.2, 0.4}, rate[] = {0, 1, 2, 3, 50, 60, 4, 4, 0, 0};
static ViewEvent events[] = {
    {VIEW_LEADING, 1, 1.2, 0}, {VIEW_BOUNDED, 1.5, 1.6, 0}, {VIEW_LEADING, 2, 2.2, 0}};

static ResultView history(int32_t event_count)
{
    return (ResultView){.rows = 5,
                        .t = t,
                        .U = U,
                        .mu = mu,
                        .nodes = 2,
                        .slip_rate = rate,
                        .events = events,
                        .event_count = event_count};
}

TEST(test_between_steps)
{
    ResultView view = history(0);
    FilmMoment now = film_moment(&view, 10.5);
    assert_int_equal(now.row, 1);
    assert_near("U", now.U, 1.05, 1e-12);
    assert_near("mu", now.mu, 0.25, 1e-12);
    assert_near("slip rate", film_value(&now, view.slip_rate, 2, 0), 2 + 0.25 * 48, 1e-12);
    assert_near("slip rate", film_value(&now, view.slip_rate, 2, 1), 3 + 0.25 * 57, 1e-12);
    assert_int_equal(film_nearest_row(&now), 1);
    now = film_moment(&view, 11.5);
    assert_int_equal(film_nearest_row(&now), 2);
    now = film_moment(&view, -1);
    assert_near("mu", now.mu, 0, 0);
    now = film_moment(&view, 40);
    assert_near("mu", now.mu, 0.4, 1e-12);
    assert_int_equal(film_nearest_row(&now), 4);
}

static void check_span(int32_t event_count, FilmSpan span, double low, double high)
{
    ResultView view = history(event_count);
    double found[2];
    Error err = {0};
    assert_true(film_span_find(&view, &span, found, &err));
    assert_near("from", found[0], low, 1e-12);
    assert_near("to", found[1], high, 1e-12);
}

TEST(test_spans)
{
    check_span(0, (FilmSpan){0}, 0, 40);
    check_span(0, (FilmSpan){.from = "U=1.1", .to = "t=30"}, 11, 30);
    check_span(0, (FilmSpan){.to = "U=9"}, 0, 40);
    check_span(3, (FilmSpan){.cycle = "last"}, 12, 22.4);   // 4 % of 2.2 - 1.2 beyond U = 2.2
    check_span(2, (FilmSpan){.cycle = "last"}, 0, 12.48);   // the first sliding is the last
    check_span(3, (FilmSpan){.cycle = "first"}, 0, 12.48);
    check_span(3, (FilmSpan){.cycle = "all"}, 0, 40);
    check_span(3, (FilmSpan){.cycle = "last", .to = "t=21"}, 12, 21);
}

static void check_refused(int32_t event_count, FilmSpan span, const char *words)
{
    ResultView view = history(event_count);
    double found[2];
    Error err = {0};
    assert_false(film_span_find(&view, &span, found, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, words));
}

TEST(test_refused)
{
    check_refused(0, (FilmSpan){.from = "1.1"}, "U=0.0117 or t=120");
    check_refused(0, (FilmSpan){.from = "t=50"}, "to U = 4, t = 40");
    check_refused(0, (FilmSpan){.from = "t=30", .to = "t=20"}, "nothing lies between");
    check_refused(0, (FilmSpan){.cycle = "last"}, "no bulk sliding");
    check_refused(3, (FilmSpan){.cycle = "7"}, "there is no cycle 7");
}
