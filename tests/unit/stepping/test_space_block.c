// SPDX-License-Identifier: GPL-2.0-or-later
// A block in space so stiff that it moves as one: braked in a straight line by Coulomb friction,
// and, sliding and spinning at once, as three equations of a rigid body have it that are integrated
// here. By implicit and by explicit steps.
#include "space_rig.h"
#include "stepping/explicit_reference.h"
#include "stepping/stable_step.h"

static const double PRESSURE = 0.003, HEIGHT = 0.1, MU = 0.3;

typedef struct StiffBlock {
    BlockRig rig;
    StepControl control;
    double centre[2];
} StiffBlock;

static void stiff_build(double young, double step, StiffBlock *block)
{
    Error err = {0};
    SpaceDef shape = {.kind = ELEMENT_HEX8, .cells = {4, 3, 1}, .size = {1, 0.8, HEIGHT}};
    RigDef def = rig_def();
    def.material.young = young;
    def.rod_width = 0;
    def.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = MU};
    StepControlDef steps = {.tolerance = 1, .step_max = step, .step_min = step, .wave_step = 1};
    space_rig_build(&shape, &def, (double[]){0, 0, -PRESSURE}, &block->rig);
    assert_true(step_control_create(&block->rig.block, &steps, &block->control, &err));
    for (int32_t k = 0; k < 200; k++)   // the load settles
        assert_true(step_control_advance(&block->control, INFINITY, &err));
    block->centre[0] = 0.5;
    block->centre[1] = 0.4;
}

static void stiff_destroy(StiffBlock *block)
{
    step_control_destroy(&block->control);
    rig_destroy(&block->rig);
}

// v + spin x (place - centre) everywhere, slipping.
static void set_motion(const double motion[3], StiffBlock *block)
{
    StepControl *control = &block->control;
    const Mesh *mesh = &block->rig.mesh;
    State *now = &control->now;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        const double *place = mesh->position + 3 * i;
        now->velocity[3 * i] = motion[0] - motion[2] * (place[1] - block->centre[1]);
        now->velocity[3 * i + 1] = motion[1] + motion[2] * (place[0] - block->centre[0]);
        now->velocity[3 * i + 2] = 0;
    }
    bulk_operator_apply(control->scheme.system, BULK_MASS, now->velocity, now->momentum);
    for (int32_t i = 0; i < now->contact_count; i++) {
        for (int32_t c = 0; c < 2; c++)
            now->slip_rate[3 * i + c] = now->velocity[block->rig.interface.dofs[3 * i + c]];
        now->status[i] = status_of_slip(now->slip_rate[3 * i]);
    }
    step_control_restart(control);
}

// Mean velocity and spin, from momentum; total: mass and inertia about z.
static void motion_of(const StiffBlock *block, double motion[3], double total[2])
{
    const Mesh *mesh = &block->rig.mesh;
    const State *now = &block->control.now;
    memset(motion, 0, 3 * sizeof *motion);
    total[0] = total[1] = 0;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        double x = mesh->position[3 * i] - block->centre[0];
        double y = mesh->position[3 * i + 1] - block->centre[1];
        double mass = block->rig.bulk.mass[3 * i];
        motion[0] += now->momentum[3 * i];
        motion[1] += now->momentum[3 * i + 1];
        motion[2] += x * now->momentum[3 * i + 1] - y * now->momentum[3 * i];
        total[0] += mass;
        total[1] += mass * (x * x + y * y);
    }
    motion[0] /= total[0];
    motion[1] /= total[0];
    motion[2] /= total[1];
}

// a = mu P/(rho H) against an oblique velocity of size v: it stays straight, stops after v/a,
// v^2/(2 a) away, and holds.
TEST(test_braking)
{
    Error err = {0};
    StiffBlock block;
    stiff_build(1e7, 1e-3, &block);
    const double motion[] = {-3e-3, 4e-3, 0};
    double rate = MU * PRESSURE / HEIGHT, way[2] = {0}, now[3], total[2];
    int32_t node = block.rig.interface.dofs[0];
    double start[] = {block.control.now.displacement[node],
                      block.control.now.displacement[node + 1]};
    set_motion(motion, &block);
    while (block.control.now.time < 0.8 * 5e-3 / rate) {
        assert_true(step_control_advance(&block.control, INFINITY, &err));
        motion_of(&block, now, total);
        double left = 5e-3 - rate * block.control.now.time;
        assert_near("v_x", now[0], -0.6 * left, 1e-5);
        assert_near("v_y", now[1], 0.8 * left, 1e-5);
    }
    while (block.control.now.time < 1.3 * 5e-3 / rate)
        assert_true(step_control_advance(&block.control, INFINITY, &err));
    for (int32_t i = 0; i < block.control.now.contact_count; i++)
        assert_int_equal(block.control.now.status[i], CONTACT_STICK);
    for (int c = 0; c < 2; c++) way[c] = block.control.now.displacement[node + c] - start[c];
    double whole = 25e-6 / (2 * rate);
    assert_near("x", way[0], -0.6 * whole, 5e-3 * whole);
    assert_near("y", way[1], 0.8 * whole, 5e-3 * whole);
    stiff_destroy(&block);
}

// One step of the rigid body under friction of the nodes, each pressed as it is.
static void slide_on(const StiffBlock *block, const double total[2], double step, double body[3])
{
    enum { PARTS = 10 };
    const Interface *interface = &block->rig.interface;
    for (int32_t part = 0; part < PARTS; part++) {
        double push[3] = {0};
        for (int32_t i = 0; i < interface->contact_count; i++) {
            const double *place = block->rig.mesh.position + 3 * interface->node[i];
            double x = place[0] - block->centre[0], y = place[1] - block->centre[1];
            double v[] = {body[0] - body[2] * y, body[1] + body[2] * x};
            double limit = MU * block->control.now.reaction[3 * i + 2] / hypot(v[0], v[1]);
            push[0] -= limit * v[0];
            push[1] -= limit * v[1];
            push[2] -= limit * (x * v[1] - y * v[0]);
        }
        body[0] += step / PARTS * push[0] / total[0];
        body[1] += step / PARTS * push[1] / total[0];
        body[2] += step / PARTS * push[2] / total[1];
    }
}

TEST(test_spinning)
{
    Error err = {0};
    StiffBlock block;
    stiff_build(1e7, 1e-3, &block);
    double body[] = {4e-3, 2e-3, 1.2e-2}, now[3], total[2];
    set_motion(body, &block);
    while (block.control.now.time < 0.5) {
        assert_true(step_control_advance(&block.control, INFINITY, &err));
        motion_of(&block, now, total);
        slide_on(&block, total, block.control.last_step, body);
        assert_near("v_x", now[0], body[0], 2e-5);
        assert_near("v_y", now[1], body[1], 1e-5);
        assert_near("spin", now[2], body[2], 4e-5);
    }
    assert_true(body[0] < 0.6 * 4e-3 && body[2] < 0.6 * 1.2e-2);   // it was braked, both ways
    stiff_destroy(&block);
}

// Central differences of the same block, softer, come to the same motion.
TEST(test_explicit)
{
    enum { RECORDS = 5 };
    Error err = {0};
    StiffBlock implicit, block;
    const double body[] = {4e-3, 2e-3, 1.2e-2};
    double step, now[3], expected[3], total[2];
    ExplicitReference scheme;
    EnergyLedger ledger = {0};
    stiff_build(1e3, 2e-3, &implicit);
    stiff_build(1e3, 2e-3, &block);
    set_motion(body, &implicit);
    set_motion(body, &block);
    assert_true(stable_step(&block.rig.bulk, &step, &err));
    int64_t steps = (int64_t)ceil(0.06 / step);
    ExplicitDef def = {.bulk = &block.rig.bulk,
                       .interface = &block.rig.interface,
                       .friction = &block.rig.friction,
                       .rod = &block.rig.rod,
                       .step = 0.06 / (double)steps};
    assert_true(explicit_reference_create(&def, &scheme, &err));
    explicit_reference_start(&scheme, &block.control.now);
    for (int32_t k = 1; k <= RECORDS; k++) {
        assert_true(explicit_reference_advance(&scheme, steps, &block.control.now, &ledger, &err));
        while (implicit.control.now.time < 0.06 * k - 1e-9)
            assert_true(step_control_advance(&implicit.control, INFINITY, &err));
        motion_of(&block, now, total);
        motion_of(&implicit, expected, total);
        for (int c = 0; c < 3; c++) assert_near("motion", now[c], expected[c], 3e-3 * body[c]);
        assert_true(ledger.frictional > 0);
    }
    explicit_reference_destroy(&scheme);
    stiff_destroy(&implicit);
    stiff_destroy(&block);
}
