// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/pace.h"

// Thousand stick-slip cycles on 20 cells are 2e5 steps, and cost a minute.
static const double STEPS_LEFT_MAX = 1e8;

bool pace_check(Pace *pace, int64_t steps, double time, double end, Error *err)
{
    if (steps < pace->steps + PACE_STEPS) return true;
    double step = (time - pace->time) / (double)(steps - pace->steps);
    double left = (end - time) / step;
    *pace = (Pace){.steps = steps, .time = time};
    if (left > STEPS_LEFT_MAX)
        FAIL(err, ERROR_COMPUTE,
             "steps of %.2g are the longest that are accepted, and the end is %.1e of "
             "them away: slip has come to a state that weakens faster than viscosity can damp on "
             "an element. Smaller elements at the contact, less pressure or a larger "
             "friction.critical_velocity would help",
             step, left);
cleanup:
    return error_is_clean(err);
}
