// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks of any element, shape, material and friction, driven any way, with steps of any size: what
// must hold in every step that is solved, whatever happens in it.
#include "block_rig.h"
#include "plane.h"
#include "contact/contact_check.h"

enum { BLOCKS = 200, STEPS = 40 };

static RigDef random_def(Random *random)
{
    RigDef def = rig_def();
    def.block = (BlockDef){.kind = (ElementKind)random_index(random, PLANE_KINDS),
                           .nx = 2 + random_index(random, 4),
                           .nz = 2 + random_index(random, 2),
                           .length = exp(random_between(random, -2, 2)),
                           .distortion = random_between(random, 0, 0.2),
                           .seed = random_bits(random)};
    def.block.height = def.block.length * random_between(random, 0.2, 1);
    def.material.poisson = random_between(random, 0, 0.45);
    def.material.density = exp(random_between(random, -2, 2));
    def.material.eta1 = exp(random_between(random, -2, 1));
    def.material.eta2 = exp(random_between(random, -2, 1));
    def.material.plane_strain = random_index(random, 2);
    def.law.kind = (FrictionKind)random_index(random, 3);
    def.law.mu_static = random_between(random, 0.1, 0.7);
    def.law.mu_kinetic = def.law.mu_static * random_between(random, 0.1, 1);
    def.law.critical_velocity = exp(random_between(random, -9, -3));
    double pressure = exp(random_between(random, -8, -4));
    def.traction[0] = pressure * random_between(random, -0.5, 0.5);
    def.traction[1] = -pressure;
    def.rod_kind = (RodKind)random_index(random, 3);
    def.rod_velocity = pressure * random_between(random, -0.1, 0.3);
    def.rod_height = 0.5 * def.block.height;
    def.rod_width = 0.7 * def.block.height;
    return def;
}

// The work that all nodes do against C and against friction is never negative.
static void check_powers(const StepOutcome *outcome, double scale)
{
    for (int stage = 0; stage < 2; stage++) {
        assert_true(outcome->power[stage].viscous >= -1e-12 * scale);
        assert_true(outcome->power[stage].frictional >= -1e-12 * scale);
    }
}

static double force_scale(const BlockRig *rig, const State *now)
{
    return fmax(dense_max_abs(now->reaction, rig->interface.count),
                dense_max_abs(rig->system.load, rig->system.dof_count));
}

static void check_contact(const BlockRig *rig, const Sdirk *scheme, const State *now)
{
    const double *schur = interface_operator_schur(scheme->dt_levels->level[0]);
    int32_t count = rig->interface.count;
    double force = force_scale(rig, now), stiffest = 0;
    for (int32_t k = 0; k < count; k++) stiffest = fmax(stiffest, schur[k * count + k]);
    ContactProblem problem = {.interface = &rig->interface,
                              .friction = &rig->friction,
                              .rod_kind = rig->rod.kind,
                              .bound = scheme->bound};
    // v_c may be far below the scale of velocities: what counts as still must be, too.
    double velocity = fmin(force / stiffest, rig->law.critical_velocity);
    ContactResidual residual =
        contact_residual(&problem, now->slip_rate, now->reaction, force, velocity);
    assert_true(residual.pull < 1e-8 && residual.cone < 1e-6 && residual.direction < 1e-6);
    assert_true(residual.gap_force < 1e-6);
    assert_true(residual.penetration * velocity < 1e-8 * force / stiffest);
    for (int32_t i = 0; i < rig->interface.contact_count; i++) {
        double v = now->slip_rate[plane_tangent(i)];
        if (now->status[i] == CONTACT_STICK) assert_true(v == 0);
        if (now->status[i] == CONTACT_SLIP_FORWARD) assert_true(v >= -1e-9 * velocity);
        if (now->status[i] == CONTACT_SLIP_BACKWARD) assert_true(v <= 1e-9 * velocity);
        // At the end of the step nothing is below the plane, and what touches is on it.
        double z = now->displacement[rig->interface.dofs[plane_normal(i)]];
        double rounding = 1e-9 * dense_max_abs(now->displacement, now->dof_count);
        assert_true(z >= -rounding);
        if (now->status[i] != CONTACT_OPEN) assert_true(z <= rounding);
    }
}

TEST(test_every_step)
{
    Error err = {0};
    Random random = {.state = 71};
    int32_t solved = 0, unsolved = 0, seen[4] = {0};
    for (int32_t b = 0; b < BLOCKS; b++) {
        RigDef def = random_def(&random);
        BlockRig rig;
        DtLevels dt_levels;
        Sdirk scheme;
        State now, next;
        rig_build(&def, &rig);
        double duration = exp(random_between(&random, -4, 1)) * def.block.length *
                          sqrt(def.material.density);
        dt_levels_init(&rig.system, duration, duration * 1e-5, &dt_levels);
        assert_true(sdirk_create(&rig.block, &dt_levels, &scheme, &err));
        assert_true(state_create(&rig.system, &rig.interface, &now, &err));
        assert_true(state_create(&rig.system, &rig.interface, &next, &err));
        assert_non_null(dt_level_operator(&dt_levels, 0, PART_WHOLE, &err));
        for (int32_t s = 0; s < STEPS; s++) {
            StepOutcome outcome;
            assert_true(sdirk_step(&scheme, random_index(&random, 3), &now, &next, &outcome, &err));
            if (!outcome.solved) {
                unsolved++;
                continue;
            }
            solved++;
            State swapped = now;
            now = next;
            next = swapped;
            EnergyLedger ledger = energy_open(&now);
            double force = force_scale(&rig, &now);
            assert_true(isfinite(outcome.error) && outcome.residual <= 1e-8 * force);
            assert_true(ledger.elastic >= 0 && ledger.kinetic >= 0);
            double fastest = fmax(dense_max_abs(now.velocity, now.dof_count),
                                  dense_max_abs(scheme.stage_velocity, now.dof_count));
            double viscous = dense_max_abs(rig.bulk.damping, rig.bulk.pattern.start[now.dof_count]);
            check_powers(&outcome, (force + viscous * fastest) * fastest);
            check_contact(&rig, &scheme, &now);
            for (int32_t i = 0; i < rig.interface.contact_count; i++) seen[now.status[i]]++;
        }
        state_destroy(&now);
        state_destroy(&next);
        sdirk_destroy(&scheme);
        dt_levels_destroy(&dt_levels);
        rig_destroy(&rig);
    }
    assert_true(solved > 100 * unsolved);
    for (int k = 0; k < 4; k++) assert_true(seen[k] > 300);
}
