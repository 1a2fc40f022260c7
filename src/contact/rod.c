// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rod.h"

#include "base/memory.h"

bool rod_build(const Interface *interface, RodKind kind, double velocity, Rod *rod, Error *err)
{
    *rod = (Rod){.kind = kind, .velocity = velocity, .count = interface->rod_count};
    rod->origin = NEW_ARRAY(double, interface->rod_count, err);
    return rod->origin != NULL;
}

void rod_destroy(Rod *rod)
{
    memory_free(rod->origin);
    *rod = (Rod){0};
}

double rod_force(const Interface *interface, const double *reaction)
{
    double force = 0;
    for (int32_t j = 0; j < interface->rod_count; j++)
        force += reaction[interface_rod(interface, j)];
    return force;
}
