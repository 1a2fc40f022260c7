// SPDX-License-Identifier: GPL-2.0-or-later
// The 1D equation in time: from u_0, where tau = mu_K p everywhere and the rod is at U = 0, as
// the theory has it, to the scene's end. Steps, events and peaks are those of a block. SDIRK2 with
// the certificate of stepping/certificate, whose S_C - W leaves nothing out here (no coupling of
// pressure to slip).
#include "study/line/model1d.h"

#include "model/step_rule.h"
#include "run/simulation_state.h"

#include <math.h>

// The local error of u in a step over the slip that the friction drop drives, (mu_S - mu_K) P H/E:
// ten times finer than a block's (model/model), as the whole line stops within one step. The energy
// ledger closes to 5e-5 then (set A, L = 4, P = 0.01).
static const double TOLERANCES[] = {
    [ACCURACY_DRAFT] = 5e-3, [ACCURACY_STANDARD] = 5e-4, [ACCURACY_FINE] = 5e-5};

// The end of the run from time.until, the chain at rest in u_0, recorders.
static bool open_simulation(Model1dSimulation *simulation, Error *err)
{
    const Scene *scene = simulation->scene;
    const Model1d *model = &simulation->model;
    simulation->scales = (ObservationScales){.load = model->pressure * model->length,
                                             .length = model->length,
                                             .time = model->length / model->speed,
                                             .slip_velocity = model->velocity};
    simulation->t_end = step_rule_end(scene);
    Friction friction = friction_everywhere(friction_node(&model->law, 1));
    StepSizes sizes = {
        .slip = friction_slip(&friction, model->pressure, model->height, model->young),
        .crossing = simulation->scales.time,
        .tolerance = TOLERANCES[scene->time.accuracy]};
    StepControlDef def = step_rule(scene, &sizes);
    if (!chain_build(model, simulation->options->nodes, &simulation->chain, err)) return false;
    if (!step_control_create(&simulation->chain.block, &def, &simulation->control, err))
        return false;
    chain_rest(model, &simulation->chain, &simulation->control.now);
    step_control_restart(&simulation->control);
    const Interface *interface = &simulation->chain.interface;
    if (!events_create(interface, model->velocity, &simulation->events, err) ||
        !drops_create(interface, &simulation->events, scene->time.periodic_tolerance,
                      &simulation->drops, err) ||
        !contact_arrays_create(interface, &simulation->chain.friction, &simulation->contact, err))
        return false;
    if (!simulation->options->folder) return true;

    // history.h5 as a block's, so that the same programs draw it; a line has no shear waves.
    ResultHead head = {.title = scene->title,
                       .units = scene->units == UNITS_SI ? "si" : "normalised",
                       .version = AMONTONS_VERSION,
                       .numbers = {[NUMBER_LENGTH] = model->length,
                                   [NUMBER_PRESSURE] = model->pressure,
                                   [NUMBER_LOAD] = simulation->scales.load,
                                   [NUMBER_ROD_VELOCITY] = model->velocity,
                                   [NUMBER_CRITICAL_VELOCITY] = model->law.critical_velocity,
                                   [NUMBER_MU_STATIC] = model->law.mu_static,
                                   [NUMBER_MU_KINETIC] = model->law.mu_kinetic,
                                   [NUMBER_C_LONGITUDINAL] = model->speed,
                                   [NUMBER_C_SHEAR] = NAN,
                                   [NUMBER_C_RAYLEIGH] = NAN,
                                   [NUMBER_ROD_LOW] = NAN,
                                   [NUMBER_ROD_HIGH] = NAN,
                                   [NUMBER_ROD_BREADTH] = NAN,
                                   [NUMBER_MU_M] = NAN,
                                   [NUMBER_L_C] = NAN}};
    return history_create(simulation->options->folder, &head, interface, &simulation->contact,
                          &simulation->history, err);
}

// Records an accepted step, or the state at the start. ERROR_COMPUTE: the energy ledger does not
// close.
static bool record_step(Model1dSimulation *simulation, Error *err)
{
    Observation seen = observe(&simulation->control, &simulation->scales);
    if (!events_record(&simulation->events, &seen, err)) return false;
    if (!drops_record(&simulation->drops, &seen, err)) return false;
    if (!contact_arrays_record(&simulation->contact, &seen, err)) return false;
    if (simulation->history.file && !history_record(&simulation->history, &seen, err)) return false;

    // As long as nothing was rapid, the run is compared with the theory: at the theory's points,
    // and by how far mu is off.
    const Model1d *model = &simulation->model;
    const Events *events = &simulation->events;
    const Observation *last = &simulation->last;
    bool rapid = events->count > events->kinds[EVENT_QUASI_STATIC];
    if (rapid || seen.U > model1d_rod(model, model->length)) {
        simulation->next_point = simulation->point_count;
    } else {
        double low = 0, high = model->length;   // l for a rod at U, by halving
        while (high - low > 1e-12 * model->length) {
            double middle = 0.5 * (low + high);
            *(model1d_rod(model, middle) < seen.U ? &low : &high) = middle;
        }
        double mu = model1d_mu(model, high);
        simulation->quasi_static_error = fmax(simulation->quasi_static_error, fabs(seen.mu - mu));
    }
    while (simulation->next_point < simulation->point_count) {
        Model1dPoint *point = &simulation->points[simulation->next_point];
        if (seen.U < point->U) break;
        double part = seen.U > last->U ? (point->U - last->U) / (seen.U - last->U) : 1;
        point->mu_seen = last->mu + part * (seen.mu - last->mu);
        point->front_seen = seen.front;
        simulation->next_point++;
    }

    const Model1dOptions *options = simulation->options;
    StepView view = step_view(&seen, &simulation->events, &simulation->contact, simulation->t_end);
    if (options->on_step) options->on_step(&view, options->context);
    simulation->last = seen;
    simulation->energy_error = fmax(simulation->energy_error, seen.energy_error);
    simulation->contact_error = fmax(simulation->contact_error, seen.contact_error);
    if (seen.energy_error > simulation->scene->time.energy_tolerance)
        return FAULT(err, ERROR_COMPUTE,
                     "at t = %g the energy ledger does not close: %.3g of the energy turned over "
                     "is missing, time.energy_tolerance allows %g; lower time.tolerance",
                     seen.t, seen.energy_error, simulation->scene->time.energy_tolerance);
    return true;
}

// Steps to the scene's end, or to the periodic regime where that is asked for.
bool model1d_simulate(Model1dSimulation *simulation, Error *err)
{
    const Model1dOptions *options = simulation->options;
    TRY(open_simulation(simulation, err));
    TRY(record_step(simulation, err));
    for (bool finished = false; !finished;) {
        double remaining = simulation->t_end - simulation->control.now.time;
        TRY(step_control_advance(&simulation->control, remaining, err));
        TRY(record_step(simulation, err));
        if (options->stop && *options->stop)
            FAIL(err, ERROR_INTERRUPT, "stopped at U = %g (t = %g)", simulation->last.U,
                 simulation->last.t);
        remaining = simulation->t_end - simulation->control.now.time;
        bool periodic = simulation->scene->time.until_periodic && simulation->events.crossed &&
                        answers_of(&simulation->drops).enough;
        finished = remaining <= 1e-9 * simulation->t_end ||
                   !step_control_fits(&simulation->control, remaining) || periodic;
    }
    events_close(&simulation->events, &simulation->last);
    Answers answers = answers_of(&simulation->drops);
    if (simulation->history.file)
        TRY(history_finish(&simulation->history, &simulation->drops, answers.first,
                           answers.mu_M.value, answers.critical_length, err));
cleanup:
    if (!error_is_clean(err)) error_context(err, "in the 1D model");
    return error_is_clean(err);
}
