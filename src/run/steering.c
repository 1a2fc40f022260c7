// SPDX-License-Identifier: GPL-2.0-or-later
// Changes that a caller of amontons.h may make between two steps. The energy ledger does not depend
// on them: work is summed over the stages with the velocity and the load that act in them.
#include "base/decimal_point.h"
#include "run/simulation_state.h"
#include "base/clock.h"
#include "run/warnings.h"
#include "scene/keys.h"
#include "scene/programs.h"

#include <math.h>

// Its history is closed, its events have ended.
bool steering_is_open(const Simulation *simulation, Error *err)
{
    if (simulation->closed)
        return REFUSE(err,
                      "%s: this simulation is finished, nothing can follow: save its state before",
                      simulation->scene.path);
    return true;
}

bool simulation_may_go_on(const Simulation *simulation, Error *err)
{
    const volatile sig_atomic_t *stop = simulation->options.stop;
    if (stop && *stop) return FAULT(err, ERROR_INTERRUPT, "stopped");
    if (clock_seconds() > simulation->deadline) return FAULT(err, ERROR_INTERRUPT, "time is up");
    return true;
}

static bool check_implicit(const Simulation *simulation, Error *err)
{
    if (!steering_is_open(simulation, err)) return false;
    if (simulation->scene.time.scheme == SCHEME_EXPLICIT)
        return REFUSE(err, "%s: time.scheme explicit: nothing can be changed between steps",
                      simulation->scene.path);
    return true;
}

// End of the run as step_rule_end has it, seen from now.
double steering_end(const Simulation *simulation)
{
    double until_U = simulation->scene.time.until_U, until_t = simulation->scene.time.until_t;
    const Rod *rod = &simulation->rod;
    double now = simulation->control.now.time, by_rod = INFINITY;
    if (until_U > 0 && rod->velocity > 0)
        by_rod = now + (until_U - rod_displacement(rod, now)) / rod->velocity;
    return until_t > 0 ? fmin(by_rod, until_t) : by_rod;
}

static void disturb(Simulation *simulation)
{
    step_control_disturb(&simulation->control);
    simulation->last_unquiet = simulation->control.now.time;
}

double steering_next_point(const Simulation *simulation)
{
    double now = simulation->control.now.time, next = INFINITY;
    if (simulation->rod.course) next = schedule_next(&simulation->rod.course->schedule, now);
    return fmin(next, load_next(simulation->control.scheme.course, now));
}

void steering_pass_point(Simulation *simulation, double point)
{
    if (simulation->control.now.time >= point * (1 - 1e-12)) disturb(simulation);
}

static bool check_free(const Simulation *simulation, const SceneProgram *program, const char *key,
                       Error *err)
{
    if (scene_has_program(program))
        return REFUSE(err, "%s: %s: the scene says how this changes", simulation->scene.path, key);
    return true;
}

bool amontons_simulation_set_rod_velocity(Simulation *simulation, double velocity, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    if (!check_implicit(simulation, err)) return false;
    if (!check_free(simulation, &simulation->scene.rod.program, "rod.program", err)) return false;
    if (!scene_size_holds(velocity))
        return REFUSE(
            err, "a rod velocity of %g is not possible: 0, and numbers of a size from %g to %g",
            velocity, SCENE_SMALLEST, SCENE_LARGEST);
    if (simulation->rod.kind == ROD_AWAY)
        return REFUSE(err, "%s: rod.kind none: there is no rod to be moved",
                      simulation->scene.path);
    rod_set_velocity(&simulation->rod, velocity, simulation->control.now.time);
    simulation->t_end = steering_end(simulation);
    disturb(simulation);
    return true;
}

// The load is the pressure's alone, so it is proportional to it. A reduced bulk follows what its
// interface does: waves that a load put on at once sends out are not in it (model/obtain).
bool amontons_simulation_set_pressure(Simulation *simulation, double pressure, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    const Scene *scene = &simulation->scene;
    BulkOperator *system = &simulation->model.system;
    if (!check_implicit(simulation, err)) return false;
    if (!check_free(simulation, &simulation->scene.load.program, "load.program", err)) return false;
    if (!(pressure > 0 && scene_size_holds(pressure)))
        return REFUSE(err, "a pressure of %g is not possible: above 0, of a size from %g to %g",
                      pressure, SCENE_SMALLEST, SCENE_LARGEST);
    if (!(simulation->pressure > 0) || scene->load.traction_count > 0)
        return REFUSE(err, "%s: the pressure can be changed where that on the top is the only load",
                      scene->path);
    if (system->reduced)
        return REFUSE(
            err,
            "%s: the pressure can be changed on the full mesh only: set reduction.use to never",
            scene->path);
    double ratio = pressure / simulation->pressure;
    for (int32_t dof = 0; dof < system->dof_count; dof++) system->load[dof] *= ratio;
    simulation->model.scales.load *= ratio;
    simulation->pressure = pressure;
    if (simulation->warnings.count == 0)
        warnings_of_resolution(&simulation->control.certificate, simulation->model.scales.load,
                               &simulation->warnings);
    disturb(simulation);
    return true;
}
