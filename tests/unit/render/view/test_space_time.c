// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/view/space_time.h"

#include "base/memory.h"
#include "cases.h"

#include <math.h>
#include <stdlib.h>

enum { COLUMNS = 10, ROWS = 4, STEPS = 8, NODES = 2 };

static const double two_x[NODES] = {0.25, 0.75}, one_pad[NODES] = {0, 0};

// The value at column and row (from the top) of a grid over U, x = 0 to 1.
static float *grid_make(const SpaceTime *data, PixelGrid *grid)
{
    Error err = {0};
    *grid = (PixelGrid){0, 1, 0, 1, COLUMNS, ROWS, 1, NULL};
    assert_true(space_time_to_pixels(data, grid, &err));
    return grid->values;
}

static float at(const PixelGrid *grid, int32_t column, int32_t row)
{
    return grid->values[row * grid->columns + column];
}

// Steps crowd in column 3, then one long step to column 8.
static const double crowd_U[STEPS] = {0, 0.15, 0.31, 0.32, 0.33, 0.34, 0.35, 0.85};
static const double crowd_rate[STEPS * NODES] = {0, 0, 1, 0, 2, 0, -50, 0, 3, 9, 4, 0, 5, 0, 6, 7};

TEST(fastest_step_shows)
{
    PixelGrid grid;
    SpaceTime data = {STEPS, crowd_U, NODES, two_x, one_pad, crowd_rate, NULL, 1, 0, NULL, 0};
    grid_make(&data, &grid);
    assert_float_equal(at(&grid, 3, 2), 50, 0);   // lower node: |-50|, between slower steps
    assert_float_equal(at(&grid, 3, 1), 9, 0);   // upper node
    assert_float_equal(at(&grid, 1, 2), 1, 0);
    pixel_grid_destroy(&grid);
}

// States: the smallest or the largest is kept, with its sign.
TEST(states_keep_their_sign)
{
    PixelGrid grid;
    SpaceTime data = {STEPS, crowd_U, NODES, two_x, one_pad, crowd_rate, NULL, 1, 0, NULL, -1};
    grid_make(&data, &grid);
    assert_float_equal(at(&grid, 3, 2), -50, 0);
    assert_float_equal(at(&grid, 3, 1), 0, 0);
    pixel_grid_destroy(&grid);
    data.sign = 1;
    grid_make(&data, &grid);
    assert_float_equal(at(&grid, 3, 2), 5, 0);
    pixel_grid_destroy(&grid);
}

// A column without a step shows the END of the step that covers it, not the start, and not the
// fastest of the column behind: 2 is the first step of column 3.
TEST(long_steps_hold_their_end)
{
    PixelGrid grid;
    SpaceTime data = {STEPS, crowd_U, NODES, two_x, one_pad, crowd_rate, NULL, 1, 0, NULL, 0};
    grid_make(&data, &grid);
    assert_float_equal(at(&grid, 2, 2), 2, 0);
    for (int32_t column = 4; column <= 8; ++column) assert_float_equal(at(&grid, column, 2), 6, 0);
    assert_true(isnan(at(&grid, 9, 2)));   // behind the last step: nothing is known
    pixel_grid_destroy(&grid);
}

// A rapid event on both sides of the border at 0.4 is in the column of its middle; one of two
// columns stays in both.
TEST(a_short_event_is_in_one_column)
{
    const double U[STEPS] = {0, 0.2, 0.38, 0.395, 0.402, 0.41, 0.45, 1};
    const double rate[STEPS * NODES] = {0, 0, 1, 1, 1, 1, 90, 90, 80, 80, 70, 70, 2, 2, 3, 3};
    const double event[1][2] = {{0.395, 0.41}}, whole[1][2] = {{0.31, 0.49}};
    PixelGrid grid;
    SpaceTime data = {STEPS, U, NODES, two_x, one_pad, rate, NULL, 1, 1, event, 0};
    grid_make(&data, &grid);
    assert_float_equal(at(&grid, 3, 2), 1, 0);
    assert_float_equal(at(&grid, 4, 2), 90, 0);
    pixel_grid_destroy(&grid);
    data.events = whole;
    grid_make(&data, &grid);
    assert_float_equal(at(&grid, 3, 2), 90, 0);
    assert_float_equal(at(&grid, 4, 2), 80, 0);
    pixel_grid_destroy(&grid);
}

// Three columns for it around that of its middle, whichever border it crosses.
TEST(a_short_event_is_as_wide_as_asked)
{
    Error err = {0};
    const double U[4] = {0, 0.52, 0.53, 1}, event[1][2] = {{0.52, 0.53}};
    const double rate[4 * NODES] = {0, 0, 90, 90, 80, 80, 2, 2};
    PixelGrid grid = {0, 1, 0, 1, COLUMNS, ROWS, 3, NULL};
    SpaceTime data = {4, U, NODES, two_x, one_pad, rate, NULL, 1, 1, event, 0};
    assert_true(space_time_to_pixels(&data, &grid, &err));
    for (int32_t column = 4; column <= 6; ++column) assert_float_equal(at(&grid, column, 2), 90, 0);
    assert_float_equal(at(&grid, 3, 2), 90, 0);   // inside of the step that ends in the event
    assert_float_equal(at(&grid, 7, 2), 2, 0);
    pixel_grid_destroy(&grid);
}

// Slip 0 to 1 evenly over U 0 to 0.5, then a leap of 3 at 0.55, V = 2: by hand.
TEST(the_mean_is_slip_over_way)
{
    Error err = {0};
    const double U[5] = {0, 0.5, 0.55, 0.5500001, 1}, rate[5 * NODES] = {0};
    const double slip[5 * NODES] = {0, 0, 1, 0, 1, 0, 4, 0, 4, 0};
    PixelGrid grid = {0, 1, 0, 1, COLUMNS, ROWS, 1, NULL};
    SpaceTime data = {5, U, NODES, two_x, one_pad, rate, slip, 2, 0, NULL, 0};
    assert_true(space_time_to_pixels(&data, &grid, &err));
    for (int32_t column = 0; column < 5; ++column)
        assert_float_equal(at(&grid, column, 2), 2 * 2, 1e-5);
    assert_float_equal(at(&grid, 5, 2), 2 * 3 / 0.1, 1e-3);
    assert_float_equal(at(&grid, 6, 2), 0, 1e-6);
    assert_float_equal(at(&grid, 0, 1), 0, 0);
    pixel_grid_destroy(&grid);
}

TEST(a_window_sees_what_surrounds_it)
{
    Error err = {0};
    PixelGrid grid = {0.4, 0.6, 0, 1, COLUMNS, ROWS, 1, NULL};
    SpaceTime data = {STEPS, crowd_U, NODES, two_x, one_pad, crowd_rate, NULL, 1, 0, NULL, 0};
    assert_true(space_time_to_pixels(&data, &grid, &err));
    for (int32_t column = 0; column < COLUMNS; ++column)
        assert_float_equal(at(&grid, column, 2), 6, 0);   // inside the step that ends at 0.85
    pixel_grid_destroy(&grid);
}

TEST(before_the_first_step_is_nothing)
{
    const double U[3] = {NAN, 0.5, 0.55}, rate[3 * NODES] = {7, 7, 1, 1, 2, 2};
    PixelGrid grid;
    SpaceTime data = {3, U, NODES, two_x, one_pad, rate, NULL, 1, 0, NULL, 0};
    grid_make(&data, &grid);
    for (int32_t column = 0; column < 5; ++column) assert_true(isnan(at(&grid, column, 0)));
    assert_float_equal(at(&grid, 5, 1), 2, 0);
    pixel_grid_destroy(&grid);
}

TEST(nodes_fill_their_pads_only)
{
    // Two pads, 0 to 0.25 and 0.75 to 1, and a node inside each.
    const double x[6] = {0, 0.1, 0.25, 0.75, 0.9, 1}, pad[6] = {0, 0, 0, 1, 1, 1};
    const double U[2] = {0, 1}, rate[12] = {1, 2, 3, 4, 5, 6, 1, 2, 3, 4, 5, 6};
    double from = 0, to = 0;
    PixelGrid grid;
    SpaceTime data = {2, U, 6, x, pad, rate, NULL, 1, 0, NULL, 0};
    node_extent(&data, 2, &from, &to);
    assert_float_equal(from, 0.175, 1e-15);
    assert_float_equal(to, 0.25, 1e-15);
    node_extent(&data, 3, &from, &to);
    assert_float_equal(from, 0.75, 1e-15);
    assert_float_equal(to, 0.825, 1e-15);
    grid_make(&data, &grid);
    assert_true(isnan(at(&grid, 5, 1)));   // 0.5 to 0.75 holds no node
    assert_float_equal(at(&grid, 5, 3), 2, 0);   // 0 to 0.25: the fastest seen, its end excluded
    assert_float_equal(at(&grid, 5, 0), 5, 0);
    pixel_grid_destroy(&grid);
}

TEST(infinite_stays_and_nan_is_none)
{
    const double U[2] = {0, 0.95}, rate[4] = {1, NAN, INFINITY, NAN};
    PixelGrid grid;
    SpaceTime data = {2, U, NODES, two_x, one_pad, rate, NULL, 1, 0, NULL, 0};
    grid_make(&data, &grid);
    assert_float_equal(at(&grid, 0, 2), 1, 0);
    assert_true(isinf(at(&grid, 5, 2)));
    assert_true(isnan(at(&grid, 5, 1)));
    pixel_grid_destroy(&grid);
}

// Against the definition, column by column, for random steps.
TEST(agrees_with_the_definition)
{
    enum { MANY = 60 };
    double U[MANY], rate[MANY], x = 0.5, pad = 0;
    srand(7);
    for (int32_t trial = 0; trial < 200; ++trial) {
        U[0] = 0;
        for (int32_t k = 0; k < MANY; ++k) {
            double leap = rand() % 9 == 0 ? 0.08 : 0.001;
            if (k > 0) U[k] = U[k - 1] + leap * rand() / RAND_MAX;
            rate[k] = rand() % 100;
        }
        PixelGrid grid = {0, 1, 0, 1, COLUMNS, 1, 1, NULL};
        Error err = {0};
        SpaceTime data = {MANY, U, 1, &x, &pad, rate, NULL, 1, 0, NULL, 0};
        assert_true(space_time_to_pixels(&data, &grid, &err));
        for (int32_t column = 0; column < COLUMNS; ++column) {
            double fastest = -1, behind = -1;
            for (int32_t k = MANY - 1; k >= 0; --k) {
                if (U[k] * COLUMNS >= column && U[k] * COLUMNS < column + 1)
                    fastest = fmax(fastest, rate[k]);
                if (U[k] * COLUMNS >= column + 1) behind = rate[k];
            }
            if (fastest < 0) fastest = behind;
            if (fastest < 0)
                assert_true(isnan(grid.values[column]));
            else
                assert_float_equal(grid.values[column], fastest, 0);
        }
        pixel_grid_destroy(&grid);
    }
}

TEST(memory_can_be_short)
{
    SpaceTime data = {STEPS, crowd_U, NODES, two_x, one_pad, crowd_rate, NULL, 1, 0, NULL, 0};
    int64_t live = memory_counters().live;
    for (int64_t k = 0; k < 3; ++k) {
        Error err = {0};
        PixelGrid grid = {0, 1, 0, 1, COLUMNS, ROWS, 1, NULL};
        memory_fail_after(k);
        assert_false(space_time_to_pixels(&data, &grid, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, ERROR_MEMORY);
        pixel_grid_destroy(&grid);
        assert_int_equal(memory_counters().live, live);
    }
}
