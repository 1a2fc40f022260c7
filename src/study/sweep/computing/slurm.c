// SPDX-License-Identifier: GPL-2.0-or-later
// An element computes a share of the points (study/sweep/computing/share): one, or more where there
// are more points than Slurm's array may have elements. A point's result is its run.json, as with
// the pool; only for an element that left one without it the state that Slurm reports decides
// (slurm_jobs): the point it was at has failed, those behind it wait for the next sweep. With
// `keep: table` points are far shorter than the start of an element: a share is so many as take
// some minutes, and all that it left undone waits.
#include "study/sweep/computing/point.h"

#include "base/clock.h"
#include "base/memory.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/files/text_file.h"
#include "io/text/json_reader.h"
#include "study/sweep/computing/share.h"
#include "study/sweep/computing/slurm_jobs.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

static const double LOOK_PAUSE = 2;   // s between two looks at the queue
static const double STOP_PAUSE = 0.1;   // s between two looks at the stop flag
static const double SHARE_SECONDS = 240;   // that an element takes over its share, about
enum { TRIED_MAX = 20 };   // points whose time is looked at to cut shares
static const double REPORT_PAUSE = 10;   // s that a file system shared by nodes may take to show a
    // run.json after its element has ended

typedef struct Element {
    bool taken;   // its result is counted
    bool listed, ended;   // by squeue, at the last look
    char state[SLURM_WORD_SIZE], reason[SLURM_REASON_SIZE];   // as squeue lists them
    double gone_since;   // wall clock, s; 0: not gone
} Element;

typedef struct SlurmRun {
    Sweep *sweep;
    SlurmJobs jobs;   // owned, like the rest
    char id[SLURM_WORD_SIZE];   // of the array
    int32_t waiting_count, *waiting;   // points to compute
    int32_t count, left;   // elements; those not taken
    Element *elements;   // [count]; element k computes waiting[k], waiting[k + count], ...
    int32_t undone;   // points that elements left so
    char cause[ERROR_MESSAGE_SIZE];   // of the first of them
} SlurmRun;

// Says how element `k` ended, in Slurm's words and its own last ones: the last line that it
// printed. One that was cancelled before it began is no longer listed.
static void describe_end(SlurmRun *run, int32_t k, char message[ERROR_MESSAGE_SIZE])
{
    const Element *element = &run->elements[k];
    char state[SLURM_WORD_SIZE + SLURM_REASON_SIZE + 40], words[1100] = "", job[SLURM_JOB_SIZE];
    bool has_reason = *element->reason && strcmp(element->reason, "None") != 0;
    bool waited = strcmp(element->state, "PENDING") == 0;
    snprintf(job, sizeof job, "%s_%d", run->id, k);   // what Slurm calls it
    int number = slurm_signal(&run->jobs, job);
    const char *last = *element->state ? element->state : "unknown";
    if (number > 0)
        snprintf(state, sizeof state, "%s by signal %d (%s)", last, number, strsignal(number));
    else if (has_reason)
        snprintf(state, sizeof state, "%s (%s)", last, element->reason);
    else
        snprintf(state, sizeof state, "%s", last);

    Error ignored = {0};
    char path[POINT_PATH_SIZE], file[SLURM_JOB_SIZE + 8], *text = NULL;
    int32_t length = 0;
    snprintf(file, sizeof file, "%s.out", job);
    slurm_path(&run->jobs, file, path, sizeof path);
    if (access(path, R_OK) == 0 && text_file_read(path, 1 << 20, &text, &length, &ignored)) {
        while (length && text[length - 1] == '\n') text[--length] = 0;
        const char *line = strrchr(text, '\n');
        if (*text) snprintf(words, sizeof words, ": %.1000s", line ? line + 1 : text);
        memory_free(text);
    }
    if (element->ended)
        snprintf(message, ERROR_MESSAGE_SIZE, "the Slurm job ended as %s%s", state, words);
    else
        snprintf(message, ERROR_MESSAGE_SIZE,
                 "the Slurm job left the queue without a result, last seen as %s%s", state,
                 waited ? ": cancelled before it began" : words);
}

// The points of element `k` that have a result. *undone: how many have none; *first: of them.
static bool take_points(SlurmRun *run, int32_t k, int32_t *undone, int32_t *first, Error *err)
{
    Sweep *sweep = run->sweep;
    bool left = false;
    *undone = 0;
    if (sweep->study.keep_table && !share_take(sweep, k, err)) return false;
    for (int32_t i = k; i < run->waiting_count; i += run->count) {
        int32_t point = run->waiting[i];
        if (!sweep_is_waiting(sweep, point)) continue;
        if (!sweep_take_ended(sweep, point, NAN, &left, err)) return false;
        if (!left && (*undone)++ == 0) *first = point;
    }
    return true;
}

// squeue is asked every LOOK_PAUSE seconds, the stop flag far more often.
static bool wait_for_all(SlurmRun *run, Error *err)
{
    while (run->left > 0) {
        bool answered = false;
        SlurmLine line;
        char *rest = NULL;
        if (!slurm_list(&run->jobs, &answered, err)) return false;
        for (int32_t k = 0; answered && k < run->count; k++)
            run->elements[k].listed = run->elements[k].ended = false;
        while (answered && slurm_next_line(&run->jobs, &rest, &line)) {
            if (strcmp(run->id, line.id) != 0 || line.index < 0 || line.index >= run->count)
                continue;
            Element *element = &run->elements[line.index];
            element->listed = true;
            element->ended = slurm_is_end(line.state);
            memcpy(element->state, line.state, sizeof element->state);
            memcpy(element->reason, line.reason, sizeof element->reason);
        }
        for (int32_t k = 0; answered && k < run->count; k++) {
            Element *element = &run->elements[k];
            int32_t undone = 0, first = 0;
            if (element->taken || (element->listed && !element->ended)) continue;

            // This element has ended, or has left the queue unseen. The results that can be seen
            // are taken at each look.
            if (!take_points(run, k, &undone, &first, err)) return false;
            if (undone > 0) {
                // Unless Slurm is known to have ended the element, it may have written more
                // results: they are waited for.
                bool comes = !element->ended || strcmp(element->state, "COMPLETED") == 0 ||
                             strcmp(element->reason, "NonZeroExitCode") == 0;
                if (element->gone_since == 0) element->gone_since = clock_seconds();
                if (comes && clock_seconds() - element->gone_since < REPORT_PAUSE) continue;

                // The point that it was at has failed.
                if (!run->sweep->study.keep_table) {
                    char message[ERROR_MESSAGE_SIZE];
                    bool cancelled = strcmp(element->state, "PENDING") == 0 ||
                                     strcmp(element->state, "CANCELLED") == 0;
                    describe_end(run, k, message);
                    if (!sweep_take_lost(run->sweep, first, NAN,
                                         cancelled ? "cancelled" : "crashed", message, err))
                        return false;
                    undone--;
                }
                if (undone > 0 && run->undone == 0) describe_end(run, k, run->cause);
                run->undone += undone;
            }
            element->taken = true;
            run->left--;
        }
        double until = clock_seconds() + LOOK_PAUSE;
        while (run->left > 0 && clock_seconds() < until) {
            if (!sweep_check_stop(run->sweep, err)) return false;
            slurm_pause(STOP_PAUSE);
        }
    }
    return true;
}

// --- the whole ----------------------------------------------------------------------------------

bool slurm_end_leftovers(const Sweep *sweep, Error *err)
{
    SlurmJobs jobs = {0};
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/slurm/running", sweep->folder);
    if (access(path, F_OK) != 0) return true;
    TRY(slurm_jobs_open(sweep->folder, 0, &jobs, err));
    TRY(slurm_cancel(&jobs, err));
    unlink(path);
cleanup:
    slurm_jobs_close(&jobs);
    return error_is_clean(err);
}

// Points that wait are cut into elements, one each. With `keep: table` an element takes as many as
// need some minutes by the mean time of some points that are done, without their mesh and basis,
// which the next ones find in the cache; as many elements as may run at a time (-j) there are in
// any case.
static bool list_elements(SlurmRun *run, Error *err)
{
    const Sweep *sweep = run->sweep;
    int32_t limit = 0, points = sweep->study.point_count, tried = 0;
    if (!(run->waiting = NEW_ARRAY(int32_t, points, err))) return false;
    for (int32_t k = 0; k < points; k++)
        if (sweep_is_waiting(sweep, k)) run->waiting[run->waiting_count++] = k;
    run->count = run->waiting_count;
    if (run->count == 0) return true;

    if (sweep->study.keep_table) {
        double sum = 0;
        for (int32_t k = 0; k < points; k += 1 + points / TRIED_MAX) {
            double total = 0, mesh = 0, reduce = 0;
            if (sweep->points[k].status != POINT_DONE) continue;
            char *report = point_report(sweep, k, err);
            if (!report) return false;
            json_find_number(report, "timing_s.total", &total);
            json_find_number(report, "timing_s.mesh", &mesh);
            json_find_number(report, "timing_s.reduce", &reduce);
            memory_free(report);
            sum += total - mesh - reduce;
            tried++;
        }
        double mean = tried > 0 ? sum / tried : SHARE_SECONDS;
        run->count = (int32_t)ceil(run->waiting_count * fmin(mean / SHARE_SECONDS, 1));
        if (run->count < sweep->options->jobs) run->count = sweep->options->jobs;
        if (run->count > run->waiting_count) run->count = run->waiting_count;
    }

    if (!slurm_array_limit(&run->jobs, &limit, err)) return false;
    if (run->count > limit) run->count = limit;
    run->left = run->count;
    return (run->elements = NEW_ARRAY(Element, run->count, err)) != NULL;
}

// Also after an error no job of ours stays in the queue: the file `running`, which exists as long
// as jobs may be there, is removed only when that is known, and otherwise tells the next sweep to
// look.
bool slurm_run(Sweep *sweep, Error *err)
{
    SlurmRun run = {.sweep = sweep};
    const Study *study = &sweep->study;
    Error ignored = {0};
    char path[POINT_PATH_SIZE], script[POINT_PATH_SIZE], why[OPEN_WHY_SIZE];
    bool out = false;   // jobs may be
    TRY(slurm_jobs_open(sweep->folder, study->point_count, &run.jobs, err));
    // How long points take is found out here, before shares are cut: some of them, from all over.
    if (study->keep_table) TRY(pool_run(sweep, 1, 1 + study->point_count / TRIED_MAX, err));
    TRY(list_elements(&run, err));
    if (run.count == 0) goto cleanup;

    TRY(folder_make_inside(run.jobs.folder, "slurm", err));
    slurm_path(&run.jobs, "running", path, sizeof path);
    int file = open_to_write(path, OPEN_KEPT, why);
    if (file < 0) FAIL(err, ERROR_FILE, "cannot write %s: %s", path, why);
    close(file);
    out = true;

    TRY(share_write_designs(sweep, err));
    for (int32_t k = 0; k < run.count; k++)
        TRY(share_write(sweep, k, run.waiting, run.waiting_count, run.count, err));
    slurm_path(&run.jobs, "array.sh", script, sizeof script);
    TRY(slurm_write_script(&run.jobs, script, study->path, sweep->options, err));
    TRY(slurm_submit(&run.jobs, script, run.count, sweep->options, run.id, err));
    TRY(wait_for_all(&run, err));
    if (run.undone > 0)
        FAIL(err, ERROR_INTERRUPT, "%d points are not computed, the same command goes on: %.1500s",
             run.undone, run.cause);
cleanup:
    if (!error_is_clean(err) && out) {
        out = !slurm_cancel(&run.jobs, &ignored);
        // A point that was written before the elements were cancelled is finished like any other.
        for (int32_t k = 0; k < run.count; k++) {
            Error none = {0};   // the caller tells why the sweep ends
            int32_t undone = 0, first = 0;
            if (!run.elements[k].taken) take_points(&run, k, &undone, &first, &none);
        }
    } else {
        out = false;
    }
    slurm_path(&run.jobs, "running", path, sizeof path);
    if (run.jobs.folder[0] && !out) unlink(path);
    memory_free_all(run.waiting, run.elements);
    slurm_jobs_close(&run.jobs);
    return error_is_clean(err);
}
