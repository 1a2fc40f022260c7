// SPDX-License-Identifier: GPL-2.0-or-later
// Steps and levels of the levels of dt, the matrix on a level, and the state's own few lines.
#include "stepping/dt_levels.h"

#include "block_rig.h"

TEST(test_steps)
{
    DtLevels dt_levels;
    dt_levels_init(NULL, 8, 1, &dt_levels);
    assert_int_equal(dt_levels.level_count, 4);   // 8 4 2 1
    for (int32_t k = 0; k < 4; k++) assert_true(dt_level_step(&dt_levels, k) == 8 / pow(2, k));
    dt_levels_init(NULL, 8, 1.1, &dt_levels);
    assert_int_equal(dt_levels.level_count, 3);   // 1 would be below
    dt_levels_init(NULL, 0.3, 0.3, &dt_levels);
    assert_int_equal(dt_levels.level_count, 1);
    dt_levels_init(NULL, 1, 2, &dt_levels);
    assert_int_equal(dt_levels.level_count, 1);   // there is always one
    dt_levels_init(NULL, 1, 1e-60, &dt_levels);
    assert_int_equal(dt_levels.level_count, DT_LEVELS_MAX);
}

TEST(test_find)
{
    DtLevels dt_levels;
    dt_levels_init(NULL, 0.7, 0.7 / 64, &dt_levels);
    for (int32_t k = 0; k < dt_levels.level_count; k++) {
        double step = dt_level_step(&dt_levels, k);
        assert_int_equal(dt_level_find(&dt_levels, step),
                         k);   // exactly it, and rounding beside it
        assert_int_equal(dt_level_find(&dt_levels, step * (1 - 1e-14)), k);
        assert_int_equal(dt_level_find(&dt_levels, step * 1.9), k);
        assert_int_equal(dt_level_find(&dt_levels, step * 0.9), k + 1);
    }
    assert_int_equal(dt_level_find(&dt_levels, 100), 0);
    assert_int_equal(dt_level_find(&dt_levels, INFINITY), 0);
    assert_int_equal(dt_level_find(&dt_levels, 1e-9), dt_levels.level_count);
    assert_int_equal(dt_level_find(&dt_levels, 0), dt_levels.level_count);
}

// A level is built when first asked for, once, from M/(gamma dt) + C + gamma dt K.
TEST(test_levels)
{
    Error err = {0};
    RigDef def = rig_def();
    BlockRig rig;
    DtLevels dt_levels;
    rig_build(&def, &rig);
    int64_t live = memory_counters().live;
    dt_levels_init(&rig.system, 2, 0.1, &dt_levels);
    assert_int_equal(rig.system.factorisations, 0);
    InterfaceOperator *level = dt_level_operator(&dt_levels, 2, PART_WHOLE, &err);
    assert_non_null(level);
    assert_ptr_equal(dt_level_operator(&dt_levels, 2, PART_WHOLE, &err), level);
    assert_int_equal(rig.system.factorisations, 1);
    assert_null(dt_levels.level[0]);

    int32_t n = rig.bulk.dof_count, count = rig.interface.count;
    double *a = rig_dense(&rig, rig.bulk.damping), *k = rig_dense(&rig, rig.bulk.stiffness);
    double *schur = hand_matrix(count, count), scaled = (1 - sqrt(0.5)) * 0.5;
    for (int32_t m = 0; m < n * n; m++) a[m] += scaled * k[m];
    for (int32_t m = 0; m < n; m++) a[m * n + m] += rig.bulk.mass[m] / scaled;
    hand_schur(a, n, rig.interface.dofs, count, schur);
    assert_all_near("S", interface_operator_schur(level), schur, count * count, 1e-12);
    free(a);
    free(k);
    free(schur);
    dt_levels_destroy(&dt_levels);
    assert_int_equal(memory_counters().live, live);

    for (int32_t dof = 0; dof < n; dof++) rig.bulk.mass[dof] = -1;   // an impossible matrix
    dt_levels_init(&rig.system, 2, 0.1, &dt_levels);
    assert_null(dt_level_operator(&dt_levels, 1, PART_WHOLE, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_non_null(strstr(err.message, "step 1: "));
    dt_levels_destroy(&dt_levels);
    rig_destroy(&rig);
}

TEST(test_state)
{
    Error err = {0};
    RigDef def = rig_def();
    BlockRig rig;
    rig_build(&def, &rig);
    int64_t live = memory_counters().live;
    State rest, other;
    assert_true(state_create(&rig.system, &rig.interface, &rest, &err));
    assert_true(state_create(&rig.system, &rig.interface, &other, &err));
    assert_int_equal(rest.dof_count, 30);
    assert_int_equal(rest.contact_count, 5);
    assert_int_equal(rest.rod_count, 1);
    assert_int_equal(rest.interface_count, 11);
    for (int32_t i = 0; i < 5; i++) assert_int_equal(rest.status[i], CONTACT_STICK);
    assert_int_equal(rest.rod_touches[0], 0);
    double *bulk[][2] = {{rest.displacement, other.displacement},
                         {rest.velocity, other.velocity},
                         {rest.elastic_force, other.elastic_force},
                         {rest.momentum, other.momentum},
                         {rest.inertia, other.inertia}};
    double *edge[][2] = {{rest.slip_rate, other.slip_rate}, {rest.reaction, other.reaction}};
    for (int a = 0; a < 5; a++)
        for (int32_t k = 0; k < 30; k++) bulk[a][0][k] = 100 * a + k;
    for (int a = 0; a < 2; a++)
        for (int32_t k = 0; k < 11; k++) edge[a][0][k] = -100 * a - k;
    rest.status[3] = CONTACT_OPEN;
    rest.rod_touches[0] = 1;
    rest.time = 7;
    state_copy(&rest, &other);
    for (int a = 0; a < 5; a++) assert_memory_equal(bulk[a][0], bulk[a][1], 30 * sizeof(double));
    for (int a = 0; a < 2; a++) assert_memory_equal(edge[a][0], edge[a][1], 11 * sizeof(double));
    assert_int_equal(other.status[3], CONTACT_OPEN);
    assert_int_equal(other.rod_touches[0], 1);
    assert_true(other.time == 7);
    state_destroy(&rest);
    state_destroy(&rest);
    state_destroy(&other);
    assert_int_equal(memory_counters().live, live);
    rig_destroy(&rig);
}
