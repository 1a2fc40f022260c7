// SPDX-License-Identifier: GPL-2.0-or-later
// The condensed operator against dense elimination, what was lifted lowered again, a whole solve.
#include "reduction/interface_operator.h"

#include "algebra/dense.h"
#include "block_mesh.h"
#include "dense_by_hand.h"

enum { INTERFACE_COUNT = 9 };

typedef struct Fixture {
    Mesh mesh;
    Bulk bulk;
    BulkOperator system;
    int32_t dofs[INTERFACE_COUNT];
} Fixture;

static void fixture_build(ElementKind kind, Fixture *fixture)
{
    Error err = {0};
    dense_use_one_thread();
    Material material = {.young = 1, .poisson = 0.34, .density = 1.3, .eta1 = 0.8, .eta2 = 0.5};
    BlockDef def = {.kind = kind, .nx = 3, .nz = 3, .length = 1, .height = 0.5, .distortion = 0.2};
    block_build(&def, &fixture->mesh);
    assert_true(bulk_create(&fixture->mesh, &fixture->bulk, &err) &&
                bulk_assemble(&fixture->mesh, &material, &fixture->bulk, &err));
    MeshBoundary contact, rod;
    assert_true(mesh_boundary(&fixture->mesh, "contact", &contact, &err));
    assert_true(mesh_boundary(&fixture->mesh, "rod", &rod, &err));
    for (int32_t k = 0; k < 8; k++) fixture->dofs[k] = 2 * contact.nodes[k / 2] + k % 2;
    fixture->dofs[8] = 2 * rod.nodes[2];
    assert_true(bulk_operator_create(&fixture->bulk, fixture->mesh.position, fixture->dofs,
                                     INTERFACE_COUNT, &fixture->system, &err));
}

static void fixture_destroy(Fixture *fixture)
{
    bulk_operator_destroy(&fixture->system);
    bulk_destroy(&fixture->bulk);
    mesh_destroy(&fixture->mesh);
}

// m M + c C + k K, dense.
static double *dense_sum(const Bulk *bulk, OperatorTerms terms)
{
    int32_t n = bulk->dof_count;
    double *a = hand_matrix(n, n);
    for (int32_t j = 0; j < n; j++) {
        for (int32_t m = bulk->pattern.start[j]; m < bulk->pattern.start[j + 1]; m++)
            a[j * n + bulk->pattern.index[m]] = terms.damping * bulk->damping[m] +
                                                terms.stiffness * bulk->stiffness[m];
        a[j * n + j] += terms.mass * bulk->mass[j];
    }
    return a;
}

TEST(test_schur)
{
    Error err = {0};
    const OperatorTerms tried[] = {
        {.mass = 10, .damping = 1, .stiffness = 0.1},   {.mass = 1e4, .damping = 1},
        {.mass = 1, .damping = 1, .stiffness = 100},    {.damping = 1, .lift = true},
        {.damping = 1, .stiffness = 0.1, .lift = true}, {.stiffness = 1, .lift = true}};
    const ElementKind kinds[] = {ELEMENT_Q4, ELEMENT_T6, ELEMENT_T3};
    for (int32_t k = 0; k < 3; k++) {
        Fixture fixture;
        fixture_build(kinds[k], &fixture);
        for (size_t t = 0; t < sizeof tried / sizeof *tried; t++) {
            double wanted[INTERFACE_COUNT * INTERFACE_COUNT];
            double *a = dense_sum(&fixture.bulk, tried[t]);   // as it is, not lifted
            hand_schur(a, fixture.bulk.dof_count, fixture.dofs, INTERFACE_COUNT, wanted);
            InterfaceOperator *level = interface_operator_create(&fixture.system, tried[t], &err);
            assert_non_null(level);
            assert_all_near("S", interface_operator_schur(level), wanted,
                            INTERFACE_COUNT * INTERFACE_COUNT, 2e-13);
            assert_int_equal(fixture.system.factorisations, t + 1);
            interface_operator_destroy(level);
            free(a);
        }
        fixture_destroy(&fixture);
    }
}

// S v = g + r, expanded, satisfies A v = b + r in every row.
TEST(test_whole_solve)
{
    Error err = {0};
    Random random = {.state = 9};
    Fixture fixture;
    fixture_build(ELEMENT_Q4, &fixture);
    int32_t n = fixture.bulk.dof_count;
    OperatorTerms terms = {.mass = 3, .damping = 1, .stiffness = 1. / 3};
    InterfaceOperator *level = interface_operator_create(&fixture.system, terms, &err);
    double *a = dense_sum(&fixture.bulk, terms), *b = hand_matrix(n, 1), *v = hand_matrix(n, 1);
    double *out = hand_matrix(n, 1), schur[INTERFACE_COUNT * INTERFACE_COUNT], g[INTERFACE_COUNT];
    for (int32_t k = 0; k < n; k++) b[k] = random_between(&random, -1, 1);
    assert_true(interface_operator_condense(level, b, g, &err));
    for (int32_t k = 0; k < INTERFACE_COUNT; k++) {
        double reaction = random_between(&random, -1, 1);
        g[k] += reaction;
        b[fixture.dofs[k]] += reaction;
    }
    memcpy(schur, interface_operator_schur(level), sizeof schur);
    assert_true(hand_solve(schur, INTERFACE_COUNT, g, 1));
    assert_true(interface_operator_expand(level, g, v, &err));
    assert_int_equal(fixture.system.solves, 1);
    hand_apply(a, n, n, v, out);
    assert_all_near("A v", out, b, n, 1e-12);

    // K x, C x and M x by the same border.
    double *dense[] = {[BULK_STIFFNESS] = dense_sum(&fixture.bulk, (OperatorTerms){.stiffness = 1}),
                       [BULK_DAMPING] = dense_sum(&fixture.bulk, (OperatorTerms){.damping = 1}),
                       [BULK_MASS] = dense_sum(&fixture.bulk, (OperatorTerms){.mass = 1})};
    for (int which = BULK_STIFFNESS; which <= BULK_MASS; which++) {
        hand_apply(dense[which], n, n, v, b);
        bulk_operator_apply(&fixture.system, (BulkTerm)which, v, out);
        assert_all_near("apply", out, b, n, 1e-13);
        free(dense[which]);
    }
    free(a);
    free(b);
    free(v);
    free(out);
    interface_operator_destroy(level);
    fixture_destroy(&fixture);
}

// Data of the block in the operator: load, unit rotation (which K does not resist), mass.
TEST(test_block_data)
{
    Error err = {0};
    Fixture fixture;
    fixture_build(ELEMENT_T6, &fixture);
    int32_t n = fixture.bulk.dof_count;
    MeshBoundary top;
    assert_true(mesh_boundary(&fixture.mesh, "top", &top, &err));
    bulk_operator_destroy(&fixture.system);
    bulk_add_traction(&fixture.mesh, &top, (double[2]){0.1, -2}, &fixture.bulk);
    assert_true(bulk_operator_create(&fixture.bulk, fixture.mesh.position, fixture.dofs,
                                     INTERFACE_COUNT, &fixture.system, &err));
    double *force = hand_matrix(n, 1), *full = hand_matrix(n, 1), moment = 0;
    const double *const turned = fixture.system.rigid + 2 * n;
    assert_all_near("load", fixture.system.load, fixture.bulk.load, n, 0);
    assert_near("mass", fixture.system.mass_total, 1.3 * 0.5, 1e-14);
    for (int32_t k = 0; k < n; k++) moment += turned[k] * fixture.system.load[k];
    assert_near("moment of the load", moment, -2 * 0.5 - 0.1 * 0.5, 1e-14);
    bulk_operator_apply(&fixture.system, BULK_STIFFNESS, turned, force);
    for (int32_t k = 0; k < n; k++) assert_near("force of a rotation", force[k], 0, 1e-13);
    assert_true(bulk_operator_recover(&fixture.system, 1, &turned, &full, &err));
    assert_all_near("recovered", full, turned, n, 0);
    assert_near("size", bulk_operator_size(&fixture.system, full), 1, 0);
    free(force);
    free(full);
    fixture_destroy(&fixture);
}

TEST(test_not_definite)
{
    Error err = {0};
    Fixture fixture;
    fixture_build(ELEMENT_Q4, &fixture);
    int64_t live = memory_counters().live;
    assert_null(interface_operator_create(&fixture.system, (OperatorTerms){.mass = -1}, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_int_equal(memory_counters().live, live);
    interface_operator_destroy(NULL);
    fixture_destroy(&fixture);
}

TEST(test_memory_faults)
{
    Fixture fixture;
    fixture_build(ELEMENT_Q4, &fixture);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        BulkOperator system;
        memory_fail_after(k);
        InterfaceOperator *level = NULL;
        if (bulk_operator_create(&fixture.bulk, fixture.mesh.position, fixture.dofs,
                                 INTERFACE_COUNT, &system, &err))
            level = interface_operator_create(&system, (OperatorTerms){.mass = 1}, &err);
        memory_fail_after(-1);
        done = level != NULL;
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        interface_operator_destroy(level);
        bulk_operator_destroy(&system);
        assert_int_equal(memory_counters().live, live);
    }
    fixture_destroy(&fixture);
}
