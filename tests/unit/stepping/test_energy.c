// SPDX-License-Identifier: GPL-2.0-or-later
// The ledger's sums against the dense matrices and against numbers worked out by hand.
#include "stepping/energy.h"

#include "block_rig.h"

TEST(test_stored)
{
    Error err = {0};
    Random random = {.state = 51};
    RigDef def = rig_def();
    def.material.density = 3;
    BlockRig rig;
    State seen;
    rig_build(&def, &rig);
    assert_true(state_create(&rig.system, &rig.interface, &seen, &err));
    int32_t n = rig.bulk.dof_count;
    for (int32_t k = 0; k < n; k++) {
        seen.displacement[k] = random_between(&random, -1, 1);
        seen.velocity[k] = random_between(&random, -1, 1);
    }
    bulk_operator_apply(&rig.system, BULK_STIFFNESS, seen.displacement, seen.elastic_force);
    bulk_operator_apply(&rig.system, BULK_MASS, seen.velocity, seen.momentum);
    double *k_dense = rig_dense(&rig, rig.bulk.stiffness), elastic = 0, kinetic = 0;
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < n; j++)
            elastic += 0.5 * seen.displacement[i] * k_dense[j * n + i] * seen.displacement[j];
        kinetic += 0.5 * rig.bulk.mass[i] * seen.velocity[i] * seen.velocity[i];
    }
    EnergyLedger ledger = energy_open(&seen);
    assert_near("elastic", ledger.elastic, elastic, 1e-12 * elastic);
    assert_near("kinetic", ledger.kinetic, kinetic, 1e-13 * kinetic);
    assert_near("at start", ledger.stored_at_start, elastic + kinetic, 1e-12 * elastic);
    assert_near("balance", energy_imbalance(&ledger), 0, 1e-13 * elastic);
    for (int32_t k = 0; k < n; k++) seen.momentum[k] *= 2;
    energy_store(&seen, &ledger);   // the start stays what it was
    assert_near("kinetic", ledger.kinetic, 2 * kinetic, 1e-12 * kinetic);
    assert_near("balance", energy_imbalance(&ledger), -kinetic, 1e-12 * elastic);
    free(k_dense);
    state_destroy(&seen);
    rig_destroy(&rig);
}

// Two contact nodes and two rod nodes: friction takes -v_t r_t, the normals nothing, the rod gives.
TEST(test_stage_powers)
{
    Interface interface = {.dim = 2, .contact_count = 2, .rod_count = 2, .count = 6};
    double v[] = {1, 10, -2, 20, 3, 4}, r[] = {-0.5, 7, 0.25, 9, 6, 1};
    double bulk_velocity[] = {1, 2, 3}, viscous_force[] = {5, 6, -1};
    ContactSolution contact = {.velocity = v, .reaction = r};
    StagePower power = energy_stage(&interface, bulk_velocity, viscous_force, 3, &contact);
    assert_near("viscous", power.viscous, 5 + 12 - 3, 0);
    assert_near("frictional", power.frictional, 0.5 + 0.5, 0);
    assert_near("rod", power.rod, 18 + 4, 0);
}

TEST(test_sums)
{
    EnergyLedger ledger = {.rod_work = 10,
                           .load_work = -3,
                           .viscous = 2,
                           .frictional = 1,
                           .elastic = 5,
                           .kinetic = 0.5,
                           .stored_at_start = 2};
    assert_near("imbalance", energy_imbalance(&ledger), 10 - 3 - 2 - 1 - (5 + 0.5 - 2), 0);
    assert_near("turnover", energy_turnover(&ledger), 10 + 3 + 2 + 1 + 5 + 0.5 + 2, 0);
}
