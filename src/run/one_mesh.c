// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/one_mesh.h"

#include "run/warnings.h"

#include <math.h>

// On most nodes friction weakens faster than viscosity can damp.
static bool is_undamped(const Simulation *simulation)
{
    double worst = 0;
    int32_t undamped =
        undamped_nodes(&simulation->control.certificate, simulation->model.scales.load, &worst);
    return 2 * undamped > simulation->model.interface.contact_count;
}

void one_mesh_read(const Simulation *simulation, Level *level)
{
    level->contact_nodes = simulation->model.interface.contact_count;
    level->nodes_along = interface_nodes_along(&simulation->model.interface);
    level->space = simulation->model.interface.dim > 2;
    level->undamped = is_undamped(simulation);
}

void one_mesh_answer(const Simulation *simulation, const Event *least, Answers *answers)
{
    Level level = {.slip_cells = least ? least->slip_cells : (double)NAN};
    if (simulation->model.interface.contact_count == 0) return;   // it failed before it had a mesh
    one_mesh_read(simulation, &level);
    level_answer_for(&level, answers);
}
