// SPDX-License-Identifier: GPL-2.0-or-later
// The reduced matrices against V' K V, V' C V, V' M V of the full ones, formed by hand: static
// modes, blocks, definiteness, rigid motions, loads, and what the operator makes of them.
#include "reduction/reduction.h"

#include "base/memory.h"
#include "reduced_checks.h"

// A general material: nothing is 1, and C is not proportional to K.
static const Material MATERIAL = {
    .young = 2.5, .poisson = 0.34, .density = 1.3, .eta1 = 0.8, .eta2 = 0.3};
static const double LOAD = 0.7;

static const BlockDef SHAPES[] = {
    {.kind = ELEMENT_Q4, .nx = 6, .nz = 5, .length = 1.4, .height = 0.5, .distortion = 0.2},
    {.kind = ELEMENT_T6, .nx = 4, .nz = 3, .length = 1.4, .height = 0.5, .distortion = 0.2},
    {.kind = ELEMENT_T3, .nx = 6, .nz = 5, .length = 1.4, .height = 0.5, .distortion = 0.2},
    {.kind = ELEMENT_Q8, .nx = 4, .nz = 3, .length = 1.4, .height = 0.5, .distortion = 0.2},
    {.kind = ELEMENT_Q9, .nx = 4, .nz = 3, .length = 1.4, .height = 0.5, .distortion = 0.2}};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

// V' A V / scale
static double *project(const ReducedPart *reduced, const double *a, double scale)
{
    int32_t n = reduced->full_dofs, count = reduced->count;
    double *out = hand_matrix(count, count), *image = hand_matrix(n, 1);
    for (int32_t j = 0; j < count; j++) {
        hand_apply(a, n, n, reduced->modes + (int64_t)j * n, image);
        for (int32_t i = 0; i < count; i++) {
            double sum = 0;
            for (int32_t k = 0; k < n; k++) sum += reduced->modes[(int64_t)i * n + k] * image[k];
            out[j * count + i] = sum / scale;
        }
    }
    free(image);
    return out;
}

// Eigenvalues of a symmetric matrix are above 0, but for `zeros` that are 0.
static void assert_definite(const char *what, const double *a, int32_t n, int32_t zeros)
{
    double *copy = hand_matrix(n, n), *values = hand_matrix(n, 1);
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < j; i++)
            assert_near(what, a[j * n + i], a[i * n + j], 1e-13 * fabs(a[0]) + 1e-14);
    memcpy(copy, a, (size_t)(n * n) * sizeof *copy);
    hand_eigenvalues(copy, n, values);
    for (int32_t k = 0; k < zeros; k++) assert_near(what, values[k], 0, 1e-10 * values[n - 1]);
    if (!(values[zeros] > 1e-9 * values[n - 1]))
        fail_msg("%s: eigenvalue %d is %g, the largest %g", what, zeros, values[zeros],
                 values[n - 1]);
    free(copy);
    free(values);
}

static void check_modes(const ReducedBlock *block, const double *stiffness)
{
    const ReducedPart *reduced = &block->reduced.part[0];
    int32_t n = reduced->full_dofs, m = block->interface_count;
    double *force = hand_matrix(n, 1);
    for (int32_t j = 0; j < reduced->count; j++) {
        const double *mode = reduced->modes + (int64_t)j * n;
        hand_apply(stiffness, n, n, mode, force);
        for (int32_t i = 0; i < m; i++) {
            assert_true(mode[block->dofs[i]] == (i == j));   // exactly
            force[block->dofs[i]] = 0;   // what holds the interface
        }
        for (int32_t k = 0; k < n && j < m; k++)
            assert_near("no force inside", force[k], 0, 1e-12 * MATERIAL.young);
    }
    free(force);
}

// K = diag(S_K, 1), M, diagonal inside, and C: what stands in the struct is what the modes make of
// the full matrices.
TEST(test_blocks)
{
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        double tolerance = s < 2 ? 1e-6 : 1e-2;
        reduced_block_build(&SHAPES[s], &MATERIAL, LOAD, tolerance, &block);
        const ReducedPart *reduced = &block.reduced.part[0];
        int32_t count = reduced->count, m = reduced->border_count;
        assert_int_equal(count, m + reduced->interior_count);
        assert_true(reduced->interior_count > 5 && count <= block.bulk.dof_count);
        double *k = dense_matrix(&block.bulk, block.bulk.stiffness);
        double *c = dense_matrix(&block.bulk, block.bulk.damping), *mass = dense_mass(&block.bulk);
        check_modes(&block, k);
        double *k_small = project(reduced, k, MATERIAL.young);
        double *schur = hand_matrix(m, m);
        hand_schur(k, block.bulk.dof_count, block.dofs, m, schur);
        for (int32_t j = 0; j < count; j++) {
            for (int32_t i = 0; i < count; i++) {
                double wanted = i == j;
                if (i < m || j < m) wanted = 0;
                if (i < m && j < m) wanted = schur[j * m + i] / MATERIAL.young;
                assert_near("V'KV", k_small[j * count + i], wanted, ROUNDING);
                if (i < m && j < m)
                    assert_near("S_K", reduced->stiffness[j * m + i], wanted, 1e-11);
            }
        }
        double *c_small = project(reduced, c, MATERIAL.eta1 + MATERIAL.eta2);
        double *m_small = project(reduced, mass, MATERIAL.density * 1.4 * 1.4);
        assert_all_near("V'CV", reduced->damping, c_small, count * count, ROUNDING);
        // A difference over the lowest inertia, a tenth of that of the slowest mode.
        double *own = whole_mass(reduced);
        assert_all_near("V'MV", own, m_small, count * count, 10 * ROUNDING);
        assert_definite("M", own, count, 0);
        free(own);
        assert_definite("C", reduced->damping, count, 3);   // the plane's rigid motions
        assert_definite("S_K", reduced->stiffness, m, 3);
        free(k), free(c), free(mass), free(k_small), free(c_small), free(m_small), free(schur);
        reduced_block_destroy(&block);
    }
}

TEST(test_rigid_motions_and_load)
{
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        reduced_block_build(&SHAPES[s], &MATERIAL, LOAD, 1e-2, &block);
        check_rigid_motions_and_load(&block, LOAD);
        reduced_block_destroy(&block);
    }
}

// The response at rest to the load, the interface held, is the first interior mode: exact however
// coarse the basis.
TEST(test_static_load_is_exact)
{
    Error err = {0};
    for (int32_t s = 0; s < SHAPE_COUNT; s++) {
        ReducedBlock block;
        reduced_block_build(&SHAPES[s], &MATERIAL, LOAD, 0.3, &block);
        const ReducedBulk *reduced = &block.reduced;
        int32_t n = reduced->full_dofs, m = reduced->interface_count;
        BulkOperator system;
        double *still = hand_matrix(m, 1), *g = hand_matrix(m, 1), *full = hand_matrix(n, 1);
        double *u = hand_matrix(reduced->count, 1);
        double *k = dense_matrix(&block.bulk, block.bulk.stiffness), *wanted = hand_matrix(n, 1);
        assert_true(bulk_operator_reduce(reduced, 1, 1, &system, &err));
        OperatorTerms terms = {.stiffness = 1};
        InterfaceOperator *level = interface_operator_create(&system, terms, &err);
        assert_true(interface_operator_condense(level, system.load, g, &err));
        assert_true(interface_operator_expand(level, still, u, &err));
        recover_state(reduced, u, full);
        memcpy(wanted, block.bulk.load, (size_t)n * sizeof *wanted);
        for (int32_t i = 0; i < m; i++) {
            for (int32_t j = 0; j < n; j++) k[j * n + block.dofs[i]] = 0;
            k[block.dofs[i] * n + block.dofs[i]] = 1;
            wanted[block.dofs[i]] = 0;
        }
        assert_true(hand_solve(k, n, wanted, 1));
        assert_all_near("u", full, wanted, n, 1e-11);
        interface_operator_destroy(level);
        bulk_operator_destroy(&system);
        free(still), free(g), free(full), free(u), free(k), free(wanted);
        reduced_block_destroy(&block);
    }
}

// Its size, besides, bounds what moves: sqrt(2 elastic energy of the interior / E), or the
// interface's largest.
TEST(test_operator)
{
    Error err = {0};
    ReducedBlock block;
    BulkOperator system;
    reduced_block_build(&SHAPES[0], &MATERIAL, LOAD, 1e-3, &block);
    check_operator(&block, 41);
    int32_t m = block.reduced.interface_count;
    double *x = hand_matrix(block.reduced.count, 1);
    assert_true(bulk_operator_reduce(&block.reduced, 1, 1, &system, &err));
    x[1] = -3;
    x[m] = 2;
    assert_near("size", bulk_operator_size(&system, x), 3, 0);
    x[m + 1] = 2.5;
    assert_near("size", bulk_operator_size(&system, x), sqrt(4 + 6.25), 1e-15);
    bulk_operator_destroy(&system);
    free(x);
    reduced_block_destroy(&block);
}

// Counts down the training points that may still be visited.
static bool goes_on(void *self, Error *err)
{
    int32_t *left = self;
    return (*left)-- > 0 ? true : FAULT(err, ERROR_INTERRUPT, "time is up");
}

// Time may be up while a basis is made.
TEST(test_ended_between_points)
{
    ReducedBlock block;
    reduced_block_build(&SHAPES[0], &MATERIAL, LOAD, 0, &block);
    block.def.tolerance = 1e-2;
    block.def.goes_on = goes_on;
    int64_t live = memory_counters().live;
    for (int32_t points = 0; points < 3; points++) {
        Error err = {0};
        int32_t left = points;
        block.def.self = &left;
        assert_false(reduction_build(&block.bulk, block.dofs, block.interface_count, &block.def,
                                     &block.reduced, &err));
        assert_int_equal(err.code, ERROR_INTERRUPT);
        assert_int_equal(left, -1);   // asked once more, and no more
        reduced_bulk_destroy(&block.reduced);
        assert_int_equal(memory_counters().live, live);
    }
    reduced_block_destroy(&block);
}

TEST(test_memory_faults)
{
    ReducedBlock block;
    reduced_block_build(&SHAPES[0], &MATERIAL, LOAD, 0, &block);
    block.def.tolerance = 1e-2;
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        BulkOperator system = {0};
        memory_fail_after(k);
        InterfaceOperator *level = NULL;
        done = reduction_build(&block.bulk, block.dofs, block.interface_count, &block.def,
                               &block.reduced, &err) &&
               bulk_operator_reduce(&block.reduced, 1, 1, &system, &err) &&
               (level = interface_operator_create(
                    &system, (OperatorTerms){.mass = 1, .damping = 1, .stiffness = 1}, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        interface_operator_destroy(level);
        bulk_operator_destroy(&system);
        reduced_bulk_destroy(&block.reduced);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 2000);
    }
    reduced_block_destroy(&block);
}
