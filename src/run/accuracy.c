// SPDX-License-Identifier: GPL-2.0-or-later
// amontons_run: one run, or, where the scene asks for an error bar (accuracy.mu), runs on meshes of
// falling cell size until the bar (answers/error_bars) is met.
//
// A level is a mesh, mesh.set.refine times as fine as the scene's; the first is the coarsest with
// enough contact nodes. Its runs write nothing and end as soon as their answer is known; they
// differ in pressure within accuracy.window, and share mesh and basis. What is done next
// follows from the largest part of the bar: a finer mesh, or more runs on this one. The last run is
// the scene itself on the last mesh, with all that it asks to be written, and counts too.
//
// Time (accuracy.within) ends a search inside a run. A part of this time is kept for the run in
// full on the last mesh that has a whole one. A run, or a mesh, is not begun if the forecast says
// that it takes longer than the time left before that. A run that was cut short has no part in the
// bar. If it was the first run of all, its own answers stand, without a bar.
#include "run/accuracy.h"

#include "record/drops.h"
#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "io/cache/cache_folder.h"
#include "model/step_rule.h"
#include "run/simulation_state.h"
#include "run/warnings.h"
#include "scene/programs.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { COARSER_MAX = 3 };   // halvings of the scene's mesh that are tried
static const double RATIO = 1.189207115002721;   // of cell size from level to level: 2^(1/4)
// A run's time goes with this power of the cells along the contact, in the plane and in space. What
// the levels of a search tell of it says less: times of short runs are noise.
static const double GROWTH[] = {2, 4};
// A mesh that is to confirm a bar may take this part of the time given, where nothing says that
// finer meshes differ.
static const double CONFIRM_SHARE = 1. / 60;

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

// Ratio of cell sizes from level to level where cells can only be halved (no .geo with `refine`),
// and the largest ratio where the last mesh does not resolve slip.
enum { RATIO_SPLIT = 2 };

typedef struct Accuracy {
    const Scene *scene;
    const RunOptions *options;
    Levels levels;
    double cell_ratio;   // of cells of a level to those of the next
    int32_t members;   // whole runs behind the bar, but for that in full
    double started, deadline;   // wall clock, s; INFINITY: accuracy.within is not given
    double begun;   // wall clock at which the run under way began, s
    double stepping;   // expected of the run in full, s; 0: no run is whole
    double making;   // likewise of its mesh and basis; 0: the cache has them
    bool out_of_time;
    char passed_over[400];   // why the last mesh that failed was passed over; "": none was
    Answers so_far;   // of the run under way
    char stage[64];   // of it, as the caller is told
    Simulation *cut;   // the first run of all, where time cut it short; owned
} Accuracy;

static Level *last_level(Accuracy *accuracy)
{
    return &accuracy->levels.list[accuracy->levels.count - 1];
}

// Before another mesh is looked at: two on the first, where they tell branches from the mesh, and
// where meshes are few as each halves the cells of the last; else one.
static int32_t runs_first(const Accuracy *accuracy)
{
    return accuracy->levels.count == 1 || accuracy->cell_ratio == RATIO_SPLIT ? 2 : 1;
}

// Kept back for the run in full, s, where it takes so many times as long.
static double seconds_in_full(const Accuracy *accuracy, double times)
{
    double most = FULL_SHARE * accuracy->scene->accuracy.within;
    double stepping = times * accuracy->stepping;
    return times * accuracy->making + (most > 0 ? fmin(stepping, most) : stepping);
}

// For runs behind the bar, s: what the run in full needs is kept back. INFINITY: no limit.
static double seconds_left(const Accuracy *accuracy)
{
    return accuracy->deadline - seconds_in_full(accuracy, 1) - clock_seconds();
}

// --- one run of a level --------------------------------------------------------------------------

// The parameter `refine` of every mesh, times what the scene may have set it to (ERROR_INPUT: there
// is no room for it).
static bool refine_scene(Scene *scene, double refine, Error *err)
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

// Returns true if the change that more slidings could make is a small part of the bar wanted.
static bool answer_is_known(const Accuracy *accuracy, const Answers *answers)
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
            finished = finished || answer_is_known(accuracy, &accuracy->so_far);
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
    named.run = last_level(accuracy)->run_count + 1;
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
    const Level *level = last_level(accuracy);
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

// Adds a run that came to its end, and the pads that slid in it, to the last level.
static void count_run(Accuracy *accuracy, const Simulation *simulation, double pressure,
                      const Answers *answers)
{
    patterns_add_drops(&last_level(accuracy)->patterns, &simulation->drops, answers->first);
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

// One run of the last level, at the next pressure of the window. *coarse (NULL: not asked): the
// mesh has too few contact nodes, as many as the one before, its cells are too long for slip, or
// the run failed. Then, as when time is out, nothing was added.
static bool run_member(Accuracy *accuracy, bool *coarse, Error *err)
{
    Level *level = last_level(accuracy);
    RunOptions options = {.on_step = show_member,
                          .on_stage = show_stage,
                          .context = accuracy,
                          .stop = accuracy->options->stop};
    Simulation *simulation = NULL;
    EndWait wait = {.mu = NAN, .passed = NAN};
    bool first = !levels_have_runs(&accuracy->levels) && accuracy->levels.count == 1;
    double started = clock_seconds(), deadline = accuracy->deadline - seconds_in_full(accuracy, 1);
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
    TRY(refine_scene(scene, level->refine, err));

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
    count_run(accuracy, simulation, pressure, &answers);
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

// --- from mesh to mesh ---------------------------------------------------------------------------

// One more run on its mesh, s.
static double seconds_of_run(const Level *level)
{
    return (level->seconds - level->making) / level->run_count;
}

// For so many more runs on the last level.
static bool has_time_for(Accuracy *accuracy, int32_t runs)
{
    const Level *level = last_level(accuracy);
    return seconds_of_run(level) * runs <= seconds_left(accuracy);
}

static bool add_runs(Accuracy *accuracy, int32_t count, Error *err)
{
    for (int32_t k = 0; k < count && !accuracy->out_of_time; k++) {
        accuracy->out_of_time = !has_time_for(accuracy, 1);
        if (accuracy->out_of_time) break;
        if (!run_member(accuracy, NULL, err)) return false;
    }
    return true;
}

// By what a run takes longer where cells are so many times smaller.
static double growth_ahead(const Accuracy *accuracy, double ratio)
{
    return pow(ratio, GROWTH[accuracy->levels.list[accuracy->levels.count - 1].space]);
}

// Wall time that the next level will take, s.
static double level_seconds(const Accuracy *accuracy, double ratio)
{
    const Level *level = &accuracy->levels.list[accuracy->levels.count - 1];
    double now = level->making +
                 seconds_of_run(level) * (accuracy->cell_ratio == RATIO_SPLIT ? 2 : 1);
    return now * growth_ahead(accuracy, ratio);
}

static void begin_level(Accuracy *accuracy, double refine)
{
    double expected = accuracy->levels.count > 0
                          ? level_seconds(accuracy, refine / last_level(accuracy)->refine)
                          : NAN;
    accuracy->levels.list[accuracy->levels.count++] =
        (Level){.refine = refine, .slip_cells = NAN, .seconds_expected = expected};
}

static const ErrorBar *asked(const Accuracy *accuracy)
{
    return levels_answer(&accuracy->levels, accuracy->levels.asked);
}

// A bar that is not known, as where slip is not resolved, is NaN, and met by nothing.
static bool is_short_enough(const Accuracy *accuracy)
{
    const ErrorBar *answer = asked(accuracy);
    return answer->bar <= accuracy->levels.wanted * answer->value;
}

// With the run in full on it. Of one mesh alone no error is known: a second, finer or coarser, is
// begun in any case.
static bool has_time_for_level(const Accuracy *accuracy, double ratio)
{
    if (accuracy->levels.count == 1) return seconds_left(accuracy) > 0;
    double more = seconds_in_full(accuracy, growth_ahead(accuracy, ratio)) -
                  seconds_in_full(accuracy, 1);
    return level_seconds(accuracy, ratio) + more <= seconds_left(accuracy);
}

// The largest of `ratio`, and of those that are smaller by powers of the usual one, at which there
// is time for a mesh; at least `least`.
static double ratio_in_time(const Accuracy *accuracy, double ratio, double least)
{
    while (ratio > least && !has_time_for_level(accuracy, fmax(ratio, accuracy->cell_ratio)))
        ratio /= accuracy->cell_ratio;
    return fmax(ratio, least);
}

// Ratio of cell sizes to the mesh that puts a bar to the test: the farther one, which confirms it,
// where that takes a small part of the time given; where pads may slide otherwise on finer meshes,
// as far towards it as time allows. 1: none is left.
static double span_left(const Accuracy *accuracy)
{
    double left = levels_span_left(&accuracy->levels, accuracy->levels.asked);
    double far = levels_confirm_left(&accuracy->levels);
    if (!levels_may_differ(&accuracy->levels)) {
        double most = CONFIRM_SHARE * accuracy->scene->accuracy.within;
        bool confirms = far > left && level_seconds(accuracy, far) <= most;
        return confirms && has_time_for_level(accuracy, far) ? far : left;
    }
    return ratio_in_time(accuracy, far, left);
}

// Ratio of cell sizes to the next level. From the third level on it is large enough that slip has
// enough cells there, as all levels tell, but at most RATIO_SPLIT, and no larger than time allows;
// or it leads to the mesh that tests a bar which is short enough.
static double next_ratio(const Accuracy *accuracy)
{
    const Levels *levels = &accuracy->levels;
    if (levels->count < 2) return accuracy->cell_ratio;
    double lacks = SLIP_CELLS_ENOUGH / levels_cells(levels), span = span_left(accuracy);
    double ratio = fmin(fmax(accuracy->cell_ratio, 1.1 * lacks), RATIO_SPLIT);
    bool far = is_short_enough(accuracy) && span > ratio && has_time_for_level(accuracy, span);
    return far ? span : ratio_in_time(accuracy, ratio, accuracy->cell_ratio);
}

// Runs on a finer mesh. One whose cells are still too long for slip is passed over, while there is
// time for a finer one. A mesh that can only be split refuses the first step (ERROR_INPUT), and is
// halved from then on.
static bool add_level(Accuracy *accuracy, double refine, Error *err)
{
    bool coarse = true;
    for (int32_t k = accuracy->levels.count + 1; coarse; k++) {
        bool *may_be = k >= LEVELS_MAX ? NULL : &coarse;
        coarse = false;
        begin_level(accuracy, refine * next_ratio(accuracy));
        if (!run_member(accuracy, may_be, err) && err->code == ERROR_INPUT &&
            accuracy->cell_ratio < RATIO_SPLIT) {
            *err = (Error){0};
            accuracy->cell_ratio = RATIO_SPLIT;
            accuracy->levels.count--;
            begin_level(accuracy, refine * accuracy->cell_ratio);
            run_member(accuracy, may_be, err);
        }
        if (!error_is_clean(err)) return false;
        refine = last_level(accuracy)->refine;
        if (!coarse) break;
        accuracy->out_of_time = growth_ahead(accuracy, accuracy->cell_ratio) *
                                    last_level(accuracy)->seconds >
                                seconds_left(accuracy);
        accuracy->levels.count--;
        if (accuracy->out_of_time) return true;
    }
    return add_runs(accuracy, runs_first(accuracy) - 1, err);
}

// Where a second mesh that is finer is not expected to end in time, a coarser one tells how far
// meshes differ.
static bool wants_coarser_level(const Accuracy *accuracy)
{
    return accuracy->levels.count == 1 && accuracy->cell_ratio < RATIO_SPLIT &&
           level_seconds(accuracy, accuracy->cell_ratio) > seconds_left(accuracy);
}

// The coarser of two meshes, in the time that is left, becomes the first level. The finer one is
// begun all the same where there is no coarser one that counts.
static bool add_coarser_level(Accuracy *accuracy, Error *err)
{
    Levels *levels = &accuracy->levels;
    Level finer = levels->list[0];
    double stepping = accuracy->stepping, making = accuracy->making;
    double excess = level_seconds(accuracy, 1) / seconds_left(accuracy);
    double ratio = fmax(pow(excess, 1 / GROWTH[finer.space]), accuracy->cell_ratio);
    bool coarse = false;
    begin_level(accuracy, finer.refine / fmin(ratio, RATIO_SPLIT));
    run_member(accuracy, &coarse, err);
    accuracy->stepping = stepping;   // the run in full is on the finer one
    accuracy->making = making;
    if (coarse || err->code == ERROR_INPUT || err->code == ERROR_LIBRARY) {
        *err = (Error){0};
        levels->count--;
        return add_level(accuracy, finer.refine, err);
    }
    if (last_level(accuracy)->run_count > 0) {
        levels->list[0] = levels->list[1];
        levels->list[1] = finer;
    }
    return error_is_clean(err);
}

// --- what next ----------------------------------------------------------------------------------

static bool is_met(const Accuracy *accuracy)
{
    return is_short_enough(accuracy) && span_left(accuracy) <= 1;
}

// Tells the caller what all levels say after runs on `level`.
static void show_level(const Accuracy *accuracy, const Level *level)
{
    const RunOptions *options = accuracy->options;
    const ErrorBar *answer = asked(accuracy);
    LevelView view = {.level = accuracy->levels.count,
                      .contact_nodes = level->contact_nodes,
                      .runs = level->run_count,
                      .answer = ANSWER_NAMES[accuracy->levels.asked],
                      .value = answer->value,
                      .bar = answer->bar,
                      .known_to = levels_known_to(&accuracy->levels, accuracy->levels.asked),
                      .mesh = answer->parts.mesh,
                      .seconds = level->seconds,
                      .seconds_next = level_seconds(accuracy, next_ratio(accuracy))};
    if (options->on_level) options->on_level(&view, options->context);
}

static const char NO_TIME[] = "no time for more";   // why a search ended

// From mesh to mesh until levels.ended says why there is none to follow.
static bool find_levels(Accuracy *accuracy, Error *err)
{
    Levels *levels = &accuracy->levels;

    // The first mesh, from one that is so many times coarser than the scene's up: one that gmsh
    // refuses or that has too few contact nodes is passed over. The scene's own mesh is taken
    // whatever it is.
    for (int32_t halvings = COARSER_MAX; halvings >= 0; halvings--) {
        bool coarse = false, last = halvings == 0;
        begin_level(accuracy, ldexp(1, -halvings));
        run_member(accuracy, last ? NULL : &coarse, err);
        if (!coarse && (last || error_is_clean(err))) break;
        if (err->code == ERROR_INPUT || err->code == ERROR_LIBRARY) *err = (Error){0};
        if (!error_is_clean(err)) return false;
        levels->count--;
    }
    if (!error_is_clean(err)) return false;
    if (!add_runs(accuracy, runs_first(accuracy) - 1, err)) return false;
    if (!levels_have_runs(levels)) levels->ended = NO_TIME;
    if (!levels->ended) show_level(accuracy, levels->list);

    while (!levels->ended) {
        const ErrorBar *answer = asked(accuracy);
        const Level *level = last_level(accuracy);
        int32_t before = levels->count, runs = level->run_count;
        double refine = level->refine;

        // More runs where branches and drops leave more than the mesh does, else another mesh. The
        // mesh's part of one level is NaN, so that a second mesh comes first.
        double between = hypot(answer->parts.branches, answer->parts.drops);
        bool more_runs = between > answer->parts.mesh && runs + 2 <= LEVEL_RUNS_MAX - 1;
        levels->met = !isnan(answer->value) && is_met(accuracy);
        if (isnan(answer->value))
            levels->ended = levels_run_in(levels) ? "the run-in of a run was not over"
                                                  : "no load drop in any run";
        else if (levels->met)
            levels->ended = "the error bar is met";
        else if (more_runs)
            levels->ended = has_time_for(accuracy, 2) ? NULL : NO_TIME;
        else if (levels->count == LEVELS_MAX)
            levels->ended = "the finest mesh that is tried";
        else if (!has_time_for_level(accuracy, next_ratio(accuracy)))
            levels->ended = NO_TIME;
        if (levels->ended) break;
        bool added = more_runs                       ? add_runs(accuracy, 2, err)
                     : wants_coarser_level(accuracy) ? add_coarser_level(accuracy, err)
                                                     : add_level(accuracy, refine, err);
        if (!more_runs && accuracy->out_of_time) levels->ended = NO_TIME;

        // A level without a whole run does not count.
        if (levels->count > 1 && last_level(accuracy)->run_count == 0) levels->count--;
        levels_estimate(levels);
        if (!added) return false;

        // A mesh that was added is the last one or, where that is still the one of before, the
        // first.
        const Level *last = last_level(accuracy);
        bool grown = levels->count != before;
        if (grown || last->run_count != runs)
            show_level(accuracy, grown && last->refine == refine ? levels->list : last);
    }
    return true;
}

// The scene itself on the last mesh, with its files. It counts as one more run where it is as
// settled as the others and went as far as one of them; a branch that it found is a reason for more
// of them.
static bool run_in_full(Accuracy *accuracy, RunSummary *summary, Error *err)
{
    Levels *levels = &accuracy->levels;
    Simulation *simulation = NULL;
    Scene *scene = NEW_ARRAY(Scene, 1, err);
    TRY(scene);
    *scene = *accuracy->scene;
    TRY(refine_scene(scene, last_level(accuracy)->refine, err));
    TRY(amontons_simulation_create(scene, accuracy->options, &simulation, err));
    simulation->deadline = accuracy->deadline;
    if (!simulation_loop(simulation, err)) {   // which is no error where it was for time
        const volatile sig_atomic_t *stop = accuracy->options->stop;
        if (err->code != ERROR_INTERRUPT || (stop && *stop)) goto cleanup;
        *err = (Error){0};
        warnings_add(
            &simulation->warnings,
            "the run in full was cut short: time was up at U = %g (--within, accuracy.within); "
            "history and pictures end there, the error bar is of the runs before",
            simulation->seen.U);
    }
    Answers answers = simulation_answers(simulation);
    if (answer_is_known(accuracy, &answers) && levels_reach(levels, simulation->seen.U))
        count_run(accuracy, simulation, 1, &answers);

    // More runs where branches, not the mesh, are why the bar is not met.
    while (!is_met(accuracy) && seconds_left(accuracy) > 0 &&
           asked(accuracy)->parts.mesh < levels->wanted * asked(accuracy)->value &&
           last_level(accuracy)->run_count + 2 <= LEVEL_RUNS_MAX)
        TRY(add_runs(accuracy, 2, err));

    if (levels->met && !is_met(accuracy)) levels->ended = "the run in full widened it";
    levels->met = is_met(accuracy);
    if (!levels->met) warnings_of_bar(levels, &simulation->warnings);
    warnings_of_last_mesh(levels, &simulation->warnings);
    if (*accuracy->passed_over) warnings_add(&simulation->warnings, "%s", accuracy->passed_over);
    simulation->started = accuracy->started;
    simulation->levels = levels;
    TRY(amontons_simulation_finish(simulation, summary, err));
    if (scene->output.figures.count > 0 && accuracy->options->folder)
        TRY(accuracy_figure(levels, scene->title, accuracy->options->folder, err));
cleanup:
    simulation_end(simulation, summary, err);
    memory_free(scene);
    return error_is_clean(err);
}

bool amontons_run(const Scene *scene, const RunOptions *options, RunSummary *summary, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    if (!(scene->accuracy.mu > 0)) return simulation_run(scene, options, summary, err);
    *summary = (RunSummary){0};
    ResultFolder folder = {0};
    Accuracy *accuracy = NEW_ARRAY(Accuracy, 1, err);
    TRY(accuracy);
    accuracy->scene = scene;
    accuracy->options = options;
    accuracy->started = clock_seconds();
    accuracy->deadline = INFINITY;
    if (scene->accuracy.within > 0) accuracy->deadline = accuracy->started + scene->accuracy.within;
    accuracy->levels.wanted = scene->accuracy.mu;
    accuracy->levels.of_hold = scene->accuracy.of == ANSWER_OF_HOLD;
    accuracy->cell_ratio = RATIO;
    if (options->resume)
        FAIL(err, ERROR_INPUT,
             "an error bar (--to, accuracy.mu) is found from several runs, which do not go on from "
             "a checkpoint: say --overwrite");
    TRY(result_folder_claim(options->folder, options->overwrite, &folder, err));
    TRY(find_levels(accuracy, err));
    if (!levels_have_runs(&accuracy->levels)) {
        // Time was up in the first run of all: what it has is reported, without a bar.
        Simulation *simulation = accuracy->cut;
        const LevelCut *cut = &accuracy->levels.cut;
        TRY(result_folder_clear(&folder, err));
        TRY(result_folder_settle(&folder, err));
        simulation->folder = folder;   // which has the lock from now on
        folder = (ResultFolder){0};
        simulation->options.on_report = options->on_report;
        simulation->options.context = options->context;
        simulation->options.folder = options->folder;
        simulation->started = accuracy->started;
        simulation->levels = &accuracy->levels;
        accuracy->levels.count = 0;
        warnings_add(&simulation->warnings,
                     "error bar not met: its first run was cut short (%.0f contact nodes, %.0f %% "
                     "of its way): time was up (--within, accuracy.within)",
                     cut->contact_nodes, isnan(cut->part) ? 0 : 100 * cut->part);
        TRY(simulation_finish(simulation, NULL, summary, err));
        goto cleanup;
    }
    result_folder_release(&folder);   // the last run claims it for itself
    TRY(run_in_full(accuracy, summary, err));
cleanup:
    if (err->code == ERROR_INTERRUPT)
        accuracy_stopped(&accuracy->levels, scene->title,
                         folder.has_earlier ? NULL : options->folder, err);
    result_folder_release(&folder);
    if (accuracy) amontons_simulation_destroy(accuracy->cut);
    memory_free(accuracy);
    return error_is_clean(err);
}
