// SPDX-License-Identifier: GPL-2.0-or-later
// How the rod is driven: its velocity V times a factor that follows a table of time, or of its own
// displacement U. Both have closed forms between two points:
//
//     by time     v = v_0 + a t                  U = v_0 t + a t^2/2
//     by way      dv/dU = g: v = v_0 exp(g t)    U = v_0 (exp(g t) - 1)/g
//
// Used by contact/rod; made of a scene by scene/programs.
#ifndef AMONTONS_CONTACT_ROD_COURSE_H
#define AMONTONS_CONTACT_ROD_COURSE_H

#include "base/schedule.h"

typedef struct RodCourse {
    bool by_way;
    double velocity;   // V
    Schedule schedule;   // over time, also where the table is one of U; count 0: V all the time
    double way[SCHEDULE_POINTS_MAX];   // U at each point, length
} RodCourse;

// table: over time or U; by way all its factors are above 0.
RodCourse rod_course(const Schedule *table, bool by_way, double velocity);

double rod_course_velocity(const RodCourse *course, double time);
double rod_course_way(const RodCourse *course, double time);   // U, 0 at time 0
// Time when U is first `way` > 0; INFINITY: never.
double rod_course_arrival(const RodCourse *course, double way);

#endif
