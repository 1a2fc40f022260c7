// SPDX-License-Identifier: GPL-2.0-or-later
// Linear stability of quasi-static slip along the loading path, after the paper's analysis of its
// 1D model but for the block itself. A state on the path is disturbed by exp(lambda t); with J the
// slipping nodes and W = diag((mu_S - mu_K) p_i w_i/v_c) on J,
//
//     [ lambda M + C + K/lambda ] v = W v   on J, all other contact nodes held,
//
// plus what the pressure changes that slip brings along do to friction (stepping/growth solves it).
// As l grows a pair of rates crosses the imaginary axis (l_sc: disturbances oscillate and grow),
// meets on the real axis (l_c: they run away), and the block slides. Between node positions the
// crossing is interpolated in l, since the front itself can only stand at nodes.
#include "study/stability/stability.h"

#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "friction/friction.h"
#include "contact/slip.h"
#include "record/contact_arrays.h"
#include "run/result/result_folder.h"
#include "scene/friction_law.h"

#include <math.h>
#include <stdio.h>

// A step of the path in units of crossing time + viscous time: long against all that can grow.
static const double PATH_STEP_LIMIT = 10;
// Displacement of the rod in a step, in units of (mu_S - mu_K) p H/E: PATH_SLIP, but at most
// PATH_ELEMENTS over the number of nodes along the contact. The front crosses a block within some 4
// units.
static const double PATH_SLIP = 0.02, PATH_ELEMENTS = 0.5;
static const double MEMORY_PART = 0.1;   // of a rate that friction's memory has: the slowest shift
static const double SNAP_LIMIT =
    4;   // slip of a node in a step, over that of the rod (up to 1.5 elsewhere)
enum {
    PATH_STEPS_LIMIT = 20000,   // some 20 times what 320 contact nodes need
    POINTS_BEYOND = 2   // front positions that are shown beyond l_c
};

// True where the caller has asked to stop, with ERROR_INTERRUPT in err.
static bool stop_wanted(const StabilityPath *path, Error *err)
{
    const StabilityOptions *options = path->options;
    if (options->stop && *options->stop)
        FAIL(err, ERROR_INTERRUPT,
             "stopped: the path is one answer, which is written when it has been followed to its "
             "end; nothing was written, and the same command begins anew");
    return false;
cleanup:
    return true;
}

// Load drops, bulk sliding or not: many pads seldom slide all at once.
static int32_t count_slidings(const Simulation *simulation)
{
    return drops_count(&simulation->drops, DROP_LOAD);
}

// The path's own steps, from the state of the simulation: tolerance and certificate off, so that
// every step is PATH_STEP_LIMIT long, and a rod of its own velocity that continues from where
// the simulation's rod is. Memory for a point per contact node and the two ends.
static bool open_path(StabilityPath *path, Error *err)
{
    Model *model = path->model;
    const Interface *interface = &model->interface;
    const Simulation *before = path->simulation;
    double elements = interface_nodes_along(interface);
    double slip = model_friction_slip(model) * fmin(PATH_SLIP, PATH_ELEMENTS / elements);
    double step = PATH_STEP_LIMIT * model_settling_time(model), velocity = slip / step;
    StepControlDef def = {.tolerance = INFINITY,
                          .step_max = step,
                          .step_min = 1e-12 * step,
                          .wave_step = INFINITY,
                          .use_certificate = false};
    Block block = {.system = &model->system,
                   .interface = interface,
                   .friction = &model->friction,
                   .rod = &path->rod};
    Block paced = block;
    path->scales = model->scales;
    TRY(stability_set_pace(path, velocity, err));
    if (path->nodes) {
        paced.friction = &path->friction;
        paced.stage_friction = path->nodes;
    }
    TRY(model_build_rod(model, before->rod.kind, &path->rod, err));
    TRY(step_control_create(&paced, &def, &path->control, err));
    path->control.certificate.moving.contact_friction =
        &model->friction;   // it is asked about states as seen
    TRY(state_create(&model->system, interface, &path->last, err));
    TRY(state_create(&model->system, interface, &path->runaway, err));
    state_copy(&before->control.now, &path->control.now);
    stability_start_states(path);
    path->U_start = before->rod.velocity * path->control.now.time;
    for (int32_t j = 0; j < interface->rod_count; j++)
        path->rod.origin[j] = before->rod.origin[j] + path->U_start;
    if (path->rod.stiffness > 0) path->control.now.rod_way -= path->U_start;
    path->rod.velocity = velocity;
    step_control_restart(&path->control);
    double speed = materials_slip_speed(&model->materials);
    double mean = material_slip_speed(&model->materials.mean);   // with soft regions it is slower
    GrowthDef growth = growth_def(model->length, speed, (int32_t)elements);
    growth.slowest = fmin(growth.slowest * (mean / speed), mean / (4 * model->height));   // if tall
    // States grow or decay at about the rate at which steady slip at V forgets.
    double memory = MEMORY_PART * model_forgets(model);
    while (path->nodes && growth.slowest > memory) growth.slowest /= 2;
    path->slowest = growth.slowest;
    path->growth = growth_create(&block, &growth, err);
    path->room = interface->contact_count + 2;
    path->points = NEW_ARRAY(StabilityPoint, path->room, err);
    path->modes = NEW_ARRAY(double, 2 * (int64_t)path->room * interface->contact_count, err);
    path->critical_mode = NEW_ARRAY(double, interface->contact_count, err);
cleanup:
    return error_is_clean(err);
}

// The part along the drive of a mode at the contact nodes. mode: [interface count]; slip:
// [contact_count].
static void keep_slip(const Interface *interface, const double *mode, double *slip)
{
    for (int32_t i = 0; i < interface->contact_count; i++)
        slip[i] = mode[interface_tangent(interface, i)];
}

static int32_t count_slipping(const Observation *seen)
{
    int32_t count = 0;
    for (int32_t i = 0; i < seen->state->contact_count; i++)
        count += seen_status(seen, i) != CONTACT_STICK;
    return count;
}

// F_T/F_N at the scene's V, of a state of the path, whose mu is for V -> 0. Slip at a rate v meets
// mu(v), as if mu_S were smaller; the path gives v over that of the rod. What the load has gained
// since slip set out goes with mu_S - mu_K, so it is smaller by the same part, a mean over the
// pressure behind the front. Without it the path's mu is above that of runs.
static double mu_at_V(const StabilityPath *path, const State *state, double mu)
{
    const Friction *friction = &path->model->friction;
    const Interface *interface = &path->model->interface;
    double start = path->count > 0 ? path->points[0].mu : mu, lost = 0, pressed = 0;
    if (path->options->at_end || !(friction->drop > 0)) return mu;
    // With memory slip rates are those at V already.
    double speed = path->nodes ? 1 : path->model->scene->rod.velocity / path->rod.velocity;
    for (int32_t i = 0; i < state->contact_count; i++) {
        double pressing = state->reaction[interface_normal(interface, i)];
        double pressure = pressing / interface->weight[i];
        if (!status_slips(state->status[i])) continue;
        double rate = speed * slip_size(interface, i, state->slip_rate);
        const FrictionNode *node = friction_at(friction, i);
        const double *theta = &state->theta[i * STATES_MAX];
        FrictionRates rests, slips;
        friction_rates_pressed(node, pressure, 0, theta, &rests);
        friction_rates_pressed(node, pressure, rate, theta, &slips);
        bool at_V = node->law->remembers &&
                    !friction_weakens_at_once(node);   // on the path already
        if (!at_V) lost += pressing * (rests.mu - slips.mu);
        pressed += pressing * (friction_drop(node) / friction->drop);
    }
    return pressed > 0 ? mu - (mu - start) * lost / (pressed * friction->drop) : mu;
}

// One more point: the growth rates of `last`, as it was seen. Keeps the shape of the fastest mode,
// of the first real one, and the state at which slip first runs away.
static bool add_point(StabilityPath *path, const Observation *seen, Error *err)
{
    const Interface *interface = &path->model->interface;
    StabilityPoint *point = &path->points[path->count];
    GrowthRates rates;
    Observation last = *seen;
    last.state = &path->last;
    last.creep /= path->pace;
    double all = 0, slips = 0;   // areas
    for (int32_t i = 0; i < interface->contact_count; i++) {
        all += interface->weight[i];
        if (seen_status(&last, i) != CONTACT_STICK) slips += interface->weight[i];
    }
    // With memory: nothing grows that is as fast as the slowest rate that is looked for.
    double reach = path->nodes ? 1 / path->slowest : 0, started = clock_seconds();
    TRY(growth_rates(path->growth, &path->last, &rates, err));
    *point = (StabilityPoint){
        .front = seen->front - seen->trailing,
        .slipping = count_slipping(&last),
        .U = path->U_start + seen->U,
        .mu = seen->mu,
        .mu_at_V = mu_at_V(path, &path->last, seen->mu),
        .rate_re = rates.count > 0 ? rates.rate[0].re : NAN,
        .rate_im = rates.count > 0 ? rates.rate[0].im : NAN,
        .real_rate = rates.real.re,
        .load = growth_scan(path->growth, &path->last).ratio,
        .certified = certificate_holds(&path->control.certificate, &path->last, reach),
        .area = slips / all};
    double *mode = path->modes + 2 * (int64_t)path->count * interface->contact_count;
    keep_slip(interface, rates.mode_re, mode);
    keep_slip(interface, rates.mode_im, mode + interface->contact_count);
    if (rates.real_mode && path->critical < 0) {
        path->critical = path->count;
        keep_slip(interface, rates.real_mode, path->critical_mode);
    }
    // At the scene's V slip runs away by half a period's growth, or for certain: by a real rate.
    bool runs_away = path->critical >= 0 || stability_half_period(path, path->count) >= 0;
    if (path->at_rod < 0 && runs_away) {
        path->at_rod = path->count;
        state_copy(&path->last, &path->runaway);
    }
    path->count++;
    path->seconds_growth += clock_seconds() - started;
    if (path->options->on_point) path->options->on_point(point, path->options->context);
cleanup:
    return error_is_clean(err);
}

// Steps until the front has reached the end (whose own state is the last point), or is some
// positions beyond l_c. A node that goes SNAP_LIMIT times as far in one step as the rod has jumped:
// where a pad rests on its leading edge, slow slip has no state to go on to once the edge reaches
// mu_S. The path's long steps damp the jump and go on; in time it may be a sliding.
static bool follow_path(StabilityPath *path, Error *err)
{
    const Interface *interface = &path->model->interface;
    const Friction *friction = path->nodes ? &path->friction : &path->model->friction;
    double end = interface->x[interface->contact_count - 1];
    Observation before = {0};
    int32_t most = 0;   // nodes that slipped at a time, so far
    // Nodes that begin to slip from one point of the path to the next: each in the plane, in space
    // a third of those that stand across it.
    double across = interface->contact_count / interface_nodes_along(interface);
    int32_t more = (int32_t)fmax(across / 3, 1);
    for (int32_t step = 0; step < PATH_STEPS_LIMIT; step++) {
        if (stop_wanted(path, err)) goto cleanup;
        stability_look(path);
        TRY(step_control_advance(&path->control, INFINITY, err));
        Observation seen = observe(&path->control, &path->scales);
        TRY(seen_check_coefficients(&seen, friction, err));
        int32_t slipping = count_slipping(&seen);
        bool snaps = seen.max_slip_rate > SNAP_LIMIT * path->rod.velocity;
        if (snaps && step > 0 && isnan(path->mu_snap)) {
            const double *rate = path->control.now.slip_rate;
            path->mu_snap = mu_at_V(path, &path->last, before.mu);
            for (int32_t i = 0; i < interface->contact_count; i++)
                if (slip_size(interface, i, rate) > slip_size(interface, path->snap_node, rate))
                    path->snap_node = i;
        }
        bool next = slipping >= most + more;
        if (step > 0 && next) TRY(add_point(path, &before, err));
        if (next) most = slipping;
        before = seen;
        bool beyond = path->critical >= 0 && path->count > path->critical + POINTS_BEYOND;
        if (beyond && !path->options->whole) break;
        bool crossed = seen.front >= end;
        if (interface->dim > 2) crossed = slipping == interface->contact_count;
        if (!crossed) continue;
        path->at_end = true;
        stability_look(path);
        TRY(add_point(path, &seen, err));
        break;
    }
cleanup:
    if (!error_is_clean(err)) error_context(err, "on the quasi-static path");
    return error_is_clean(err);
}

// Four stages: a run up to rest after the wanted slidings, the quasi-static path with a point per
// front position, where things are lost, results.
bool amontons_stability(const Scene *scene, const StabilityOptions *options,
                        StabilitySummary *summary, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    StabilityPath path = {
        .options = options, .pace = 1, .critical = -1, .at_rod = -1, .mu_snap = NAN};
    ResultFolder folder = {0};
    double started = clock_seconds();
    *summary = (StabilitySummary){.l_c = NAN, .mu_c = NAN};
    bool driven = scene->rod.kind != ROD_NONE && scene->rod.velocity > 0;
    if (!options->at_end && !driven)
        FAIL(err, ERROR_INPUT,
             "%s: stability follows the slip that a rod drives: rod.velocity must be above 0 and "
             "rod.kind push or bonded",
             scene->path);
    if (!options->at_end && (scene->rod.program.factor.count || scene->load.program.factor.count))
        FAIL(err, ERROR_INPUT,
             "%s: %s.program: the quasi-static path is that of one load and of a rod that gets on",
             scene->path, scene->rod.program.factor.count > 0 ? "rod" : "load");
    if (scene->time.scheme == SCHEME_EXPLICIT)
        FAIL(err, ERROR_INPUT,
             "%s: the quasi-static path needs implicit steps: --set time.scheme=sdirk2",
             scene->path);
    if (!scene_law_waits(scene) && !(scene->friction.mu_static > 0))
        FAIL(err, ERROR_INPUT, "%s: without friction (friction.mu_static = 0) nothing can grow",
             scene->path);
    TRY(result_folder_claim(options->folder, options->overwrite, &folder, err));
    RunOptions run = {.on_step = options->on_step, .context = options->context};
    TRY(amontons_simulation_create(scene, &run, &path.simulation, err));
    path.model = &path.simulation->model;

    // Time stepping until the block has come to rest after the wanted number of slidings.
    Simulation *simulation = path.simulation;
    bool finished = false;
    while (!options->at_end &&
           (count_slidings(simulation) < options->slidings || simulation->events.rapid >= 0)) {
        if (stop_wanted(&path, err)) goto cleanup;
        if (finished)
            FAIL(err, ERROR_INPUT,
                 "%s: only %d of %d slidings, or drops of the load by 5 %%, ended before the "
                 "scene's end at U = %g: give a later one (--set time.until.U=%g), or start the "
                 "path earlier (--from start, fewer --slidings)",
                 simulation->scene.path, count_slidings(simulation), options->slidings,
                 simulation->seen.U, 4 * simulation->seen.U);
        TRY(amontons_simulation_step(simulation, NULL, &finished, err));
    }

    double before = clock_seconds();
    if (options->at_end) {
        // The one state in which the scene's run ends.
        while (!finished) {
            if (stop_wanted(&path, err)) goto cleanup;
            TRY(amontons_simulation_step(simulation, NULL, &finished, err));
        }
        Observation seen = simulation->seen;
        TRY(open_path(&path, err));
        state_copy(&simulation->control.now, &path.last);
        seen.creep = 0;   // what creeps may grow
        if (count_slipping(&seen) == 0)
            FAIL(err, ERROR_INPUT, "%s: nothing slips at the scene's end, t = %g: nothing can grow",
                 simulation->scene.path, seen.t);
        seen.U = 0;   // add_point counts from where the path begins
        TRY(add_point(&path, &seen, err));
    } else {
        TRY(open_path(&path, err));
        TRY(follow_path(&path, err));
    }
    stability_summarise(&path, summary);
    TRY(stability_measure_pads(&path, summary, err));
    stability_explain(&path, summary);
    summary->seconds_before = before - started;
    summary->seconds_path = clock_seconds() - before - path.seconds_growth;
    TRY(result_folder_clear(&folder, err));
    if (options->folder) {
        snprintf(summary->folder, sizeof summary->folder, "%s", options->folder);
        TRY(stability_write(&path, summary, err));
    }
    TRY(result_folder_settle(&folder, err));
cleanup:
    growth_destroy(path.growth);
    step_control_destroy(&path.control);
    state_destroy(&path.last);
    state_destroy(&path.runaway);
    rod_destroy(&path.rod);
    amontons_simulation_destroy(path.simulation);
    memory_free_all(path.nodes, path.points, path.modes, path.critical_mode);

    result_folder_release(&folder);
    return error_is_clean(err);
}
