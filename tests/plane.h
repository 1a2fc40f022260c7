// SPDX-License-Identifier: GPL-2.0-or-later
// The interface unknowns of contact node i in the plane, where tests give numbers by hand.
#ifndef AMONTONS_TESTS_PLANE_H
#define AMONTONS_TESTS_PLANE_H

#include <stdint.h>

static inline int32_t plane_tangent(int32_t i)
{
    return 2 * i;
}
static inline int32_t plane_normal(int32_t i)
{
    return 2 * i + 1;
}

#endif
