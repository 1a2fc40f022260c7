// SPDX-License-Identifier: GPL-2.0-or-later
// mesh -> bulk and interface -> steps prepared -> relaxed -> recorders -> steps -> results.
#include "run/simulation_state.h"

#include "algebra/dense.h"
#include "record/drops.h"
#include "answers/answers.h"
#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "fem/floor.h"
#include "io/files/own_list.h"
#include "model/obtain.h"
#include "run/warnings.h"
#include "scene/keys.h"
#include "scene/programs.h"

#include <math.h>

// Static balance of moments is asked of frames in which inertia has no part: the longest step was
// taken there, and the last rapid event, the last state that was not certified and the rod's start
// lie this many times (crossing time + viscous time) back.
static const double QUIET_TIME = 20;

// A Recorder, the last one: the caller sees a step when everything else has.
static bool report_step(void *self, const Observation *seen, Error *err)
{
    (void)err;
    Simulation *simulation = self;
    if (!simulation->options.on_step) return true;
    StepView view = step_view(seen, &simulation->events, &simulation->contact, simulation->t_end);
    simulation->options.on_step(&view, simulation->options.context);
    return true;
}

// Events come first: the others read them.
static bool open_recorders(Simulation *simulation, Error *err)
{
    simulation->errors = (RunErrors){0};
    const Model *model = &simulation->model;
    const Recorder recorders[] = {{&simulation->events, events_record},
                                  {&simulation->drops, drops_record},
                                  {&simulation->steady, steady_record},
                                  {&simulation->pads, pads_record},
                                  {&simulation->contact, contact_arrays_record},
                                  {&simulation->readings, program_readings_record},
                                  {&simulation->rotation, rotation_record}};
    Events *events = &simulation->events;
    if (!events_create(&model->interface, model->scales.slip_velocity, events, err) ||
        !drops_create(&model->interface, events, simulation->scene.time.periodic_tolerance,
                      &simulation->drops, err) ||
        !pads_create(&model->interface, events, &simulation->pads, err) ||
        !contact_arrays_create(&model->interface, &model->friction, &simulation->contact, err))
        return false;
    bool remembers = simulation->control.scheme.memory.node != NULL;
    simulation->drops.mu_static = remembers ? NAN : model->friction.mu_static;
    simulation->steady = steady_of(events, model_friction_slip(model) + model_machine_yield(model),
                                   model->scales.slip_velocity / model_forgets(model));
    if (program_jumps(&simulation->rod_course))
        simulation->readings.course = &simulation->rod_course;
    simulation->rotation.contact = &simulation->contact;
    for (size_t k = 0; k < sizeof recorders / sizeof *recorders; k++)
        recorders_add(&simulation->recorders, recorders[k].self, recorders[k].record);
    if (result_folder_is_ours(&simulation->folder) && !output_open(simulation, err)) return false;
    recorders_add(&simulation->recorders, simulation, report_step);
    return true;
}

// Looks at the state just accepted and hands it on.
static bool record_step(Simulation *simulation, Error *err)
{
    StepControl *control = &simulation->control;
    double started = clock_seconds();
    Observation seen = observe(control, &simulation->model.scales);
    simulation->seen = seen;

    // time.until.mu_below asks whether mu has fallen.
    double limit = simulation->scene.time.until_mu_below, mu = simulation->seen.mu;
    simulation->mu_fell = limit > 0 && simulation->mu_above && mu < limit;
    simulation->mu_above = simulation->mu_above || mu >= limit;

    RunErrors *errors = &simulation->errors;
    errors->energy = fmax(errors->energy, seen.energy_error);
    errors->complementarity = fmax(errors->complementarity, seen.contact_error);
    errors->penetration = fmax(errors->penetration, seen.penetration);
    errors->equation = fmax(errors->equation, seen.equation_error);
    // The forces of supports are not known here, so no balance of moments is checked with them.
    bool balances = !simulation->model.block_is_held;
    if (balances && control->counters.accepted > 0)
        errors->moment = fmax(errors->moment, seen.moment_error);
    TRY(recorders_record(&simulation->recorders, &seen, err));
    bool quiet = simulation->events.rapid < 0 && seen.certified;
    if (!quiet) simulation->last_unquiet = seen.t;
    bool longest = seen.step_size >= control->def.step_max;
    if (balances && longest &&
        seen.t - simulation->last_unquiet > QUIET_TIME * simulation->model.scales.time)
        errors->moment_quasi_static = fmax(errors->moment_quasi_static, seen.moment_static_error);
    if (!isfinite(seen.mu) || !isfinite(seen.max_slip_rate))
        FAIL(err, ERROR_COMPUTE, "at t = %g mu is %g and the largest slip rate %g", seen.t, seen.mu,
             seen.max_slip_rate);
    static const char *const usual =
        "allow more if something hits the block (the nodes that are hit lose their energy, less on "
        "a finer mesh), else lower time.tolerance";
    static const char *const warned =
        "no step may close it: the problem is ill-posed, or not resolved, as the run was warned";
    if (!(seen.energy_error <= simulation->scene.time.energy_tolerance))
        FAIL(err, ERROR_COMPUTE,
             "at t = %g the energy ledger does not close: %.3g of the energy turned over is "
             "missing, time.energy_tolerance allows %g; %s",
             seen.t, seen.energy_error, simulation->scene.time.energy_tolerance,
             simulation->ill_posed ? warned : usual);
cleanup:
    simulation->timing.output += clock_seconds() - started;
    return error_is_clean(err);
}

// This is a StageNotice.
static bool tell_stage(void *self, const char *stage, Error *err)
{
    const Simulation *simulation = self;
    if (!simulation_may_go_on(simulation, err)) return false;
    if (simulation->options.on_stage)
        simulation->options.on_stage(stage, simulation->options.context);
    return true;
}

static bool goes_on_reducing(void *self, Error *err)
{
    return simulation_may_go_on(self, err);
}

// Continues from a checkpoint, which is known to be this scene's before the result is touched.
static bool go_on(Simulation *simulation, const SavedState *state, Error *err)
{
    SavedHead head;
    TRY(saved_state_fits(simulation, state, &head, err));
    if (head.time > simulation->t_end * (1 + 1e-9))
        FAIL(err, ERROR_INPUT,
             "time.until is at t = %g, and this result goes to t = %g already: give a later end "
             "(--extend U=...)",
             simulation->t_end, head.time);
    if (simulation->scene.output.history)
        TRY(checkpoint_check_history(simulation->folder.path, &head.history, err));
    TRY(result_folder_take_up(&simulation->folder, err));
    simulation->goes_on = true;
    start_programs(simulation);
    TRY(start_explicit_steps(simulation, err));
    TRY(open_recorders(simulation, err));
    TRY(amontons_simulation_restore(simulation, state, err));
    simulation->resumed++;
cleanup:
    if (!error_is_clean(err))
        error_context(err, "%s/%s", simulation->options.folder, CHECKPOINT_FILE);
    return error_is_clean(err);
}

// On failure *out still holds what was made: amontons_run reports it, and everyone destroys it.
bool simulation_create_by(const Scene *scene, const RunOptions *options, double deadline,
                          Simulation **out, Error *err)
{
    SavedState state = {0};
    *out = NULL;
    Simulation *simulation = NEW_ARRAY(Simulation, 1, err);
    TRY(simulation);
    *out = simulation;   // also when a stage fails: what is there can be reported and destroyed

    // A run that fails before t = 0 has no answer and no error, and reports none.
    simulation->drops = drops_none();
    simulation->steady = steady_of(NULL, 0, 0);
    simulation->errors = (RunErrors){NAN, NAN, NAN, NAN, NAN, NAN, NAN};

    simulation->scene = *scene;
    simulation->options = *options;
    simulation->deadline = deadline;
    simulation->scene.output.whole_block = options->whole_block;
    simulation->started = simulation->checkpoint_at = clock_seconds();
    TRY(dense_begin(err));

    // The scene must have all that a run needs. Then the folder is claimed, and the checkpoint read
    // where the run is to be continued from one.
    if (options->folder) TRY(output_check(scene, err));
    TRY(result_folder_claim(options->folder, options->overwrite || options->resume,
                            &simulation->folder, err));
    const char *unlocked = file_lock_warning(&simulation->folder.lock);
    if (unlocked) warnings_add(&simulation->warnings, "%s", unlocked);
    if (!(scene->time.until_U > 0) && !(scene->time.until_t > 0))
        FAIL(err, ERROR_INPUT,
             "%s: says not when to stop (time.until): it is a scene for `amontons static`",
             scene->path);
    if (options->resume && !options->folder)
        FAIL(err, ERROR_INPUT, "a run without a result folder leaves nothing to go on from");
    if (options->resume) TRY(checkpoint_read(options->folder, &state, err));

    // The model, the steps, and what makes their answer doubtful.
    const char *warning = amontons_scene_warning(scene);
    if (warning) warnings_add(&simulation->warnings, "%s", warning);
    StageNotice notice = {.tell = tell_stage, .goes_on = goes_on_reducing, .self = simulation};
    TRY(model_obtain(&simulation->scene, &notice, &simulation->model, err));
    simulation->pressure = simulation->model.pressure;
    if (simulation->model.not_reduced[0])
        warnings_add(&simulation->warnings,
                     "the block is not reduced, steps are those of the whole mesh: %s",
                     simulation->model.not_reduced);
    TRY(start_prepare_steps(simulation, err));
    Schedule load = scene_schedule(&scene->load.program);
    bool inviscid = warnings_of_viscosity(scene, &simulation->model, &simulation->warnings);
    bool undamped = warnings_of_resolution(&simulation->control.certificate,
                                           simulation->model.scales.load * schedule_largest(&load),
                                           &simulation->warnings);
    simulation->ill_posed = warning || inviscid || undamped;
    warnings_of_branches(&simulation->model, &simulation->warnings);
    warnings_of_damping(&simulation->model, &simulation->warnings);
    if (simulation->model.interface.dim > 2 && scene->given[scene_key_index("material.plane")])
        warnings_add(&simulation->warnings,
                     "material.plane means nothing here: the mesh is in space");
    if (simulation->model.mesh.warning[0])
        warnings_add(&simulation->warnings, "gmsh made the mesh, but says: %s",
                     simulation->model.mesh.warning);
    warnings_of_memory(&simulation->model, simulation->model.scales.load * schedule_largest(&load),
                       &simulation->warnings);
    warnings_of_shape(scene, simulation->model.length, simulation->model.height,
                      &simulation->warnings);
    warnings_of_units(&simulation->model, &simulation->warnings);
    warnings_of_gaps(&simulation->model, &simulation->warnings);
    warnings_of_rod(scene, &simulation->model.interface, simulation->model.height,
                    &simulation->warnings);
    if (options->resume)
        TRY(go_on(simulation, &state, err));
    else {
        // A new run: the block relaxes, an earlier result is set aside, t = 0 is recorded.
        double begun = clock_processor_seconds();
        TRY(tell_stage(simulation, "relaxing", err));
        TRY(start_relax(simulation, err));
        simulation->timing.outside -= clock_processor_seconds() - begun;
        TRY(start_explicit_steps(simulation, err));
        TRY(result_folder_clear(&simulation->folder, err));
        TRY(open_recorders(simulation, err));
        TRY(record_step(simulation, err));
        simulation->allocations_before = simulation_allocations(simulation);
    }

    simulation->timing.outside += clock_processor_seconds();
cleanup:
    amontons_state_free(&state);
    return error_is_clean(err);
}

bool amontons_simulation_create(const Scene *scene, const RunOptions *options, Simulation **out,
                                Error *err)
{
    NUMBERS_HAVE_A_POINT;
    return simulation_create_by(scene, options, INFINITY, out, err);
}

// A run is also finished if the time that is left is shorter than every step size whose matrices
// are factored: a new factorisation is not worth it. The periodic regime is looked at only when an
// event has ended.
static bool is_finished(const Simulation *simulation)
{
    const StepControl *control = &simulation->control;
    bool implicit = simulation->scene.time.scheme != SCHEME_EXPLICIT;
    double remaining = simulation->t_end - control->now.time;
    bool finished = isfinite(simulation->t_end) &&
                    (remaining <= 1e-9 * simulation->t_end ||
                     (implicit && !step_control_fits(control, remaining)));
    if (simulation->scene.time.until_periodic && simulation->events.ended)
        finished = finished || answers_of(&simulation->drops).enough;

    // An event that time.until asks for.
    const Events *events = &simulation->events;
    double slidings = simulation->scene.time.until_slidings;
    bool slid = slidings > 0 && events->rapid < 0 && events->kinds[EVENT_LEADING] >= slidings;
    return finished || slid || simulation->mu_fell;
}

// An explicit `step` is one record. *finished: the end of the scene, or the
// periodic regime where the scene asks for it.
bool amontons_simulation_step(Simulation *simulation, StepView *view, bool *finished, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    static const double WORTH = 0.125;   // of the wave step
    StepControl *control = &simulation->control;
    const Events *events = &simulation->events;
    double started = clock_seconds(), end = simulation->t_end, now = control->now.time;
    bool implicit = simulation->scene.time.scheme != SCHEME_EXPLICIT;
    if (!steering_is_open(simulation, err)) return false;
    if (implicit) {
        // Steps end at the points of programs, but for what is too short to be worth a level: that
        // is stepped over while waves are resolved.
        double point = steering_next_point(simulation);
        bool near = point - now < WORTH * control->def.wave_step;
        if (near) step_control_disturb(control);
        control->lands = !near && point < end;
        if (!step_control_advance(control, (control->lands ? point : end) - now, err)) return false;
        steering_pass_point(simulation, point);
    } else {
        // One record of many small steps: of few where slip is rapid, as its events would be missed
        // else.
        double rate = events->rapid >= 0 ? -1 : events->rate_start;
        if (!step_control_advance_explicit(control, &simulation->explicit_reference,
                                           simulation->explicit_steps, rate, err))
            return false;
    }
    simulation->timing.solve += clock_seconds() - started;

    // The state reached goes to the recorders.
    if (!record_step(simulation, err)) return false;
    if (!output_begin_result(simulation, err)) return false;
    if (implicit && isfinite(simulation->t_end) &&
        !step_control_gets_on(control, simulation->t_end, err))
        return false;
    *finished = is_finished(simulation);
    if (view) *view = step_view(&simulation->seen, events, &simulation->contact, simulation->t_end);
    return true;
}

void amontons_simulation_view(const Simulation *simulation, StepView *view)
{
    *view =
        step_view(&simulation->seen, &simulation->events, &simulation->contact, simulation->t_end);
}

// Recovered at each call: a product with all modes of a reduced bulk.
bool amontons_simulation_block(Simulation *simulation, BlockView *view, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    const Mesh *mesh = &simulation->model.mesh;
    const BulkOperator *system = &simulation->model.system;
    const State *now = &simulation->control.now;
    *view = (BlockView){0};
    if (!simulation->options.whole_block)
        return REFUSE(
            err,
            "the motion of the whole block is kept only where RunOptions.whole_block asks for it");
    int64_t dofs = (int64_t)mesh->dim * mesh->node_count;
    if (!simulation->block_motion && !(simulation->block_motion = NEW_ARRAY(double, 2 * dofs, err)))
        return false;
    double *displacement = simulation->block_motion;
    double *velocity = displacement + dofs;
    if (!bulk_operator_recover(system, 2, (const double *[]){now->displacement, now->velocity},
                               (double *[]){displacement, velocity}, err))
        return false;
    floor_displace(mesh, displacement);
    floor_displace(mesh, velocity);
    *view = (BlockView){.nodes = mesh->node_count,
                        .dimensions = mesh->dim,
                        .elements = mesh->element_count,
                        .position = mesh->position,
                        .displacement = displacement,
                        .velocity = velocity,
                        .first_node = mesh->first_node,
                        .element_nodes = mesh->element_nodes};
    return true;
}

// Steps until the scene ends, or something ends it before.
bool simulation_loop(Simulation *simulation, Error *err)
{
    Error unseen = {0}, lost = {0};
    bool finished = simulation->goes_on && is_finished(simulation);
    while (!finished) {
        if (!amontons_simulation_step(simulation, NULL, &finished, err)) return false;
        checkpoint_when_due(simulation);
        if (simulation_may_go_on(simulation, &unseen)) continue;

        // Stopped. It says what is kept only where it is.
        bool asked = checkpoint_is_kept(simulation);
        bool kept = asked && checkpoint_now(simulation, &lost);
        const char *folder = simulation->folder.path;
        double U = simulation->seen.U, t = simulation->seen.t;
        if (asked && !kept)
            return FAULT(err, ERROR_INTERRUPT,
                         "stopped at U = %g (t = %g); this state is not kept: %s", U, t,
                         lost.message);
        return FAULT(err, ERROR_INTERRUPT, "stopped at U = %g (t = %g)%s%s%s", U, t,
                     *folder ? "; what was computed is kept in " : "", folder,
                     kept ? "; the same command with --resume goes on from there" : "");
    }
    return true;
}

Answers simulation_answers(const Simulation *simulation)
{
    Answers answers = answers_of(&simulation->drops);
    steady_answer(&simulation->steady, &answers);
    return answers;
}

bool simulation_finish(Simulation *simulation, const Error *failure, RunSummary *summary,
                       Error *err)
{
    double started = clock_seconds();
    simulation->timing.outside -= clock_processor_seconds();
    Error second = {0};
    if (failure)
        fields_flush(&simulation->fields, &second);   // what was computed is written all the same
    else if (!output_begin_result(simulation, err) || !fields_flush(&simulation->fields, err) ||
             !checkpoint_at_end(simulation, err))
        return false;
    simulation->closed = true;
    if (!failure) output_warn_of_window(simulation);
    events_close(&simulation->events, &simulation->seen);
    if (simulation->recorders.count > 0)
        simulation->errors.reduction = dt_levels_reduction_error(&simulation->control.dt_levels);
    Answers *answers = &simulation->answers;
    *answers = simulation_answers(simulation);
    double own_mu_M = answers->mu_M.value;
    simulation->least_resolved = drops_least_resolved(&simulation->drops, answers->first);
    one_mesh_answer(simulation, answers);
    if (simulation->levels) levels_answer_for(simulation->levels, answers);
    warnings_of_slip(&simulation->scene, &simulation->model.interface, simulation->least_resolved,
                     &simulation->warnings);
    warnings_of_strain(&simulation->model, answers->mu_max, &simulation->warnings);
    warnings_of_base(base_slip(&simulation->model, &simulation->control.now),
                     &simulation->warnings);
    warnings_of_rotation(&simulation->scene, &simulation->rotation, &simulation->warnings);
    simulation->counters = summary_count(simulation);   // what follows allocates
    if (simulation->history.file && !simulation->folder.aside &&
        !(output_store_warnings(simulation, err) &&
          history_finish(&simulation->history, &simulation->drops, answers->first,
                         answers->mu_M.value, answers->critical_length, err) &&
          output_draw_figures(simulation, err)))
        return false;
    simulation->timing.output += clock_seconds() - started;
    simulation->timing.total = clock_seconds() - simulation->started;
    simulation->timing.outside += clock_processor_seconds();

    // run.json, and the same for the caller. A run whose input was refused leaves none; one that
    // failed before t = 0 has made no list of its files yet.
    const RunOptions *options = &simulation->options;
    bool refused = failure && failure->code == ERROR_INPUT;
    if (result_folder_is_settled(&simulation->folder) && !refused &&
        !(own_list_make(simulation->folder.path, err) &&
          report_write(simulation, failure, simulation->folder.path, err)))
        return false;
    if (options->on_report) {
        const char *folder = options->folder ? options->folder : ".";
        char *text = report_text(simulation, failure, folder, err);
        if (!text) return false;
        options->on_report(text, options->context);
        memory_free(text);
    }
    summary_fill(simulation, summary);
    summary->bar_own_mu_M = own_mu_M;
    return true;
}

bool amontons_simulation_finish(Simulation *simulation, RunSummary *summary, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    return steering_is_open(simulation, err) && simulation_finish(simulation, NULL, summary, err);
}

void amontons_simulation_destroy(Simulation *simulation)
{
    if (!simulation) return;
    fields_destroy(&simulation->fields);
    history_destroy(&simulation->history);
    probes_destroy(&simulation->probes);
    contact_arrays_destroy(&simulation->contact);
    pads_destroy(&simulation->pads);
    drops_destroy(&simulation->drops);
    events_destroy(&simulation->events);
    explicit_reference_destroy(&simulation->explicit_reference);
    step_control_destroy(&simulation->control);
    rod_destroy(&simulation->rod);
    model_destroy(&simulation->model);
    result_folder_release(&simulation->folder);
    memory_free_all(simulation->block_motion, simulation);
}

void simulation_end(Simulation *simulation, RunSummary *summary, const Error *err)
{
    if (simulation && !error_is_clean(err)) {
        Error second = {0};   // the first error is the one that counts
        simulation_finish(simulation, err, summary, &second);
    }
    amontons_simulation_destroy(simulation);
}

// The loop itself allocates nothing but levels and output. A failure anywhere is written into
// run.json with what there was until then.
bool simulation_run(const Scene *scene, const RunOptions *options, RunSummary *summary, Error *err)
{
    Simulation *simulation = NULL;
    *summary = (RunSummary){0};
    TRY(amontons_simulation_create(scene, options, &simulation, err));
    TRY(simulation_loop(simulation, err));
    TRY(amontons_simulation_finish(simulation, summary, err));
cleanup:
    simulation_end(simulation, summary, err);
    return error_is_clean(err);
}
