// SPDX-License-Identifier: GPL-2.0-or-later
// A factor by points: straight lines between them, level beyond the last; two points at one place
// make a jump. Used by contact/rod_course and stepping/state.
#ifndef AMONTONS_BASE_SCHEDULE_H
#define AMONTONS_BASE_SCHEDULE_H

#include <stdbool.h>
#include <stdint.h>

enum { SCHEDULE_POINTS_MAX = 64 };

typedef struct Schedule {
    int32_t count;   // of points, at least 2; 0: the factor is 1
    double at[SCHEDULE_POINTS_MAX];   // ascending from 0
    double factor[SCHEDULE_POINTS_MAX];
    bool repeats;   // from the last point on as from the first
} Schedule;

// Factor at x >= 0; where it jumps, the one before the jump: a step that ends there knows nothing
// of the jump.
double schedule_factor(const Schedule *schedule, double x);
// The next point beyond x, INFINITY: there is none.
double schedule_next(const Schedule *schedule, double x);
double schedule_largest(const Schedule *schedule);   // |factor|

// The segment between two points that x lies or, at a point, ends in, from 0; count - 1 beyond the
// last. *from: where x is counted from: 0, or the beginning of this repetition.
int32_t schedule_segment(const Schedule *schedule, double x, double *from);

#endif
