// SPDX-License-Identifier: GPL-2.0-or-later
// The response of the reduced bulk at the interface, S of any step of a block of any length,
// against CHOLMOD's exact Schur complements of the full mesh: too stiff, never too soft, within the
// tolerance wherever the basis says so, and no further off anywhere than it says.
#include "random_numbers.h"
#include "reduced_block.h"

static const double GAMMA = 0.29289321881345254;
static const Material MATERIAL = {.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1};
// Long steps weigh K against the mass of a rigid motion: S is then singular but for 1e-6.
static const double ROUNDING = 1e-7;

static OperatorTerms step_terms(double dt)
{
    return (OperatorTerms){.mass = 1 / (GAMMA * dt), .damping = 1, .stiffness = GAMMA * dt};
}

// A = (1 - viscosity) K + viscosity C + inertia M, normalised, as terms of the block's matrices.
static OperatorTerms parameter_terms(const BulkScales *scales, double viscosity, double inertia)
{
    return (OperatorTerms){.mass = inertia / scales->mass,
                           .damping = viscosity / scales->damping,
                           .stiffness = (1 - viscosity) / scales->stiffness};
}

// The largest relative error of S in the energy norm; too soft it must not be.
static double response_error(ReducedBlock *block, const ReducedBulk *reduced, OperatorTerms terms)
{
    double least, largest;
    double *wanted = full_schur(block, terms), *schur = reduced_schur(reduced, terms);
    energy_differences(schur, wanted, block->interface_count, &least, &largest);
    if (least < -ROUNDING) fail_msg("inertia %g: too soft by %g", terms.mass, -least);
    free(wanted);
    free(schur);
    return largest;
}

// The error that the operator names for these terms is that of the basis for their inertia.
static void assert_said(const ReducedBlock *block, OperatorTerms terms, double said)
{
    BulkOperator system;
    Error err = {0};
    assert_true(bulk_operator_reduce(&block->reduced, 1, 1, &system, &err));
    assert_near("said", bulk_operator_error(&system, terms), said, 1e-12 * said);
    bulk_operator_destroy(&system);
}

// Anywhere in the parameter domain, between the levels of the build and between all elastic and all
// viscous, S is off by no more than the basis says of that inertia, and than the tolerance allows
// at the next level. Two of three points lie where damping hardly, or almost alone, counts.
static void check_error_of(const BlockDef *shape, const Materials *materials, double layer,
                           double tolerance, Random *random)
{
    ReducedBlock block;
    const Material *material = &materials->list[0];
    reduced_block_build_of(shape, *materials, layer, 0.003, tolerance, &block);
    const ReductionErrors *errors = &block.reduced.part[0].errors;
    double element = errors->inertia[errors->count - 2], lowest = errors->inertia[0];
    double worst = 0;
    for (int32_t k = 0; k < 30; k++) {
        double inertia = lowest * pow(element / lowest, random_between(random, -0.3, 1));
        double viscosity = random_between(random, 0, 1);
        if (k % 3 == 1) viscosity = pow(viscosity, 4);
        if (k % 3 == 2) viscosity = 1 - pow(viscosity, 4);
        OperatorTerms terms = parameter_terms(&block.def.scales, viscosity, inertia);
        double error = response_error(&block, &block.reduced, terms);
        int32_t level = 0;   // the next above, one of those it is measured at
        while (errors->inertia[level] < inertia) level++;
        double allowed = tolerance * (tolerance + 2.5 * errors->inertia[level] / element);
        double said = reduced_bulk_error(&block.reduced, inertia);
        assert_said(&block, terms, said);
        if (error > said + 1e-9 || error > allowed)
            fail_msg("eta2/eta1 %g, viscosity %g, inertia %g of %g: error %g, said %g, allowed %g",
                     material->eta2 / material->eta1, viscosity, inertia, element, error, said,
                     allowed);
        worst = fmax(worst, error / allowed);
    }
    print_message("tolerance %g: %d of %d unknowns, worst error %.2f of the allowed\n", tolerance,
                  block.reduced.count, block.bulk.dof_count, worst);
    assert_true(worst > 0.1);   // nothing is added that is not needed
    reduced_block_destroy(&block);
}

static void check_error(const BlockDef *shape, const Material *material, double tolerance,
                        Random *random)
{
    Materials one = materials_of(material);
    check_error_of(shape, &one, 0, tolerance, random);
}

TEST(test_error_is_known)
{
    const BlockDef shapes[] = {
        {.kind = ELEMENT_Q4, .nx = 12, .nz = 12, .length = 1, .height = 0.5},
        {.kind = ELEMENT_Q4, .nx = 20, .nz = 6, .length = 1, .height = 0.1},
        {.kind = ELEMENT_T6, .nx = 6, .nz = 6, .length = 1, .height = 0.5, .distortion = 0.1}};
    const double tolerances[] = {1e-1, 2e-2, 2e-3};
    Random random = {.state = 17};
    for (int32_t s = 0; s < 3; s++)
        for (int32_t t = 0; t < 3; t++) check_error(&shapes[s], &MATERIAL, tolerances[t], &random);
}

// The same with branches: in plane strain shear alone relaxes, by little and by far; in plane
// stress the plate's areal modulus has times of its own; and a volume that relaxes after shear has.
TEST(test_error_of_branches)
{
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 16, .nz = 8, .length = 1, .height = 0.5};
    Material materials[] = {
        {.young = 2, .poisson = 0.3, .density = 1, .eta1 = 0.3, .eta2 = 0.3, .plane_strain = true},
        {.young = 2, .poisson = 0.45, .density = 1, .eta1 = 0.1, .eta2 = 0.2, .plane_strain = true},
        {.young = 2, .poisson = 0.34, .density = 1, .eta1 = 0.3, .eta2 = 0.3}};
    Random random = {.state = 31};
    for (int32_t k = 0; k < 3; k++) {
        materials[k].branch_count = 3;
        materials[k].branch[0] = (Branch){.time = 0.02, .shear = k == 1 ? 20 : 1};
        materials[k].branch[1] = (Branch){.time = 2, .shear = 0.5};
        materials[k].branch[2] = (Branch){.time = 200, .shear = k, .bulk = k};
        check_error(&shape, &materials[k], 2e-2, &random);
    }
}

// The same where C is nothing like K: almost all in the change of volume, or in shear alone.
TEST(test_error_of_unlike_damping)
{
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 16, .nz = 8, .length = 1, .height = 0.5};
    const Material materials[] = {
        {.young = 2, .poisson = 0.34, .density = 1, .eta1 = 0.3, .eta2 = 3},
        {.young = 2, .poisson = 0.34, .density = 1, .eta1 = 0.5},
        {.young = 2, .poisson = 0.48, .density = 1, .eta1 = 0.5, .plane_strain = true},
        {.young = 2,
         .poisson = 0.45,
         .density = 1,
         .eta1 = 0.5,
         .eta2 = 0.5,
         .plane_strain = true}};
    Random random = {.state = 18};
    for (int32_t k = 0; k < 4; k++)
        for (int32_t t = 0; t < 2; t++)
            check_error(&shape, &materials[k], t ? 2e-3 : 2e-2, &random);
}

// A block on a layer of another material, softer or stiffer, and of another viscous time.
TEST(test_error_of_regions)
{
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 10, .nz = 6, .length = 1, .height = 0.3};
    const Material layers[] = {
        {.young = 0.01, .poisson = 0.45, .density = 0.5, .eta1 = 0.01, .eta2 = 0.02},
        {.young = 20, .poisson = 0.3, .density = 3, .eta1 = 0.5, .eta2 = 0.5},
        {.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1e-4, .eta2 = 1e-4},
        {.young = 1e-2, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1}};
    Random random = {.state = 19};
    for (int32_t k = 0; k < 4; k++) {
        Materials two = {.count = 2, .list = {MATERIAL, layers[k]}};
        check_error_of(&shape, &two, 0.1, k % 2 ? 2e-3 : 2e-2, &random);
    }
}

// From 80 interface unknowns on only what is wanted of the eigenvalues is computed, where that is
// little: still what is said of a level is the largest error that was met there, or 1 % more, as at
// the one that was visited last.
TEST(test_error_of_many_nodes)
{
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 48, .nz = 4, .length = 1, .height = 0.1};
    ReducedBlock block;
    reduced_block_build(&shape, &MATERIAL, 0.003, 2e-2, &block);
    const ReductionErrors *errors = &block.reduced.part[0].errors;
    double closest = INFINITY;
    for (int32_t level = 1; level < errors->count - 1; level++) {
        OperatorTerms terms = parameter_terms(&block.def.scales, 1, errors->inertia[level]);
        double error = response_error(&block, &block.reduced, terms), said = errors->error[level];
        if (error > said + 1e-9) fail_msg("level %d: error %g, said %g", level, error, said);
        closest = fmin(closest, said / error);
    }
    assert_true(closest < 1.02);
    reduced_block_destroy(&block);
}

// Beyond the inertia of an element S is worse, and the basis says so.
TEST(test_shortest_steps)
{
    const BlockDef shape = {.kind = ELEMENT_Q4, .nx = 12, .nz = 12, .length = 1, .height = 0.5};
    ReducedBlock block;
    reduced_block_build(&shape, &MATERIAL, 0.003, 2e-2, &block);
    const ReductionErrors *errors = &block.reduced.part[0].errors;
    double element = errors->inertia[errors->count - 2];
    for (double inertia = 2 * element; inertia < 1e8 * element; inertia *= 20) {
        double error =
            response_error(&block, &block.reduced, parameter_terms(&block.def.scales, 1, inertia));
        double said = reduced_bulk_error(&block.reduced, inertia);
        if (error > 1.0001 * said) fail_msg("inertia %g: error %g, said %g", inertia, error, said);
    }
    assert_true(reduced_bulk_error(&block.reduced, 1e9 * element) > 0.06);
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
TEST(test_units)
{
    Material si = {.young = 3e9, .poisson = 0.37, .density = 1200, .eta1 = 6e4, .eta2 = 4e4};
    Material own = {.young = 1, .poisson = 0.37, .density = 1, .eta1 = 0.6, .eta2 = 0.4};
    BlockDef shape = {.kind = ELEMENT_Q4, .nx = 6, .nz = 6, .length = 0.1, .height = 0.05};
    ReducedBlock block[2];
    reduced_block_build(&shape, &si, 2e6, 1e-3, &block[0]);
    shape.length = sqrt(3e9 * 1200) * 0.1 / 1e5;
    shape.height = shape.length / 2;
    reduced_block_build(&shape, &own, 0.01, 1e-3, &block[1]);
    const ReducedPart *a = &block[0].reduced.part[0], *b = &block[1].reduced.part[0];
    int32_t count = a->count, m = a->border_count;
    assert_int_equal(count, b->count);
    assert_all_near("S_K", a->stiffness, b->stiffness, m * m, 1e-10);
    double *mass[] = {whole_mass(a), whole_mass(b)};
    const double *both[][2] = {{mass[0], mass[1]}, {a->damping, b->damping}};
    for (int which = 0; which < 2; which++) {
        double *left = eigenvalues_of(both[which][0], count);
        double *right = eigenvalues_of(both[which][1], count);
        // Two bases, each with rounding of 1e-9 (LOSS_LIMIT of reduction/reduction) in an entry.
        assert_all_near("spectrum", left, right, count, 8e-9);
        free(left);
        free(right);
        for (int32_t j = 0; j < m; j++)
            assert_all_near("on the interface", both[which][0] + j * count,
                            both[which][1] + j * count, m, 1e-10);
    }
    free(mass[0]), free(mass[1]);
    assert_all_near("load", a->load, b->load, m, 1e-10);
    double turn = 1e5 / 3e9;   // eta/E
    for (int32_t k = 0; k < 4; k++) {
        double dt = pow(10, 2 - 2 * k);
        double *left = reduced_schur(&block[0].reduced, step_terms(turn * dt));
        double *right = reduced_schur(&block[1].reduced, step_terms(dt));
        for (int32_t e = 0; e < m * m; e++) left[e] /= 1e5;   // over eta
        assert_all_near("S", left, right, m * m, 1e-8);
        free(left);
        free(right);
    }
    reduced_block_destroy(&block[0]);
    reduced_block_destroy(&block[1]);
}

// A basis built of the block of length 1 steps the block of a fortieth and of four times that
// length, with waves and layers of its own, as one built there would: S of every step.
TEST(test_another_length)
{
    ReducedBlock built, other;
    BlockDef shape = {.kind = ELEMENT_Q4, .nx = 10, .nz = 10, .length = 1, .height = 0.5};
    const double lengths[] = {0.02, 0.25, 4}, tolerance = 2e-2;
    reduced_block_build(&shape, &MATERIAL, 0.003, tolerance, &built);
    for (int k = 0; k < 3; k++) {
        shape.length = lengths[k];
        shape.height = lengths[k] / 2;
        reduced_block_build(&shape, &MATERIAL, 0.003, tolerance, &other);
        ReducedBulk rescaled = built.reduced;
        rescaled.scales = other.def.scales;
        assert_int_equal(rescaled.count, other.reduced.count);
        for (double dt = 1e-6; dt < 1e3; dt *= 10) {
            OperatorTerms terms = step_terms(dt * lengths[k]);
            double fresh = response_error(&other, &other.reduced, terms);
            double reused = response_error(&other, &rescaled, terms);
            assert_near("error", reused, fresh, 1e-6 * fresh + ROUNDING);
        }
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
