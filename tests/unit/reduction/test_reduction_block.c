// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks of one shape give one block to make a basis of, to the last bit, whatever their length,
// place and units; and another name goes with everything that the basis depends on.
#include "reduction/reduction_block.h"

#include "block_mesh.h"
#include "base/memory.h"

static const BlockDef SHAPE = {
    .kind = ELEMENT_T6, .nx = 7, .nz = 5, .length = 1, .height = 0.5, .distortion = 0.2};
static const Material MATERIAL = {.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1};

typedef struct Case {
    double length, shift;   // of the block, and how far along x it stands
    Material material;
    double load, load_x;   // on the top
    int32_t held;   // unknown that is held; -1: none
    int32_t moved;   // node that stands a millionth of the length further up; -1: none
    int32_t interface;   // unknowns of it
} Case;

#define MATERIAL(...)                                                                              \
    {                                                                                              \
        __VA_ARGS__, .branch_count = 0                                                             \
    }
static const Case BASE = {1, 0, MATERIAL(1, 0.34, 1, 1, 1, false), 0.003, 0.001, -1, -1, 12};

// Builds mesh and bulk of a case, then the block and its name.
static void build(Case what, Mesh *mesh, ReductionBlock *block, char name[HASH_TEXT_SIZE])
{
    Error err = {0};
    Bulk bulk;
    MeshBoundary top;
    double traction[2] = {what.load_x, -what.load};
    int32_t dofs[32];
    block_build(&SHAPE, mesh);
    for (int32_t i = 0; i < 2 * mesh->node_count; i++)
        mesh->position[i] = mesh->position[i] * what.length + (i % 2 ? 0 : what.shift);
    mesh->x_min = what.shift;
    mesh->x_max = what.length + what.shift;
    if (what.moved >= 0) mesh->position[2 * what.moved + 1] += 1e-6 * what.length;
    assert_true(bulk_create(mesh, &bulk, &err));
    assert_true(mesh_boundary(mesh, "top", &top, &err));
    bulk_add_traction(mesh, &top, traction, &bulk);
    if (what.held >= 0) bulk_hold(what.held, &bulk);
    double largest = 0;
    for (int32_t k = 0; k < bulk.dof_count; k++) largest = fmax(largest, fabs(bulk.load[k]));
    Materials materials = materials_of(&what.material);
    if (!reduction_block_create(mesh, &bulk, &materials, largest, block, &err) ||
        !reduction_block_assemble(mesh, block, &err))
        fail_msg("%s", err.message);
    for (int32_t k = 0; k < what.interface; k++) dofs[k] = k;
    Hash hash = hash_start();
    reduction_block_hash(block, mesh, dofs, what.interface, &hash);
    hash_write(&hash, name);
    bulk_destroy(&bulk);
}

// Same bits, in numbers that no rounding of the scene's could hide: M, C, K and f.
TEST(test_similar_blocks_are_one)
{
    Case cases[] = {BASE, BASE, BASE, BASE};
    cases[0].length = 0.04;
    cases[1] = (Case){4, -1.7, MATERIAL(1, 0.34, 7, 1, 1, false), 0.3, 0.1, -1, -1, 12};
    cases[2] = (Case){0.1, 0, MATERIAL(3e9, 0.34, 1200, 6e4, 6e4, false), 2e6, 2e6 / 3, -1, -1, 12};
    cases[3].length = 1.0 / 3;
    Mesh mesh, other;
    ReductionBlock base, block;
    char name[HASH_TEXT_SIZE], same[HASH_TEXT_SIZE];
    build(BASE, &mesh, &base, name);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        build(cases[k], &other, &block, same);
        assert_string_equal(same, name);
        size_t dofs = (size_t)base.bulk.dof_count, entries = (size_t)base.bulk.pattern.start[dofs];
        assert_memory_equal(block.bulk.mass, base.bulk.mass, dofs * sizeof(double));
        assert_memory_equal(block.bulk.load, base.bulk.load, dofs * sizeof(double));
        assert_memory_equal(block.bulk.stiffness, base.bulk.stiffness, entries * sizeof(double));
        assert_memory_equal(block.bulk.damping, base.bulk.damping, entries * sizeof(double));
        reduction_block_destroy(&block);
        mesh_destroy(&other);
    }
    reduction_block_destroy(&base);
    mesh_destroy(&mesh);
}

// Normalised: K/E of a material with other E is the one of E = 1, on the scene's own mesh.
TEST(test_normalised)
{
    Error err = {0};
    Case si = BASE;
    si.length = 0.1;
    si.material = (Material)MATERIAL(3e9, 0.37, 1200, 6e4, 4e4, true);
    Mesh mesh;
    Bulk bulk;
    ReductionBlock block;
    char name[HASH_TEXT_SIZE];
    build(si, &mesh, &block, name);
    assert_true(bulk_create(&mesh, &bulk, &err) && bulk_assemble(&mesh, &si.material, &bulk, &err));
    int32_t entries = bulk.pattern.start[bulk.dof_count];
    for (int32_t k = 0; k < entries; k++) {
        assert_near("K", block.bulk.stiffness[k], bulk.stiffness[k] / 3e9, 1e-6);
        assert_near("C", block.bulk.damping[k], bulk.damping[k] / 1e5, 1e-6);
    }
    double total = 0, largest = 0;
    for (int32_t k = 0; k < bulk.dof_count; k++) {
        total += block.bulk.mass[k] / 2;
        largest = fmax(largest, fabs(block.bulk.load[k]));
    }
    assert_near("mass", total, 0.5, 1e-8);   // of a block of length 1 and height 1/2
    assert_near("load", largest, 1, 1e-9);
    bulk_destroy(&bulk);
    reduction_block_destroy(&block);
    mesh_destroy(&mesh);
}

TEST(test_names)
{
    Case cases[8];
    for (int k = 0; k < 8; k++) cases[k] = BASE;
    cases[1].material.poisson = 0.35;
    cases[2].material.plane_strain = true;
    cases[3].material.eta2 = 1.1;
    cases[4].load_x = 0.002;
    cases[5].held = 30;
    cases[6].moved = 20;
    cases[7].interface = 11;
    char names[8][HASH_TEXT_SIZE];
    for (int k = 0; k < 8; k++) {
        Mesh mesh;
        ReductionBlock block;
        build(cases[k], &mesh, &block, names[k]);
        reduction_block_destroy(&block);
        mesh_destroy(&mesh);
        for (int j = 0; j < k; j++)
            if (strcmp(names[j], names[k]) == 0) fail_msg("cases %d and %d share a name", j, k);
    }
}

TEST(test_memory_faults)
{
    Error err = {0};
    Mesh mesh;
    Bulk bulk;
    ReductionBlock block;
    block_build(&SHAPE, &mesh);
    assert_true(bulk_create(&mesh, &bulk, &err));
    int64_t live = memory_counters().live;
    bool done = false;
    Materials materials = materials_of(&MATERIAL);
    for (int32_t k = 0; !done; k++) {
        err = (Error){0};
        memory_fail_after(k);
        done = reduction_block_create(&mesh, &bulk, &materials, 1, &block, &err) &&
               reduction_block_assemble(&mesh, &block, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        reduction_block_destroy(&block);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 30);
    }
    bulk_destroy(&bulk);
    mesh_destroy(&mesh);
}
