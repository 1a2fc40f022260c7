// SPDX-License-Identifier: GPL-2.0-or-later
// A block of Q4 on the plane with everything a time integrator asks for, without gmsh: pressure on
// top, friction, a rod at mid-height. It starts in its exact equilibrium without friction, the
// uniform stress -P: u_z = -P z/E, u_x = nu P x/E, which Q4 represents.
#ifndef AMONTONS_TESTS_STEPPED_BLOCK_H
#define AMONTONS_TESTS_STEPPED_BLOCK_H

#include "algebra/dense.h"
#include "block_mesh.h"
#include "friction_by_hand.h"
#include "reduction/interface_operator.h"
#include "contact/rod.h"
#include "stepping/state.h"
#include "paper_material.h"
#include "plane.h"

typedef struct SteppedDef {
    int32_t cells;   // along each side
    double pressure;
    double eta;   // eta1 = eta2
    FrictionLaw law;
    RodKind rod_kind;
    double rod_velocity;
    int32_t branch_count;
    Branch branch[2];   // [branch_count] of the material
} SteppedDef;

typedef struct SteppedBlock {
    Mesh mesh;
    Material material;
    Bulk bulk;
    Interface interface;
    FrictionLaw law;
    Friction friction;   // everywhere by that law
    Rod rod;
    BulkOperator system;
    State state;
} SteppedBlock;

static const double STEPPED_LENGTH = 1, STEPPED_HEIGHT = 0.5;

static inline void stepped_block_start(const SteppedDef *def, SteppedBlock *block)
{
    double squeeze = def->pressure / block->material.young;
    State *state = &block->state;
    for (int32_t i = 0; i < block->mesh.node_count; i++) {
        const double *at = block->mesh.position + 2 * i;
        state->displacement[2 * i] = block->material.poisson * squeeze * at[0];
        state->displacement[2 * i + 1] = -squeeze * at[1];
    }
    bulk_operator_apply(&block->system, BULK_STIFFNESS, state->displacement, state->elastic_force);
    for (int32_t i = 0; i < block->interface.contact_count; i++)
        state->reaction[plane_normal(i)] = def->pressure * block->interface.weight[i];
    for (int32_t j = 0; j < block->rod.count; j++)
        block->rod.origin[j] = 0;   // the trailing face stands at x = 0
}

static inline void stepped_block_build(const SteppedDef *def, SteppedBlock *block)
{
    Error err = {0};
    dense_use_one_thread();
    *block = (SteppedBlock){.law = def->law, .material = paper_material()};
    block->friction = FRICTION_OF(&block->law);
    block->material.eta1 = block->material.eta2 = def->eta;
    BlockDef shape = {.kind = ELEMENT_Q4,
                      .nx = def->cells,
                      .nz = def->cells,
                      .length = STEPPED_LENGTH,
                      .height = STEPPED_HEIGHT};
    block_build(&shape, &block->mesh);
    MeshBoundary top;
    double traction[2] = {0, -def->pressure};
    InterfaceDef touching = {.has_rod = true,
                             .rod_name = "rod",
                             .rod_height = STEPPED_HEIGHT / 2,
                             .rod_width = 0.1 * STEPPED_HEIGHT};
    Bulk *bulk = &block->bulk;
    Interface *interface = &block->interface;
    for (; block->material.branch_count < def->branch_count; block->material.branch_count++)
        block->material.branch[block->material.branch_count] =
            def->branch[block->material.branch_count];
    Materials materials = materials_of(&block->material);
    bool built = bulk_create(&block->mesh, bulk, &err) &&
                 spectrum_find(&materials, 2, &bulk->spectrum, &err) &&
                 bulk_assemble(&block->mesh, &block->material, bulk, &err) &&
                 mesh_boundary(&block->mesh, "top", &top, &err);
    if (built) bulk_add_traction(&block->mesh, &top, traction, bulk);
    built = built && interface_build(&block->mesh, &touching, interface, &err) &&
            bulk_operator_create(bulk, block->mesh.position, interface->dofs, interface->count,
                                 &block->system, &err) &&
            rod_build(interface, def->rod_kind, def->rod_velocity, &block->rod, &err) &&
            state_create(&block->system, interface, &block->state, &err);
    if (!built) fail_msg("%s", err.message);
    stepped_block_start(def, block);
}

static inline void stepped_block_destroy(SteppedBlock *block)
{
    state_destroy(&block->state);
    rod_destroy(&block->rod);
    bulk_operator_destroy(&block->system);
    interface_destroy(&block->interface);
    bulk_destroy(&block->bulk);
    mesh_destroy(&block->mesh);
}

#endif
