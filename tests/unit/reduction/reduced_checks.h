// SPDX-License-Identifier: GPL-2.0-or-later
// Checks of any reduced block, however it is kept: products, loads and solves as the full
// matrices seen through the modes, by hand; rigid motions.
#ifndef AMONTONS_TESTS_REDUCED_CHECKS_H
#define AMONTONS_TESTS_REDUCED_CHECKS_H

#include "random_numbers.h"
#include "unit/reduction/reduced_block.h"

// For matrices that come from products of responses, whose energies agree in log10(5e4) digits
// (LOSS_LIMIT of reduction/reduction): 4e-14 times that.
static const double ROUNDING = 2e-9;

// [full_dofs * count] what each coordinate moves.
static inline double *reduced_modes(const ReducedBulk *reduced)
{
    int32_t n = reduced->full_dofs, count = reduced->count;
    double *modes = hand_matrix(n, count), *unit = hand_matrix(count, 1);
    for (int32_t j = 0; j < count; j++) {
        unit[j] = 1;
        recover_state(reduced, unit, modes + (int64_t)j * n);
        unit[j] = 0;
    }
    free(unit);
    return modes;
}

// image [count] := V' full
static inline void seen_by_modes(const ReducedBulk *reduced, const double *modes,
                                 const double *full, double *image)
{
    int32_t n = reduced->full_dofs;
    for (int32_t j = 0; j < reduced->count; j++) {
        image[j] = 0;
        for (int32_t k = 0; k < n; k++) image[j] += modes[(int64_t)j * n + k] * full[k];
    }
}

// K x, C x, M x of the operator are those of the full mesh, seen through the modes; its solve gives
// back what was put in.
static inline void check_operator(const ReducedBlock *block, uint64_t seed)
{
    Error err = {0};
    Random random = {.state = seed};
    const ReducedBulk *reduced = &block->reduced;
    int32_t n = reduced->full_dofs, m = reduced->interface_count, count = reduced->count;
    double *x = hand_matrix(count, 1), *y = hand_matrix(count, 1);
    double *full = hand_matrix(n, 1), *image = hand_matrix(n, 1), *wanted = hand_matrix(count, 1);
    double *sum = hand_matrix(count, 1), *g = hand_matrix(m, 1), *modes = reduced_modes(reduced);
    BulkOperator system;
    assert_true(bulk_operator_reduce(reduced, 1, 1, &system, &err));
    double *dense[] = {[BULK_STIFFNESS] = dense_matrix(&block->bulk, block->bulk.stiffness),
                       [BULK_DAMPING] = dense_matrix(&block->bulk, block->bulk.damping),
                       [BULK_MASS] = dense_mass(&block->bulk)};
    const double factor[] = {[BULK_STIFFNESS] = 0.05, [BULK_DAMPING] = 1, [BULK_MASS] = 20};
    for (int32_t k = 0; k < count; k++) x[k] = random_between(&random, -1, 1);
    recover_state(reduced, x, full);
    for (int which = BULK_STIFFNESS; which <= BULK_MASS; which++) {
        hand_apply(dense[which], n, n, full, image);
        seen_by_modes(reduced, modes, image, wanted);
        bulk_operator_apply(&system, (BulkTerm)which, x, y);
        // The largest of some 60 sums of 60 terms of either sign: three times sqrt(60 / 3).
        assert_all_near("A x", y, wanted, count, 14 * ROUNDING);
        for (int32_t j = 0; j < count; j++) sum[j] += factor[which] * y[j];
        free(dense[which]);
    }
    OperatorTerms terms = {.mass = 20, .damping = 1, .stiffness = 0.05};
    InterfaceOperator *level = interface_operator_create(&system, terms, &err);
    assert_true(interface_operator_condense(level, sum, g, &err));
    hand_apply(interface_operator_schur(level), m, m, x, y);
    assert_all_near("S x_b", y, g, m, 1e-11);
    assert_true(interface_operator_expand(level, x, y, &err));
    assert_all_near("x", y, x, count, 1e-11);
    assert_int_equal(system.solves, 1);
    interface_operator_destroy(level);
    bulk_operator_destroy(&system);
    free(x), free(y), free(full), free(image), free(wanted), free(sum), free(g);
    free(modes);
}

// The operator's rigid motions move the whole block rigidly; its load is the work of the full load,
// of size `load`.
static inline void check_rigid_motions_and_load(const ReducedBlock *block, double load)
{
    Error err = {0};
    const ReducedBulk *reduced = &block->reduced;
    int32_t n = reduced->full_dofs;
    const double *position = block->mesh.position;
    double *full = hand_matrix(n, 1), *wanted = hand_matrix(n, 1);
    double *work = hand_matrix(reduced->count, 1), *modes = reduced_modes(reduced);
    BulkOperator system;
    assert_true(bulk_operator_reduce(reduced, 1, 12.5, &system, &err));
    for (int motion = 0; motion < 3; motion++) {
        for (int32_t k = 0; k < n; k++) {
            double rotated = k % 2 ? position[k - 1] : -position[k + 1];
            wanted[k] = motion == 2 ? rotated : k % 2 == motion;
        }
        recover_state(reduced, system.rigid + motion * reduced->count, full);
        assert_all_near("rigid", full, wanted, n, 1e-11);
    }
    assert_near("mass", system.mass_total, 12.5, 0);
    seen_by_modes(reduced, modes, block->bulk.load, work);
    for (int32_t j = 0; j < reduced->count; j++)
        assert_near("load", system.load[j], work[j], 1e-11 * load);   // sqrt(5e4) digits lost
    bulk_operator_destroy(&system);
    free(full), free(wanted), free(work), free(modes);
}

#endif
