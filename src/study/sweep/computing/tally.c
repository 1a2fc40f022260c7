// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/computing/point.h"

#include "base/clock.h"
#include "base/memory.h"
#include "io/text/json_reader.h"

#include <math.h>
#include <string.h>

// Reports to the caller that point `k` has ended and left `report` (NULL: none).
static void report_point(Sweep *sweep, int32_t k, const char *report)
{
    const SweepPoint *point = &sweep->points[k];
    char path[POINT_PATH_SIZE + 16], words[POINT_WORDS_SIZE] = "";
    char message[ERROR_MESSAGE_SIZE] = "", warning[8];
    Error ignored = {0};
    sweep->finished++;
    if (point->status == POINT_FAILED) sweep->failed++;
    if (!sweep->options->on_point) return;
    const Scene *scene = point_scene(sweep, k, &ignored);
    if (scene) point_words(sweep, scene, words);
    point_path(sweep, k, "run.json", path);
    SweepView view = {.point = k,
                      .words = words,
                      .run = sweep->reports.open ? NULL : path,
                      .mu_M = NAN,
                      .mu_M_error = NAN,
                      .value = NAN,
                      .bar = NAN,
                      .known_to = NAN,
                      .seconds = point->seconds,
                      .seconds_left = NAN,
                      .finished = sweep->finished,
                      .failed = sweep->failed,
                      .points = sweep->planned,
                      .reused = point->reused};

    // The quantity that the study ranks by, or mu_M, of a finished point.
    const Study *study = &sweep->study;
    const StudyRecord *ranked = study->rank.wanted ? &study->records[study->rank.record] : NULL;
    PointValue found = point_value(report, ranked ? ranked->path : "results.mu_M");
    view.quantity = ranked ? ranked->name : "mu_M";
    view.value = found.value;
    view.bar = found.bar;
    view.known_to = found.known_to;

    if (report) {
        json_find_number(report, "results.mu_M", &view.mu_M);
        json_find_number(report, "results.mu_M_error", &view.mu_M_error);
        view.warned = json_find_text(report, "warnings.0", warning, sizeof warning);
    }
    if (point->status == POINT_FAILED) {
        if (report) json_find_text(report, "message", message, sizeof message);
        view.message = message;
    }
    if (sweep->computed > 0)
        view.seconds_left = (clock_seconds() - sweep->started) / sweep->computed *
                            (sweep->planned - sweep->finished);
    sweep->options->on_point(&view, sweep->options->context);
}

// Looks up what the study records in the first run.json of a finished point: a mistyped path must
// not cost a whole sweep, and run.json has no schema in which to look it up before.
static bool check_records(Sweep *sweep, int32_t point, const char *report, Error *err)
{
    const Study *study = &sweep->study;
    if (sweep->checked || sweep->points[point].status != POINT_DONE) return true;
    sweep->checked = true;
    for (int32_t k = 0; k < study->record_count; k++) {
        const StudyRecord *record = &study->records[k];
        char first[STUDY_NAME_SIZE];
        if (record->node == YAML_NO_NODE || json_may_hold(report, record->path)) continue;
        if (json_find_key(report, record->path, 0, first, sizeof first))
            return yaml_error(study->file, record->node, err,
                              "%s: `%s` of run.json has many values: name one, as in %s.%s",
                              record->given_by, record->path, record->path, first);
        return yaml_error(study->file, record->node, err, "%s: run.json has no `%s`",
                          record->given_by, record->path);
    }
    return true;
}

// Points finished by an earlier sweep.
bool sweep_take_finished(Sweep *sweep, int32_t first, Error *err)
{
    for (int32_t k = first; k < sweep->study.point_count; k++) {
        SweepPoint *point = &sweep->points[k];
        if (point->same_as < k) continue;
        if (!point_check_place(sweep, k, err)) return false;
        char *report = point_report(sweep, k, err), failure[40] = "";
        if (!error_is_clean(err)) return false;
        point->status = point_status(report);
        bool failed = point->status == POINT_FAILED;

        // A disk or memory that was full says nothing of the point: it is computed again.
        if (failed) json_find_text(report, "failure", failure, sizeof failure);
        bool by_machine = strcmp(failure, amontons_error_name(ERROR_FILE)) == 0 ||
                          strcmp(failure, amontons_error_name(ERROR_MEMORY)) == 0;
        if (sweep->options->fresh || (failed && (sweep->options->retry || by_machine)))
            point->status = POINT_PENDING;
        point->reused = point->status != POINT_PENDING;
        if (point->reused) {
            report_point(sweep, k, report);
            check_records(sweep, k, report, err);
        } else {
            point_remove(sweep, k, sweep->options->fresh, err);
        }
        memory_free(report);
        if (!error_is_clean(err)) return false;
    }
    return error_is_clean(err);
}

bool sweep_check_stop(const Sweep *sweep, Error *err)
{
    const volatile sig_atomic_t *stop = sweep->options->stop;
    if (stop && *stop)
        return FAULT(err, ERROR_INTERRUPT,
                     "interrupted; the same command continues where this one stopped");
    return true;
}

// A point with the scene of an earlier one is not computed again.
bool sweep_is_waiting(const Sweep *sweep, int32_t point)
{
    return sweep->points[point].status == POINT_PENDING && sweep->points[point].same_as == point;
}

// Points end in any order; the table keeps the study's.
bool sweep_take_ended(Sweep *sweep, int32_t point, double seconds, bool *left, Error *err)
{
    char *report = point_report(sweep, point, err);
    TRY(error_is_clean(err));
    *left = point_status(report) != POINT_PENDING;
    if (!*left) goto cleanup;
    if (isnan(seconds) && !json_find_number(report, "timing_s.total", &seconds)) seconds = 0;
    sweep->points[point].status = point_status(report);
    sweep->points[point].seconds = seconds;
    sweep->computed++;
    report_point(sweep, point, report);
    TRY(check_records(sweep, point, report, err));
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

// The report is read back, so that what is counted is what the next sweep will find.
bool sweep_take_lost(Sweep *sweep, int32_t point, double seconds, const char *failure,
                     const char *message, Error *err)
{
    bool left = false;
    return point_write_failure(sweep, point, failure, message, err) &&
           sweep_take_ended(sweep, point, seconds, &left, err);
}

// This comes before the table, which has a row for each.
void sweep_share_results(Sweep *sweep)
{
    for (int32_t k = 0; k < sweep->study.point_count; k++) {
        SweepPoint *point = &sweep->points[k];
        const SweepPoint *first = &sweep->points[point->same_as];
        point->status = first->status;
        if (point->same_as < k) point->reused = first->status != POINT_PENDING;
    }
}

void sweep_summarise(const Sweep *sweep, SweepSummary *summary)
{
    *summary = (SweepSummary){.points = sweep->study.point_count,
                              .computed = sweep->computed,
                              .seconds = clock_seconds() - sweep->started};
    for (int32_t k = 0; k < sweep->study.point_count; k++) {
        const SweepPoint *point = &sweep->points[k];
        summary->reused += point->reused;
        summary->failed += point->status == POINT_FAILED;
        summary->pending += point->status == POINT_PENDING;
    }
}
