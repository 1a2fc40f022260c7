// SPDX-License-Identifier: GPL-2.0-or-later
// A block of block_mesh.h with all that stepping needs: material, loads, interface, rod, operator
// of the full mesh. A rig must not be moved once it is built.
#ifndef AMONTONS_TESTS_BLOCK_RIG_H
#define AMONTONS_TESTS_BLOCK_RIG_H

#include "algebra/dense.h"
#include "block_mesh.h"
#include "dense_by_hand.h"
#include "friction_by_hand.h"
#include "stepping/step_control.h"
#include "paper_material.h"

typedef struct RigDef {
    BlockDef block;
    Material material;
    FrictionLaw law;
    const Friction *friction;   // NULL: everywhere by that law
    RodKind rod_kind;
    double rod_velocity, rod_height, rod_width;   // width 0: no rod nodes
    double traction[2];   // on top, (x, z), stress
} RigDef;

typedef struct BlockRig {
    Mesh mesh;
    Bulk bulk;
    Interface interface;
    BulkOperator system;
    FrictionLaw law;
    Friction friction;   // everywhere by that law
    Rod rod;
    Block block;
} BlockRig;

static inline RigDef rig_def(void)
{
    return (RigDef){.block = {.kind = ELEMENT_Q4, .nx = 4, .nz = 2, .length = 1, .height = 0.5},
                    .material = paper_material(),
                    .law = {.kind = FRICTION_LINEAR_WEAKENING,
                            .mu_static = 0.38,
                            .mu_kinetic = 0.1,
                            .critical_velocity = 3.4e-4},   // the paper's set A
                    .rod_height = 0.25,
                    .rod_width = 0.1,
                    .traction = {0, -0.003}};
}

static inline void rig_build(const RigDef *def, BlockRig *rig)
{
    Error err = {0};
    MeshBoundary top;
    dense_use_one_thread();
    memset(rig, 0, sizeof *rig);
    block_build(&def->block, &rig->mesh);
    rig->law = def->law;
    rig->friction = def->friction ? *def->friction : FRICTION_OF(&rig->law);
    InterfaceDef interface = {.has_rod = def->rod_width > 0,
                              .rod_name = "rod",
                              .rod_height = def->rod_height,
                              .rod_width = def->rod_width};
    Materials materials = materials_of(&def->material);
    bool done = bulk_create(&rig->mesh, &rig->bulk, &err) &&
                spectrum_find(&materials, 2, &rig->bulk.spectrum, &err) &&
                bulk_assemble(&rig->mesh, &def->material, &rig->bulk, &err) &&
                mesh_boundary(&rig->mesh, "top", &top, &err);
    if (done) bulk_add_traction(&rig->mesh, &top, def->traction, &rig->bulk);
    done = done && interface_build(&rig->mesh, &interface, &rig->interface, &err) &&
           bulk_operator_create(&rig->bulk, rig->mesh.position, rig->interface.dofs,
                                rig->interface.count, &rig->system, &err) &&
           rod_build(&rig->interface, def->rod_kind, def->rod_velocity, &rig->rod, &err);
    if (!done) fail_msg("%s", err.message);
    rig->block = (Block){&rig->system, &rig->interface, &rig->friction, &rig->rod, NULL};
}

static inline void rig_destroy(BlockRig *rig)
{
    rod_destroy(&rig->rod);
    bulk_operator_destroy(&rig->system);
    interface_destroy(&rig->interface);
    bulk_destroy(&rig->bulk);
    mesh_destroy(&rig->mesh);
}

// A dense copy of K, C (of `values`) in the mesh's order of unknowns.
static inline double *rig_dense(const BlockRig *rig, const double *values)
{
    int32_t n = rig->bulk.dof_count;
    double *a = hand_matrix(n, n);
    for (int32_t j = 0; j < n; j++)
        for (int32_t k = rig->bulk.pattern.start[j]; k < rig->bulk.pattern.start[j + 1]; k++)
            a[j * n + rig->bulk.pattern.index[k]] = values[k];
    return a;
}

#endif
