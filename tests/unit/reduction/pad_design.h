// SPDX-License-Identifier: GPL-2.0-or-later
// A design of meshes/pads.geo in cells of 1/80: assembled, scaled, cut at the line above its pads.
#ifndef AMONTONS_TESTS_PAD_DESIGN_H
#define AMONTONS_TESTS_PAD_DESIGN_H

#include "base/memory.h"
#include "reduction/upper_block.h"
#include "near.h"

typedef struct PadDesign {
    double n, fill, height, pad_height;   // meshes/pads.geo
    double rod;   // height of the rod's node over the pads
    double poisson, load_x;   // load_x: of the load on top, which is 1 downwards
    const char *layout, *ends;
} PadDesign;

static const PadDesign PAD_DESIGN = {2, 0.6, 0.6, 0.05, 0.25, 0.34, 0, "regular", "open"};
enum { PAD_PARAMETERS = 9 };

typedef struct PadBlock {
    Mesh mesh;
    ReductionBlock block;
    int32_t interface_count;
    int32_t *dofs;   // [interface_count] of the contact, then x of a rod node
    UpperBlock upper;
    char name[HASH_TEXT_SIZE];   // of the upper block
} PadBlock;

static inline void pad_block_read(PadDesign design, Mesh *mesh)
{
    Error err = {0};
    MeshFile file;
    char path[600];
    MeshParameter parameters[PAD_PARAMETERS] = {{"n", design.n, ""},
                                                {"fill", design.fill, ""},
                                                {"height", design.height, ""},
                                                {"pad_height", design.pad_height, ""},
                                                {"size_contact", 0.0125, ""},
                                                {"size_bulk", 0.0125, ""},
                                                {"length", 1, ""},
                                                {"layout", 0, ""},
                                                {"ends", 0, ""}};
    snprintf(parameters[7].text, GROUP_NAME_SIZE, "%s", design.layout);
    snprintf(parameters[8].text, GROUP_NAME_SIZE, "%s", design.ends);
    snprintf(path, sizeof path, "%s/meshes/pads.geo", getenv("AMONTONS_SOURCE"));
    if (!mesh_file_read(path, parameters, PAD_PARAMETERS, &file, &err) ||
        !mesh_build(&file, path, mesh, &err))
        fail_msg("%s", err.message);
}

static inline void pad_block_list_interface(PadDesign design, PadBlock *made)
{
    Error err = {0};
    MeshContact contact;
    MeshCurve rod;
    int32_t nearest = 0;
    double height = design.pad_height + design.rod;
    assert_true(mesh_contact(&made->mesh, NULL, 0, &contact, &err));
    assert_true(mesh_curve(&made->mesh, "rod", &rod, &err));
    made->interface_count = 2 * contact.node_count + 1;
    made->dofs = calloc((size_t)made->interface_count, sizeof *made->dofs);
    for (int32_t k = 0; k < 2 * contact.node_count; k++)
        made->dofs[k] = 2 * contact.nodes[k / 2] + k % 2;
    for (int32_t i = 0; i < rod.node_count; i++)
        if (fabs(made->mesh.position[2 * rod.nodes[i] + 1] - height) <
            fabs(made->mesh.position[2 * rod.nodes[nearest] + 1] - height))
            nearest = i;
    made->dofs[made->interface_count - 1] = 2 * rod.nodes[nearest];
    mesh_contact_destroy(&contact);
}

static inline void pad_block_build(PadDesign design, PadBlock *made)
{
    Error err = {0};
    Bulk bulk;
    MeshCurve top;
    Material material = {1, design.poisson, 1, 1, 1, false};
    Materials materials = materials_of(&material);
    double traction[2] = {design.load_x, -1}, largest = 0;
    memset(made, 0, sizeof *made);
    pad_block_read(design, &made->mesh);
    assert_true(bulk_assemble(&made->mesh, &material, &bulk, &err));
    assert_true(mesh_curve(&made->mesh, "top", &top, &err));
    bulk_add_traction(&made->mesh, &top, traction, &bulk);
    for (int32_t k = 0; k < bulk.dof_count; k++) largest = fmax(largest, fabs(bulk.load[k]));
    assert_true(
        reduction_block_create(&made->mesh, &bulk, &materials, largest, &made->block, &err));
    bulk_destroy(&bulk);
    pad_block_list_interface(design, made);
    if (!upper_block_create(&made->mesh, &made->block, made->dofs, made->interface_count,
                            &made->upper, &err))
        fail_msg("%s", err.message);
    if (made->upper.interface_count == 0) return;
    Hash hash = hash_start();
    reduction_block_hash(&made->upper.block, &made->upper.mesh, made->upper.interface_dofs,
                         made->upper.interface_count, &hash);
    hash_write(&hash, made->name);
}

static inline void pad_block_destroy(PadBlock *made)
{
    upper_block_destroy(&made->upper);
    reduction_block_destroy(&made->block);
    mesh_destroy(&made->mesh);
    free(made->dofs);
}

#endif
