// SPDX-License-Identifier: GPL-2.0-or-later
// The shown part of a run: the last slidings of many, or what was asked for, by U or by time.
#include "render/view/zoom.h"

#include "cases.h"

#include <string.h>

enum { ROWS = 100, SLIDINGS = 45 };
#define U_LAST (0.01 * (ROWS - 1))

// U = 0.01 k at t = 2 k; sliding j ends at U = 0.02 j, and one event is none.
static ResultView view_of(int32_t slidings, double t[ROWS], double U[ROWS], ViewEvent *events)
{
    for (int32_t k = 0; k < ROWS; k++) {
        t[k] = 2 * k;
        U[k] = 0.01 * k;
    }
    for (int32_t j = 0; j < slidings; j++)
        events[j] = (ViewEvent){.kind = VIEW_LEADING, .U_stop = 0.02 * (j + 1)};
    events[slidings] = (ViewEvent){.kind = VIEW_BOUNDED, .U_stop = 0.98};
    return (ResultView){
        .rows = ROWS, .t = t, .U = U, .event_count = slidings + 1, .events = events};
}

static ViewRange range_of(int32_t slidings, const char *from, const char *to, Error *err)
{
    double t[ROWS], U[ROWS];
    ViewEvent events[SLIDINGS + 1];
    ResultView view = view_of(slidings, t, U, events);
    PictureStyle style = {.from = from, .to = to};
    ViewRange shown;
    view_range_find(&view, &style, &shown, err);
    return shown;
}

TEST(test_last_slidings)
{
    Error err = {0};
    ViewRange few = range_of(40, NULL, NULL, &err), many = range_of(SLIDINGS, NULL, NULL, &err);
    ViewRange asked = range_of(SLIDINGS, NULL, "U=0.5", &err);
    assert_true(error_is_clean(&err));
    assert_true(few.low == 0 && few.high == U_LAST && !*few.words);
    assert_true(many.low == 0.02 * 25 && many.high == U_LAST);   // behind the 25th are 20
    assert_string_equal(many.words, "the last 20 of 45 slidings");
    assert_true(asked.low == 0 && asked.high == 0.5 && !*asked.words);
}

TEST(test_moments)
{
    Error err = {0};
    ViewRange shown = range_of(1, "t=21", "t=1000", &err);   // the rod was at 0.1 from t = 20 on
    assert_true(error_is_clean(&err));
    assert_true(shown.low == 0.01 * 10 && shown.high == U_LAST);
    shown = range_of(1, "t=-5", "U=0.2", &err);
    assert_true(shown.low == 0 && shown.high == 0.2);
    range_of(1, "U=0.3", "t=20", &err);
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "nothing lies from U = 0.3 to U = 0.1"));
    err = (Error){0};
    range_of(1, "0.3", NULL, &err);
    assert_int_equal(err.code, ERROR_INPUT);
}
