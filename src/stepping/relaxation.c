// SPDX-License-Identifier: GPL-2.0-or-later
// The block settles under its load with the rod away or held, by the steps that the run takes
// later; nothing is asked of energy on the way.
#include "stepping/relaxation.h"

#include "algebra/dense.h"

#include <math.h>

// The largest velocity on the interface, or the root mean square over the block if that is larger.
// v'M v over the block's mass is the mean square of |v|, twice the kinetic energy over the mass.
static double fastest(const StepControl *control)
{
    const State *state = &control->now;
    double mean_square = dense_dot(state->velocity, state->momentum, state->dof_count) /
                         control->scheme.system->mass_total;
    return fmax(sqrt(mean_square), dense_max_abs(state->slip_rate, state->interface_count));
}

// *steps: how many. control's state at the end is the start of the run; its clock is set back by
// step_control_restart. ERROR_COMPUTE: it did not settle.
bool relax(StepControl *control, const RelaxationDef *def, int64_t *steps, Error *err)
{
    double speed = INFINITY;
    step_control_settle(control);
    for (*steps = 0; speed > def->speed_max; (*steps)++) {
        if (control->now.time > def->duration_max)
            FAIL(err, ERROR_COMPUTE,
                 "the block has not settled under its load after t = %g: the fastest point moves "
                 "at %g, start.tolerance asks for %g (does it tip over, or is start.duration_max "
                 "too short?)",
                 control->now.time, speed, def->speed_max);
        TRY(step_control_advance(control, INFINITY, err));
        if (def->may_go_on) TRY(def->may_go_on(def->self, err));
        speed = fastest(control);
    }
cleanup:
    if (!error_is_clean(err)) error_context(err, "while relaxing before the rod moves");
    return error_is_clean(err);
}
