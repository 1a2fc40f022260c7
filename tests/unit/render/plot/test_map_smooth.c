// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/map_smooth.h"

#include "base/memory.h"
#include "cases.h"

#include <math.h>

enum { COLUMNS = 4, ROWS = 3, PARTS = 5, FINE = (COLUMNS - 1) * PARTS + 1 };
static const int64_t corner = (ROWS - 1) * PARTS * FINE + FINE - 1;   // the last place

static const double column_x[COLUMNS] = {0, 1, 4, 6}, row_y[ROWS] = {0, 2, 3};

// Rows from low to high, as map_cells finds them; y downwards on the picture.
static void smooth_make(const double *values, SmoothGrid *smooth)
{
    Error err = {0};
    Point place[COLUMNS * ROWS];
    int32_t point[COLUMNS * ROWS];
    for (int32_t k = 0; k < COLUMNS * ROWS; ++k) {
        place[k] = (Point){column_x[k % COLUMNS], 10 - row_y[k / COLUMNS]};
        point[k] = k;
    }
    MapGrid grid = {.columns = COLUMNS, .rows = ROWS, .point = point};
    assert_true(map_smooth(&grid, values, place, PARTS, smooth, &err));
    assert_int_equal(smooth->columns, FINE);
    assert_int_equal(smooth->triangles.count, 2 * (FINE - 1) * (smooth->rows - 1));
}

// A plane stays one, at the places where it says it is.
TEST(a_plane_stays)
{
    double values[COLUMNS * ROWS];
    SmoothGrid smooth;
    for (int32_t k = 0; k < COLUMNS * ROWS; ++k)
        values[k] = 1 + 2 * column_x[k % COLUMNS] - 3 * row_y[k / COLUMNS];
    smooth_make(values, &smooth);
    for (int32_t k = 0; k < smooth.columns * smooth.rows; ++k) {
        Point at = smooth.place[k];
        assert_true(fabs(smooth.value[k] - (1 + 2 * at.x - 3 * (10 - at.y))) < 1e-12);
    }
    smooth_destroy(&smooth);
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

// A step: through every value, and between points never beyond; a hole spreads to the next.
TEST(it_does_not_overshoot)
{
    const double values[COLUMNS * ROWS] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, NAN};
    SmoothGrid smooth;
    smooth_make(values, &smooth);
    for (int32_t row = 0; row < ROWS; ++row)
        for (int32_t column = 0; column < COLUMNS; ++column) {
            double wanted = values[row * COLUMNS + column];
            double seen = smooth.value[row * PARTS * FINE + column * PARTS];
            assert_true(isnan(wanted) ? isnan(seen) : fabs(seen - wanted) < 1e-15);
        }
    for (int32_t k = 0; k < smooth.columns * smooth.rows; ++k)
        assert_true(isnan(smooth.value[k]) || (smooth.value[k] >= 0 && smooth.value[k] <= 1));
    assert_true(isnan(smooth.value[corner - 1]) != 0);
    assert_true(isfinite(smooth.value[FINE - 2]) != 0);
    smooth_destroy(&smooth);
}
