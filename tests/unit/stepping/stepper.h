// SPDX-License-Identifier: GPL-2.0-or-later
// A block with its levels of dt, the integrator and two states: tests of single steps.
#ifndef AMONTONS_TESTS_STEPPER_H
#define AMONTONS_TESTS_STEPPER_H

#include "stepping/sdirk.h"

#include "block_rig.h"

typedef struct Stepper {
    BlockRig rig;
    DtLevels dt_levels;
    Sdirk scheme;
    State now, next;
} Stepper;

static inline void stepper_build(const RigDef *def, double step_max, Stepper *stepper)
{
    Error err = {0};
    rig_build(def, &stepper->rig);
    BlockRig *rig = &stepper->rig;
    dt_levels_init(&rig->system, step_max, step_max * 1e-4, &stepper->dt_levels);
    assert_true(sdirk_create(&rig->block, &stepper->dt_levels, &stepper->scheme, &err));
    assert_true(state_create(&rig->system, &rig->interface, &stepper->now, &err));
    assert_true(state_create(&rig->system, &rig->interface, &stepper->next, &err));
}

static inline void stepper_destroy(Stepper *stepper)
{
    state_destroy(&stepper->now);
    state_destroy(&stepper->next);
    sdirk_destroy(&stepper->scheme);
    dt_levels_destroy(&stepper->dt_levels);
    rig_destroy(&stepper->rig);
}

static inline StepOutcome do_step(Stepper *stepper, int32_t k)
{
    Error err = {0};
    StepOutcome outcome;
    if (!sdirk_step(&stepper->scheme, k, &stepper->now, &stepper->next, &outcome, &err))
        fail_msg("%s", err.message);
    assert_true(outcome.solved);
    State swapped = stepper->now;
    stepper->now = stepper->next;
    stepper->next = swapped;
    return outcome;
}

// A frictionless block on its plane, loaded askew at t = 0 so that it bends, spreads and drifts,
// but nowhere lifts off: smooth and linear.
static inline RigDef smooth_def(void)
{
    RigDef def = rig_def();
    def.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0};
    def.rod_width = 0;
    def.block.nx = 3;
    def.traction[0] = 0.0004;
    return def;
}

#endif
