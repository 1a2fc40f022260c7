// SPDX-License-Identifier: GPL-2.0-or-later
// Counts of tests in the plane, by hand: the interface unknowns of contact node i, and the kinds of
// elements, which come first.
#ifndef AMONTONS_TESTS_PLANE_H
#define AMONTONS_TESTS_PLANE_H

#include "io/mesh/mesh_file.h"

#include <stdint.h>

enum { PLANE_KINDS = ELEMENT_Q9 + 1 };

static inline int32_t plane_tangent(int32_t i)
{
    return 2 * i;
}
static inline int32_t plane_normal(int32_t i)
{
    return 2 * i + 1;
}

#endif
