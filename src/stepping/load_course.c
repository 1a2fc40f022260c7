// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/load_course.h"

#include <math.h>
#include <stddef.h>

double load_factor(const LoadCourse *course, double time)
{
    if (course == NULL) return 1;
    double x = course->by_way ? rod_displacement(course->rod, time) : time;
    return schedule_factor(&course->schedule, x);
}

double load_next(const LoadCourse *course, double time)
{
    if (course == NULL) return INFINITY;
    if (!course->by_way) return schedule_next(&course->schedule, time);
    double next = schedule_next(&course->schedule, rod_displacement(course->rod, time));
    return isfinite(next) ? rod_arrival(course->rod, next) : INFINITY;
}
