// SPDX-License-Identifier: GPL-2.0-or-later
// A cache of its own, empty at first, for each test or group of tests that has these two as its
// setup and teardown.
#ifndef AMONTONS_TESTS_CACHE_FIXTURE_H
#define AMONTONS_TESTS_CACHE_FIXTURE_H

#include "result_place.h"

static char cache[PLACE_SIZE];

static int cache_begin(void **state)
{
    (void)state;
    place_make(cache);
    return setenv("AMONTONS_CACHE", cache, 1);
}

static int cache_end(void **state)
{
    (void)state;
    place_remove(cache);
    unsetenv("AMONTONS_CACHE_LIMIT");
    return setenv("AMONTONS_CACHE", "", 1);
}

#endif
