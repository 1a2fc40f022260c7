// SPDX-License-Identifier: GPL-2.0-or-later
// A block under the control of its steps: relaxed under its load, the rod just touching, at t = 0.
#ifndef AMONTONS_TESTS_PUSHED_BLOCK_H
#define AMONTONS_TESTS_PUSHED_BLOCK_H

#include "block_rig.h"
#include "stepping/step_control.h"

static const double PUSHED_PRESSURE = 0.003;

// Must not be moved once it is built.
typedef struct PushedBlock {
    BlockRig rig;
    StepControl control;
} PushedBlock;

// Parameter set A, nx by nx/2 cells, two rod nodes.
static inline RigDef pushed_def(int32_t nx)
{
    RigDef def = rig_def();
    def.block.nx = nx;
    def.block.nz = nx / 2;
    def.rod_kind = ROD_AWAY;
    def.rod_velocity = 1e-5;
    def.rod_width = 0.25;
    return def;
}

static inline StepControlDef pushed_steps(void)
{
    return (StepControlDef){.tolerance = 2.7e-6,
                            .step_max = 8,
                            .step_min = 1e-9,
                            .wave_step = 0.1,
                            .use_certificate = true};
}

static inline void pushed_build(const RigDef *def, const StepControlDef *steps, PushedBlock *pushed)
{
    Error err = {0};
    int64_t count = 0;
    rig_build(def, &pushed->rig);
    BlockRig *rig = &pushed->rig;
    double velocity = rig->rod.velocity;
    rig->rod.velocity = 0;
    assert_true(step_control_create(&rig->block, steps, &pushed->control, &err));
    RelaxationDef relaxation = {.speed_max = 1e-5 * velocity, .duration_max = 1e5};
    if (!relax(&pushed->control, &relaxation, &count, &err)) fail_msg("%s", err.message);
    for (int32_t j = 0; j < rig->interface.rod_count; j++)
        rig->rod.origin[j] =
            pushed->control.now
                .displacement[rig->interface.dofs[interface_rod(&rig->interface, j)]];
    rig->rod.velocity = velocity;
    rig->rod.kind = ROD_PUSHES;
    step_control_restart(&pushed->control);
}

static inline void pushed_destroy(PushedBlock *pushed)
{
    step_control_destroy(&pushed->control);
    rig_destroy(&pushed->rig);
}

static inline void pushed_advance(PushedBlock *pushed, double remaining)
{
    Error err = {0};
    if (!step_control_advance(&pushed->control, remaining, &err)) fail_msg("%s", err.message);
}

// U
static inline double pushed_way(const PushedBlock *pushed)
{
    return pushed->control.now.time * pushed->rig.rod.velocity;
}

// F_T / F_N
static inline double pushed_mu(const PushedBlock *pushed)
{
    return rod_force(&pushed->rig.interface, pushed->control.now.reaction) / PUSHED_PRESSURE;
}

#endif
