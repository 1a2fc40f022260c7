// SPDX-License-Identifier: GPL-2.0-or-later
// A block reduced in its symmetric and its antisymmetric part against its full matrices, dense and
// by hand: S within what the reduction allows, products and solves to rounding, rigid motions
// without interior coordinates. The load pushes to one side, and the rod is on one: only the block
// is its own mirror image.
#include "base/memory.h"
#include "reduction/mirror.h"
#include "reduction/mirror_nodes.h"
#include "reduction/symmetry_reduction.h"
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
    bool paired;
    int32_t nodes = block->mesh.node_count;
    double *position = hand_matrix(2 * nodes, 1);
    int32_t *image = calloc((size_t)nodes, sizeof *image);
    memcpy(position, block->mesh.position, 2 * (size_t)nodes * sizeof *position);
    assert_true(mirror_nodes_find(2, position, nodes, image, &paired, &err));
    free(position);
    if (paired) return image;
    free(image);
    return NULL;
}

static void find_mirror(const ReducedBlock *block, Mirror *mirror)
{
    Error err = {0};
    int32_t *image = node_images(block);
    *mirror = (Mirror){0};
    if (image)
        assert_true(
            mirror_find(&block->bulk, image, block->dofs, block->interface_count, mirror, &err));
    free(image);
}

static bool reduce(ReducedBlock *block, const int32_t *image, Error *err)
{
    block->def.node_image = image;
    return symmetry_reduction_build(&block->bulk, block->dofs, block->interface_count, &block->def,
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
    assert_true(mirror.found);
    assert_int_equal(mirror.mirrored, 1);   // of the rod node's x
    assert_int_equal(mirror.part[0].bulk.dof_count + mirror.part[1].bulk.dof_count,
                     block->bulk.dof_count);
    mirror_destroy(&mirror);
    int32_t *image = node_images(block);
    if (!reduce(block, image, &err)) fail_msg("%s", err.message);
    assert_int_equal(block->reduced.part_count, 2);
    free(image);
}

static void test_response(void **state)
{
    (void)state;
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

static void test_operator(void **state)
{
    (void)state;
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        build(&SHAPES[s], &block);
        check_operator(&block, 44);
        reduced_block_destroy(&block);
    }
}

static void test_rigid_motions_and_load(void **state)
{
    (void)state;
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        build(&SHAPES[s], &block);
        check_rigid_motions_and_load(&block, LOAD);
        reduced_block_destroy(&block);
    }
}

// A node moved, a layer of another material on one side: no image, or not its own.
static void test_what_is_none(void **state)
{
    (void)state;
    Mirror mirror;
    ReducedBlock block;
    BlockDef shaken = SHAPES[0];
    shaken.distortion = 0.1;
    reduced_block_build(&shaken, &MATERIAL, LOAD, 0, &block);
    find_mirror(&block, &mirror);
    assert_false(mirror.found);
    reduced_block_destroy(&block);

    reduced_block_build(&SHAPES[0], &MATERIAL, LOAD, 0, &block);
    block.bulk.stiffness[0] *= 1 + 1e-6;
    find_mirror(&block, &mirror);
    assert_false(mirror.found);
    block.bulk.stiffness[0] /= 1 + 1e-6;
    block.bulk.mass[0] *= 1 + 1e-6;
    find_mirror(&block, &mirror);
    assert_false(mirror.found);
    block.bulk.mass[0] /= 1 + 1e-6;
    find_mirror(&block, &mirror);
    assert_true(mirror.found);
    mirror_destroy(&mirror);
    bulk_hold(1, &block.bulk);   // a support on one side
    find_mirror(&block, &mirror);
    assert_false(mirror.found);
    reduced_block_destroy(&block);

    // Triangles whose diagonals all lean to one side.
    BlockDef leaning = SHAPES[0];
    leaning.kind = ELEMENT_T3;
    reduced_block_build(&leaning, &MATERIAL, LOAD, 0, &block);
    find_mirror(&block, &mirror);
    assert_false(mirror.found);
    reduced_block_destroy(&block);
}

// Without a rod node nothing is mirrored; with those of the contact's left half there are as many
// as on the contact's right half, which is too one-sided. What is likely is found.
static void test_mirrored(void **state)
{
    (void)state;
    Error err = {0};
    ReducedBlock block;
    Mirror mirror;
    bool likely;
    reduced_block_build(&SHAPES[0], &MATERIAL, LOAD, 0, &block);
    block.def.tolerance = TOLERANCE;
    for (int32_t less = 0; less < 2; less++) {
        block.interface_count -= less == 0 ? 1 : 2;   // the rod's x, then contact nodes at one end
        find_mirror(&block, &mirror);
        assert_true(mirror.found);
        assert_int_equal(mirror.mirrored, 2 * less);
        assert_true(mirror_is_likely(&block.bulk, block.mesh.position, block.dofs,
                                     block.interface_count, &likely, &err));
        assert_true(likely);
        int32_t *image = node_images(&block);
        assert_true(reduce(&block, image, &err));
        assert_int_equal(block.reduced.part_count, 2);
        free(image);
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
    assert_false(mirror.found);
    assert_true(mirror_is_likely(&block.bulk, block.mesh.position, block.dofs,
                                 block.interface_count, &likely, &err));
    assert_false(likely);
    reduced_block_destroy(&block);
}

static void test_memory_faults(void **state)
{
    (void)state;
    ReducedBlock block;
    reduced_block_build(&SHAPES[1], &MATERIAL, LOAD, 0, &block);
    block.def.tolerance = 1e-1;
    int32_t *image = node_images(&block);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        BulkOperator system = {0};
        InterfaceOperator *rung = NULL;
        memory_fail_after(k);
        done = reduce(&block, image, &err) &&
               bulk_operator_reduce(&block.reduced, 1, 1, &system, &err) &&
               (rung = interface_operator_create(
                    &system, (OperatorTerms){.mass = 1, .damping = 1, .stiffness = 1}, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        interface_operator_destroy(rung);
        bulk_operator_destroy(&system);
        reduced_bulk_destroy(&block.reduced);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 4000);
    }
    free(image);
    reduced_block_destroy(&block);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_response),
        cmocka_unit_test(test_operator),
        cmocka_unit_test(test_rigid_motions_and_load),
        cmocka_unit_test(test_what_is_none),
        cmocka_unit_test(test_mirrored),
        cmocka_unit_test(test_memory_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
