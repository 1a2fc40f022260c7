// SPDX-License-Identifier: GPL-2.0-or-later
// Monotonic: a clock that is set by hand or by the network must not bend a timing.
#include "base/clock.h"

#include <time.h>

static double read_clock(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// Since some moment in the past, the same for a whole run: only differences mean something.
double clock_seconds(void)
{
    return read_clock(CLOCK_MONOTONIC);
}

// User and system time of all threads: what a run costs beside others on the same machine.
double clock_processor_seconds(void)
{
    return read_clock(CLOCK_PROCESS_CPUTIME_ID);
}
