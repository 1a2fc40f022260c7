// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk whose unknowns far from the interface became few replaced, against the mesh it was made
// of: S by CHOLMOD's factor of all unknowns, rigid motions and statics in every node.
#include "reduction/far_field.h"
#include "random_numbers.h"
#include "reduced_block.h"

static const Material MATERIAL = {.young = 2, .poisson = 0.3, .density = 3, .eta1 = 1, .eta2 = 0.5};
// 110 and 200 rows: 55 and 100 elements from the rod to the top.
static const BlockDef WIDE = {.kind = ELEMENT_Q4, .nx = 24, .nz = 110, .length = 2, .height = 1.3};
static const BlockDef TALL = {.kind = ELEMENT_Q4, .nx = 8, .nz = 200, .length = 1, .height = 2};
// An interface of 143 unknowns: three patches in the first layer, two in the next.
static const BlockDef PATCHED = {.kind = ELEMENT_Q4, .nx = 70, .nz = 140, .length = 2, .height = 4};
// An interface of 103 unknowns: the reduction replaces what is far from it.
static const BlockDef BROAD = {.kind = ELEMENT_Q4, .nx = 50, .nz = 110, .length = 2, .height = 1.3};
static const double LOAD = 0.003, TOLERANCE = 1e-2;

static FarFieldDef far_def(const ReducedBlock *block)
{
    return (FarFieldDef){TOLERANCE, block->def.scales, block->def.materials};
}

static double *schur_of(const Bulk *bulk, const int32_t *dofs, int32_t m, OperatorTerms terms)
{
    ReducedBlock as_block = {
        .bulk = *bulk, .interface_count = m, .dofs = (int32_t *)(uintptr_t)dofs};
    return full_schur(&as_block, terms);
}

// Too stiff, never too soft, and by a small part of what the reduction may leave.
static void check_response(const BlockDef *shape, int32_t patches, double kept)
{
    Error err = {0};
    ReducedBlock block;
    FarField far;
    Random random = {.state = 5};
    reduced_block_build(shape, &MATERIAL, LOAD, 0, &block);
    int32_t m = block.interface_count;
    FarFieldDef def = far_def(&block);
    if (!far_field_create(&block.bulk, block.dofs, m, &def, &far, &err))
        fail_msg("%s", err.message);
    assert_true(far.used);
    int32_t replaced = 0;   // blocks of many unknowns
    for (int32_t b = 0; b < far.modes.block_count; b++) replaced += far.modes.blocks[b].size > 1;
    assert_int_equal(replaced, patches);
    if (far.bulk.dof_count > kept * block.bulk.dof_count)
        fail_msg("%d of %d unknowns are left", far.bulk.dof_count, block.bulk.dof_count);
    for (int32_t k = 0; k < 8; k++) {
        ParameterPoint point = {.viscosity = random_between(&random, 0, 1),
                                .inertia = pow(10, random_between(&random, -2, 4))};
        OperatorTerms terms = parameter_terms(point, &def.scales);
        double *wanted = full_schur(&block, terms), least, largest;
        double *left = schur_of(&far.bulk, far.system.interface_dofs, m, terms);
        energy_differences(left, wanted, m, &least, &largest);
        if (least < -1e-9 || largest > 0.15 * TOLERANCE * TOLERANCE)
            fail_msg("viscosity %g, inertia %g: S is off by %g to %g", point.viscosity,
                     point.inertia, least, largest);
        free(wanted), free(left);
    }
    far_field_destroy(&far);
    reduced_block_destroy(&block);
}

TEST(test_response)
{
    check_response(&WIDE, 2, 0.65);
    check_response(&TALL, 2, 0.55);
    check_response(&PATCHED, 5, 0.5);
}

// u = modes * (motion of the interface), with the interior coordinates 0.
static void recover_static(const ReducedBulk *reduced, const double *motion, double *full)
{
    double *state = hand_matrix(reduced->count, 1);
    memcpy(state, motion, (size_t)reduced->interface_count * sizeof *state);
    recover_state(reduced, state, full);
    free(state);
}

// Moves of the interface come out in every node as CHOLMOD's static responses; a shift and a
// rotation of it as the same of all nodes.
TEST(test_statics_everywhere)
{
    Error err = {0};
    ReducedBlock block;
    BulkOperator system;
    Random random = {.state = 9};
    reduced_block_build(&BROAD, &MATERIAL, LOAD, 2e-2, &block);
    int32_t m = block.interface_count, dofs = block.bulk.dof_count;
    assert_int_equal(block.reduced.full_dofs, dofs);
    double *motion = hand_matrix(m, 1), *full = hand_matrix(dofs, 1),
           *wanted = hand_matrix(dofs, 1);
    assert_true(bulk_operator_create(&block.bulk, NULL, block.dofs, m, &system, &err));
    OperatorTerms terms = {.stiffness = 1, .lift = true};
    InterfaceOperator *statics = interface_operator_create(&system, terms, &err);
    assert_non_null(statics);
    for (int32_t j = 0; j < m; j++) motion[j] = random_between(&random, -1, 1);
    assert_true(interface_operator_respond(statics, motion, 1, wanted, &err));
    recover_static(&block.reduced, motion, full);
    double size = dense_max_abs(wanted, dofs);
    for (int32_t k = 0; k < dofs; k++) assert_near("response", full[k], wanted[k], 1e-5 * size);

    const double *position = block.mesh.position;
    for (int32_t k = 0; k < dofs; k++)
        wanted[k] = k % 2 ? 1 + position[k - 1] : 2 - position[k + 1];
    for (int32_t j = 0; j < m; j++) motion[j] = wanted[block.dofs[j]];
    recover_static(&block.reduced, motion, full);
    for (int32_t k = 0; k < dofs; k++) assert_near("rigid", full[k], wanted[k], 1e-6);
    interface_operator_destroy(statics);
    bulk_operator_destroy(&system);
    free(motion), free(full), free(wanted);
    reduced_block_destroy(&block);
}

// A block that is hardly deeper than the near part stays as it is.
TEST(test_nothing_far)
{
    Error err = {0};
    ReducedBlock block;
    FarField far;
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 10, .nz = 30, .length = 1, .height = 1};
    reduced_block_build(&shape, &MATERIAL, LOAD, 0, &block);
    FarFieldDef def = far_def(&block);
    int32_t m = block.interface_count;
    assert_true(far_field_create(&block.bulk, block.dofs, m, &def, &far, &err));
    assert_false(far.used);
    far_field_destroy(&far);
    reduced_block_destroy(&block);
}

TEST(test_memory_faults)
{
    ReducedBlock block;
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 2, .nz = 200, .length = 1, .height = 50};
    reduced_block_build(&shape, &MATERIAL, LOAD, 0, &block);
    FarFieldDef def = far_def(&block);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k += 1 + k / 40) {   // later ones are alike, motion by motion
        Error err = {0};
        FarField far;
        int32_t m = block.interface_count;
        memory_fail_after(k);
        done = far_field_create(&block.bulk, block.dofs, m, &def, &far, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(far.used || !done, 1);
        far_field_destroy(&far);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 3000);
    }
    reduced_block_destroy(&block);
}
