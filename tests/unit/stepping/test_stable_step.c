// SPDX-License-Identifier: GPL-2.0-or-later
// Bounds of rates against the largest ones of a chain, known in closed form; the limit against what
// really blows up.
#include "stepping/stable_step.h"

#include "stepped_block.h"
#include "stepping/explicit_reference.h"

enum { CHAIN = 50 };

// Two chains of CHAIN masses between walls, one in x, one in z, springs `spring` and half of it.
static Bulk chain_build(double mass, double spring, double dashpot)
{
    Error err = {0};
    Bulk bulk = {.dim = 2, .dof_count = 2 * CHAIN};
    bulk.pattern.size = bulk.dof_count;
    bulk.pattern.start = NEW_ARRAY(int32_t, bulk.dof_count + 1, &err);
    bulk.pattern.index = NEW_ARRAY(int32_t, 3 * bulk.dof_count, &err);
    bulk.stiffness = NEW_ARRAY(double, 3 * bulk.dof_count, &err);
    bulk.damping = NEW_ARRAY(double, 3 * bulk.dof_count, &err);
    bulk.mass = NEW_ARRAY(double, bulk.dof_count, &err);
    int32_t filled = 0;
    for (int32_t dof = 0; dof < bulk.dof_count; dof++) {
        double share = dof % 2 ? 0.5 : 1;
        bulk.mass[dof] = mass;
        for (int32_t other = dof - 2; other <= dof + 2; other += 2) {
            if (other < 0 || other >= bulk.dof_count) continue;
            bulk.pattern.index[filled] = other;
            bulk.stiffness[filled] = share * spring * (other == dof ? 2 : -1);
            bulk.damping[filled++] = share * dashpot * (other == dof ? 2 : -1);
        }
        bulk.pattern.start[dof + 1] = filled;
    }
    return bulk;
}

// Largest eigenvalue of the tridiagonal (-1, 2, -1): 2 + 2 cos(pi / (n + 1)).
static double chain_largest(void)
{
    return 2 + 2 * cos(M_PI / (CHAIN + 1));
}

TEST(test_chain)
{
    Bulk bulk = chain_build(0.25, 3, 0.7);
    double rate = rate_bound(&bulk, bulk.stiffness), exact = 3 / 0.25 * chain_largest();
    assert_near("largest eigenvalue", rate, exact, 2e-3 * exact);
    assert_true(rate >= exact);
    bulk_destroy(&bulk);
}

TEST(test_limits)
{
    Error err = {0};
    double step = 0, largest = chain_largest();
    Bulk elastic = chain_build(1, 4, 0), viscous = chain_build(1, 0, 5);
    assert_true(stable_step(&elastic, &step, &err));   // the chain's h / c is 1/2
    assert_near("elastic", step, 0.98 * 2 / sqrt(4 * largest), 2e-3 * step);
    assert_true(stable_step(&viscous, &step, &err));
    assert_near("viscous", step, 0.98 * 2 / (5 * largest), 2e-3 * step);
    Bulk nothing = chain_build(1, 0, 0);
    assert_false(stable_step(&nothing, &step, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    bulk_destroy(&elastic);
    bulk_destroy(&viscous);
    bulk_destroy(&nothing);
}

// Steps a freely vibrating block; false: it blew up.
static bool stays_finite(SteppedBlock *block, double step)
{
    Error err = {0};
    EnergyLedger ledger = {0};
    ExplicitReference scheme;
    ExplicitDef def = {.bulk = &block->bulk,
                       .interface = &block->interface,
                       .friction = &block->friction,
                       .rod = &block->rod,
                       .step = step};
    Random random = {.state = 7};
    for (int32_t k = 0; k < block->state.dof_count; k++)
        block->state.displacement[k] = random_between(&random, 0, 1e-3);
    memset(block->state.velocity, 0, (size_t)block->state.dof_count * sizeof(double));
    assert_true(explicit_reference_create(&def, &scheme, &err));
    explicit_reference_start(&scheme, &block->state);
    bool finite = explicit_reference_advance(&scheme, 30000, &block->state, &ledger, &err);
    if (!finite) assert_int_equal(err.code, ERROR_COMPUTE);
    explicit_reference_destroy(&scheme);
    return finite;
}

// The limit is safe, and twice it blows up, with waves ruling the step, viscosity, and
// in between.
TEST(test_sharpness)
{
    const double viscosities[] = {0, 0.02, 1};
    for (size_t k = 0; k < sizeof viscosities / sizeof *viscosities; k++) {
        Error err = {0};
        SteppedDef def = {.cells = 6,
                          .eta = viscosities[k],
                          .law = {.kind = FRICTION_COULOMB},
                          .rod_kind = ROD_AWAY};
        SteppedBlock block;
        double step = 0;
        stepped_block_build(&def, &block);
        assert_true(stable_step(&block.bulk, &step, &err));
        assert_true(stays_finite(&block, step));
        assert_false(stays_finite(&block, 2 * step));
        stepped_block_destroy(&block);
    }
}

TEST(test_memory)
{
    Error err = {0};
    Bulk bulk = chain_build(1, 1, 1);
    int64_t live = memory_counters().live;
    double step = 0;
    bulk.spectrum.count = 1;   // matrices of branches are added up
    memory_fail_after(0);
    assert_false(stable_step(&bulk, &step, &err));
    assert_int_equal(err.code, ERROR_MEMORY);
    error_clear(&err);
    memory_fail_after(1);
    assert_true(stable_step(&bulk, &step, &err));
    memory_fail_after(-1);
    assert_int_equal(memory_counters().live, live);
    bulk_destroy(&bulk);
}
