// SPDX-License-Identifier: GPL-2.0-or-later
// amontons_run: one run, or, where the scene asks for an error bar (accuracy.mu), runs on meshes of
// falling cell size until the bar (answers/error_bars) is met.
//
// A level is a mesh, mesh.set.refine times as fine as the scene's; the first is the coarsest with
// enough contact nodes. Its runs write nothing and end as soon as their answer is known; they
// differ in pressure within accuracy.window, and share mesh and basis. What is done next
// follows from the largest part of the bar: a finer mesh, or more runs on this one. The last run is
// the scene itself on the last mesh, with all that it asks to be written, and counts too.
#include "answers/drop_series.h"
#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "run/accuracy_figure.h"
#include "run/accuracy_state.h"
#include "run/warnings.h"

#include <math.h>

enum { COARSER_MAX = 3 };   // halvings of the scene's mesh that are tried
static const double RATIO = 1.189207115002721;   // of cell size from level to level: 2^(1/4)
// A run's time goes with this power of the cells along the contact, in the plane and in space. What
// the levels of a search tell of it says less: times of short runs are noise.
static const double GROWTH[] = {2, 4};
// A mesh that is to confirm a bar may take this part of the time given, where nothing says that
// finer meshes differ.
static const double CONFIRM_SHARE = 1. / 60;

// One more run on its mesh, s.
static double seconds_of_run(const Level *level)
{
    return (level->seconds - level->making) / level->run_count;
}

// For so many more runs on the last level.
static bool has_time_for(Accuracy *accuracy, int32_t runs)
{
    const Level *level = accuracy_last_level(accuracy);
    return seconds_of_run(level) * runs <= accuracy_seconds_left(accuracy);
}

static bool add_runs(Accuracy *accuracy, int32_t count, Error *err)
{
    for (int32_t k = 0; k < count && !accuracy->out_of_time; k++) {
        accuracy->out_of_time = !has_time_for(accuracy, 1);
        if (accuracy->out_of_time) break;
        if (!accuracy_run_member(accuracy, NULL, err)) return false;
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
                          ? level_seconds(accuracy, refine / accuracy_last_level(accuracy)->refine)
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
    if (accuracy->levels.count == 1) return accuracy_seconds_left(accuracy) > 0;
    double more = accuracy_full(accuracy, growth_ahead(accuracy, ratio)) -
                  accuracy_full(accuracy, 1);
    return level_seconds(accuracy, ratio) + more <= accuracy_seconds_left(accuracy);
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
        if (!accuracy_run_member(accuracy, may_be, err) && err->code == ERROR_INPUT &&
            accuracy->cell_ratio < RATIO_SPLIT) {
            *err = (Error){0};
            accuracy->cell_ratio = RATIO_SPLIT;
            accuracy->levels.count--;
            begin_level(accuracy, refine * accuracy->cell_ratio);
            accuracy_run_member(accuracy, may_be, err);
        }
        if (!error_is_clean(err)) return false;
        refine = accuracy_last_level(accuracy)->refine;
        if (!coarse) break;
        accuracy->out_of_time = growth_ahead(accuracy, accuracy->cell_ratio) *
                                    accuracy_last_level(accuracy)->seconds >
                                accuracy_seconds_left(accuracy);
        accuracy->levels.count--;
        if (accuracy->out_of_time) return true;
    }
    return add_runs(accuracy, accuracy_runs_first(accuracy) - 1, err);
}

// Where a second mesh that is finer is not expected to end in time, a coarser one tells how far
// meshes differ.
static bool wants_coarser_level(const Accuracy *accuracy)
{
    return accuracy->levels.count == 1 && accuracy->cell_ratio < RATIO_SPLIT &&
           level_seconds(accuracy, accuracy->cell_ratio) > accuracy_seconds_left(accuracy);
}

// The coarser of two meshes, in the time that is left, becomes the first level. The finer one is
// begun all the same where there is no coarser one that counts.
static bool add_coarser_level(Accuracy *accuracy, Error *err)
{
    Levels *levels = &accuracy->levels;
    Level finer = levels->list[0];
    double stepping = accuracy->stepping, making = accuracy->making;
    double excess = level_seconds(accuracy, 1) / accuracy_seconds_left(accuracy);
    double ratio = fmax(pow(excess, 1 / GROWTH[finer.space]), accuracy->cell_ratio);
    bool coarse = false;
    begin_level(accuracy, finer.refine / fmin(ratio, RATIO_SPLIT));
    accuracy_run_member(accuracy, &coarse, err);
    accuracy->stepping = stepping;   // the run in full is on the finer one
    accuracy->making = making;
    if (coarse || err->code == ERROR_INPUT || err->code == ERROR_LIBRARY) {
        *err = (Error){0};
        levels->count--;
        return add_level(accuracy, finer.refine, err);
    }
    if (accuracy_last_level(accuracy)->run_count > 0) {
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
        accuracy_run_member(accuracy, last ? NULL : &coarse, err);
        if (!coarse && (last || error_is_clean(err))) break;
        if (err->code == ERROR_INPUT || err->code == ERROR_LIBRARY) *err = (Error){0};
        if (!error_is_clean(err)) return false;
        levels->count--;
    }
    if (!error_is_clean(err)) return false;
    if (!add_runs(accuracy, accuracy_runs_first(accuracy) - 1, err)) return false;
    if (!levels_have_runs(levels)) levels->ended = NO_TIME;
    if (!levels->ended) show_level(accuracy, levels->list);

    while (!levels->ended) {
        const ErrorBar *answer = asked(accuracy);
        const Level *level = accuracy_last_level(accuracy);
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
        if (levels->count > 1 && accuracy_last_level(accuracy)->run_count == 0) levels->count--;
        levels_estimate(levels);
        if (!added) return false;

        // A mesh that was added is the last one or, where that is still the one of before, the
        // first.
        const Level *last = accuracy_last_level(accuracy);
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
    TRY(scene_refine(scene, accuracy_last_level(accuracy)->refine, err));
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
    if (accuracy_is_known(accuracy, &answers) && levels_reach(levels, simulation->seen.U))
        accuracy_count_run(accuracy, simulation, 1, &answers);

    // More runs where branches, not the mesh, are why the bar is not met.
    while (!is_met(accuracy) && accuracy_seconds_left(accuracy) > 0 &&
           asked(accuracy)->parts.mesh < levels->wanted * asked(accuracy)->value &&
           accuracy_last_level(accuracy)->run_count + 2 <= LEVEL_RUNS_MAX)
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
    *summary = summary_none();
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
