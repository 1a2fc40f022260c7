// SPDX-License-Identifier: GPL-2.0-or-later
// A block so stiff that it moves as one, where everything has a closed form: it slows down under
// Coulomb friction and stops; under velocity weakening it runs away with the known growth rate,
// which the certificate must see coming.
#include "block_rig.h"
#include "own_laws.h"
#include "plane.h"

static const double PRESSURE = 0.003, HEIGHT = 0.1;

static RigDef stiff_def(void)
{
    RigDef def = rig_def();
    def.block.height = HEIGHT;
    def.block.nz = 1;
    def.material.young = 1e7;
    def.rod_width = 0;
    return def;
}

static StepControlDef control_def(double step)
{
    return (StepControlDef){.tolerance = 1,
                            .step_max = step,
                            .step_min = step,
                            .wave_step = 1,
                            .use_certificate = false};
}

static void set_velocity(StepControl *control, double velocity)
{
    State *now = &control->now;
    for (int32_t k = 0; k < now->dof_count; k += 2) now->velocity[k] = velocity;
    bulk_operator_apply(control->scheme.system, BULK_MASS, now->velocity, now->momentum);
    for (int32_t i = 0; i < now->contact_count; i++) {
        now->status[i] = CONTACT_SLIP_FORWARD;
        now->slip_rate[plane_tangent(i)] = velocity;
    }
    step_control_restart(control);
}

// Lets the load settle on an undeformed block before anything else is asked of it.
static void settle(StepControl *control)
{
    Error err = {0};
    for (int32_t s = 0; s < 200; s++) assert_true(step_control_advance(control, INFINITY, &err));
}

static double mean_velocity(const StepControl *control)
{
    double momentum = 0;
    for (int32_t k = 0; k < control->now.dof_count; k += 2) momentum += control->now.momentum[k];
    return momentum / control->scheme.system->mass_total;
}

// a = mu P / (rho H): stops after v/a at v^2/(2a), and then holds for good.
TEST(test_braking)
{
    Error err = {0};
    RigDef def = stiff_def();
    def.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.5};
    StepControlDef steps = control_def(0.01);
    BlockRig rig;
    StepControl control;
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps, &control, &err));
    settle(&control);
    const double velocity = 0.02, deceleration = 0.5 * PRESSURE / HEIGHT;
    double start = control.now.displacement[0], stop = velocity / deceleration;
    set_velocity(&control, velocity);
    while (control.now.time < 0.99 * stop) {
        assert_true(step_control_advance(&control, INFINITY, &err));
        assert_near("v", mean_velocity(&control), velocity - deceleration * control.now.time,
                    1e-4 * velocity);
    }
    while (control.now.time < 2 * stop) assert_true(step_control_advance(&control, INFINITY, &err));
    for (int32_t i = 0; i < control.now.contact_count; i++)
        assert_int_equal(control.now.status[i], CONTACT_STICK);
    double way = velocity * velocity / (2 * deceleration);
    assert_near("way", control.now.displacement[0] - start, way, 1e-3 * way);
    assert_near("v", mean_velocity(&control), 0, 1e-10);
    // All the kinetic energy went into friction.
    double energy = 0.5 * HEIGHT * velocity * velocity;
    assert_near("friction", control.ledger.frictional, energy, 2e-3 * energy);
    step_control_destroy(&control);
    rig_destroy(&rig);
}

// v' = lambda v + const., lambda = (mu_S - mu_K) P / (rho H v_c), until v_c.
TEST(test_runaway)
{
    Error err = {0};
    RigDef def = stiff_def();
    def.traction[0] = 0.385 * PRESSURE;   // just above mu_S = 0.38
    const double lambda = 0.28 * PRESSURE / (HEIGHT * 3.4e-4);
    StepControlDef steps = control_def(0.02 / lambda);
    BlockRig rig;
    StepControl control;
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps, &control, &err));
    // Settled with friction so high that it holds; then the law is let loose.
    rig.law.mu_static = 10;
    settle(&control);
    rig.law.mu_static = 0.38;
    step_control_restart(&control);
    double before = 0, time = 0, drive = 0.005 * PRESSURE / HEIGHT / lambda;
    int32_t measured = 0;
    bool certified = true;
    while (mean_velocity(&control) < 2.5e-4) {
        assert_true(step_control_advance(&control, INFINITY, &err));
        double velocity = mean_velocity(&control);
        if (velocity < 5e-5) {
            before = velocity;
            time = control.now.time;
            continue;
        }
        double wanted = (before + drive) * exp(lambda * (control.now.time - time)) - drive;
        assert_near("v", velocity, wanted, 1e-3 * wanted);
        certified = certified && certificate_holds(&control.certificate, &control.now, 0);
        measured++;
    }
    assert_true(measured > 20);
    assert_false(certified);
    step_control_destroy(&control);
    rig_destroy(&rig);
}

// A law that weakens and strengthens again, under a shear between its lowest and its highest: the
// block comes to the speed at which friction holds the balance, on the way that Heun's method finds
// with steps of its own.
static double acceleration(double shear, double v)
{
    return (shear - (0.1 + 0.28 * exp(-v / 3.4e-4) + 0.05 * log(1 + v / 1e-3))) * PRESSURE / HEIGHT;
}

TEST(test_strengthening)
{
    Error err = {0};
    const double shear = 0.25, step = 2e-3;
    RigDef def = stiff_def();
    def.traction[0] = shear * PRESSURE;
    StepControlDef steps = control_def(step);
    BlockRig rig;
    StepControl control;
    def.law = own_formula("0.1 + 0.28 * exp(-v / 3.4e-4) + 0.05 * log(1 + v / 1e-3)", 0.1);
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps, &control, &err));
    settle(&control);
    set_velocity(&control, 1e-3);   // past the static branch: 0.25 exceeds friction there
    double v = mean_velocity(&control), time = 0, h = 1e-3, fastest = 0;
    while (control.now.time < 4) {
        assert_true(step_control_advance(&control, INFINITY, &err));
        for (; time + h < control.now.time + 0.5 * h; time += h) {
            double first = acceleration(shear, v), second = acceleration(shear, v + h * first);
            v += 0.5 * h * (first + second);
        }
        fastest = fmax(fastest, fabs(mean_velocity(&control) - v));
    }
    assert_true(v > 5e-3);   // it ran a good way
    assert_near("v", fastest, 0, 2e-6 * v);
    step_control_destroy(&control);
    rig_destroy(&rig);
}

// Friction that rises with speed from rest on, mu = 0.3 + k v: v' = lambda (v_end - v), lambda =
// k P/(rho H), v_end = (shear - 0.3)/k. Driven from rest the block comes to v_end, where mu is that
// of the drive; thrown forward under less it brakes and stops when v_end + (v - v_end)
// exp(-lambda t) is 0, and then holds. All of it is certified: nothing weakens.
static void move_on_rising_friction(double shear, double thrown)
{
    Error err = {0};
    const double k = 50, lambda = k * PRESSURE / HEIGHT, v_end = (shear - 0.3) / k;
    const double velocity[] = {0, 0.02}, mu[] = {0.3, 0.3 + 0.02 * k};
    RigDef def = stiff_def();
    StepControlDef steps = control_def(0.005 / lambda);
    BlockRig rig;
    StepControl control;
    def.traction[0] = shear * PRESSURE;
    def.law = own_table(2, velocity, mu, true);
    assert_near("nothing falls", friction_law_drop(&def.law), 0, 0);
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps, &control, &err));
    rig.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 10};
    settle(&control);
    rig.law = def.law;
    step_control_restart(&control);
    double start = control.now.displacement[0], from = control.now.time;
    double friction = control.ledger.frictional;
    if (thrown > 0) set_velocity(&control, thrown);
    double stop = v_end < 0 ? log(1 - thrown / v_end) / lambda : INFINITY, fastest = 0;
    while (lambda * (control.now.time - from) < 4) {
        assert_true(step_control_advance(&control, INFINITY, &err));
        double t = control.now.time - from;
        double wanted = t < stop ? v_end + (thrown - v_end) * exp(-lambda * t) : 0;
        fastest = fmax(fastest, fabs(mean_velocity(&control) - wanted));
        assert_true(certificate_holds(&control.certificate, &control.now, 0));
    }
    assert_near("v", fastest, 0, 2e-3 * fmax(thrown, v_end));
    if (thrown > 0) {
        double way = (thrown - v_end) * (1 - exp(-lambda * stop)) / lambda + v_end * stop;
        double energy = 0.5 * HEIGHT * thrown * thrown + shear * PRESSURE * way;
        for (int32_t i = 0; i < control.now.contact_count; i++)
            assert_int_equal(control.now.status[i], CONTACT_STICK);
        assert_near("way", control.now.displacement[0] - start, way, 2e-3 * way);
        assert_near("friction", control.ledger.frictional - friction, energy, 5e-3 * energy);
    }
    step_control_destroy(&control);
    rig_destroy(&rig);
}

TEST(test_rising)
{
    move_on_rising_friction(0.8, 0);
    move_on_rising_friction(0.1, 0.015);
}
