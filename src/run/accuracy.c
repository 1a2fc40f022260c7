// SPDX-License-Identifier: GPL-2.0-or-later
// amontons_run: one run, or, where the scene asks for an error bar (accuracy.mu), runs on meshes of
// falling cell size until the bar (record/error_bars) is met.
//
// A level is a mesh, mesh.set.refine times as fine as the scene's; the first is the coarsest with
// enough contact nodes. Its runs write nothing and end as soon as their answer is known; they
// differ in pressure within accuracy.window, and share mesh and basis. What is done next
// follows from the largest part of the bar: a finer mesh, or more runs on this one. The last run is
// the scene itself on the last mesh, with all that it asks to be written, and counts too.
#include "base/clock.h"
#include "base/memory.h"
#include "model/step_rule.h"
#include "run/accuracy_figure.h"
#include "run/end_wait.h"
#include "run/level_scene.h"
#include "run/simulation_state.h"
#include "run/warnings.h"
#include "scene/programs.h"

#include <math.h>

enum {
    CONTACT_NODES_MIN = 21,   // of the first level
    PAD_NODES_MIN = 5,   // of it on each piece of the contact
    PEAKS_MIN = 8,   // that count in a run, before its answer can be known
    RUNS_FIRST = 2,   // on every level, at either end of the window
    COARSER_MAX = 3,   // halvings of the scene's mesh that are tried
};
static const double DROPS_SHARE = 0.2;   // of the bar wanted, for the drops of each run
static const double LONGER = 4;   // than the scene's end, for a run whose answer is not known; and
    // once more as much longer where its run-in is not over
static const double STEP = 1.4142135623730951;   // of cell size from level to level
static const double STEP_SPLIT = 2;   // where cells can only be halved: no .geo with `refine`; and
    // at most, where the last mesh does not resolve slip
static const double GROWTH = 2.5;   // of a level's time, before two levels are known

typedef struct Accuracy {
    const Scene *scene;
    const RunOptions *options;
    Levels levels;
    double step;   // of cell size from level to level
    double started;   // wall clock, s
    bool out_of_time;
} Accuracy;

static Level *last_level(Accuracy *accuracy)
{
    return &accuracy->levels.list[accuracy->levels.count - 1];
}

static double seconds_left(const Accuracy *accuracy)
{
    double within = accuracy->scene->accuracy.within;
    return within > 0 ? within - (clock_seconds() - accuracy->started) : INFINITY;
}

// The scene of a run that writes nothing; owned by the caller.
static Scene *scene_of_run(const Accuracy *accuracy, double refine, double pressure, Error *err)
{
    Scene *scene = NEW_ARRAY(Scene, 1, err);
    if (!scene) return NULL;
    *scene = *accuracy->scene;
    scene->output.history = scene->output.fields = false;
    scene->output.figures.count = 0;
    scene->time.until_U *= LONGER;
    scene->time.until_t *= LONGER;
    scene->time.until_periodic = false;
    scene->time.until_slidings = scene->time.until_mu_below = 0;   // its answer ends it
    scene_scale_loads(scene, pressure);
    if (scene_refine(scene, refine, err)) return scene;
    memory_free(scene);
    return NULL;
}

// What more slidings could still change is a small part of the bar wanted.
static bool is_known(const Accuracy *accuracy, const Answers *answers)
{
    const Estimate *mu_M = &answers->mu_M;
    double allowed = DROPS_SHARE * accuracy->scene->accuracy.mu;
    if (answers->regime.run_in != RUN_IN_OVER) return false;
    if (answers->peaks_counted >= PEAKS_MIN) return mu_M->error <= allowed * mu_M->value;
    return answers->peaks_counted == 0 && answers->enough;
}

// A run that comes to its end in the middle of its run-in goes on, once. What a program does may
// well look like a run-in, for ever.
static bool goes_on(const Accuracy *accuracy, Simulation *simulation)
{
    const Scene *scene = accuracy->scene;
    bool once = simulation->scene.time.until_U > LONGER * scene->time.until_U ||
                simulation->scene.time.until_t > LONGER * scene->time.until_t;
    bool steered = scene_has_program(&scene->rod.program) ||
                   scene_has_program(&scene->load.program);
    if (once || steered || regime_of(&simulation->drops).run_in == RUN_IN_OVER) return false;
    simulation->scene.time.until_U *= LONGER;
    simulation->scene.time.until_t *= LONGER;
    simulation->t_end = step_rule_end(&simulation->scene);
    return true;
}

// Steps until the answer is known, time is up (never on the first level), or the end.
static bool step_until_known(Accuracy *accuracy, Simulation *simulation, EndWait *wait, Error *err)
{
    const volatile sig_atomic_t *stop = accuracy->options->stop;
    for (bool finished = false; !finished;) {
        TRY(amontons_simulation_step(simulation, NULL, &finished, err));
        end_wait_watch(wait, simulation);
        if (stop && *stop)
            FAIL(err, ERROR_INTERRUPT, "stopped on mesh %d of an error bar",
                 accuracy->levels.count);
        if (finished && goes_on(accuracy, simulation)) finished = false;
        if (!simulation->events.ended) continue;
        Answers answers = answers_of(&simulation->drops);
        finished = finished || is_known(accuracy, &answers);
        accuracy->out_of_time = accuracy->levels.count > 1 && seconds_left(accuracy) < 0;
        finished = finished || accuracy->out_of_time;
    }
cleanup:
    return error_is_clean(err);
}

static bool contact_has_nodes(const Interface *interface)
{
    for (int32_t pad = 0; pad < interface->pad_count; pad++) {
        int32_t nodes = 0;
        for (int32_t i = 0; i < interface->contact_count; i++) nodes += interface->pad[i] == pad;
        if (nodes < PAD_NODES_MIN) return false;
    }
    return interface->contact_count >= CONTACT_NODES_MIN;
}

// On most nodes friction weakens faster than viscosity can damp: cells are too long for slip.
static bool is_undamped(const Simulation *simulation)
{
    double worst = 0;
    int32_t undamped =
        undamped_nodes(&simulation->control.certificate, simulation->model.scales.load, &worst);
    return 2 * undamped > simulation->model.interface.contact_count;
}

// A StepCallback: says which run of which mesh it is.
static void show_member(const StepView *view, void *context)
{
    Accuracy *accuracy = context;
    StepView named = *view;
    named.mesh = accuracy->levels.count;
    named.run = last_level(accuracy)->run_count + 1;
    accuracy->options->on_step(&named, accuracy->options->context);
}

// One run of the last level. *coarse (NULL: not asked): the mesh has too few contact nodes, or its
// cells are too long for slip; nothing was stepped.
static bool run_member(Accuracy *accuracy, double pressure, bool *coarse, Error *err)
{
    Level *level = last_level(accuracy);
    RunOptions options = {.on_step = accuracy->options->on_step ? show_member : NULL,
                          .context = accuracy,
                          .stop = accuracy->options->stop};
    Simulation *simulation = NULL;
    EndWait wait = {.mu = NAN};
    double started = clock_seconds();
    Scene *scene = scene_of_run(accuracy, level->refine, pressure, err);
    TRY(scene);
    TRY(amontons_simulation_create(scene, &options, &simulation, err));
    const Interface *interface = &simulation->model.interface;
    level->contact_nodes = interface->contact_count;
    level->pads = interface->pad_count;
    level->undamped = is_undamped(simulation);
    if (coarse && (*coarse = level->undamped || !contact_has_nodes(interface))) goto cleanup;
    TRY(step_until_known(accuracy, simulation, &wait, err));
    Answers answers = answers_of(&simulation->drops);
    const Event *least = drops_least_resolved(&simulation->drops, answers.first);
    if (least) level->slip_cells = fmin(level->slip_cells, least->slip_cells);
    level->end_wait = fmax(level->end_wait, end_wait_of(&wait, interface, answers.critical_length));
    if (!accuracy->out_of_time)
        levels_add_run(&accuracy->levels, pressure, &answers,
                       simulation->control.counters.accepted);
cleanup:
    amontons_simulation_destroy(simulation);
    memory_free(scene);
    level->seconds += clock_seconds() - started;
    return error_is_clean(err);
}

// Pressures over the scene's: the ends of the window, then points between them, in pairs that leave
// the mean where it is.
static double pressure_of(const Accuracy *accuracy, int32_t run)
{
    static const double places[] = {1, 0.5, 0.75, 0.25};
    double half = accuracy->scene->accuracy.window / 2;
    double place = places[run / 2 % (int32_t)(sizeof places / sizeof *places)];
    return 1 + (run % 2 == 0 ? -half : half) * place;
}

static bool add_runs(Accuracy *accuracy, int32_t count, Error *err)
{
    int32_t first = last_level(accuracy)->run_count;
    first -= first % 2 == 1 && count % 2 == 0;   // the run in full is no half of a pair
    for (int32_t k = first; k < first + count && !accuracy->out_of_time; k++)
        TRY(run_member(accuracy, pressure_of(accuracy, k), NULL, err));
cleanup:
    return error_is_clean(err);
}

static void begin_level(Accuracy *accuracy, double refine)
{
    accuracy->levels.list[accuracy->levels.count++] = (Level){.refine = refine, .slip_cells = NAN};
}

// From a mesh that is so many times coarser than the scene's up: one that gmsh refuses or that has
// too few contact nodes is passed over. The scene's own mesh is taken whatever it is.
static bool first_level(Accuracy *accuracy, Error *err)
{
    for (int32_t halvings = COARSER_MAX; halvings >= 0; halvings--) {
        bool coarse = false, last = halvings == 0;
        begin_level(accuracy, ldexp(1, -halvings));
        run_member(accuracy, pressure_of(accuracy, 0), last ? NULL : &coarse, err);
        if (!coarse && (last || error_is_clean(err))) break;
        if (err->code == ERROR_INPUT || err->code == ERROR_LIBRARY) *err = (Error){0};
        TRY(error_is_clean(err));
        accuracy->levels.count--;
    }
    TRY(error_is_clean(err));
    TRY(add_runs(accuracy, RUNS_FIRST - 1, err));
cleanup:
    return error_is_clean(err);
}

// Of cell size to the next level: from the third on one that resolves slip, by what the last tells.
static double next_step(const Accuracy *accuracy)
{
    const Levels *levels = &accuracy->levels;
    double cells = level_cells(&levels->list[levels->count - 1]);
    if (levels->count < LEVELS_LEAST - 1) return accuracy->step;
    double lacks = SLIP_CELLS_ENOUGH / fmax(cells, 0.5);
    return fmin(fmax(accuracy->step, 1.1 * lacks), STEP_SPLIT);
}

// The first run of a new level. A mesh that can only be split refuses the first step (ERROR_INPUT),
// and is halved from then on.
static bool try_level(Accuracy *accuracy, double refine, bool *coarse, Error *err)
{
    begin_level(accuracy, refine * next_step(accuracy));
    if (!run_member(accuracy, pressure_of(accuracy, 0), coarse, err) && err->code == ERROR_INPUT &&
        accuracy->step < STEP_SPLIT) {
        *err = (Error){0};
        accuracy->step = STEP_SPLIT;
        accuracy->levels.count--;
        begin_level(accuracy, refine * accuracy->step);
        run_member(accuracy, pressure_of(accuracy, 0), coarse, err);
    }
    return error_is_clean(err);
}

// Meshes whose cells are still too long for slip are passed over, while there is time for a finer.
static bool add_level(Accuracy *accuracy, double refine, Error *err)
{
    bool coarse = true;
    for (int32_t k = accuracy->levels.count + 1; coarse; k++) {
        coarse = false;
        TRY(try_level(accuracy, refine, k >= LEVELS_MAX ? NULL : &coarse, err));
        refine = last_level(accuracy)->refine;
        if (!coarse) break;
        accuracy->out_of_time = GROWTH * last_level(accuracy)->seconds > seconds_left(accuracy);
        accuracy->levels.count--;
        if (accuracy->out_of_time) goto cleanup;
    }
    TRY(add_runs(accuracy, RUNS_FIRST - 1, err));
cleanup:
    return error_is_clean(err);
}

// --- what next ----------------------------------------------------------------------------------

static const ErrorBar *asked(const Accuracy *accuracy)
{
    return levels_answer(&accuracy->levels, accuracy->levels.asked);
}

static bool is_met(const Accuracy *accuracy)
{
    const ErrorBar *answer = asked(accuracy);
    return levels_known(&accuracy->levels, accuracy->levels.asked) >= LEVELS_LEAST &&
           levels_resolved(&accuracy->levels) && !isnan(answer->parts.mesh) &&
           answer->bar <= accuracy->levels.wanted * answer->value;
}

// Wall time that the next level will take, from the last ones, s.
static double next_seconds(const Accuracy *accuracy)
{
    int32_t last = accuracy->levels.count - 1;
    const Level *level = &accuracy->levels.list[last];
    double growth = last > 0 ? level[0].seconds / level[-1].seconds : GROWTH;
    double steps = log(next_step(accuracy)) / log(accuracy->step);
    return level->seconds * pow(fmax(growth, 1.5), steps) * RUNS_FIRST / level->run_count;
}

static void show_level(const Accuracy *accuracy)
{
    const RunOptions *options = accuracy->options;
    const ErrorBar *answer = asked(accuracy);
    const Level *level = &accuracy->levels.list[accuracy->levels.count - 1];
    LevelView view = {.level = accuracy->levels.count,
                      .contact_nodes = level->contact_nodes,
                      .runs = level->run_count,
                      .answer = ANSWER_NAMES[accuracy->levels.asked],
                      .value = answer->value,
                      .bar = answer->bar,
                      .mesh = answer->parts.mesh,
                      .seconds = level->seconds,
                      .seconds_next = next_seconds(accuracy)};
    if (options->on_level) options->on_level(&view, options->context);
}

static bool end_here(Accuracy *accuracy, const char *why)
{
    accuracy->levels.ended = why;
    return true;
}

// More runs where branches and drops leave more than the mesh does, else a finer mesh. A level that
// time cuts short does not count.
static bool go_on(Accuracy *accuracy, bool *ended, Error *err)
{
    const ErrorBar *answer = asked(accuracy);
    Level *level = last_level(accuracy);
    double between = hypot(answer->parts.branches, answer->parts.drops);
    bool enough = accuracy->levels.count >= LEVELS_LEAST && levels_resolved(&accuracy->levels);
    if (isnan(answer->value))
        return *ended = end_here(accuracy, levels_run_in(&accuracy->levels)
                                               ? "the run-in of a run was not over"
                                               : "no load drop in any run");
    accuracy->levels.met = is_met(accuracy);
    if (accuracy->levels.met) return *ended = end_here(accuracy, "the error bar is met");
    if (enough && between > answer->parts.mesh && level->run_count + 2 <= LEVEL_RUNS_MAX - 1) {
        if (level->seconds / level->run_count * 2 > seconds_left(accuracy))
            return *ended = end_here(accuracy, "no time for more");
        TRY(add_runs(accuracy, 2, err));
        goto cleanup;
    }
    if (accuracy->levels.count == LEVELS_MAX)
        return *ended = end_here(accuracy, "the finest mesh that is tried");
    if (next_seconds(accuracy) > seconds_left(accuracy))
        return *ended = end_here(accuracy, "no time for more");
    TRY(add_level(accuracy, level->refine, err));
    if (accuracy->out_of_time && last_level(accuracy)->run_count < RUNS_FIRST)
        accuracy->levels.count--;
    if (accuracy->out_of_time) *ended = end_here(accuracy, "no time for more");
cleanup:
    return error_is_clean(err);
}

static bool find_levels(Accuracy *accuracy, Error *err)
{
    bool ended = false;
    TRY(first_level(accuracy, err));
    show_level(accuracy);
    while (!ended) {
        int32_t before = accuracy->levels.count, runs = last_level(accuracy)->run_count;
        TRY(go_on(accuracy, &ended, err));
        bool new = accuracy->levels.count != before || last_level(accuracy)->run_count != runs;
        if (new) show_level(accuracy);
    }
cleanup:
    return error_is_clean(err);
}

// Branches, not the mesh, are why the bar is not met, and more runs may mend it.
static bool levels_lack_runs(const Accuracy *accuracy)
{
    const Levels *levels = &accuracy->levels;
    const ErrorBar *answer = asked(accuracy);
    return !is_met(accuracy) && answer->parts.mesh < levels->wanted * answer->value &&
           levels->list[levels->count - 1].run_count + 2 <= LEVEL_RUNS_MAX;
}

// The scene itself on the last mesh, with its files. It counts as one more run where it goes on for
// long enough to have an answer; a branch that it found is a reason for more of them.
static bool run_in_full(Accuracy *accuracy, RunSummary *summary, Error *err)
{
    Levels *levels = &accuracy->levels;
    Simulation *simulation = NULL;
    Scene *scene = NEW_ARRAY(Scene, 1, err);
    TRY(scene);
    *scene = *accuracy->scene;
    TRY(scene_refine(scene, last_level(accuracy)->refine, err));
    TRY(amontons_simulation_create(scene, accuracy->options, &simulation, err));
    TRY(simulation_loop(simulation, err));
    Answers answers = answers_of(&simulation->drops);
    if (is_known(accuracy, &answers))
        levels_add_run(levels, 1, &answers, simulation->control.counters.accepted);
    while (levels_lack_runs(accuracy) && seconds_left(accuracy) > 0)
        TRY(add_runs(accuracy, 2, err));
    if (levels->met && !is_met(accuracy)) levels->ended = "the run in full widened it";
    levels->met = is_met(accuracy);
    if (!levels->met) warnings_of_bar(levels, &simulation->warnings);
    warnings_of_last_mesh(levels, &simulation->warnings);
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
    if (!(scene->accuracy.mu > 0)) return simulation_run(scene, options, summary, err);
    *summary = (RunSummary){.mu_M = NAN};
    ResultFolder folder = {0};
    Accuracy *accuracy = NEW_ARRAY(Accuracy, 1, err);
    TRY(accuracy);
    accuracy->scene = scene;
    accuracy->options = options;
    accuracy->started = clock_seconds();
    accuracy->levels.wanted = scene->accuracy.mu;
    accuracy->step = STEP;
    if (options->resume)
        FAIL(err, ERROR_INPUT,
             "an error bar (--to, accuracy.mu) is found from several runs, which do not go on from "
             "a checkpoint: say --overwrite");
    TRY(result_folder_claim(options->folder, options->overwrite, &folder, err));
    TRY(find_levels(accuracy, err));
    result_folder_release(&folder);   // the last run claims it for itself
    TRY(run_in_full(accuracy, summary, err));
cleanup:
    if (err->code == ERROR_INTERRUPT)
        accuracy_stopped(&accuracy->levels, scene->title,
                         folder.has_earlier ? NULL : options->folder, err);
    result_folder_release(&folder);
    memory_free(accuracy);
    return error_is_clean(err);
}
