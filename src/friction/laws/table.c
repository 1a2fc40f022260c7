// SPDX-License-Identifier: GPL-2.0-or-later
// A coefficient given at some speeds, and what it is between them: straight lines, or cubics whose
// slopes at the points keep each piece monotone, so that nothing overshoots what was measured
// (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980; slopes of the parabola through three points,
// bounded as by Hyman, SIAM J. Sci. Stat. Comput. 4, 1983). With points h apart lines are off by
// h^2, cubics by h^3.
#include "friction/laws/law.h"

#include <math.h>
#include <string.h>

static double rise(const FrictionTable *table, int32_t k)
{
    return (table->mu[k + 1] - table->mu[k]) / (table->speed[k + 1] - table->speed[k]);
}

// A slope with which both neighbouring pieces stay monotone: at most three times the smaller rise,
// 0 at an extreme.
static double bounded(double slope, double before, double after)
{
    if (before * after <= 0) return 0;
    double largest = 3 * fmin(fabs(before), fabs(after));
    return copysign(fmin(fmax(copysign(1, before) * slope, 0), largest), before);
}

// Slopes at point k of the parabola through it and its two neighbours; at an end through the three
// nearest points.
static void find_slopes(FrictionTable *table)
{
    int32_t last = table->count - 1;
    for (int32_t k = 0; k <= last; k++) {
        int32_t middle = k == 0 ? 1 : k == last ? last - 1 : k;
        if (last == 1) {
            table->slope[k] = rise(table, 0);
            continue;
        }
        double left = table->speed[middle] - table->speed[middle - 1];
        double right = table->speed[middle + 1] - table->speed[middle];
        double before = rise(table, middle - 1), after = rise(table, middle);
        double curve = (after - before) / (left + right);
        double slope = before + curve * (2 * table->speed[k] - table->speed[middle - 1] -
                                         table->speed[middle]);
        if (k == 0) after = before;
        if (k == last) before = after;
        table->slope[k] = bounded(slope, before, after);
    }
}

static bool make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    FrictionTable *table = &law->table;
    int32_t count = source->velocity_count;
    *key = "velocity";
    if (count < 2 || count > FRICTION_POINTS_MAX)
        return REFUSE(err, "has %d numbers; a table has 2 to %d", count, FRICTION_POINTS_MAX);
    if (source->velocity[0] != 0)
        return REFUSE(err, "begins with %g; the first is 0, where mu holds at rest",
                      source->velocity[0]);
    *table = (FrictionTable){.count = count, .straight = source->straight};
    for (int32_t k = 0; k < count; k++) {
        table->speed[k] = source->velocity[k];
        if (k > 0 && !(table->speed[k] > table->speed[k - 1]))
            return REFUSE(err, "%g stands after %g; velocities ascend", table->speed[k],
                          table->speed[k - 1]);
    }
    *key = "mu";
    if (source->mu_count != count)
        return REFUSE(err, "has %d numbers, friction.velocity has %d", source->mu_count, count);
    memcpy(table->mu, source->mu, (size_t)count * sizeof(double));
    find_slopes(table);
    law->end = table->speed[count - 1];
    return true;
}

// Number of the interval of `speed`, 0 to count - 2; beyond an end that at the end.
static int32_t interval_of(const FrictionTable *table, double speed)
{
    int32_t low = 0, high = table->count - 1;
    while (high - low > 1) {
        int32_t middle = (low + high) / 2;
        *(speed < table->speed[middle] ? &high : &low) = middle;
    }
    return low;
}

// Hermite's cubic in s = (speed - start)/width:
//     mu = a + width s (p (1 - s)^2 - q s (1 - s)) + (b - a) s^2 (3 - 2 s),   p, q: end slopes.
static double value(const FrictionLaw *law, double speed, double *slope)
{
    const FrictionTable *table = &law->table;
    int32_t k = interval_of(table, speed);
    double start = table->speed[k], width = table->speed[k + 1] - start;
    double from = table->mu[k], step = table->mu[k + 1] - from;
    if (table->straight) {
        *slope = step / width;
        return from + *slope * (speed - start);
    }
    double s = (speed - start) / width, t = 1 - s;
    double p = table->slope[k], q = table->slope[k + 1];
    *slope = p * t * (1 - 3 * s) + q * s * (3 * s - 2) + 6 * step / width * s * t;
    return from + width * s * t * (p * t - q * s) + step * s * s * (3 - 2 * s);
}

// The points and fifteen speeds between each two.
static double look_speed(const FrictionLaw *law, int32_t k)
{
    enum { BETWEEN = 16 };
    int32_t last = BETWEEN * (law->table.count - 1);
    if (k >= last) return k == last ? law->end : INFINITY;
    const double *speed = law->table.speed + k / BETWEEN;
    return speed[0] + (speed[1] - speed[0]) * (k % BETWEEN) / BETWEEN;
}

const FrictionOperations friction_table = {
    .must = "velocity mu",
    .may = "mu_static mu_kinetic critical_velocity interpolation",
    .own = true,
    .has_drop = true,
    .make = make,
    .value = value,
    .look_speed = look_speed};
