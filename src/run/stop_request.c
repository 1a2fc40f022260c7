// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/stop_request.h"

#include "base/clock.h"

bool simulation_may_go_on(const Simulation *simulation, Error *err)
{
    const volatile sig_atomic_t *stop = simulation->options.stop;
    if (stop && *stop) return FAULT(err, ERROR_INTERRUPT, "stopped");
    if (clock_seconds() > simulation->deadline) return FAULT(err, ERROR_INTERRUPT, "time is up");
    return true;
}
