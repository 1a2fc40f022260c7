// SPDX-License-Identifier: GPL-2.0-or-later
// Slip and friction of a contact node as vectors of dim - 1 components: a slipping node has a speed
// and a direction. With one component all of this is exact: a magnitude and a sign.
#ifndef AMONTONS_CONTACT_SLIP_H
#define AMONTONS_CONTACT_SLIP_H

#include "contact/interface.h"

#include <math.h>

enum { TANGENTS_MAX = 2 };

static inline int32_t slip_tangents(const Interface *interface)
{
    return interface->dim - 1;
}

// Size of the tangential part of x [interface->count] at node i, ...
static inline double slip_size(const Interface *interface, int32_t i, const double *x)
{
    const double *tangent = x + interface_tangent(interface, i);
    return slip_tangents(interface) == 1 ? fabs(tangent[0]) : hypot(tangent[0], tangent[1]);
}

// ... and its product with that of y.
static inline double slip_dot(const Interface *interface, int32_t i, const double *x,
                              const double *y)
{
    int32_t t = interface_tangent(interface, i);
    double sum = x[t] * y[t];
    for (int32_t c = 1; c < slip_tangents(interface); c++) sum += x[t + c] * y[t + c];
    return sum;
}

#endif
