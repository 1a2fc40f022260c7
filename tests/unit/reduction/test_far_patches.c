// SPDX-License-Identifier: GPL-2.0-or-later
// Patches of a rectangle of even cells, whose distances and nearest nodes can be counted.
#include "reduction/far_patches.h"
#include "reduced_block.h"

static const Material MATERIAL = {.young = 2, .poisson = 0.3, .density = 3, .eta1 = 1, .eta2 = 0.5};
static const double LOAD = 0.003;
enum { NX = 255, NZ = 140, CONTACT = 2 * (NX + 1), DISTANCE = 15, LAYERS = 3 };

// The contact alone, from left to right: u_x and u_z of each node take turns.
static void list_contact(const ReducedBlock *block, int32_t *dofs)
{
    const double *position = block->mesh.position;
    int32_t found = 0;
    for (int32_t i = 0; i < block->mesh.node_count; i++) {
        if (position[2 * i + 1] != 0) continue;
        int32_t column = (int32_t)round(position[2 * i] * NX);
        dofs[2 * column] = 2 * i;
        dofs[2 * column + 1] = 2 * i + 1;
        found += 2;
    }
    assert_int_equal(found, CONTACT);
}

// Rows 1 to 15 are near; layers of 15, 30 and, to the top, 80 rows follow, of 16, 8 and 4 parts.
TEST(test_rectangle)
{
    Error err = {0};
    ReducedBlock block;
    FarPatches patches;
    int32_t contact[CONTACT];
    const int32_t end[LAYERS] = {30, 60, NZ}, parts[LAYERS] = {16, 8, 4};
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = NX, .nz = NZ, .length = 1, .height = 0.5};
    reduced_block_build(&shape, &MATERIAL, LOAD, 0, &block);
    list_contact(&block, contact);
    assert_true(far_patches_create(&block.bulk.pattern, contact, CONTACT, &patches, &err));
    assert_int_equal(patches.distance, DISTANCE);
    assert_int_equal(patches.count, 16 + 8 + 4);
    for (int32_t i = 0; i < block.mesh.node_count; i++) {
        int32_t row = (int32_t)round(block.mesh.position[2 * i + 1] * NZ / 0.5), layer = 0;
        int32_t column = (int32_t)round(block.mesh.position[2 * i] * NX), before = 0;
        assert_int_equal(patches.of[2 * i], patches.of[2 * i + 1]);
        if (row <= DISTANCE) {
            assert_int_equal(patches.of[2 * i], NO_PATCH);
            continue;
        }
        while (row > end[layer]) before += parts[layer++];
        int32_t part = patches.of[2 * i] - before, width = (NX + 1) / parts[layer];
        assert_in_range(part, 0, parts[layer] - 1);
        // The node straight below, or, of two equally near the middle, the one beside it.
        if (column < part * width - 1 || column > (part + 1) * width)
            fail_msg("node %d of row %d is in part %d of layer %d", column, row, part, layer);
    }
    far_patches_destroy(&patches);
    reduced_block_destroy(&block);
}

// Each far unknown stands once in the list of its patch, in order.
TEST(test_lists)
{
    Error err = {0};
    ReducedBlock block;
    FarPatches patches;
    const BlockDef shape = {.kind = ELEMENT_T3, .nx = 60, .nz = 90, .length = 1, .height = 1};
    reduced_block_build(&shape, &MATERIAL, LOAD, 0, &block);
    assert_true(
        far_patches_create(&block.bulk.pattern, block.dofs, block.interface_count, &patches, &err));
    assert_true(patches.count > 2);
    int32_t listed = 0, far = 0;
    for (int32_t p = 0; p < patches.count; p++) {
        const PatchModes *patch = &patches.modes[p];
        assert_true(patch->size > 0);
        for (int32_t i = 0; i < patch->size; i++, listed++) {
            assert_int_equal(patches.of[patch->dofs[i]], p);
            assert_int_equal(patches.place[patch->dofs[i]], i);
            assert_true(i == 0 || patch->dofs[i] > patch->dofs[i - 1]);
        }
    }
    for (int32_t k = 0; k < block.bulk.dof_count; k++) far += patches.of[k] != NO_PATCH;
    assert_int_equal(listed, far);
    for (int32_t j = 0; j < block.interface_count; j++)
        assert_int_equal(patches.of[block.dofs[j]], NO_PATCH);
    far_patches_destroy(&patches);
    reduced_block_destroy(&block);
}
