// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rod.h"

#include "base/memory.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

bool rod_build(const Interface *interface, RodKind kind, double velocity, Rod *rod, Error *err)
{
    *rod = (Rod){.kind = kind, .velocity = velocity, .count = interface->rod_count};
    rod->origin = NEW_ARRAY(double, interface->rod_count, err);
    rod->softness = NEW_ARRAY(double, interface->rod_count, err);
    return rod->origin && rod->softness;
}

void rod_destroy(Rod *rod)
{
    memory_free(rod->origin);
    memory_free(rod->softness);
    *rod = (Rod){0};
}

void rod_soften(const Interface *interface, double modulus, double viscosity, Rod *rod)
{
    rod->lag = viscosity / modulus;
    for (int32_t j = 0; j < interface->rod_count; j++)
        rod->softness[j] = -4 * log(interface->rod_share[j]) / (PI * modulus);
}

double rod_bound(const Rod *rod, int32_t j, double position, double time, double reach)
{
    double way = rod->origin[j] + rod->velocity * time - position;
    if (rod->softness[j] == 0) return way / reach;
    // r = [way - reach v + lag (V - v)] / softness = 0 at this v.
    return (way + rod->lag * rod->velocity) / (reach + rod->lag);
}

double rod_force(const Interface *interface, const double *reaction)
{
    double force = 0;
    for (int32_t j = 0; j < interface->rod_count; j++)
        force += reaction[interface_rod(interface, j)];
    return force;
}
