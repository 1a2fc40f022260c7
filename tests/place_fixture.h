// SPDX-License-Identifier: GPL-2.0-or-later
// A folder for each test that has these two as its setup and teardown.
#ifndef AMONTONS_TESTS_PLACE_FIXTURE_H
#define AMONTONS_TESTS_PLACE_FIXTURE_H

#include "result_place.h"

static char place[PLACE_SIZE];

static int begin(void **state)
{
    (void)state;
    place_make(place);
    return 0;
}

static int end(void **state)
{
    (void)state;
    place_remove(place);
    return 0;
}

#endif
