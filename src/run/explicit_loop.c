// SPDX-License-Identifier: GPL-2.0-or-later
// The explicit scheme in the place of step control: central differences on the full mesh
// (stepping/explicit_reference). RECORDS states are recorded, and while slip is rapid as many as
// with implicit steps, whatever the length of the run. Recorders see the same state as with
// implicit steps; parts that only those have (step-size levels, error control) stand still.
#include "run/explicit_loop.h"

#include "stepping/stable_step.h"

#include <math.h>

static const double RECORDS = 2000;   // a run, beside those of rapid slip

// Nothing is done for an implicit scheme. The step is the longest stable one
// (stepping/stable_step), or time.step_max if that is less, shortened so that a whole number of
// them makes an interval between records.
bool explicit_loop_prepare(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    StepControl *control = &simulation->control;
    double step = 0, interval = simulation->t_end / RECORDS;
    if (scene->time.scheme != SCHEME_EXPLICIT) return true;
    const Model *model = &simulation->model;
    const Bulk *bulk = model->mesh.is_base ? &model->bulk_of_nodes : &model->bulk;
    if (!stable_step(bulk, &step, err)) return false;
    if (scene->time.step_max > 0) step = fmin(step, scene->time.step_max);
    double steps = ceil(interval / step);
    if (steps < 1 || steps > 1e15)
        return FAULT(err, ERROR_COMPUTE, "explicit steps of %g in %g of time cannot be counted",
                     step, interval);
    simulation->explicit_steps = (int64_t)steps;
    ExplicitDef def = {.bulk = bulk,
                       .mesh = &model->mesh,
                       .interface = &model->interface,
                       .friction = &simulation->friction,
                       .rod = &simulation->rod,
                       .course = control->scheme.course,
                       .step = interval / steps,
                       .stage_friction = control->scheme.memory.node};
    if (!explicit_reference_create(&def, &simulation->explicit_reference, err)) return false;
    explicit_reference_start(&simulation->explicit_reference, &control->now);
    step_control_use_explicit(control, &simulation->explicit_reference);
    return true;
}
