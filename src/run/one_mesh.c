// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/simulation_state.h"

#include "run/warnings.h"

#include <math.h>

enum { END_NODES = 2 };   // with so few left to slip, they decide when the block slides
// They did not where mu rises by more than this part after they, too, have begun to slip.
static const double AFTERWARDS = 0.1;
static const double ROUNDING = 1e-6;   // of positions, in cells

void one_mesh_read(const Simulation *simulation, Level *level)
{
    level->contact_nodes = simulation->model.interface.contact_count;
    level->nodes_along = interface_nodes_along(&simulation->model.interface);
    level->pads = simulation->model.interface.pad_count;
    level->space = simulation->model.interface.dim > 2;

    // A level is undamped where friction weakens faster than viscosity can damp on most nodes.
    double worst = 0;
    int32_t undamped =
        undamped_nodes(&simulation->control.certificate, simulation->model.scales.load, &worst);
    level->undamped = 2 * undamped > simulation->model.interface.contact_count;
}

void one_mesh_answer(const Simulation *simulation, Answers *answers)
{
    Level level = {0};
    if (simulation->model.interface.contact_count == 0) return;   // it failed before it had a mesh
    one_mesh_read(simulation, &level);
    level_answer_for(&level, answers);
}

// --- its last nodes -----------------------------------------------------------------------------

// Cells from the front to the leading end.
static double cells_left(const Interface *interface, double front)
{
    int32_t last = interface->contact_count - 1;
    double end = interface->x[last];
    return (end - front) / (end - interface->x[last - 1]);
}

static bool has_end(const Interface *interface)
{
    return interface->dim == 2 && interface->pad_count == 1 && interface->contact_count > END_NODES;
}

void end_wait_watch(EndWait *wait, const Simulation *simulation)
{
    const Interface *interface = &simulation->model.interface;
    const Events *events = &simulation->events;
    const Drops *drops = &simulation->drops;
    if (!has_end(interface)) return;
    bool in_event = events->rapid >= 0 || events->ended;
    double left = cells_left(interface, simulation->seen.front), mu = simulation->seen.mu;
    if (!in_event && isnan(wait->mu) && left < END_NODES - ROUNDING) wait->mu = mu;
    if (!in_event && isnan(wait->passed) && left < ROUNDING) wait->passed = mu;
    if (events->crossed && drops->count > 1) {
        double peak = drops->list[drops->count - 1].mu, rise = peak - wait->mu;
        wait->slidings++;
        if (rise > 0 && !(peak - wait->passed > AFTERWARDS * rise)) wait->rise += rise;
    }
    if (in_event) wait->mu = wait->passed = NAN;
}

double end_wait_of(const EndWait *wait, const Interface *interface, double critical_length)
{
    if (!has_end(interface) || isnan(critical_length) || wait->slidings == 0) return 0;
    bool waits = cells_left(interface, critical_length) < END_NODES - ROUNDING;
    return waits ? wait->rise / wait->slidings : 0;
}
