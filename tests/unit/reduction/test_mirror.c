// SPDX-License-Identifier: GPL-2.0-or-later
// A block reduced in its symmetric and its antisymmetric part against its full matrices, dense and
// by hand: S within what the reduction allows, products and solves to rounding, rigid motions
// without interior coordinates. The load pushes to one side, and the rod is on one: only the block
// is its own mirror image.
#include "base/memory.h"
#include "reduction/mirror.h"
#include "reduction/reduction.h"
#include "unit/reduction/reduced_checks.h"

static const Material MATERIAL = {
    .young = 2.5, .poisson = 0.3, .density = 1.7, .eta1 = 0.4, .eta2 = 0.9};
static const double LOAD = 0.3, TOLERANCE = 2e-2;

// Columns even in number and odd, so that there is a node in the middle of the contact or none.
static const BlockDef SHAPES[] = {
    {.kind = ELEMENT_Q4, .nx = 8, .nz = 5, .length = 1.4, .height = 0.6},
    {.kind = ELEMENT_Q4, .nx = 7, .nz = 6, .length = 1.4, .height = 0.8},
    {.kind = ELEMENT_Q9, .nx = 4, .nz = 3, .length = 1.4, .height = 0.6},
};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

// [nodes], NULL: some have none.
static int32_t *node_images(const ReducedBlock *block)
{
    Error err = {0};
    int32_t nodes = block->mesh.node_count, *image;
    double *position = hand_matrix(2 * nodes, 1);
    memcpy(position, block->mesh.position, 2 * (size_t)nodes * sizeof *position);
    assert_true(mirror_nodes_find(2, 0, position, nodes, &image, &err));
    free(position);
    return image;
}

static void find_mirror(const ReducedBlock *block, Mirror *mirror)
{
    Error err = {0};
    int32_t *image = node_images(block);
    *mirror = (Mirror){0};
    if (image)
        assert_true(
            mirror_find(&block->bulk, &image, block->dofs, block->interface_count, mirror, &err));
    memory_free(image);
}

static bool reduce(ReducedBlock *block, int32_t *image, Error *err)
{
    block->def.node_image = &image;
    return reduction_build(&block->bulk, block->dofs, block->interface_count, &block->def,
                           &block->reduced, err);
}

// `block` with its reduced bulk in two parts.
static void build(const BlockDef *shape, ReducedBlock *block)
{
    Error err = {0};
    Mirror mirror;
    reduced_block_build(shape, &MATERIAL, LOAD, 0, block);
    block->def.tolerance = TOLERANCE;
    find_mirror(block, &mirror);
    assert_int_equal(mirror.part_count, 2);
    assert_int_equal(mirror.mirrored, 1);   // of the rod node's x
    assert_int_equal(mirror.part[0].bulk.dof_count + mirror.part[1].bulk.dof_count,
                     block->bulk.dof_count);
    mirror_destroy(&mirror);
    int32_t *image = node_images(block);
    if (!reduce(block, image, &err)) fail_msg("%s", err.message);
    assert_int_equal(block->reduced.part_count, 2);
    memory_free(image);
}

TEST(test_response)
{
    static const OperatorTerms ASKED[] = {
        {.stiffness = 1, .mass = 1e-3}, {.stiffness = 1, .damping = 1, .mass = 1e-2},
        {.stiffness = 1, .mass = 3},    {.damping = 1, .mass = 50},
        {.stiffness = 1, .mass = 1000}, {.stiffness = 0.1, .damping = 2, .mass = 0.1},
        {.damping = 3, .mass = 1e-3}};
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        build(&SHAPES[s], &block);
        assert_true(block.reduced.count < block.bulk.dof_count);
        for (size_t k = 0; k < sizeof ASKED / sizeof *ASKED; k++) {
            double least, largest, *full = full_schur(&block, ASKED[k]);
            double *reduced = reduced_schur(&block.reduced, ASKED[k]);
            energy_differences(reduced, full, block.interface_count, &least, &largest);
            double inertia = ASKED[k].mass * block.def.scales.mass /
                             (ASKED[k].stiffness * block.def.scales.stiffness +
                              ASKED[k].damping * block.def.scales.damping);
            assert_true(least > -ROUNDING);   // a Galerkin projection is too stiff
            assert_true(largest < reduced_bulk_error(&block.reduced, inertia) + ROUNDING);
            free(full), free(reduced);
        }
        reduced_block_destroy(&block);
    }
}

// Parts that are built one after another, as where memory is short, are those built side by side.
TEST(test_one_by_one)
{
    Error err = {0};
    ReducedBlock side_by_side, one_by_one;
    build(&SHAPES[0], &side_by_side);
    build(&SHAPES[0], &one_by_one);
    reduced_bulk_destroy(&one_by_one.reduced);
    int32_t *image = node_images(&one_by_one);
    one_by_one.def.one_by_one = true;
    if (!reduce(&one_by_one, image, &err)) fail_msg("%s", err.message);
    memory_free(image);
    assert_int_equal(one_by_one.reduced.part_count, 2);
    for (int p = 0; p < 2; p++) {
        const ReducedPart *one = &side_by_side.reduced.part[p],
                          *other = &one_by_one.reduced.part[p];
        assert_int_equal(one->count, other->count);
        assert_memory_equal(one->damping, other->damping,
                            (size_t)one->count * (size_t)one->count * sizeof(double));
        assert_memory_equal(one->masses, other->masses,
                            (size_t)(one->count - one->border_count) * sizeof(double));
    }
    reduced_block_destroy(&side_by_side);
    reduced_block_destroy(&one_by_one);
}

TEST(test_operator)
{
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        build(&SHAPES[s], &block);
        check_operator(&block, 43);
        reduced_block_destroy(&block);
    }
}

TEST(test_rigid_motions_and_load)
{
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        build(&SHAPES[s], &block);
        check_rigid_motions_and_load(&block, LOAD);
        reduced_block_destroy(&block);
    }
}

// A node moved, a layer of another material on one side: no image, or not its own.
TEST(test_what_is_none)
{
    Mirror mirror;
    ReducedBlock block;
    BlockDef shaken = SHAPES[0];
    shaken.distortion = 0.1;
    reduced_block_build(&shaken, &MATERIAL, LOAD, 0, &block);
    find_mirror(&block, &mirror);
    assert_int_equal(mirror.part_count, 0);
    reduced_block_destroy(&block);

    reduced_block_build(&SHAPES[0], &MATERIAL, LOAD, 0, &block);
    block.bulk.stiffness[0] *= 1 + 1e-6;
    find_mirror(&block, &mirror);
    assert_int_equal(mirror.part_count, 0);
    block.bulk.stiffness[0] /= 1 + 1e-6;
    block.bulk.mass[0] *= 1 + 1e-6;
    find_mirror(&block, &mirror);
    assert_int_equal(mirror.part_count, 0);
    block.bulk.mass[0] /= 1 + 1e-6;
    find_mirror(&block, &mirror);
    assert_int_equal(mirror.part_count, 2);
    mirror_destroy(&mirror);
    bulk_hold(1, &block.bulk);   // a support on one side
    find_mirror(&block, &mirror);
    assert_int_equal(mirror.part_count, 0);
    reduced_block_destroy(&block);

    // Triangles whose diagonals all lean to one side.
    BlockDef leaning = SHAPES[0];
    leaning.kind = ELEMENT_T3;
    reduced_block_build(&leaning, &MATERIAL, LOAD, 0, &block);
    find_mirror(&block, &mirror);
    assert_int_equal(mirror.part_count, 0);
    reduced_block_destroy(&block);
}

// Without a rod node nothing is mirrored; with those of the contact's left half there are as many
// as on the contact's right half, which is too one-sided. What is counted is found.
TEST(test_mirrored)
{
    Error err = {0};
    ReducedBlock block;
    Mirror mirror;
    int32_t parts;
    reduced_block_build(&SHAPES[0], &MATERIAL, LOAD, 0, &block);
    block.def.tolerance = TOLERANCE;
    for (int32_t less = 0; less < 2; less++) {
        block.interface_count -= less == 0 ? 1 : 2;   // the rod's x, then contact nodes at one end
        find_mirror(&block, &mirror);
        assert_int_equal(mirror.part_count, 2);
        assert_int_equal(mirror.mirrored, 2 * less);
        int32_t *image = node_images(&block), *images[DIM_MAX - 1] = {image};
        assert_true(mirror_count_parts(&block.bulk, images, block.dofs, block.interface_count,
                                       &parts, &err));
        assert_int_equal(parts, 2);
        assert_true(reduce(&block, image, &err));
        assert_int_equal(block.reduced.part_count, 2);
        memory_free(image);
        OperatorTerms terms = {.stiffness = 1, .mass = 3};
        double least, largest, *full = full_schur(&block, terms);
        double *reduced = reduced_schur(&block.reduced, terms);
        energy_differences(reduced, full, block.interface_count, &least, &largest);
        assert_true(least > -ROUNDING && largest < 0.5 && largest > 0);
        free(full), free(reduced);
        reduced_bulk_destroy(&block.reduced);
        mirror_destroy(&mirror);
    }
    block.interface_count = 8;   // four nodes on one side
    find_mirror(&block, &mirror);
    assert_int_equal(mirror.part_count, 0);
    int32_t *image = node_images(&block), *images[DIM_MAX - 1] = {image};
    assert_true(
        mirror_count_parts(&block.bulk, images, block.dofs, block.interface_count, &parts, &err));
    assert_int_equal(parts, 1);
    memory_free(image);
    reduced_block_destroy(&block);
}

// --- a lattice of springs in space, its own image along both axes of the floor -------------------

enum { NX = 5, NY = 4, NZ = 3, NODES = NX * NY * NZ, DOFS = 3 * NODES, FLOOR = 3 * NX * NY };

typedef struct Lattice {
    double place[DOFS];
    double stiffness[DOFS * DOFS], damping[DOFS * DOFS], mass[DOFS], load[DOFS];
    int32_t start[DOFS + 1], index[DOFS * DOFS], dofs[FLOOR + 1];
    uint8_t held[DOFS];
    Bulk bulk;
    ReductionDef def;
} Lattice;

static void add_spring(double k, const double *way, int32_t one, int32_t other, double *a)
{
    for (int32_t i = 0; i < 3; i++)
        for (int32_t j = 0; j < 3; j++) {
            double force = k * way[i] * way[j];
            a[(3 * one + i) * DOFS + 3 * one + j] += force;
            a[(3 * other + i) * DOFS + 3 * other + j] += force;
            a[(3 * one + i) * DOFS + 3 * other + j] -= force;
            a[(3 * other + i) * DOFS + 3 * one + j] -= force;
        }
}

// The floor's nodes, and x of a node on one side (the rod's).
static void build_lattice(Lattice *lattice)
{
    memset(lattice, 0, sizeof *lattice);
    for (int32_t n = 0; n < NODES; n++) {
        double *at = lattice->place + 3 * n;
        at[0] = 0.25 * (n % NX), at[1] = 0.2 * (n / NX % NY), at[2] = 0.3 * (n / (NX * NY));
        for (int32_t d = 0; d < 3; d++) lattice->mass[3 * n + d] = 1.0 / NODES;
        lattice->load[3 * n] = 0.1 * n;
    }
    for (int32_t one = 0; one < NODES; one++)
        for (int32_t other = 0; other < one; other++) {
            double way[3], square = 0;
            for (int32_t d = 0; d < 3; d++) {
                way[d] = lattice->place[3 * one + d] - lattice->place[3 * other + d];
                square += way[d] * way[d];
            }
            if (square > 0.2) continue;   // diagonals, too
            add_spring(1 / square, way, one, other, lattice->stiffness);
            add_spring(0.5 / square + 1, way, one, other, lattice->damping);
        }
    for (int32_t k = 0; k < DOFS * DOFS; k++) lattice->index[k] = k % DOFS;
    for (int32_t k = 0; k <= DOFS; k++) lattice->start[k] = k * DOFS;
    for (int32_t k = 0; k < FLOOR; k++) lattice->dofs[k] = k;
    lattice->dofs[FLOOR] = FLOOR;
    lattice->bulk = (Bulk){.dim = 3,
                           .dof_count = DOFS,
                           .pattern = {DOFS, lattice->start, lattice->index},
                           .stiffness = lattice->stiffness,
                           .damping = lattice->damping,
                           .mass = lattice->mass,
                           .load = lattice->load,
                           .held = lattice->held};
    lattice->def = (ReductionDef){.tolerance = TOLERANCE,
                                  .scales = {1, 1, 1, 1},
                                  .materials = materials_of(&MATERIAL),
                                  .modes = true,
                                  .position = lattice->place};
}

static void expect_rigid_motions(const Lattice *lattice, const ReducedBulk *reduced)
{
    Error err = {0};
    BulkOperator system;
    double full[DOFS], wanted[DOFS];
    assert_true(bulk_operator_reduce(reduced, 1, 1, &system, &err));
    for (int32_t motion = 0; motion < 6; motion++) {
        static const int32_t PLANES[][2] = {{0, 2}, {0, 1}, {1, 2}};
        for (int32_t dof = 0; dof < DOFS; dof++) {
            const double *at = lattice->place + dof / 3 * 3;
            wanted[dof] = motion == dof % 3;
            if (motion < 3) continue;
            const int32_t *plane = PLANES[motion - 3];
            wanted[dof] = dof % 3 == plane[0]   ? -at[plane[1]]
                          : dof % 3 == plane[1] ? at[plane[0]]
                                                : 0;
        }
        recover_state(reduced, system.rigid + motion * reduced->count, full);
        assert_all_near("rigid", full, wanted, DOFS, 1e-10);
    }
    bulk_operator_destroy(&system);
}

// Four parts, from which S of the whole comes back; with a spring more on one side, two.
TEST(test_two_mirrors)
{
    static Lattice lattice;
    Error err = {0};
    if (DIM_MAX < 3) skip();
    build_lattice(&lattice);
    for (int32_t whole = 0; whole < 2; whole++) {
        ReducedBlock block = {
            .bulk = lattice.bulk, .dofs = lattice.dofs, .interface_count = FLOOR + 1};
        int32_t *found[2], parts = 0;
        Mirror mirror;
        for (int32_t axis = 0; axis < 2; axis++) {
            assert_true(mirror_nodes_find(3, axis, lattice.place, NODES, &found[axis], &err));
            assert_non_null(found[axis]);
        }
        const double along_y[] = {0, 0.2, 0};
        if (whole) add_spring(0.1, along_y, NX / 2, NX / 2 + NX, lattice.stiffness);
        assert_true(mirror_find(&lattice.bulk, found, block.dofs, FLOOR + 1, &mirror, &err));
        assert_int_equal(mirror.part_count, whole ? 2 : 4);
        assert_int_equal(mirror.mirrored, whole ? 1 : 3);
        mirror_destroy(&mirror);
        assert_true(mirror_count_parts(&lattice.bulk, found, block.dofs, FLOOR + 1, &parts, &err));
        assert_int_equal(parts, whole ? 2 : 4);
        lattice.def.node_image = found;
        if (!reduction_build(&lattice.bulk, block.dofs, FLOOR + 1, &lattice.def, &block.reduced,
                             &err))
            fail_msg("%s", err.message);
        assert_int_equal(block.reduced.full_dofs, DOFS);
        expect_rigid_motions(&lattice, &block.reduced);
        for (int32_t k = 0; k < 3; k++) {
            OperatorTerms terms = {.stiffness = 1, .damping = k, .mass = k == 2 ? 30 : 0.3};
            BulkOperator system;
            assert_true(
                bulk_operator_create(&lattice.bulk, NULL, block.dofs, FLOOR + 1, &system, &err));
            InterfaceOperator *full = interface_operator_create(&system, terms, &err);
            assert_non_null(full);
            double least, largest, *reduced = reduced_schur(&block.reduced, terms);
            energy_differences(reduced, interface_operator_schur(full), FLOOR + 1, &least,
                               &largest);
            assert_true(least > -ROUNDING && largest < 2 * TOLERANCE);
            free(reduced);
            interface_operator_destroy(full);
            bulk_operator_destroy(&system);
        }
        memory_free(found[0]);
        memory_free(found[1]);
        reduced_bulk_destroy(&block.reduced);
    }
}

TEST(test_memory_faults)
{
    ReducedBlock block;
    reduced_block_build(&SHAPES[1], &MATERIAL, LOAD, 0, &block);
    block.def.tolerance = 1e-1;
    int32_t *image = node_images(&block);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        BulkOperator system = {0};
        InterfaceOperator *level = NULL;
        memory_fail_after(k);
        done = reduce(&block, image, &err) &&
               bulk_operator_reduce(&block.reduced, 1, 1, &system, &err) &&
               (level = interface_operator_create(
                    &system, (OperatorTerms){.mass = 1, .damping = 1, .stiffness = 1}, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        interface_operator_destroy(level);
        bulk_operator_destroy(&system);
        reduced_bulk_destroy(&block.reduced);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 4000);
    }
    memory_free(image);
    reduced_block_destroy(&block);
}
