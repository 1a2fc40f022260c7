// SPDX-License-Identifier: GPL-2.0-or-later
// The rig of block_rig.h for a block of space_mesh.h.
#ifndef AMONTONS_TESTS_SPACE_RIG_H
#define AMONTONS_TESTS_SPACE_RIG_H

#include "block_rig.h"
#include "space_mesh.h"

// The rod stands at half the height, as wide as def->rod_width. traction: on top.
static inline void space_rig_build(const SpaceDef *shape, const RigDef *def,
                                   const double traction[3], BlockRig *rig)
{
    Error err = {0};
    MeshBoundary top;
    dense_use_one_thread();
    memset(rig, 0, sizeof *rig);
    space_build(shape, &rig->mesh);
    rig->law = def->law;
    rig->friction = FRICTION_OF(&rig->law);
    Material material = def->material;
    material.plane_strain = true;
    InterfaceDef interface = {.has_rod = def->rod_width > 0,
                              .rod_name = "rod",
                              .rod_height = 0.5 * shape->size[2],
                              .rod_width = def->rod_width};
    bool done = bulk_create(&rig->mesh, &rig->bulk, &err) &&
                bulk_assemble(&rig->mesh, &material, &rig->bulk, &err) &&
                mesh_boundary(&rig->mesh, "top", &top, &err);
    if (done) bulk_add_traction(&rig->mesh, &top, traction, &rig->bulk);
    done = done && interface_build(&rig->mesh, &interface, &rig->interface, &err) &&
           bulk_operator_create(&rig->bulk, rig->mesh.position, rig->interface.dofs,
                                rig->interface.count, &rig->system, &err) &&
           rod_build(&rig->interface, def->rod_kind, def->rod_velocity, &rig->rod, &err);
    if (!done) fail_msg("%s", err.message);
    rig->block = (Block){&rig->system, &rig->interface, &rig->friction, &rig->rod, NULL};
}

#endif
