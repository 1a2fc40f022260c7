// SPDX-License-Identifier: GPL-2.0-or-later
// A driven rod against its equations of motion, integrated by small steps: dU/dt = V factor, the
// factor a table of time or of U; and when it arrives.
#include "contact/rod_course.h"

#include "near.h"

static const double V = 1e-3;

// The table as it stands in a scene, by straight lines; after a jump.
static double table_value(const Schedule *table, double x)
{
    double end = table->at[table->count - 1];
    if (table->repeats) x = fmod(x, end);
    int32_t k = 0;
    while (k + 1 < table->count && table->at[k + 1] <= x) k++;
    if (k + 1 == table->count) return table->factor[k];
    double part = (x - table->at[k]) / (table->at[k + 1] - table->at[k]);
    return table->factor[k] + part * (table->factor[k + 1] - table->factor[k]);
}

// Midpoint rule, whose error is that of the steps across jumps. A rod that is farther than ever
// arrives there then.
static void compare(const Schedule *table, bool by_way, double end)
{
    enum { STEPS = 100000 };
    RodCourse course = rod_course(table, by_way, V);
    double U = 0, farthest = 0, step = end / STEPS, worst = 0;
    for (int32_t k = 0; k < STEPS; k++) {
        double t = k * step, x = by_way ? U : t;
        double middle = by_way ? U + 0.5 * step * V * table_value(table, x) : t + 0.5 * step;
        U += step * V * table_value(table, middle);
        double way = rod_course_way(&course, t + step);
        worst = fmax(worst, fabs(way - U));
        if (way > farthest && k % 100 == 0)
            assert_near("arrival", rod_course_arrival(&course, way), t + step, 1e-6 * end);
        farthest = fmax(farthest, way);
    }
    assert_near("U", worst, 0, 3e-4 * V * end);
    if (!by_way) {
        double t = 0.37 * end;
        assert_near("velocity", rod_course_velocity(&course, t), V * table_value(table, t), 1e-12);
    }
}

TEST(test_by_time)
{
    Schedule table = {.count = 6, .at = {0, 2, 3, 3, 5, 6}, .factor = {1, 1, -0.5, 0, 0, 2}};
    compare(&table, false, 12);
    table.repeats = true;
    compare(&table, false, 31);
}

TEST(test_by_way)
{
    Schedule table = {
        .count = 5, .at = {0, 2e-3, 3e-3, 3e-3, 7e-3}, .factor = {1, 1, 5, 0.5, 0.25}};
    compare(&table, true, 40);
    table.repeats = true;
    compare(&table, true, 60);
}

TEST(test_never)
{
    const Schedule swings = {
        .count = 4, .at = {0, 1, 1, 2}, .factor = {1, 1, -1, -1}, .repeats = true};
    const Schedule stops = {.count = 3, .at = {0, 1, 2}, .factor = {1, 1, 0}};
    RodCourse course = rod_course(&swings, false, V), stopped = rod_course(&stops, false, V);
    assert_near("its farthest", rod_course_arrival(&course, V), 1, 1e-9);
    assert_true(rod_course_arrival(&course, 1.01 * V) == INFINITY);
    assert_near("where it stops", rod_course_arrival(&stopped, 1.5 * V), 2, 1e-6);
    assert_true(rod_course_arrival(&stopped, 1.51 * V) == INFINITY);
    const Schedule none = {0};
    course = rod_course(&none, false, V);
    assert_near("with V", rod_course_arrival(&course, 3), 3 / V, 1e-9);
}
