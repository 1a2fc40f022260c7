// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_table.h"

#include <math.h>

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
void friction_table_slopes(FrictionTable *table)
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

int32_t friction_table_interval(const FrictionTable *table, double speed)
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
double friction_table_at(const FrictionTable *table, int32_t interval, double speed, double *slope)
{
    double start = table->speed[interval], width = table->speed[interval + 1] - start;
    double from = table->mu[interval], step = table->mu[interval + 1] - from;
    if (table->straight) {
        *slope = step / width;
        return from + *slope * (speed - start);
    }
    double s = (speed - start) / width, t = 1 - s;
    double p = table->slope[interval], q = table->slope[interval + 1];
    *slope = p * t * (1 - 3 * s) + q * s * (3 * s - 2) + 6 * step / width * s * t;
    return from + width * s * t * (p * t - q * s) + step * s * s * (3 - 2 * s);
}
