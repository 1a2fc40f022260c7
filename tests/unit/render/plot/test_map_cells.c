// SPDX-License-Identifier: GPL-2.0-or-later
// The area between points: cells of grids with gaps, half way between neighbours, also on
// logarithmic axes.
#include "render/plot/map_cells.h"

#include "near.h"

TEST(grid_with_gaps)
{
    Error err = {0};
    double x[] = {100, 1, 10, 1, 10}, y[] = {0, 0, 0, 3, 3}, value[5] = {0};
    PlotMap map = {.count = 5, .x = x, .y = y, .value = value};
    MapGrid grid = {0};
    assert_true(map_grid_find(&map, true, false, &grid, &err));
    assert_int_equal(grid.columns, 3);
    assert_int_equal(grid.rows, 2);
    const double edges[] = {-0.5, 0.5, 1.5, 2.5}, sides[] = {-1.5, 1.5, 4.5};
    for (int32_t k = 0; k < 4; k++) assert_near("edge", grid.x[k], edges[k], 1e-12);
    for (int32_t k = 0; k < 3; k++) assert_near("edge", grid.y[k], sides[k], 1e-12);
    const int32_t cells[] = {1, 2, 0, 3, 4, -1};
    for (int32_t k = 0; k < 6; k++) assert_int_equal(grid.point[k], cells[k]);
    map_grid_destroy(&grid);
}

TEST(no_grid)
{
    Error err = {0};
    double diagonal[] = {1, 2, 3, 4, 5}, same[] = {1, 1, 2, 2, 2}, value[5] = {0};
    PlotMap map = {.count = 5, .x = diagonal, .y = diagonal, .value = value};
    MapGrid grid = {0};
    assert_true(map_grid_find(&map, false, false, &grid, &err));   // a fifth of the places
    assert_int_equal(grid.columns, 0);
    map.x = map.y = same;   // two points at one place
    assert_true(map_grid_find(&map, false, false, &grid, &err));
    assert_int_equal(grid.columns, 0);
}

// Lines of a large map: a value of its own kind is not seen, a step stays where it is, and a point
// without a value has no median.
TEST(medians_pass_single_values_over)
{
    enum { SIDE = 21, ODD = 5 * SIDE + 4, HOLE = 7 * SIDE + 16, CORNER = SIDE * SIDE - 1 };
    double values[SIDE * SIDE], medians[SIDE * SIDE];
    int32_t point[SIDE * SIDE];
    for (int32_t k = 0; k < SIDE * SIDE; ++k) {
        values[k] = k % SIDE < 10 ? 1 : 2;
        point[k] = k;
    }
    values[ODD] = 9;
    values[HOLE] = values[CORNER - 1] = NAN;
    point[CORNER] = -1;
    MapGrid grid = {.columns = SIDE, .rows = SIDE, .point = point};
    map_medians(&grid, values, medians);
    for (int32_t k = 0; k < CORNER - 1; ++k) {
        double wanted = k % SIDE < 10 ? 1 : 2;
        assert_true(k == HOLE ? isnan(medians[k]) : medians[k] == wanted);
    }
    assert_true(isnan(medians[CORNER - 1]) != 0);
}
