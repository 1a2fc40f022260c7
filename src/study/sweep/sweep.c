// SPDX-License-Identifier: GPL-2.0-or-later
// study read -> every scene checked and hashed -> finished points found -> the rest computed ->
// table, and what the study wants shown of it.
#include "study/sweep/sweep.h"

#include "algebra/dense.h"
#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/module.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/files/own_list.h"
#include "study/sweep/computing/point.h"
#include "study/sweep/computing/share.h"
#include "study/sweep/reading/study.h"
#include "study/sweep/showing/sweep_plot.h"
#include "study/sweep/showing/rank.h"

#include <errno.h>
#include <string.h>

// Points of a sweep that was killed die with it, and leave its lock a moment later; s.
static const double LOCK_WAIT = 1;

// Makes the sweep's folder and takes its lock, which the system removes when the process ends,
// however it ends. A file of somebody's with the name of one of the sweep's tables is told before
// hours of computing, not behind them.
static bool make_folder(Sweep *sweep, Error *err)
{
    static const char *const tables[] = {"sweep.csv", "sweep.h5", "ranking.csv", "reports"};
    static const char *const inner[] = {"points", "figures", "slurm"};
    const Study *study = &sweep->study;
    char path[POINT_PATH_SIZE + STUDY_NAME_SIZE];
    if (snprintf(sweep->folder, sizeof sweep->folder, "%s", sweep->options->folder) >=
        (int)sizeof sweep->folder)
        return REFUSE(err, "the path of the sweep's folder is too long");
    if (!folder_make(sweep->folder, err)) return false;

    snprintf(path, sizeof path, "%s/amontons.lock", sweep->folder);
    bool locked = file_lock_take(&sweep->lock, path, LOCK_WAIT);
    if (!locked && sweep->lock.busy)
        return FAULT(err, ERROR_FILE,
                     "another sweep is running in %s: wait for it, or choose another folder (-o)",
                     sweep->folder);
    if (!locked)
        return FAULT(err, ERROR_FILE, "cannot write into %s: %s", sweep->folder, strerror(errno));
    const char *unlocked = file_lock_warning(&sweep->lock);
    if (unlocked && sweep->options->out) fprintf(sweep->options->out, "%s\n\n", unlocked);

    for (size_t k = 0; k < sizeof tables / sizeof tables[0]; k++) {
        snprintf(path, sizeof path, "%s/%s", sweep->folder, tables[k]);
        if (!own_list_refuse_taken(path, err)) return false;
    }
    if (!own_list_check(sweep->folder, err) || !own_list_make(sweep->folder, err)) return false;

    // The folders in it, which are written into and removed from, before any of that.
    for (size_t k = 0; k < sizeof inner / sizeof inner[0]; k++)
        if (!folder_check_inside(sweep->folder, inner[k], err)) return false;
    if (!study->keep_table && !folder_make_inside(sweep->folder, "points", err)) return false;
    if (!slurm_end_leftovers(sweep, err)) return false;
    snprintf(path, sizeof path, "%s/reports", sweep->folder);
    return !study->keep_table || reports_open(&sweep->reports, path, sweep->options->fresh, err);
}

// Plans the points that the study has more than before: scenes and hashes, so that what is wrong
// with any of them shows before the first is run; then the folder; then what was finished earlier
// is found and reported.
static bool sweep_plan(Sweep *sweep, Error *err)
{
    const Study *study = &sweep->study;
    int32_t first = sweep->point_count, count = study->point_count;
    bool found = false;
    TRY(memory_resize(&sweep->points, first, count, sizeof *sweep->points, err));
    for (int32_t k = first; k < count; k++) {
        const Scene *scene = point_scene(sweep, k, err);
        TRY(scene && point_hash(sweep, scene, sweep->points[k].hash, err));

        // `keep: table` keeps nothing but numbers, and cannot do what needs more.
        if (study->keep_table &&
            (scene->output.history || scene->output.fields || scene->output.figures.count > 0))
            FAIL(err, ERROR_INPUT,
                 "%s: keep: with `table` points have no folder for a history, fields or figures: "
                 "say `keep: points`",
                 study->path);
        if (study->keep_table && study->rank.refine > 0)
            FAIL(err, ERROR_INPUT, "%s: keep: `table` does not go with `refine`", study->path);
        if (study->rank.refine > 0 && !(scene->accuracy.mu > 0))
            FAIL(err, ERROR_INPUT,
                 "%s: rank: `refine` halves accuracy.mu, which must be given to begin with, as in "
                 "`set: {accuracy.mu: 3%%}`",
                 study->path);
    }
    TRY(points_find_same(sweep, err));

    // The baseline of each point: the one whose scene is its own with the keys of `rank.against`.
    // Where no point at all has one the ranking would have no gains.
    for (int32_t k = 0; study->rank.against == AGAINST_KEYS && k < count; k++) {
        char hash[HASH_TEXT_SIZE];
        TRY(study_scene(study, &(PointChoice){.point = k, .baseline = true}, sweep->scene, err));
        TRY(point_hash(sweep, sweep->scene, hash, err));
        sweep->points[k].baseline = points_look_up(sweep, hash);
        found = found || sweep->points[k].baseline >= 0;
    }
    if (study->rank.against == AGAINST_KEYS && !found)
        TRY(yaml_error(study->file, study->rank.baseline, err,
                       "against: no point of the study has these values"));
    sweep->point_count = count;
    if (sweep->planned < count) sweep->planned = count;

    // The folder is made when the study has turned out to be right. Reports of an earlier sweep are
    // listed, also of points that the study no longer has, or not yet.
    if (!sweep->folder[0]) TRY(make_folder(sweep, err));
    if (study->keep_table) {
        TRY(reports_list(&sweep->reports, points_note_place, sweep, err));
        TRY(share_take_all(sweep, err));
    }
    TRY(sweep_take_finished(sweep, first, err));
cleanup:
    return error_is_clean(err);
}

bool sweep_show(const Sweep *sweep, FILE *out, bool whole, Error *err)
{
    SweepTable table = {0};
    TRY(table_write(sweep, &table, err));
    if (sweep->study.rank.wanted) TRY(ranking_show(sweep, &table, out, whole, err));
    for (int32_t k = 0; whole && k < sweep->study.plot_count; k++)
        TRY(sweep_plot_draw(sweep->folder, sweep->study.path, &sweep->study.plots[k], NULL, err));
    Error none = {0};
    bool described = whole && (sweep->study.rank.wanted || sweep->study.plot_count > 0);
    if (out && described && !module_check("render", &none))
        fprintf(
            out,
            "\nThe figures are not drawn, figures/*.json has what is in them (`amontons render` "
            "of another build draws it). %s\n",
            none.message);
    if (out) warned_print(&table.warned, out);
    if (out && table.no_bar)
        fprintf(out,
                "\nAt %d of %d points there is no error bar: mu is known to what a mesh usually "
                "leaves; a study's `set: {accuracy.mu: 1%%}` asks for bars\n",
                table.no_bar, sweep->study.point_count);
cleanup:
    table_destroy(&table);
    return error_is_clean(err);
}

bool sweep_compute(Sweep *sweep, Error *err)
{
    bool whole = sweep->options->slurm ? slurm_run(sweep, err)
                                       : pool_run(sweep, sweep->options->jobs, 1, err);
    sweep_share_results(sweep);
    return whole;
}

// --- the whole ----------------------------------------------------------------------------------

bool sweep_open(const char *path, const SweepOptions *options, Sweep **opened, Error *err)
{
    Sweep *sweep = *opened = NEW_ARRAY(Sweep, 1, err);
    if (!sweep) return false;
    sweep->options = options;
    sweep->started = clock_seconds();
    if (!(sweep->scene = NEW_ARRAY(Scene, 1, err))) return false;
    dense_use_one_thread();   // before forking
    return study_read(path, options->overrides, options->override_count, options->trust,
                      &sweep->study, err);
}

bool sweep_add(Sweep *sweep, const char *designs, Error *err)
{
    return study_add_designs(&sweep->study, designs, err) && sweep_plan(sweep, err);
}

void sweep_close(Sweep *sweep)
{
    if (!sweep) return;
    file_lock_release(&sweep->lock);
    reports_close(&sweep->reports);
    points_forget(&sweep->by_hash);
    memory_free_all(sweep->points, sweep->scene);
    study_destroy(&sweep->study);
    memory_free(sweep);
}

bool amontons_sweep_element(const char *path, const SweepOptions *options, int32_t element,
                            Error *err)
{
    NUMBERS_HAVE_A_POINT;
    Sweep *sweep = NULL;
    TRY(sweep_open(path, options, &sweep, err));
    snprintf(sweep->folder, sizeof sweep->folder, "%s", options->folder);
    TRY(share_run(sweep, element, err));
cleanup:
    sweep_close(sweep);
    return error_is_clean(err);
}

// A stopped sweep still leaves its table, with what is not done marked as pending.
bool amontons_sweep(const char *path, const SweepOptions *options, SweepSummary *summary,
                    Error *err)
{
    NUMBERS_HAVE_A_POINT;
    *summary = (SweepSummary){0};
    Error stopped = {0};
    Sweep *sweep = NULL;
    TRY(sweep_open(path, options, &sweep, err));
    if (sweep->study.search.node != YAML_NO_NODE) {
        yaml_key_error(sweep->study.file, sweep->study.search.node, err,
                       "search: designs are chosen by `amontons %s`, not by a sweep",
                       sweep->study.search.fits ? "fit" : "optimise");
        goto cleanup;
    }
    if (sweep->study.rank.refine > 0)
        FAIL(err, ERROR_INPUT,
             "%s: rank: `refine` is of `amontons optimise`; a sweep computes all points with the "
             "same bar: set a smaller accuracy.mu, or search by `amontons optimise`",
             sweep->study.path);
    TRY(sweep_plan(sweep, err));
    bool whole = sweep_compute(sweep, &stopped);
    sweep_summarise(sweep, summary);
    if (!whole && stopped.code != ERROR_INTERRUPT) {
        *err = stopped;
        goto cleanup;
    }
    TRY(sweep_show(sweep, options->out, whole, err));
    if (!whole) *err = stopped;
cleanup:
    sweep_close(sweep);
    return error_is_clean(err);
}
