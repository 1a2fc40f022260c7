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
#include "base/memory.h"
#include "run/result_folder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A step of the path in units of crossing time + viscous time: long against all that can grow.
static const double PATH_STEP = 10;
// What the rod moves in a step, in units of (mu_S - mu_K) p H/E (the front crosses a block within
// some 4 of them), but not more than about this part of an element.
static const double PATH_SLIP = 0.02, PATH_ELEMENTS = 0.5;
static const double SNAP =
    4;   // slip of a node in a step, over that of the rod (up to 1.5 elsewhere)
enum {
    PATH_STEPS_MAX = 20000,   // some 20 times what 320 contact nodes need
    POINTS_BEYOND = 2   // front positions that are shown beyond l_c
};

static bool check_scene(const Scene *scene, const StabilityOptions *options, Error *err)
{
    bool driven = scene->rod.kind != ROD_NONE && scene->rod.velocity > 0;
    if (!options->at_end && !driven)
        FAIL(err, ERROR_INPUT,
             "%s: stability follows the slip that a rod drives: rod.velocity must be above 0 and "
             "rod.kind push or bonded",
             scene->path);
    if (scene->time.scheme == SCHEME_EXPLICIT)
        FAIL(err, ERROR_INPUT,
             "%s: the quasi-static path needs implicit steps: --set time.scheme=sdirk2",
             scene->path);
    if (!(scene->friction.mu_static > 0))
        FAIL(err, ERROR_INPUT, "%s: without friction (friction.mu_static = 0) nothing can grow",
             scene->path);
cleanup:
    return error_is_clean(err);
}

// True where the caller has asked to stop, with ERROR_INTERRUPT in err.
static bool stop_wanted(const StabilityPath *path, Error *err)
{
    const StabilityOptions *options = path->options;
    if (options->stop && *options->stop) FAIL(err, ERROR_INTERRUPT, "stopped; nothing was written");
    return false;
cleanup:
    return true;
}

// Load drops, bulk sliding or not: many pads seldom slide all at once.
static int32_t count_slidings(const Simulation *simulation)
{
    return drops_count(&simulation->drops, DROP_LOAD);
}

// Time stepping until the block has come to rest after the wanted number of slidings.
static bool run_slidings(StabilityPath *path, Error *err)
{
    Simulation *simulation = path->simulation;
    const Events *events = &simulation->events;
    bool finished = false;
    while (count_slidings(simulation) < path->options->slidings || events->rapid >= 0) {
        if (stop_wanted(path, err)) goto cleanup;
        if (finished)
            FAIL(err, ERROR_INPUT,
                 "%s: only %d of %d slidings, or drops of the load by 5 %%, ended before the "
                 "scene's end at U = %g: give a later one (--set time.until.U=%g), or start the "
                 "path earlier (--from start, fewer --slidings)",
                 simulation->scene.path, count_slidings(simulation), path->options->slidings,
                 simulation->seen.U, 4 * simulation->seen.U);
        TRY(amontons_simulation_step(simulation, NULL, &finished, err));
    }
cleanup:
    return error_is_clean(err);
}

// The path's own steps, from the state of the simulation: tolerance and certificate off, so that
// every step is PATH_STEP long, and a rod of its own velocity that continues from where
// the simulation's rod is. Memory for a point per contact node and the two ends.
static bool open_path(StabilityPath *path, Error *err)
{
    Model *model = path->model;
    const Interface *interface = &model->interface;
    const Simulation *before = path->simulation;
    double elements = interface->contact_count;
    double slip = model_friction_slip(model) * fmin(PATH_SLIP, PATH_ELEMENTS / elements);
    double step = PATH_STEP * model->scales.time;
    StepControlDef def = {.tolerance = INFINITY,
                          .step_max = step,
                          .step_min = 1e-12 * step,
                          .wave_step = INFINITY,
                          .use_certificate = false};
    Block block = {
        .system = &model->system, .interface = interface, .law = &model->law, .rod = &path->rod};
    TRY(model_build_rod(model, before->rod.kind, &path->rod, err));
    TRY(step_control_create(&block, &def, &path->control, err));
    TRY(state_create(&model->system, interface, &path->last, err));
    TRY(state_create(&model->system, interface, &path->runaway, err));
    state_copy(&before->control.now, &path->control.now);
    path->U_start = before->rod.velocity * path->control.now.time;
    for (int32_t j = 0; j < interface->rod_count; j++)
        path->rod.origin[j] = before->rod.origin[j] + path->U_start;
    path->rod.velocity = slip / step;
    step_control_restart(&path->control);
    double speed = material_slip_speed(&model->material);
    GrowthDef growth = growth_def(model->length, speed, interface->contact_count);
    growth.slowest = fmin(growth.slowest, speed / (4 * model->height));   // a tall one
    path->growth = growth_create(&block, &growth, err);
    path->room = interface->contact_count + 2;
    path->points = NEW_ARRAY(StabilityPoint, path->room, err);
    path->modes = NEW_ARRAY(double, 2 * (int64_t)path->room * interface->contact_count, err);
    path->critical_mode = NEW_ARRAY(double, interface->contact_count, err);
cleanup:
    return error_is_clean(err);
}

// The tangential part of a mode at the contact nodes. mode: [interface count]; slip:
// [contact_count].
static void keep_slip(const Interface *interface, const double *mode, double *slip)
{
    for (int32_t i = 0; i < interface->contact_count; i++) slip[i] = mode[interface_tangent(i)];
}

static int32_t count_slipping(const State *state)
{
    int32_t count = 0;
    for (int32_t i = 0; i < state->contact_count; i++) count += state->status[i] != CONTACT_STICK;
    return count;
}

// Half a period's growth against v_c/V: pi Re/Im - ln(v_c/V). From 0 on a disturbance of the rod's
// size comes to v_c, where friction no longer weakens, before its oscillation turns it back: slip
// then runs away although the pair is still complex.
static double half_period(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    double ratio = path->model->law.critical_velocity / path->model->scene->rod.velocity;
    if (!(point->rate_re > 0)) return -INFINITY;
    if (!(point->rate_im > 0)) return INFINITY;
    return M_PI * point->rate_re / point->rate_im - log(ratio);
}

// At the scene's V: by the above, or for certain because a real rate has been found.
static bool runs_away(const StabilityPath *path, int32_t k)
{
    return path->critical >= 0 || half_period(path, k) >= 0;
}

// One more point: the growth rates of `last`, as it was seen. Keeps the shape of the fastest mode,
// of the first real one, and the state at which slip first runs away.
static bool add_point(StabilityPath *path, const Observation *seen, Error *err)
{
    const Interface *interface = &path->model->interface;
    StabilityPoint *point = &path->points[path->count];
    GrowthRates rates;
    double started = clock_seconds();
    TRY(growth_rates(path->growth, &path->last, &rates, err));
    *point =
        (StabilityPoint){.front = seen->front,
                         .slipping = count_slipping(&path->last),
                         .U = path->U_start + seen->U,
                         .mu = seen->mu,
                         .rate_re = rates.count > 0 ? rates.rate[0].re : NAN,
                         .rate_im = rates.count > 0 ? rates.rate[0].im : NAN,
                         .real_rate = rates.real.re,
                         .load = growth_scan(path->growth, &path->last).load,
                         .certified = certificate_holds(&path->control.certificate, &path->last)};
    double *mode = path->modes + 2 * (int64_t)path->count * interface->contact_count;
    keep_slip(interface, rates.mode_re, mode);
    keep_slip(interface, rates.mode_im, mode + interface->contact_count);
    if (rates.real_mode && path->critical < 0) {
        path->critical = path->count;
        keep_slip(interface, rates.real_mode, path->critical_mode);
    }
    if (path->at_rod < 0 && runs_away(path, path->count)) {
        path->at_rod = path->count;
        state_copy(&path->last, &path->runaway);
    }
    path->count++;
    path->seconds_growth += clock_seconds() - started;
    if (path->options->on_point) path->options->on_point(point, path->options->context);
cleanup:
    return error_is_clean(err);
}

// The one state in which the scene's run ends.
static bool take_end(StabilityPath *path, Error *err)
{
    Simulation *simulation = path->simulation;
    bool finished = false;
    while (!finished) {
        if (stop_wanted(path, err)) goto cleanup;
        TRY(amontons_simulation_step(simulation, NULL, &finished, err));
    }
    Observation seen = simulation->seen;
    TRY(open_path(path, err));
    state_copy(&simulation->control.now, &path->last);
    if (count_slipping(&path->last) == 0)
        FAIL(err, ERROR_INPUT, "%s: nothing slips at the scene's end, t = %g: nothing can grow",
             simulation->scene.path, seen.t);
    seen.U = 0;   // add_point counts from where the path begins
    TRY(add_point(path, &seen, err));
cleanup:
    return error_is_clean(err);
}

// Steps until the front has reached the end (whose own state is the last point), or is some
// positions beyond l_c. A node that goes SNAP times as far in one step as the rod has jumped: where
// a pad rests on its leading edge, slow slip has no state to go on to once the edge reaches mu_S.
// The path's long steps damp the jump and go on; in time it may be a sliding.
static bool follow_path(StabilityPath *path, Error *err)
{
    const Interface *interface = &path->model->interface;
    double end = interface->x[interface->contact_count - 1];
    Observation before = {0};
    int32_t most = 0;   // nodes that slipped at a time, so far
    for (int32_t step = 0; step < PATH_STEPS_MAX; step++) {
        if (stop_wanted(path, err)) goto cleanup;
        state_copy(&path->control.now, &path->last);
        TRY(step_control_advance(&path->control, INFINITY, err));
        Observation seen = observe(&path->control, &path->model->scales);
        int32_t slipping = count_slipping(&path->control.now);
        bool snaps = seen.max_slip_rate > SNAP * path->rod.velocity;
        if (snaps && step > 0 && isnan(path->mu_snap)) path->mu_snap = before.mu;
        if (step > 0 && slipping > most) TRY(add_point(path, &before, err));
        if (slipping > most) most = slipping;
        before = seen;
        bool beyond = path->critical >= 0 && path->count > path->critical + POINTS_BEYOND;
        if (beyond && !path->options->whole) break;
        if (seen.front < end) continue;
        path->at_end = true;
        state_copy(&path->control.now, &path->last);
        TRY(add_point(path, &seen, err));
        break;
    }
cleanup:
    if (!error_is_clean(err)) error_context(err, "on the quasi-static path");
    return error_is_clean(err);
}

// --- where something is lost --------------------------------------------------------------------

// A measure of a point that is below 0 where it is stable and reaches 0 where that is lost. Between
// two points of which the second has one more slipping node, it is taken as linear in l.
typedef double (*Margin)(const StabilityPath *path, int32_t k);

// Point k slips at one node more than the one before, and that is the next one along the front
// (where two slipping parts meet, the front jumps).
static bool is_next(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    const Interface *interface = &path->model->interface;
    int32_t passed = 0;
    for (int32_t i = 0; i < interface->contact_count; i++)
        passed += interface->x[i] > point[-1].front && interface->x[i] <= point->front;
    return point->slipping == point[-1].slipping + 1 && passed == 1;
}

// The certificate is yes or no: lost at the point itself.
static double certificate_margin(const StabilityPath *path, int32_t k)
{
    return path->points[k].certified ? -INFINITY : 0;
}

// Of the oscillating pair: the overdamped rates, which stay near -E/eta, say nothing about it.
static double real_part(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    return point->rate_im > 0 || point->rate_re > 0 ? point->rate_re : -INFINITY;
}

// Weakening over the resistance of M, C and K at the worst s, less 1 (growth_scan; pressure kept).
static double overload(const StabilityPath *path, int32_t k)
{
    return path->points[k].load - 1;
}

// Near the birth of the real pair (Im lambda)^2 is linear through 0; the first point of the
// real pair has none, and is replaced by the extrapolation of the two before it.
static double frequency_square(const StabilityPath *path, int32_t k)
{
    const StabilityPoint *point = &path->points[k];
    if (!(point->rate_re > 0)) return -INFINITY;
    if (point->rate_im > 0) return -point->rate_im * point->rate_im;
    if (k < 2 || !(point[-1].rate_im > 0) || !(point[-2].rate_re > 0) || !is_next(path, k) ||
        !is_next(path, k - 1))
        return 0;
    double square = point[-1].rate_im * point[-1].rate_im;
    double fall = (point[-2].rate_im * point[-2].rate_im - square) /
                  (point[-1].front - point[-2].front);
    return fmax(fall * (point->front - point[-1].front) - square, 0);
}

// Where the margin is lost first: l, U and mu there. Where the margin jumps, the set of slipping
// nodes that has lost it slips ever since its last node began to: since the point before, whose U
// and mu are taken (its own are those at which one more node is about to slip: in set B 4 % more).
static StabilityPoint first_loss(const StabilityPath *path, Margin margin)
{
    StabilityPoint lost = {.front = NAN, .U = NAN, .mu = NAN, .rate_im = NAN};
    int32_t count = path->options->at_end ? 0 : path->count;   // one state has no path
    for (int32_t k = 0; k < count; k++) {
        double after = margin(path, k), before = k > 0 ? margin(path, k - 1) : 0;
        if (!(after >= 0)) continue;
        lost = path->points[k];
        if (k == 0) break;
        const StabilityPoint *last = &path->points[k - 1];
        if (!isfinite(before) || before >= 0 || !is_next(path, k)) {
            lost.U = last->U;
            lost.mu = last->mu;
            break;
        }
        double part = isfinite(after) ? before / (before - after) : 1;
        lost.front = last->front + part * (lost.front - last->front);
        lost.U = last->U + part * (lost.U - last->U);
        lost.mu = last->mu + part * (lost.mu - last->mu);
        break;
    }
    return lost;
}

// The same, or the end of the block: there it slides, whether or not anything grows, at the largest
// mu of the path (that of the end itself is what is left while it slides).
static StabilityPoint first_sliding(const StabilityPath *path, Margin margin)
{
    StabilityPoint lost = first_loss(path, margin);
    if (!isnan(lost.front) || !path->at_end) return lost;
    lost = path->points[path->count - 1];
    for (int32_t k = 0; k < path->count - 1; k++) {
        if (path->points[k].mu < lost.mu) continue;
        lost.mu = path->points[k].mu;
        lost.U = path->points[k].U;
    }
    return lost;
}

// l_sc, l_c and mu there. At the scene's V slip cannot run away later than for V -> 0.
static void summarise(const StabilityPath *path, StabilitySummary *summary)
{
    const Interface *interface = &path->model->interface;
    double length = path->model->length;
    StabilityPoint oscillates = first_loss(path, real_part);
    StabilityPoint slides = first_sliding(path, frequency_square);
    StabilityPoint rod = first_sliding(path, half_period);
    if (slides.front < rod.front) rod = slides;
    *summary =
        (StabilitySummary){.l_sc_certificate = first_loss(path, certificate_margin).front / length,
                           .l_sc = oscillates.front / length,
                           .l_c_scan = first_loss(path, overload).front / length,
                           .l_c = slides.front / length,
                           .l_c_rod = rod.front / length,
                           .mu_sc = oscillates.mu,
                           .mu_snap = path->mu_snap,
                           .mu_c = slides.mu,
                           .mu_rod = rod.mu,
                           .U_c = slides.U,
                           .U_rod = rod.U,
                           .frequency = oscillates.rate_im,
                           .element = 1.0 / fmax(interface->contact_count - 1, 1),
                           .points = path->count,
                           .path_steps = path->control.counters.accepted,
                           .seconds_growth = path->seconds_growth};
}

// Zeroed and half-built paths too.
static void path_destroy(StabilityPath *path)
{
    growth_destroy(path->growth);
    step_control_destroy(&path->control);
    state_destroy(&path->last);
    state_destroy(&path->runaway);
    rod_destroy(&path->rod);
    amontons_simulation_destroy(path->simulation);
    memory_free(path->points);
    memory_free(path->modes);
    memory_free(path->critical_mode);
}

// Four stages: a run up to rest after the wanted slidings, the quasi-static path with a point per
// front position, where things are lost, results.
bool amontons_stability(const Scene *scene, const StabilityOptions *options,
                        StabilitySummary *summary, Error *err)
{
    StabilityPath path = {.options = options, .critical = -1, .at_rod = -1, .mu_snap = NAN};
    ResultFolder folder = {0};
    double started = clock_seconds();
    *summary = (StabilitySummary){.l_c = NAN, .mu_c = NAN};
    TRY(check_scene(scene, options, err));
    TRY(result_folder_claim(options->folder, options->overwrite, &folder, err));
    RunOptions run = {.on_step = options->on_step, .context = options->context};
    TRY(amontons_simulation_create(scene, &run, &path.simulation, err));
    path.model = &path.simulation->model;
    if (!options->at_end) TRY(run_slidings(&path, err));
    double before = clock_seconds();
    if (options->at_end) {
        TRY(take_end(&path, err));
    } else {
        TRY(open_path(&path, err));
        TRY(follow_path(&path, err));
    }
    summarise(&path, summary);
    TRY(stability_measure_pads(&path, summary, err));
    summary->seconds_before = before - started;
    summary->seconds_path = clock_seconds() - before - path.seconds_growth;
    TRY(result_folder_clear(&folder, err));
    if (options->folder) {
        snprintf(summary->folder, sizeof summary->folder, "%s", options->folder);
        TRY(stability_write(&path, summary, err));
    }
cleanup:
    path_destroy(&path);
    result_folder_release(&folder);
    return error_is_clean(err);
}
