// SPDX-License-Identifier: GPL-2.0-or-later
// A coefficient given at some speeds, and what it is between them: straight lines, or cubics whose
// slopes at the points keep each piece monotone, so that nothing overshoots what was measured
// (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980; slopes of the parabola through three points,
// bounded as by Hyman, SIAM J. Sci. Stat. Comput. 4, 1983). With points h apart lines are off by
// h^2, cubics by h^3. What was measured over decades of speed is even over its logarithm: there the
// cubics are of ln v.
#include "friction/laws/law.h"

#include <math.h>
#include <string.h>

static double rise(const FrictionTable *table, int32_t k)
{
    return (table->mu[k + 1] - table->mu[k]) / (table->at[k + 1] - table->at[k]);
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
        double left = table->at[middle] - table->at[middle - 1];
        double right = table->at[middle + 1] - table->at[middle];
        double before = rise(table, middle - 1), after = rise(table, middle);
        double curve = (after - before) / (left + right);
        double slope = before +
                       curve * (2 * table->at[k] - table->at[middle - 1] - table->at[middle]);
        if (k == 0) after = before;
        if (k == last) before = after;
        table->slope[k] = bounded(slope, before, after);
    }
}

// A measured table seldom begins at rest: then mu there is mu_static where that is given, else the
// first value.
static bool make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    FrictionTable *table = &law->table;
    int32_t given = source->velocity_count, first = 0;
    if (given < 2 || given >= FRICTION_POINTS_MAX)
        return REFUSE_AT(err, key, "velocity", "has %d numbers; a table has 2 to %d", given,
                         FRICTION_POINTS_MAX - 1);
    for (int32_t k = 1; k < given; k++)
        if (!(source->velocity[k] > source->velocity[k - 1]))
            return REFUSE_AT(err, key, "velocity", "%g stands after %g; velocities ascend",
                             source->velocity[k], source->velocity[k - 1]);
    if (source->by_log && given < 3 && source->velocity[0] == 0)
        return REFUSE_AT(err, key, "velocity",
                         "has one number above 0; between two or more mu goes by their logarithm");
    if (source->mu_count != given)
        return REFUSE_AT(err, key, "mu", "has %d numbers, friction.velocity has %d",
                         source->mu_count, given);

    bool rests = source->velocity[0] == 0;
    *table = (FrictionTable){
        .straight = source->straight, .by_log = source->by_log, .first = source->velocity[0]};
    table->rest = !rests && law->mu_static > 0 ? law->mu_static : source->mu[0];
    if (rests && source->by_log) first = 1;
    if (!rests && !source->by_log) table->mu[table->count++] = table->rest;   // at v = 0
    for (int32_t k = first; k < given; k++, table->count++) {
        table->speed[table->count] = source->velocity[k];
        table->mu[table->count] = source->mu[k];
    }
    for (int32_t k = 0; k < table->count; k++)
        table->at[k] = source->by_log ? log(table->speed[k]) : table->speed[k];
    find_slopes(table);
    law->end = table->speed[table->count - 1];
    return true;
}

// Number of the interval of `at`, 0 to count - 2; beyond an end that at the end.
static int32_t interval_of(const FrictionTable *table, double at)
{
    int32_t low = 0, high = table->count - 1;
    while (high - low > 1) {
        int32_t middle = (low + high) / 2;
        *(at < table->at[middle] ? &high : &low) = middle;
    }
    return low;
}

// Hermite's cubic in s = (at - start)/width, at = v or ln v:
//     mu = a + width s (p (1 - s)^2 - q s (1 - s)) + (b - a) s^2 (3 - 2 s),   p, q: end slopes.
static double value(const FrictionLaw *law, double speed, double *slope)
{
    const FrictionTable *table = &law->table;
    if (speed < table->speed[0]) {   // by_log alone
        *slope = (table->mu[0] - table->rest) / table->speed[0];
        return table->rest + *slope * speed;
    }
    double at = table->by_log ? log(speed) : speed;
    int32_t k = interval_of(table, at);
    double start = table->at[k], width = table->at[k + 1] - start;
    double from = table->mu[k], step = table->mu[k + 1] - from;
    if (table->straight) {
        *slope = step / width;
        return from + *slope * (speed - start);
    }
    double s = (at - start) / width, t = 1 - s;
    double p = table->slope[k], q = table->slope[k + 1];
    *slope = p * t * (1 - 3 * s) + q * s * (3 * s - 2) + 6 * step / width * s * t;
    if (table->by_log) *slope /= speed;
    return from + width * s * t * (p * t - q * s) + step * s * s * (3 - 2 * s);
}

// The points and fifteen speeds between each two, and between rest and the first.
static double look_speed(const FrictionLaw *law, int32_t k)
{
    enum { BETWEEN = 16 };
    const FrictionTable *table = &law->table;
    int32_t piece = k / BETWEEN - table->by_log, last = table->count - 1;
    double part = (double)(k % BETWEEN) / BETWEEN;
    if (piece >= last) return piece == last && k % BETWEEN == 0 ? law->end : INFINITY;
    if (piece < 0) return table->speed[0] * part;
    double start = table->at[piece], at = start + (table->at[piece + 1] - start) * part;
    return part == 0 ? table->speed[piece] : table->by_log ? exp(at) : at;
}

const FrictionOperations friction_table = {
    .must = "velocity mu",
    .may = "file mu_static mu_kinetic critical_velocity interpolation",
    .own = true,
    .has_drop = true,
    .make = make,
    .value = value,
    .look_speed = look_speed,
    .mu_key = "mu"};
