// SPDX-License-Identifier: GPL-2.0-or-later
// Frames of a history written by hand: a rod that moves evenly, a force that falls twice.
#include "render/frames/frame_choice.h"

#include "cases.h"

#include <math.h>

enum { ROWS = 1000, MOST = 20 };

static double U[ROWS], mu[ROWS];
static int64_t rows[ROWS];
static double rapid[2][2] = {{0.3, 0.31}, {0.7, 0.71}};

// mu rises by 1 between the falls, which take ten rows each.
static ResultView history(void)
{
    for (int32_t k = 0; k < ROWS; ++k) {
        U[k] = (double)k / (ROWS - 1);
        rows[k] = k;
        double since = U[k] < 0.3 ? U[k] : U[k] < 0.7 ? U[k] - 0.3 : U[k] - 0.7;
        double falls = U[k] >= 0.3 ? fmax(0, 1 - 100 * since) : 0;
        mu[k] = fmin(since / 0.3, 1) * (falls > 0 ? 0 : 1) + falls;
    }
    return (ResultView){.rows = ROWS, .U = U, .mu = mu, .rapid_count = 2, .rapid = rapid};
}

TEST(few_are_all_taken)
{
    ResultView view = history();
    int32_t chosen[MOST];
    assert_int_equal(frames_choose(&view, rows, MOST, MOST, chosen), MOST);
    for (int32_t k = 0; k < MOST; ++k) assert_int_equal(chosen[k], k);
}

TEST(frames_rise_and_reach_both_ends)
{
    ResultView view = history();
    int32_t chosen[MOST];
    int32_t count = frames_choose(&view, rows, ROWS, MOST, chosen);
    assert_in_range(count, MOST - 4, MOST);
    assert_int_equal(chosen[0], 0);
    assert_int_equal(chosen[count - 1], ROWS - 1);
    for (int32_t k = 1; k < count; ++k) assert_true(chosen[k] > chosen[k - 1]);
}

static int32_t between(const int32_t *chosen, int32_t count, double from, double to)
{
    int32_t found = 0;
    for (int32_t k = 0; k < count; ++k) found += U[chosen[k]] >= from && U[chosen[k]] <= to;
    return found;
}

// A fiftieth of the way of the rod, but half of that of the force.
TEST(frames_stand_close_where_the_force_falls)
{
    ResultView view = history();
    int32_t chosen[MOST];
    int32_t count = frames_choose(&view, rows, ROWS, MOST, chosen);
    assert_in_range(between(chosen, count, 0.295, 0.315) + between(chosen, count, 0.695, 0.715), 4,
                    12);
    assert_in_range(between(chosen, count, 0.35, 0.65), 2, 8);
}

// Also where nothing else would lead there.
TEST(each_rapid_event_has_a_frame)
{
    ResultView view = history();
    int32_t chosen[MOST];
    for (int32_t k = 0; k < ROWS; ++k) mu[k] = 0.1;
    int32_t count = frames_choose(&view, rows, ROWS, 6, chosen);
    assert_in_range(count, 5, 6);
    assert_true(between(chosen, count, 0.3, 0.31) >= 1);
    assert_true(between(chosen, count, 0.7, 0.71) >= 1);
}

TEST(a_history_without_numbers_is_no_trap)
{
    ResultView view = history();
    int32_t chosen[MOST];
    for (int32_t k = 0; k < ROWS; ++k) mu[k] = U[k] = NAN;
    assert_in_range(frames_choose(&view, rows, ROWS, MOST, chosen), 1, MOST);
}
