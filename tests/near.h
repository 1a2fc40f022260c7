// SPDX-License-Identifier: GPL-2.0-or-later
// Doubles compared as doubles (cmocka 1.1.5 compares floats only).
#ifndef AMONTONS_TESTS_NEAR_H
#define AMONTONS_TESTS_NEAR_H

#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// what: said when it fails.
static inline void assert_near(const char *what, double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %.17g is not %.17g within %g", what, value, wanted, tolerance);
}

// The same for arrays, relative to the largest entry wanted.
static inline void assert_all_near(const char *what, const double *value, const double *wanted,
                                   int32_t count, double tolerance)
{
    double scale = 0;
    for (int32_t k = 0; k < count; k++) scale = fmax(scale, fabs(wanted[k]));
    for (int32_t k = 0; k < count; k++) {
        if (!(fabs(value[k] - wanted[k]) <= tolerance * scale))
            fail_msg("%s [%d of %d]: %.17g is not %.17g within %g of %g", what, k, count, value[k],
                     wanted[k], tolerance, scale);
    }
}

#endif
