// SPDX-License-Identifier: GPL-2.0-or-later
// A coefficient given at some speeds, and what it is between them: straight lines, or cubics whose
// slopes at the points keep each piece monotone, so that nothing overshoots what was measured
// (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980; slopes of the parabola through three points,
// bounded as by Hyman, SIAM J. Sci. Stat. Comput. 4, 1983). With points h apart lines are off by
// h^2, cubics by h^3. Called by friction/friction_law.
#ifndef AMONTONS_FRICTION_FRICTION_TABLE_H
#define AMONTONS_FRICTION_FRICTION_TABLE_H

#include <stdbool.h>
#include <stdint.h>

enum { FRICTION_POINTS_MAX = 64 };

typedef struct FrictionTable {
    int32_t count;   // of points, at least 2
    bool straight;   // lines in place of cubics
    double speed[FRICTION_POINTS_MAX];   // ascending from 0, velocity
    double mu[FRICTION_POINTS_MAX];   // 1
    double slope[FRICTION_POINTS_MAX];   // of the cubics at the points, one over a velocity
} FrictionTable;

// Fills `slope` from the rest.
void friction_table_slopes(FrictionTable *table);

// Number of the interval of `speed`, 0 to count - 2; beyond an end that at the end.
int32_t friction_table_interval(const FrictionTable *table, double speed);

// mu and its slope by the cubic or line of `interval`, at any speed.
double friction_table_at(const FrictionTable *table, int32_t interval, double speed, double *slope);

#endif
