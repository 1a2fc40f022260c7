// SPDX-License-Identifier: GPL-2.0-or-later
// Quantities that a caller of amontons.h may read between two steps.
#include "base/decimal_point.h"
#include "base/memory.h"
#include "fem/floor.h"
#include "run/simulation_state.h"
#include "run/summary.h"

void amontons_simulation_view(const Simulation *simulation, StepView *view)
{
    *view =
        step_view(&simulation->seen, &simulation->events, &simulation->contact, simulation->t_end);
}

// Recovered at each call: a product with all modes of a reduced bulk.
bool amontons_simulation_block(Simulation *simulation, BlockView *view, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    const Mesh *mesh = &simulation->model.mesh;
    const BulkOperator *system = &simulation->model.system;
    const State *now = &simulation->control.now;
    *view = (BlockView){0};
    if (!simulation->options.whole_block)
        return REFUSE(
            err,
            "the motion of the whole block is kept only where RunOptions.whole_block asks for it");
    int64_t dofs = (int64_t)mesh->dim * mesh->node_count;
    if (!simulation->block_motion && !(simulation->block_motion = NEW_ARRAY(double, 2 * dofs, err)))
        return false;
    double *displacement = simulation->block_motion;
    double *velocity = displacement + dofs;
    if (!bulk_operator_recover(system, 2, (const double *[]){now->displacement, now->velocity},
                               (double *[]){displacement, velocity}, err))
        return false;
    floor_displace(mesh, displacement);
    floor_displace(mesh, velocity);
    *view = (BlockView){.nodes = mesh->node_count,
                        .dimensions = mesh->dim,
                        .elements = mesh->element_count,
                        .position = mesh->position,
                        .displacement = displacement,
                        .velocity = velocity,
                        .first_node = mesh->first_node,
                        .element_nodes = mesh->element_nodes};
    return true;
}
