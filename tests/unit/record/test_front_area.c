// SPDX-License-Identifier: GPL-2.0-or-later
// Fronts whose speed is known: straight ones in any direction on faces of any kind, a circle, one
// that stops, and one that is everywhere at once.
#include "record/front_area.h"

#include "cases.h"
#include "near.h"

enum { SIDE = 17, NODES = SIDE * SIDE, CELLS = (SIDE - 1) * (SIDE - 1), WIDTH = 6 };

static double x[NODES], y[NODES], arrival[NODES], corner[2 * NODES];
static int32_t point[2 * CELLS * WIDTH];
static Interface interface;

// A lattice of skew cells over the unit square, all sides bent but the outer ones; cut in two
// triangles where `triangles`.
static void lattice(bool triangles)
{
    ContactFaces *faces = &interface.faces;
    interface = (Interface){.dim = 3, .contact_count = NODES, .x = x, .y = y};
    *faces = (ContactFaces){.width = 4, .point = point, .corner = corner};
    for (int32_t i = 0; i < NODES; i++) {
        double s = i / SIDE / (SIDE - 1.0), r = i % SIDE / (SIDE - 1.0);
        double bend = 0.02 * sin(7 * s + 5 * r) * sin(3.14159265358979 * s);
        x[i] = s + bend * sin(3.14159265358979 * r);
        y[i] = r - bend * sin(3.14159265358979 * r);
    }
    for (int32_t c = 0; c < CELLS; c++) {
        int32_t a = c / (SIDE - 1) * SIDE + c % (SIDE - 1);
        const int32_t cell[4] = {a, a + SIDE, a + SIDE + 1, a + 1};
        for (int32_t half = 0; half < (triangles ? 2 : 1); half++) {
            int32_t *row = point + 4 * faces->count++;
            for (int32_t k = 0; k < 4; k++) row[k] = cell[k];
            if (triangles) row[3] = -1;
            if (half) row[1] = cell[3];   // 0, 3, 2
        }
    }
}

TEST(test_straight)
{
    for (int32_t triangles = 0; triangles < 2; triangles++)
        for (int32_t k = 0; k < 8; k++) {
            lattice(triangles);
            for (int32_t i = 0; i < NODES; i++)
                arrival[i] = 5 + (cos(0.8 * k) * x[i] + sin(0.8 * k) * y[i]) / 0.7;
            assert_near("speed", front_area_speed(&interface, arrival, -INFINITY), 0.7, 1e-12);
        }
}

// Over half of the contact with twice the speed: the mean by area of 1/speed; the cells where it
// changes lie on a line of nodes.
TEST(test_two_speeds)
{
    lattice(false);
    for (int32_t i = 0; i < NODES; i++) x[i] = i / SIDE / (SIDE - 1.0);
    for (int32_t i = 0; i < NODES; i++) arrival[i] = x[i] < 0.5 ? x[i] : 0.5 + (x[i] - 0.5) / 2;
    double speed = front_area_speed(&interface, arrival, -INFINITY);
    assert_near("mean", speed, 1 / (0.5 * 1 + 0.5 / 2), 1e-12);
    assert_near("later", front_area_speed(&interface, arrival, 0.5), 2, 1e-12);
}

// A circle that grows from a corner; it stops at a radius, and what is not swept does not count.
TEST(test_circle_that_stops)
{
    lattice(false);
    for (int32_t i = 0; i < NODES; i++) {
        double r = hypot(x[i], y[i]);
        arrival[i] = r < 0.6 ? r / 0.3 : NAN;
    }
    assert_near("speed", front_area_speed(&interface, arrival, -INFINITY), 0.3,
                6e-3);   // cells of 0.06
}

// Corners of T6 faces are no contact nodes: three mid-sides tell the front.
TEST(test_faces_of_tet10)
{
    double mid_x[] = {0.5, 0.5, 0}, mid_y[] = {0, 0.5, 0.5};
    double at[] = {0, 0, 1, 0, 0, 1};
    int32_t row[] = {3, 4, 5, 0, 1, 2};
    interface = (Interface){.dim = 3, .contact_count = 3, .x = mid_x, .y = mid_y};
    interface.faces =
        (ContactFaces){.corner_count = 3, .corner = at, .count = 1, .width = WIDTH, .point = row};
    for (int32_t k = 0; k < 3; k++) arrival[k] = (0.6 * mid_x[k] + 0.8 * mid_y[k]) / 4;
    assert_near("speed", front_area_speed(&interface, arrival, -INFINITY), 4, 1e-12);
}

TEST(test_none)
{
    lattice(true);
    for (int32_t i = 0; i < NODES; i++) arrival[i] = 3;
    assert_true(isnan(front_area_speed(&interface, arrival, -INFINITY)));   // at once
    for (int32_t i = 0; i < NODES; i++) arrival[i] = i % 2 ? INFINITY : NAN;
    assert_true(isnan(front_area_speed(&interface, arrival, -INFINITY)));
    interface.faces.count = 0;   // in the plane
    assert_true(isnan(front_area_speed(&interface, arrival, -INFINITY)));
}
