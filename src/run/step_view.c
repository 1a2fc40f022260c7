// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/step_view.h"

#include <math.h>

StepView step_view(const Observation *seen, const Events *events, double t_end)
{
    const int32_t *kinds = events->kinds;
    return (StepView){.t = seen->t,
                      .U = seen->U,
                      .mu = seen->mu,
                      .step_size = seen->step_size,
                      .front = seen->front,
                      .max_slip_rate = seen->max_slip_rate,
                      .fraction = fmin(seen->t / t_end, 1),
                      .certified = seen->certified,
                      .events = kinds[EVENT_BOUNDED] + kinds[EVENT_LEADING],
                      .slidings = kinds[EVENT_LEADING]};
}
