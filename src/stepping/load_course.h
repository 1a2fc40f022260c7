// SPDX-License-Identifier: GPL-2.0-or-later
// The load while the rod moves: that at t = 0 times a factor, by a table of time or of the rod's
// displacement. Used by stepping/sdirk and stepping/explicit_reference; read by record/ and run/.
#ifndef AMONTONS_STEPPING_LOAD_COURSE_H
#define AMONTONS_STEPPING_LOAD_COURSE_H

#include "base/schedule.h"
#include "contact/rod.h"

typedef struct LoadCourse {
    Schedule schedule;   // count 0: the load stays
    bool by_way;   // of U; else of time
    const Rod *rod;   // whose U it follows; not owned
} LoadCourse;

// Load at `time` over that at t = 0. NULL: 1.
double load_factor(const LoadCourse *course, double time);
// Time of its next point after `time`; INFINITY: none does.
double load_next(const LoadCourse *course, double time);

#endif
