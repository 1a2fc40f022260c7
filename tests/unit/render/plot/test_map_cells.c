// SPDX-License-Identifier: GPL-2.0-or-later
// The area between points: cells of grids with gaps, half way between neighbours, also on
// logarithmic axes; triangles that tile the hull of scattered points, whose area is known; gaps
// that stay empty.
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
    MapTriangles triangles = {0};
    Point place[5] = {{0}};
    assert_true(map_triangles_find(&grid, place, 5, &triangles, &err));
    assert_int_equal(triangles.count, 2);   // between the four points that meet
    map_triangles_destroy(&triangles);
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

static double area(const Point *place, const int32_t corner[3])
{
    Point a = place[corner[0]], b = place[corner[1]], c = place[corner[2]];
    return fabs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
}

// Points along the sides of a square and inside, by a generator of fractions: the area is 1; a
// cluster far away is joined to nothing.
TEST(triangles_tile_the_hull)
{
    enum { SIDE = 20, INSIDE = 300, ALL = INSIDE + 4 * SIDE };
    Error err = {0};
    Point place[2 * ALL + 1] = {{0}};
    for (int32_t k = 0; k < SIDE; k++) {
        double part = (double)k / SIDE;
        place[4 * k] = (Point){part, 0};
        place[4 * k + 1] = (Point){1, part};
        place[4 * k + 2] = (Point){1 - part, 1};
        place[4 * k + 3] = (Point){0, 1 - part};
    }
    for (int32_t k = 4 * SIDE; k < ALL; k++)
        place[k] = (Point){fmod(k * 0.7548776662, 1), fmod(k * 0.5698402910, 1)};
    const MapGrid none = {0};
    for (int32_t groups = 1; groups <= 2; groups++) {
        for (int32_t k = 0; k < ALL; k++) place[ALL + k] = (Point){place[k].x + 9, place[k].y};
        place[2 * ALL] = (Point){NAN, 0};
        MapTriangles triangles = {0};
        int32_t count = groups == 1 ? ALL : 2 * ALL + 1;
        double sum = 0;
        assert_true(map_triangles_find(&none, place, count, &triangles, &err));
        for (int32_t k = 0; k < triangles.count; k++) {
            const int32_t *corner = triangles.points + 3 * k;
            sum += area(place, corner);
            assert_true((corner[0] < ALL) == (corner[1] < ALL) &&
                        (corner[0] < ALL) == (corner[2] < ALL));
        }
        assert_near("area", sum, groups, 1e-9);
        map_triangles_destroy(&triangles);
    }
}

// On one line there is nothing between points.
TEST(flat_points)
{
    Error err = {0};
    const Point place[] = {{0, 0}, {1, 2}, {2, 4}, {5, 10}};
    const MapGrid none = {0};
    MapTriangles triangles = {0};
    for (int32_t count = 0; count <= 4; count++) {
        assert_true(map_triangles_find(&none, place, count, &triangles, &err));
        assert_int_equal(triangles.count, 0);
        map_triangles_destroy(&triangles);
    }
}
