// SPDX-License-Identifier: GPL-2.0-or-later
// Operators factored several at once, looked at in their order, against ones made here at the same
// points; what a point that cannot be factored says, and a look that fails.
#include "reduction/factored_points.h"

#include "base/memory.h"
#include "reduced_block.h"

static const Material MATERIAL = {
    .young = 2.5, .poisson = 0.34, .density = 1.3, .eta1 = 0.8, .eta2 = 0.3};
static const BlockDef SHAPE = {
    .kind = ELEMENT_Q4, .nx = 5, .nz = 3, .length = 1.4, .height = 0.5, .distortion = 0.2};

enum { COUNT = 5 };

typedef struct Rig {
    ReducedBlock block;   // not reduced
    BulkOperator system;
    OperatorTerms terms[COUNT];
    FactoredPointsDef def;
    int32_t visited, fails_at;
} Rig;

static void assert_point(Rig *rig, OperatorTerms terms, const FactoredPoint *point)
{
    Error err = {0};
    int32_t dofs = rig->block.bulk.dof_count, m = rig->block.interface_count;
    double *held = hand_matrix(dofs, 1), *pull = hand_matrix(m, 1);
    InterfaceOperator *here = interface_operator_create(&rig->system, terms, &err);
    assert_non_null(here);
    assert_true(interface_operator_respond_held(here, rig->def.load, held, pull, &err));
    assert_all_near("S", interface_operator_schur(point->full), interface_operator_schur(here),
                    m * m, 1e-12);
    assert_all_near("held", point->held, held, dofs, 1e-12);
    assert_all_near("pull", point->pull, pull, m, 1e-12);
    interface_operator_destroy(here);
    free(held), free(pull);
}

static bool visit(void *context, int32_t k, const FactoredPoint *point, Error *err)
{
    Rig *rig = context;
    assert_int_equal(k, rig->visited++);
    if (k == rig->fails_at) FAIL(err, ERROR_LIBRARY, "enough is seen");
    assert_point(rig, rig->terms[k], point);
cleanup:
    return error_is_clean(err);
}

static void start(Rig *rig)
{
    Error err = {0};
    *rig = (Rig){0};
    reduced_block_build(&SHAPE, &MATERIAL, 0.7, 0, &rig->block);
    for (int32_t k = 0; k < COUNT; k++)
        rig->terms[k] =
            (OperatorTerms){.stiffness = 1, .damping = 0.3 * k, .mass = 2. * k * k, .lift = true};
    assert_true(bulk_operator_create(&rig->block.bulk, NULL, rig->block.dofs,
                                     rig->block.interface_count, &rig->system, &err));
    rig->def = (FactoredPointsDef){.system = &rig->system,
                                   .load = rig->block.bulk.load,
                                   .terms = rig->terms,
                                   .count = COUNT,
                                   .visit = visit,
                                   .context = rig};
    rig->fails_at = -1;
}

static void end(Rig *rig)
{
    bulk_operator_destroy(&rig->system);
    reduced_block_destroy(&rig->block);
}

TEST(test_in_order)
{
    for (int32_t count = 0; count <= COUNT; count++) {
        Rig rig;
        Error err = {0};
        start(&rig);
        rig.def.count = count;
        int64_t live = memory_counters().live;
        if (!factored_points_visit(&rig.def, &err)) fail_msg("%s", err.message);
        assert_int_equal(rig.visited, count);
        assert_int_equal(memory_counters().live, live);
        end(&rig);
    }
}

// The points before it are there all the same.
TEST(test_a_point_that_cannot_be)
{
    Rig rig;
    Error err = {0};
    start(&rig);
    rig.terms[2].stiffness = -1;
    int64_t live = memory_counters().live;
    assert_false(factored_points_visit(&rig.def, &err));
    assert_int_equal(rig.visited, 2);
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_non_null(strstr(err.message, "not positive definite"));
    assert_int_equal(memory_counters().live, live);
    end(&rig);
}

TEST(test_stopped_early)
{
    Rig rig;
    Error err = {0};
    start(&rig);
    rig.fails_at = 3;
    int64_t live = memory_counters().live;
    assert_false(factored_points_visit(&rig.def, &err));
    assert_int_equal(rig.visited, 4);
    assert_string_equal(err.message, "enough is seen");
    assert_int_equal(memory_counters().live, live);
    end(&rig);
}
