// SPDX-License-Identifier: GPL-2.0-or-later
// Wall time goes on while the process sleeps, processor time while it works.
#include "base/clock.h"

#include "near.h"

#include <time.h>

TEST(test_sleeping)
{
    const struct timespec nap = {.tv_nsec = 50000000};
    double wall = clock_seconds(), processor = clock_processor_seconds();
    nanosleep(&nap, NULL);
    assert_true(clock_seconds() - wall >= 0.05);
    assert_true(clock_processor_seconds() - processor < 0.025);
}

TEST(test_working)
{
    double began = clock_processor_seconds(), wall = clock_seconds();
    volatile double sum = 0;
    while (clock_processor_seconds() - began < 0.02) sum += 1;
    // One thread: it cannot have worked longer than it was there, but for the clocks' own steps.
    assert_true(clock_seconds() - wall > 0.019);
    assert_true(sum > 0);
}
