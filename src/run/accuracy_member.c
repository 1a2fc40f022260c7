// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/accuracy_state.h"

#include "answers/drop_series.h"
#include "base/clock.h"
#include "base/memory.h"
#include "io/cache/cache_folder.h"
#include "model/step_rule.h"
#include "scene/programs.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    CONTACT_NODES_MIN = 21,   // of the first level
    PAD_NODES_MIN = 5,   // of it on each piece of the contact
    SPACE_NODES_MIN = 36,   // likewise in space: 6 x 6, and 3 x 3
    SPACE_PAD_NODES_MIN = 9,
    PEAKS_MIN = 8,   // that count in a run, before its answer can be known
    SPACE_PEAKS_MIN = 4,   // where each takes seconds to minutes
};
static const double DROPS_SHARE = 0.2;   // of the bar wanted, for the drops of each run
static const double LONGER = 4;   // than the scene's end, for a run whose answer is not known; and
    // once more as much longer where its run-in is not over
static const double FULL_SHARE = 0.25;   // of the time given, at most, for stepping in full

Level *accuracy_last_level(Accuracy *accuracy)
{
    return &accuracy->levels.list[accuracy->levels.count - 1];
}

int32_t accuracy_runs_first(const Accuracy *accuracy)
{
    return accuracy->levels.count == 1 || accuracy->cell_ratio == RATIO_SPLIT ? 2 : 1;
}

double accuracy_full(const Accuracy *accuracy, double times)
{
    double most = FULL_SHARE * accuracy->scene->accuracy.within;
    double stepping = times * accuracy->stepping;
    return times * accuracy->making + (most > 0 ? fmin(stepping, most) : stepping);
}

double accuracy_seconds_left(const Accuracy *accuracy)
{
    return accuracy->deadline - accuracy_full(accuracy, 1) - clock_seconds();
}

bool scene_refine(Scene *scene, double refine, Error *err)
{
    int32_t k = 0, count = scene->mesh.parameter_count;
    while (k < count && strcmp(scene->mesh.parameters[k].name, "refine") != 0) k++;
    if (refine == 1) return true;
    if (k < count) {
        scene->mesh.parameters[k].value *= refine;
        return true;
    }
    if (k == SCENE_LIST_MAX)
        return REFUSE(err, "%s: mesh.set: no room for `refine` beside %d parameters", scene->path,
                      k);
    scene->mesh.parameters[k] = (MeshParameter){.name = "refine", .value = refine};
    scene->mesh.parameter_count++;
    return true;
}

void scene_scale_loads(Scene *scene, double factor)
{
    scene->load.pressure *= factor;
    scene->load.force *= factor;
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        scene->load.tractions[k].x *= factor;
        scene->load.tractions[k].y *= factor;
        scene->load.tractions[k].z *= factor;
    }
}

bool accuracy_is_known(const Accuracy *accuracy, const Answers *answers)
{
    bool hold = accuracy->levels.of_hold;
    const Estimate *asked = hold ? &answers->mu_hold : &answers->mu_M;
    int32_t counted = hold ? answers->regime.count : answers->peaks_counted;
    double allowed = DROPS_SHARE * accuracy->scene->accuracy.mu;
    if (answers->steady) return true;
    if (answers->regime.run_in != RUN_IN_OVER) return false;
    int32_t least = accuracy->levels.list[accuracy->levels.count - 1].space ? SPACE_PEAKS_MIN
                                                                            : PEAKS_MIN;
    if (counted >= least) return asked->error <= allowed * asked->value;
    return counted == 0 && answers->enough;
}

static bool is_steered(const Scene *scene)
{
    return scene_has_program(&scene->rod.program) || scene_has_program(&scene->load.program);
}

// Steps until the answer is known, time is up, or the end.
static bool step_until_known(Accuracy *accuracy, Simulation *simulation, EndWait *wait, Error *err)
{
    const Scene *scene = accuracy->scene;
    Scene *own = &simulation->scene;
    for (bool finished = false; !finished;) {
        if (!amontons_simulation_step(simulation, NULL, &finished, err)) return false;
        end_wait_watch(wait, simulation);

        // As far as the scene itself goes, it slides steadily, and no load drop is ahead.
        if (simulation->seen.t >= step_rule_end(scene) &&
            !isnan(steady_mu(&simulation->steady).value) && !is_steered(scene))
            break;

        // A run that comes to its end in the middle of its run-in, or slides slowly and is not
        // steady yet, goes on, once. What a program does may well look like a run-in, for ever.
        bool once = own->time.until_U > LONGER * scene->time.until_U ||
                    own->time.until_t > LONGER * scene->time.until_t;
        if (finished && !once && !is_steered(scene)) {
            bool is_steady_soon = simulation->steady.slides && simulation->drops.count == 0;
            if (is_steady_soon || regime_of(&simulation->drops).run_in != RUN_IN_OVER) {
                own->time.until_U *= LONGER;
                own->time.until_t *= LONGER;
                simulation->t_end = step_rule_end(own);
                finished = false;
            }
        }
        if (simulation->events.ended) {
            accuracy->so_far = answers_of(&simulation->drops);
            finished = finished || accuracy_is_known(accuracy, &accuracy->so_far);
        }
        if (!finished && !simulation_may_go_on(simulation, err)) return false;
    }
    return true;
}

// A StepCallback: says which run of which mesh it is, and what is known so far.
static void show_member(const StepView *view, void *context)
{
    Accuracy *accuracy = context;
    double left = fmax(accuracy->deadline - clock_seconds(), 0);
    StepView named = *view;
    named.mesh = accuracy->levels.count;
    named.run = accuracy_last_level(accuracy)->run_count + 1;
    named.mu_M = accuracy->so_far.mu_M.value;
    named.mu_hold = accuracy->so_far.mu_hold.value;
    named.seconds_left = isfinite(left) ? left : (double)NAN;
    if (accuracy->options->on_step) accuracy->options->on_step(&named, accuracy->options->context);
}

// A StageCallback.
static void show_stage(const char *stage, void *context)
{
    Accuracy *accuracy = context;
    const RunOptions *options = accuracy->options;
    snprintf(accuracy->stage, sizeof accuracy->stage, "mesh %d: %s", accuracy->levels.count, stage);
    if (options->on_stage) options->on_stage(accuracy->stage, options->context);
}

// --- what time allows ---------------------------------------------------------------------------

// Notes a run that was stopped. This is an error only if the caller stopped it, not if time did.
static void note_cut(Accuracy *accuracy, const Simulation *simulation, Error *err)
{
    const volatile sig_atomic_t *stop = accuracy->options->stop;
    const Level *level = accuracy_last_level(accuracy);
    LevelCut *cut = &accuracy->levels.cut;
    *cut = (LevelCut){.mesh = accuracy->levels.count,
                      .run = level->run_count + 1,
                      .contact_nodes = level->contact_nodes,
                      .U = NAN,
                      .part = NAN,
                      .seconds = clock_seconds() - accuracy->begun + level->seconds,
                      .seconds_expected = level->seconds_expected,
                      .mu_M = NAN,
                      .mu_hold = NAN};
    if (simulation->seen.t > 0) {
        Answers answers = answers_of(&simulation->drops);
        cut->U = simulation->seen.U;
        cut->part = fmin(simulation->seen.t / simulation->t_end, 1);
        cut->mu_M = answers.mu_M.value;
        cut->mu_hold = answers.mu_hold.value;
    }
    *err = (Error){0};
    accuracy->out_of_time = !(stop && *stop);
    if (!accuracy->out_of_time)
        (void)FAULT(err, ERROR_INTERRUPT, "stopped on mesh %.0f of an error bar", cut->mesh);
}

void accuracy_count_run(Accuracy *accuracy, const Simulation *simulation, double pressure,
                        const Answers *answers)
{
    patterns_add_drops(&accuracy_last_level(accuracy)->patterns, &simulation->drops,
                       answers->first);
    levels_add_run(&accuracy->levels, pressure, simulation->seen.U, answers,
                   simulation->control.counters.accepted);
}

// Returns true if nothing new is learnt on the last mesh: it is finer than the one before and has
// no more contact nodes, or coarser and has no fewer; it has too few; or its cells are too long for
// slip.
static bool is_too_coarse(const Accuracy *accuracy, const Interface *interface)
{
    const Level *level = &accuracy->levels.list[accuracy->levels.count - 1];
    bool space = interface->dim > 2;
    if (level->undamped) return true;
    if (accuracy->levels.count > 1) {
        int32_t more = level->contact_nodes - level[-1].contact_nodes;
        if (level->refine > level[-1].refine ? more <= 0 : more >= 0) return true;
    }
    if (interface->contact_count < (space ? SPACE_NODES_MIN : CONTACT_NODES_MIN)) return true;
    int32_t least = space ? SPACE_PAD_NODES_MIN : PAD_NODES_MIN;
    for (int32_t pad = 0; pad < interface->pad_count; pad++)
        if (pad_size(interface, pad).nodes < least) return true;
    return false;
}

bool accuracy_run_member(Accuracy *accuracy, bool *coarse, Error *err)
{
    Level *level = accuracy_last_level(accuracy);
    RunOptions options = {.on_step = show_member,
                          .on_stage = show_stage,
                          .context = accuracy,
                          .stop = accuracy->options->stop};
    Simulation *simulation = NULL;
    EndWait wait = {.mu = NAN, .passed = NAN};
    bool first = !levels_have_runs(&accuracy->levels) && accuracy->levels.count == 1;
    double started = clock_seconds(), deadline = accuracy->deadline - accuracy_full(accuracy, 1);
    accuracy->begun = started;

    // The next pressure, over the scene's: the ends of the window, then points between them, in
    // pairs that leave the mean where it is.
    static const double places[] = {1, 0.5, 0.75, 0.25};
    double half = accuracy->scene->accuracy.window / 2;
    double place = places[accuracy->members / 2 % (int32_t)(sizeof places / sizeof *places)];
    double pressure = 1 + (accuracy->members % 2 == 0 ? -half : half) * place;

    // The scene of a run that writes nothing, and is ended by its answer.
    Scene *scene = NEW_ARRAY(Scene, 1, err);
    accuracy->so_far = (Answers){.mu_M = {NAN, NAN}, .mu_hold = {NAN, NAN}};
    TRY(scene);
    *scene = *accuracy->scene;
    scene->output.history = scene->output.fields = false;
    scene->output.figures.count = 0;
    scene->time.until_U *= LONGER;
    scene->time.until_t *= LONGER;
    scene->time.until_periodic = false;
    scene->time.until_slidings = scene->time.until_mu_below = 0;
    scene_scale_loads(scene, pressure);
    TRY(scene_refine(scene, level->refine, err));

    // Mesh and basis.
    TRY(simulation_create_by(scene, &options, first ? INFINITY : deadline, &simulation, err));
    simulation->deadline = deadline;   // one step is made, whatever time there is
    const Interface *interface = &simulation->model.interface;
    one_mesh_read(simulation, level);
    if (coarse && (*coarse = is_too_coarse(accuracy, interface))) goto cleanup;

    // Steps. Where they come to no end, as where slip weakens faster than viscosity can damp on a
    // cell, the mesh is passed over: a finer one may.
    double begun = clock_seconds();
    step_until_known(accuracy, simulation, &wait, err);
    if (coarse && (*coarse = err->code == ERROR_COMPUTE)) {
        snprintf(accuracy->passed_over, sizeof accuracy->passed_over,
                 "no run on the mesh of %d contact nodes, finer ones were taken: %.300s",
                 level->contact_nodes, err->message);
        *err = (Error){0};
        goto cleanup;
    }
    TRY(error_is_clean(err));

    // A whole run: what it says, and the time it took. Mesh and basis are made once where the cache
    // keeps them.
    Answers answers = simulation_answers(simulation);
    const Event *least = drops_least_resolved(&simulation->drops, answers.first);
    if (least) level->slip_cells = fmin(level->slip_cells, least->slip_cells);
    level->end_wait = fmax(level->end_wait, end_wait_of(&wait, interface, answers.critical_length));
    accuracy_count_run(accuracy, simulation, pressure, &answers);
    accuracy->members++;
    char cache[PATH_MAX];
    if (simulation->model.is_reduced && simulation->scene.reduction.cache &&
        cache_folder_path(cache))
        level->making += begun - started;
    else
        accuracy->making = begun - started;

    // The run in full goes to the scene's end at the same pace, unless an event ends it before.
    // Output is not in it, and where it would take more than its share it is cut short.
    const Scene *whole = accuracy->scene;
    double way = step_rule_end(whole) / simulation->control.now.time;
    bool sooner = whole->time.until_periodic || whole->time.until_slidings > 0 ||
                  whole->time.until_mu_below > 0;
    if (sooner || !isfinite(way)) way = fmin(way, 1);
    accuracy->stepping = way * (clock_seconds() - begun);
cleanup:
    if (err->code == ERROR_INTERRUPT) note_cut(accuracy, simulation, err);
    if (accuracy->out_of_time && !levels_have_runs(&accuracy->levels)) {
        accuracy->cut = simulation;
        simulation = NULL;
    }
    amontons_simulation_destroy(simulation);
    memory_free(scene);
    level->seconds += clock_seconds() - started;
    return error_is_clean(err);
}
