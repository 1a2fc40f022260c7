// SPDX-License-Identifier: GPL-2.0-or-later
// What the reduced bulk answers at the interface, S(dt) over seven decades of steps, against
// CHOLMOD's exact Schur complements of the full mesh: too stiff, never too soft, and the closer the
// smaller the tolerance; the same in any units, and for a block of another size.
#include "bulk/reduction_check.h"

#include "reduced_block.h"

static const double GAMMA = 0.29289321881345254;
static const Material MATERIAL = {.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1};
// Long steps weigh K against the mass of a rigid motion: S is then singular but for 1e-6.
static const double ROUNDING = 1e-7;
enum { STEPS = 21 };   // dt from 1e-7 to 1e3, two a decade

static double step_tried(int32_t k)
{
    return pow(10, -7 + 0.5 * k);
}

static OperatorTerms step_terms(double dt)
{
    return (OperatorTerms){.mass = 1 / (GAMMA * dt), .damping = 1, .stiffness = GAMMA * dt};
}

// The largest relative error in the energy norm, over the steps whose 1/(gamma dt) the basis was
// built for; times in units of eta/E. Too soft it is at none.
static double worst_response(ReducedBlock *block, const ReducedBulk *reduced)
{
    double worst = 0, unit = reduced->scales.damping / reduced->scales.stiffness;
    double shifts[REDUCTION_SHIFTS_MAX];
    int32_t count = reduction_shifts(&reduced->scales, shifts);
    for (int32_t k = 0; k < STEPS; k++) {
        double least, largest, dt = step_tried(k);
        OperatorTerms terms = step_terms(unit * dt);
        double *wanted = full_schur(block, terms), *schur = reduced_schur(reduced, terms);
        energy_differences(schur, wanted, block->interface_count, &least, &largest);
        if (least < -ROUNDING) fail_msg("dt %g: too soft by %g", dt, -least);
        if (1 / (GAMMA * dt) < shifts[count - 1]) worst = fmax(worst, largest);
        free(wanted);
        free(schur);
    }
    return worst;
}

// Energies go with the square of what is left out: the error stays below the tolerance, and falls.
static void test_error_falls_with_tolerance(void **state)
{
    (void)state;
    const BlockDef shapes[] = {
        {.kind = ELEMENT_Q4, .nx = 12, .nz = 12, .length = 1, .height = 0.5},
        {.kind = ELEMENT_T6, .nx = 6, .nz = 6, .length = 1, .height = 0.5, .distortion = 0.1}};
    const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-5};
    for (int32_t s = 0; s < 2; s++) {
        double before = INFINITY;
        int32_t modes = 0;
        for (int32_t t = 0; t < 4; t++) {
            ReducedBlock block;
            reduced_block_build(&shapes[s], &MATERIAL, 0.003, tolerances[t], &block);
            double error = worst_response(&block, &block.reduced);
            print_message("%s, tolerance %g: %d of %d unknowns, error of S %.1e\n", s ? "T6" : "Q4",
                          tolerances[t], block.reduced.count, block.bulk.dof_count, error);
            assert_true(error < tolerances[t]);
            assert_true(error < before && block.reduced.interior_count > modes);
            before = error;
            modes = block.reduced.interior_count;
            reduced_block_destroy(&block);
        }
    }
}

// A block in which waves are slow beside viscosity (rho L^2 E / eta^2 = 100) and one in which they
// are fast (0.01) are covered by the shifts that these make.
static void test_heavy_and_light(void **state)
{
    (void)state;
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 10, .nz = 10, .length = 1, .height = 0.5};
    for (double density = 400; density > 1e-2; density *= 1e-4) {
        Material material = MATERIAL;
        material.density = density;
        ReducedBlock block;
        reduced_block_build(&shape, &material, 0.003, 1e-2, &block);
        double error = worst_response(&block, &block.reduced);
        print_message("density %g: error of S %.1e\n", density, error);
        assert_true(error < 1e-3);
        reduced_block_destroy(&block);
    }
}

// The program's own measure, at shifts between those of the build, is the same as ours there.
static void test_own_measure(void **state)
{
    (void)state;
    Error err = {0};
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 10, .nz = 8, .length = 1, .height = 0.5};
    ReducedBlock block;
    BulkOperator full, reduced;
    reduced_block_build(&shape, &MATERIAL, 0.003, 3e-2, &block);
    double *turn = hand_matrix(block.interface_count, 1), measured, worst = 0;
    assert_true(bulk_operator_create(&block.bulk, block.mesh.position, block.dofs,
                                     block.interface_count, &full, &err));
    assert_true(bulk_operator_reduce(&block.reduced, turn, 1, &reduced, &err));
    assert_true(reduction_check(&full, &reduced, &measured, &err));
    double shifts[REDUCTION_SHIFTS_MAX];
    int32_t count = reduction_shifts(&block.def.scales, shifts);
    assert_true(count >= 5);
    for (int32_t k = 0; k + 1 < count; k++) {
        double least, largest, s = sqrt(shifts[k] * shifts[k + 1]) / 2;   // E / (eta1 + eta2)
        OperatorTerms terms = {.mass = s, .damping = 1, .stiffness = 1 / s};
        double *wanted = full_schur(&block, terms), *schur = reduced_schur(&block.reduced, terms);
        energy_differences(schur, wanted, block.interface_count, &least, &largest);
        worst = fmax(worst, largest);
        free(wanted);
        free(schur);
    }
    assert_near("measured", measured, worst, 1e-6 * worst + 1e-12);
    bulk_operator_destroy(&full);
    bulk_operator_destroy(&reduced);
    free(turn);
    reduced_block_destroy(&block);
}

static double *eigenvalues_of(const double *a, int32_t n)
{
    double *copy = hand_matrix(n, n), *values = hand_matrix(n, 1);
    memcpy(copy, a, (size_t)(n * n) * sizeof *copy);
    hand_eigenvalues(copy, n, values);
    free(copy);
    return values;
}

// PMMA-like numbers in SI, and the same block in units of its own: rho L^2 E / eta^2 and eta2/eta1
// agree, so do the normalised matrices (the interior up to a rotation of its basis).
static void test_units(void **state)
{
    (void)state;
    Material si = {.young = 3e9, .poisson = 0.37, .density = 1200, .eta1 = 6e4, .eta2 = 4e4};
    Material own = {.young = 1, .poisson = 0.37, .density = 1, .eta1 = 0.6, .eta2 = 0.4};
    BlockDef shape = {.kind = ELEMENT_Q4, .nx = 6, .nz = 6, .length = 0.1, .height = 0.05};
    ReducedBlock block[2];
    reduced_block_build(&shape, &si, 2e6, 1e-3, &block[0]);
    shape.length = sqrt(3e9 * 1200) * 0.1 / 1e5;
    shape.height = shape.length / 2;
    reduced_block_build(&shape, &own, 0.01, 1e-3, &block[1]);
    const ReducedBulk *a = &block[0].reduced, *b = &block[1].reduced;
    int32_t count = a->count, m = a->interface_count;
    assert_int_equal(count, b->count);
    assert_all_near("S_K", a->stiffness, b->stiffness, m * m, 1e-10);
    const double *both[][2] = {{a->mass, b->mass}, {a->damping, b->damping}};
    for (int which = 0; which < 2; which++) {
        double *left = eigenvalues_of(both[which][0], count);
        double *right = eigenvalues_of(both[which][1], count);
        assert_all_near("spectrum", left, right, count, 1e-9);
        free(left);
        free(right);
        for (int32_t j = 0; j < m; j++)
            assert_all_near("on the interface", both[which][0] + j * count,
                            both[which][1] + j * count, m, 1e-10);
    }
    assert_all_near("load", a->load, b->load, m, 1e-10);
    double turn = 1e5 / 3e9;   // eta/E
    for (int32_t k = 0; k < 4; k++) {
        double dt = pow(10, 2 - 2 * k);
        double *left = reduced_schur(a, step_terms(turn * dt));
        double *right = reduced_schur(b, step_terms(dt));
        for (int32_t e = 0; e < m * m; e++) left[e] /= 1e5;   // over eta
        assert_all_near("S", left, right, m * m, 1e-8);
        free(left);
        free(right);
    }
    reduced_block_destroy(&block[0]);
    reduced_block_destroy(&block[1]);
}

// A basis built at L = 1, rescaled, steps the block of twice that length, and of half.
static void test_another_length(void **state)
{
    (void)state;
    ReducedBlock built, other;
    BlockDef shape = {.kind = ELEMENT_Q4, .nx = 10, .nz = 10, .length = 1, .height = 0.5};
    reduced_block_build(&shape, &MATERIAL, 0.003, 1e-2, &built);
    for (double length = 0.5; length < 3; length *= 4) {
        shape.length = length;
        shape.height = length / 2;
        reduced_block_build(&shape, &MATERIAL, 0.003, 0, &other);
        ReducedBulk rescaled = built.reduced;
        rescaled.scales = other.def.scales;
        double error = worst_response(&other, &rescaled);
        if (!(error < 1e-2)) fail_msg("L = %g: error %g", length, error);
        reduced_block_destroy(&other);
    }
    // That it is the mass which scales, with L^2: unscaled, it is wrong by all of that.
    shape.length = 2;
    shape.height = 1;
    reduced_block_build(&shape, &MATERIAL, 0.003, 0, &other);
    double least, largest;
    OperatorTerms heavy = step_terms(1e-3);
    double *wanted = full_schur(&other, heavy), *schur = reduced_schur(&built.reduced, heavy);
    energy_differences(schur, wanted, other.interface_count, &least, &largest);
    assert_true(least < -0.3);
    free(wanted);
    free(schur);
    reduced_block_destroy(&other);
    reduced_block_destroy(&built);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_error_falls_with_tolerance),
        cmocka_unit_test(test_heavy_and_light),
        cmocka_unit_test(test_own_measure),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_another_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
