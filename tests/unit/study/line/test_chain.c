// SPDX-License-Identifier: GPL-2.0-or-later
// The stepped line: its sums against the integrals they stand for, its rest state against the
// equation, its quasi-static slip against the closed forms as nodes are added.
#include "algebra/dense.h"
#include "base/memory.h"
#include "model1d_sets.h"
#include "plane.h"

TEST(test_sums)
{
    enum { NODES = 31 };
    Error err = {0};
    Model1d model = set_a(0.003, 2);
    Chain chain;
    assert_true(chain_build(&model, NODES, &chain, &err));
    const Interface *interface = &chain.interface;
    int32_t count = interface->count;
    assert_int_equal(count, 2 * NODES + 1);
    double load = 0, moment = 0, weight = 0;
    for (int32_t i = 0; i < NODES; i++) {
        double pressed = -chain.system.load[plane_normal(i)];
        assert_true(pressed > 0);
        load += pressed;
        moment += pressed * interface->x[i];
        weight += interface->weight[i];
    }
    assert_near("P L", load, 0.003 * 2, 1e-16);
    assert_near("moment of 2 P x/L", moment, 2 * 0.003 * 2 * 2 / 3., 1e-4 * moment);
    assert_near("L", weight, 2, 1e-14);

    // A stretch u = x with the rod at U: ends carry alpha H E_1, springs E_2 (U - x)/h.
    double *u = NEW_ARRAY(double, count, &err), *force = NEW_ARRAY(double, count, &err);
    double U = 3, layer = 0.2 * model.height;
    for (int32_t i = 0; i < NODES; i++) u[plane_tangent(i)] = interface->x[i];
    u[interface_rod(interface, 0)] = U;
    BulkTerm terms[] = {BULK_STIFFNESS, BULK_DAMPING};
    double axial[] = {model.elastic_x, model.viscous_x};
    double shear[] = {model.elastic_shear, model.viscous_shear};
    for (int k = 0; k < 2; k++) {
        bulk_operator_apply(&chain.system, terms[k], u, force);
        for (int32_t i = 0; i < NODES; i++) {
            double end = i == 0 ? -1 : i == NODES - 1 ? 1 : 0;
            double wanted = end * layer * axial[k] -
                            interface->weight[i] * shear[k] / model.drive * (U - interface->x[i]);
            assert_near("a node", force[plane_tangent(i)], wanted, 1e-12);
        }
        // The integral of (U - x) over 0..2
        assert_near("F_T", force[interface_rod(interface, 0)], shear[k] / model.drive * 4, 1e-12);
    }
    bulk_operator_apply(&chain.system, BULK_MASS, u, force);
    double mass = 0;
    for (int32_t i = 0; i < NODES; i++) mass += force[plane_tangent(i)];
    assert_near("mass times mean of x", mass, layer * 2 * 1, 1e-12);
    memory_free(u);
    memory_free(force);
    chain_destroy(&chain);
}

// tau = mu_K p at every node but for the error of differences, which falls by four.
static double rest_error(const Model1d *model, int32_t nodes)
{
    Error err = {0};
    Chain chain;
    State line;
    double worst = 0, mean = 2 * model->pressure * model->length / (nodes - 1);
    assert_true(chain_build(model, nodes, &chain, &err));
    assert_true(state_create(&chain.system, &chain.interface, &line, &err));
    chain_rest(model, &chain, &line);
    for (int32_t i = 0; i < nodes; i++) {
        double pressed = line.reaction[plane_normal(i)];
        double rubbed = -line.reaction[plane_tangent(i)];
        worst = fmax(worst, fabs(rubbed - model->law.mu_kinetic * pressed) / mean);
    }
    double force = rod_force(&chain.interface, line.reaction) / (model->pressure * model->length);
    assert_near("F_T/F_N", force, model->law.mu_kinetic, 2e-3);
    state_destroy(&line);
    chain_destroy(&chain);
    return worst;
}

TEST(test_rest)
{
    Model1d model = set_a(0.003, 1);
    double coarse = rest_error(&model, 41), fine = rest_error(&model, 81);
    assert_true(fine < 1e-3);
    assert_near("order", log2(coarse / fine), 2, 0.3);
}

// Led slowly by the steps of a block to a front of about 0.4 L: mu against the theory's.
static double slip_error(int32_t nodes)
{
    Error err = {0};
    Model1d model = set_a(0.003, 1);
    model.velocity = 1e-9;
    Chain chain;
    StepControl control;
    double U = model1d_rod(&model, 0.4), end = U / model.velocity;
    StepControlDef def = {.tolerance = 1e-9,
                          .step_max = end / 256,
                          .step_min = end * 1e-9,
                          .wave_step = 0.1,
                          .use_certificate = true};
    assert_true(chain_build(&model, nodes, &chain, &err));
    assert_true(step_control_create(&chain.block, &def, &control, &err));
    chain_rest(&model, &chain, &control.now);
    step_control_restart(&control);
    while (control.now.time < end * (1 - 1e-9)) {
        if (!step_control_advance(&control, end - control.now.time, &err))
            fail_msg("%s", err.message);
        assert_true(control.certified);
    }
    double mu = rod_force(&chain.interface, control.now.reaction) / (model.pressure * model.length);
    double theory = model1d_mu(&model, 0.4);
    int32_t front = 0;
    while (control.now.status[front] != CONTACT_STICK) front++;
    assert_near("front", chain.interface.x[front - 1], 0.4, 2. / (nodes - 1));
    double slip = 0, wanted = 0;   // of the trailing end since the rest state
    slip = control.now.displacement[0] - model1d_rest(&model, 0);
    wanted = model1d_slip(&model, 0.4, 0);
    assert_near("slip", slip / wanted, 1, 20. / nodes / nodes + 1e-3);
    step_control_destroy(&control);
    chain_destroy(&chain);
    return fabs(mu - theory);
}

TEST(test_slip_converges)
{
    double coarse = slip_error(21), middle = slip_error(41), fine = slip_error(81);
    assert_true(fine < 5e-5);
    assert_true(coarse > 2.5 * middle && middle > 2.5 * fine);
}

TEST(test_memory)
{
    Model1d model = set_a(0.003, 1);
    Chain chain;
    int64_t live = memory_counters().live;
    int32_t k = 0;
    for (bool built = false; !built; k++) {
        Error err = {0};
        memory_fail_after(k);
        built = chain_build(&model, 5, &chain, &err);
        memory_fail_after(-1);
        if (!built) assert_int_equal(err.code, ERROR_MEMORY);
        chain_destroy(&chain);
        assert_int_equal(memory_counters().live, live);
    }
    assert_true(k > 10);
}

FIXTURE(group_begin)
{
    dense_use_one_thread();
    return 0;
}

GROUP_BETWEEN(group_begin, NULL);
