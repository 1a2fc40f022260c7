// SPDX-License-Identifier: GPL-2.0-or-later
// Springs for the ends of the strip (the header derives them), the bound of a node in a stage, and
// the force.
#include "contact/rod.h"

#include "base/memory.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
// Softness over ln(1/w)/(pi E*); the header says what it is fitted to.
static const double END_SOFTNESS = 4;
// A node with such a share is rigid: its spring would hardly yield beside the block, and be so
// stiff that forces could not be found to the solver's tolerance.
static const double WHOLE = 1 - 1e-4;

// origin is 0 here: where the nodes stand when the rod begins to move is set once the block is at
// rest. false with ERROR_MEMORY: *rod is half built, rod_destroy frees it.
bool rod_build(const Interface *interface, RodKind kind, double velocity, Rod *rod, Error *err)
{
    *rod = (Rod){.kind = kind, .velocity = velocity, .count = interface->rod_count};
    rod->origin = NEW_ARRAY(double, interface->rod_count, err);
    rod->softness = NEW_ARRAY(double, interface->rod_count, err);
    rod->lag = NEW_ARRAY(double, interface->rod_count, err);
    return rod->origin && rod->softness && rod->lag;
}

void rod_destroy(Rod *rod)
{
    memory_free_all(rod->origin, rod->softness, rod->lag);
    *rod = (Rod){0};
}

// END_SOFTNESS ln(1/w) / (pi E*) with w the node's share in (0, 1]; 0, rigid, for a node that is in
// the strip as good as wholly.
void rod_soften(const Interface *interface, const RodGround ground[2], Rod *rod)
{
    for (int32_t j = 0; j < interface->rod_count; j++) {
        const double *z = interface->rod_z;
        const RodGround *at = &ground[z[j] > 0.5 * (z[0] + z[interface->rod_count - 1])];
        double length = interface->rod_length ? interface->rod_length[j] : 1;
        double share = interface->rod_share[j] > WHOLE ? 1 : interface->rod_share[j];
        rod->softness[j] = -END_SOFTNESS * (log(share) / length) / (PI * at->modulus);
        rod->lag[j] = rod->softness[j] > 0 ? at->viscosity / at->modulus : 0;
    }
}

double rod_displacement(const Rod *rod, double time)
{
    if (rod->course) return rod_course_way(rod->course, time);
    return rod->way + rod->velocity * (time - rod->since);
}

double rod_velocity(const Rod *rod, double time)
{
    return rod->course ? rod_course_velocity(rod->course, time) : rod->velocity;
}

double rod_arrival(const Rod *rod, double way)
{
    if (rod->course) return rod_course_arrival(rod->course, way);
    return rod->velocity > 0 ? rod->since + (way - rod->way) / rod->velocity : INFINITY;
}

void rod_set_velocity(Rod *rod, double velocity, double time)
{
    rod->way = rod_displacement(rod, time);
    rod->since = time;
    rod->velocity = velocity;
}

// Length over time. A rigid node goes to origin + U within the stage: v = (origin + U - u*)/reach.
// At a soft one this is the velocity at which its spring carries nothing.
double rod_bound(const Rod *rod, int32_t j, double position, double time, double reach)
{
    double way = rod->origin[j] + rod_displacement(rod, time) - position;
    if (rod->softness[j] == 0) return way / reach;
    // r = [way - reach v + lag (V - v)] / softness = 0 at this v.
    return (way + rod->lag[j] * rod_velocity(rod, time)) / (reach + rod->lag[j]);
}

double rod_bound_on_spring(const Rod *rod, int32_t j, double position, double way, double reach)
{
    return (rod->origin[j] + way - position) / (reach + rod->lag[j]);
}

// Force per width, positive when the rod pushes along +x.
double rod_force(const Interface *interface, const double *reaction)
{
    double force = 0;
    for (int32_t j = 0; j < interface->rod_count; j++)
        force += reaction[interface_rod(interface, j)];
    return force;
}

void rod_archive(Rod *rod, Archive *archive)
{
    int32_t kind = (int32_t)rod->kind;
    archive_section(archive, "rod");
    archive_index(archive, &kind, ROD_AWAY, ROD_IS_BONDED + 1);
    rod->kind = (RodKind)kind;
    archive_numbers_of(archive, &rod->velocity, &rod->since, &rod->way);
    archive_numbers(archive, rod->origin, rod->count);
}
