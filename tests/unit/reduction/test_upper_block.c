// SPDX-License-Identifier: GPL-2.0-or-later
// Designs whose pads are others share the block above them to the last bit, and what was found far
// from the line of one serves the others: against S of their whole meshes by CHOLMOD.
#include "reduction/far_field.h"
#include "reduction/reduction.h"
#include "pad_design.h"
#include "random_numbers.h"
#include "unit/fem/mesh_by_hand.h"
#include "unit/reduction/reduced_block.h"

static const double TOLERANCE = 2e-2;

static FarFieldDef far_def(const PadBlock *made)
{
    BulkScales scales = {1, 1, 1, 1};
    return (FarFieldDef){TOLERANCE, scales, made->block.materials};
}

static void assert_same(const void *a, const void *b, size_t size)
{
    assert_non_null(a);
    assert_memory_equal(a, b, size);
}

// Other pads, other gaps, higher pads.
static void test_shared_by_designs(void **state)
{
    (void)state;
    PadDesign others[] = {PAD_DESIGN, PAD_DESIGN, PAD_DESIGN, PAD_DESIGN};
    PadBlock first, other;
    others[0].fill = 0.7;
    others[1].n = 4;
    others[2].pad_height = 0.1125;   // a sixteenth more: the same on the grid of positions
    others[3].ends = "flush";
    pad_block_build(PAD_DESIGN, &first);
    size_t unknowns = (size_t)first.upper.block.bulk.dof_count;
    assert_int_equal(unknowns, 2 * 81 * 49);
    assert_int_equal(first.upper.interface_count, 2 * 81 + 1);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        pad_block_build(others[k], &other);
        const Bulk *a = &first.upper.block.bulk, *b = &other.upper.block.bulk;
        size_t entries = (size_t)a->pattern.start[unknowns];
        assert_string_equal(other.name, first.name);
        assert_int_equal(b->dof_count, unknowns);
        assert_int_equal(other.upper.interface_count, first.upper.interface_count);
        assert_same(a->pattern.index, b->pattern.index, entries * sizeof(int32_t));
        assert_same(a->stiffness, b->stiffness, entries * sizeof(double));
        assert_same(a->damping, b->damping, entries * sizeof(double));
        assert_same(a->mass, b->mass, unknowns * sizeof(double));
        assert_same(a->load, b->load, unknowns * sizeof(double));
        pad_block_destroy(&other);
    }
    pad_block_destroy(&first);
}

// Where its unknowns are in the whole; by x, then z, the first column is at the trailing side.
static void test_places(void **state)
{
    (void)state;
    PadBlock made;
    pad_block_build(PAD_DESIGN, &made);
    const UpperBlock *upper = &made.upper;
    for (int32_t k = 0; k < upper->block.bulk.dof_count; k++) {
        int32_t column = k / 2 / 49, row = k / 2 % 49;
        assert_int_equal(upper->dofs[k] % 2, k % 2);
        const double *at = made.mesh.position + 2 * (upper->dofs[k] / 2);
        assert_near("x", at[0], column * 0.0125, 1e-9);
        assert_near("z", at[1], 0.05 + row * 0.0125, 1e-9);
    }
    int32_t rod = -1;
    for (int32_t j = 0; j < upper->interface_count; j++) {
        int32_t dof = upper->interface_dofs[j];
        if (dof / 2 % 49 == 0) continue;
        assert_int_equal(rod, -1);
        rod = upper->dofs[dof];
    }
    assert_int_equal(rod, made.dofs[made.interface_count - 1]);
    pad_block_destroy(&made);
}

static void test_other_blocks(void **state)
{
    (void)state;
    PadDesign others[] = {PAD_DESIGN, PAD_DESIGN, PAD_DESIGN, PAD_DESIGN};
    PadBlock first, other;
    others[0].height = 0.625;
    others[1].rod = 0.3;
    others[2].poisson = 0.35;
    others[3].load_x = 0.1;
    pad_block_build(PAD_DESIGN, &first);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        pad_block_build(others[k], &other);
        assert_true(other.upper.interface_count > 0);
        assert_string_not_equal(other.name, first.name);
        pad_block_destroy(&other);
    }
    pad_block_destroy(&first);
}

// Rows of one straight block begin at its contact; free cells have no straight line.
static void test_no_line(void **state)
{
    (void)state;
    PadDesign plain = PAD_DESIGN, loose = PAD_DESIGN;
    PadBlock made;
    plain.n = plain.fill = 1;
    loose.layout = "free";
    pad_block_build(plain, &made);
    assert_int_equal(made.upper.interface_count, 0);
    pad_block_destroy(&made);
    pad_block_build(loose, &made);
    assert_int_equal(made.upper.interface_count, 0);
    pad_block_destroy(&made);
}

// One element below two; their common edge bulges upwards by `rise` at its middle. The interface
// are the two corners on the ground.
static int32_t interface_above(double rise)
{
    static const double at[][2] = {{0, 0},   {1, 0},  {1, 1},   {0, 1},   {2, 1},   {2, 2},
                                   {1, 2},   {0, 2},  {.5, 0},  {1, .5},  {.5, 1},  {0, .5},
                                   {1, 1.5}, {.5, 2}, {0, 1.5}, {1.5, 1}, {2, 1.5}, {1.5, 2}};
    static const int32_t corners[] = {0,  1,  2,  3,  8, 9, 10, 11, 3,  2,  6,  7,
                                      10, 12, 13, 14, 2, 4, 5,  6,  15, 16, 17, 12};
    const int32_t dofs[] = {0, 1, 2, 3};
    Error err = {0};
    Bulk bulk;
    Mesh mesh;
    ReductionBlock block;
    UpperBlock upper;
    Material material = {1, 0.3, 1, 1, 1, false};
    Materials materials = materials_of(&material);
    MeshFile file = hand_mesh(18, at, ELEMENT_Q8, 3, corners);
    if (!mesh_build(&file, "three", &mesh, &err)) fail_msg("%s", err.message);
    mesh.position[2 * 10 + 1] += rise;
    assert_true(bulk_assemble(&mesh, &material, &bulk, &err));
    assert_true(reduction_block_create(&mesh, &bulk, &materials, 0, &block, &err));
    assert_true(upper_block_create(&mesh, &block, dofs, 4, &upper, &err));
    int32_t count = upper.interface_count;
    upper_block_destroy(&upper);
    reduction_block_destroy(&block);
    bulk_destroy(&bulk);
    mesh_destroy(&mesh);
    return count;
}

static void test_curved_edge(void **state)
{
    (void)state;
    assert_int_equal(interface_above(0), 2 * 5);
    assert_int_equal(interface_above(0.1), 0);
    assert_int_equal(interface_above(-0.1), 0);
}

static double *whole_schur(const Bulk *bulk, const int32_t *dofs, int32_t m, OperatorTerms terms)
{
    ReducedBlock as_block = {
        .bulk = *bulk, .interface_count = m, .dofs = (int32_t *)(uintptr_t)dofs};
    return full_schur(&as_block, terms);
}

// Largest relative errors of S at 6 points: what is left of the mesh by a tenth of what the
// reduction may leave, the reduction itself by what it says. Never too soft.
static void check_points(const PadBlock *made, const FarField *far, ReducedBulk *reduced)
{
    Error err = {0};
    Random random = {.state = 5};
    BulkOperator system;
    BulkScales scales = {1, 1, 1, 1};
    int32_t m = made->interface_count;
    double *rotation = hand_matrix(m, 1), least, largest;
    assert_true(bulk_operator_reduce(reduced, rotation, 1, &system, &err));
    for (int32_t k = 0; k < 6; k++) {
        ParameterPoint point = {random_between(&random, 0, 1),
                                pow(10, random_between(&random, -1, 4))};
        OperatorTerms terms = parameter_terms(point, &scales);
        double *wanted = whole_schur(&made->block.bulk, made->dofs, m, terms);
        double *left = whole_schur(&far->bulk, far->system.interface_dofs, m, terms);
        double *small = reduced_schur(reduced, terms);
        energy_differences(left, wanted, m, &least, &largest);
        if (least < -1e-9 || largest > 0.1 * TOLERANCE * TOLERANCE)
            fail_msg("viscosity %g, inertia %g: S is off by %g to %g", point.viscosity,
                     point.inertia, least, largest);
        energy_differences(small, wanted, m, &least, &largest);
        if (least < -1e-9 || largest > bulk_operator_error(&system, terms))
            fail_msg("viscosity %g, inertia %g: the reduction is off by %g to %g", point.viscosity,
                     point.inertia, least, largest);
        free(wanted), free(left), free(small);
    }
    bulk_operator_destroy(&system);
    free(rotation);
}

// Motions found on the block of one design, S of another. Statics are the other mesh's own.
static void test_reused_motions(void **state)
{
    (void)state;
    Error err = {0};
    PadBlock first, other;
    PadDesign moved = PAD_DESIGN;
    FarBlock replaced;
    ReducedBulk reduced;
    dense_use_one_thread();
    moved.n = 4;
    pad_block_build(PAD_DESIGN, &first);
    pad_block_build(moved, &other);
    FarFieldDef def = far_def(&first);
    if (!far_block_create(&first.upper.block.bulk, first.upper.interface_dofs,
                          first.upper.interface_count, &def, &replaced, &err))
        fail_msg("%s", err.message);
    assert_int_equal(replaced.patch_count, 5);
    int32_t m = other.interface_count;
    FarField far = {.block = &replaced, .dofs = other.upper.dofs};
    assert_true(m >= FAR_INTERFACE);
    assert_true(far_field_create(&other.block.bulk, other.dofs, m, 1, &far, &err));
    assert_true(far.bulk.dof_count < 0.7 * other.block.bulk.dof_count);
    ReductionDef how = {.tolerance = TOLERANCE,
                        .scales = def.scales,
                        .materials = def.materials,
                        .above = {&replaced, other.upper.dofs}};
    if (!reduction_build(&other.block.bulk, other.dofs, m, &how, &reduced, &err))
        fail_msg("%s", err.message);
    check_points(&other, &far, &reduced);
    double *wanted = whole_schur(&other.block.bulk, other.dofs, m,
                                 (OperatorTerms){.stiffness = 1, .lift = true});
    double size = dense_max_abs(wanted, m * m);
    for (int32_t k = 0; k < m * m; k++)
        assert_near("S of K", reduced.stiffness[k], wanted[k], 1e-12 * size);
    free(wanted);
    reduced_bulk_destroy(&reduced);
    far_field_destroy(&far);
    far_block_destroy(&replaced);
    pad_block_destroy(&other);
    pad_block_destroy(&first);
}

static void test_memory_faults(void **state)
{
    (void)state;
    PadBlock made;
    pad_block_build(PAD_DESIGN, &made);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        UpperBlock upper;
        memory_fail_after(k);
        done = upper_block_create(&made.mesh, &made.block, made.dofs, made.interface_count, &upper,
                                  &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        upper_block_destroy(&upper);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 100);
    }
    pad_block_destroy(&made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shared_by_designs), cmocka_unit_test(test_places),
        cmocka_unit_test(test_other_blocks),      cmocka_unit_test(test_no_line),
        cmocka_unit_test(test_curved_edge),       cmocka_unit_test(test_reused_motions),
        cmocka_unit_test(test_memory_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
