// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/stop_request.h"

#include "base/clock.h"

bool simulation_may_go_on(const Simulation *simulation, Error *err)
{
    const volatile sig_atomic_t *stop = simulation->options.stop;
    if (stop && *stop) FAIL(err, ERROR_INTERRUPT, "stopped");
    if (clock_seconds() > simulation->deadline) FAIL(err, ERROR_INTERRUPT, "time is up");
cleanup:
    return error_is_clean(err);
}
