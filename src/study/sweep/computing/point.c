// SPDX-License-Identifier: GPL-2.0-or-later
// The files of a sweep's point, and their names.
#include "study/sweep/computing/point.h"

#include "base/computation.h"
#include "base/memory.h"
#include "io/files/folder.h"
#include "io/files/own_list.h"
#include "io/files/text_file.h"
#include "io/mesh/mesh_cache.h"
#include "io/text/json_reader.h"
#include "io/text/json_writer.h"
#include "scene/keys.h"
#include "study/sweep/reading/study.h"

#include <limits.h>
#include <math.h>
#include <search.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { REPORT_BYTES_MAX = 1 << 28 };

static const char RUN_REPORT[] = "run.json";   // whose presence makes a point finished
static const char CHECKPOINT[] =
    "checkpoint.bin";   // of a run that was cut off; short ones have none

static bool key_counts(const char *key)
{
    return strcmp(key, "title") != 0 && strcmp(key, "mesh.file") != 0;
}

// Hashes all that decides the result of a point, the mesh by its content. The title and the path of
// the mesh do not count. Where the mesh file draws on others, the mesh counts that gmsh makes of it
// with this point's parameters, every time.
bool point_hash(Sweep *sweep, const Scene *scene, char text[HASH_TEXT_SIZE], Error *err)
{
    PointMesh *mesh = &sweep->mesh;
    MeshFile made = {0};
    bool whole = false;
    Hash hash = computation_hash();
    if (strcmp(mesh->path, scene->mesh.file) != 0) {
        mesh->hash = hash_start();
        TRY(mesh_source_hash(scene->mesh.file, NULL, 0, &mesh->hash, &whole, err));
        Error failed = {0};   // it will be this point's own, when it is computed
        if (whole)
            memcpy(mesh->path, scene->mesh.file, SCENE_TEXT_SIZE);
        else if (mesh_file_read(scene->mesh.file, scene->mesh.parameters,
                                scene->mesh.parameter_count, scene->trusted, NULL, &made, &failed))
            mesh_file_hash(&made, &mesh->hash);
    }
    hash_bytes(&hash, &mesh->hash, sizeof mesh->hash);
    TRY(scene_hash(scene, key_counts, &hash, err));
    hash_write(&hash, text);
cleanup:
    mesh_file_destroy(&made);
    return error_is_clean(err);
}

static int compare_hashes(const void *a, const void *b)
{
    const SweepPoint *one = a, *other = b;
    return strcmp(one->hash, other->hash);
}

static void keep_point(void *point)
{
    (void)point;   // the tree does not own it
}

void points_forget(void **tree)
{
    if (*tree) tdestroy(*tree, keep_point);
    *tree = NULL;
}

// A study may have a million points: none is compared with all others.
bool points_find_same(Sweep *sweep, Error *err)
{
    points_forget(&sweep->by_hash);
    for (int32_t k = 0; k < sweep->study.point_count; k++) {
        SweepPoint *const *first = tsearch(&sweep->points[k], &sweep->by_hash, compare_hashes);
        if (!first) return FAULT(err, ERROR_MEMORY, "no memory for %d points", k);
        sweep->points[k].same_as = (int32_t)(*first - sweep->points);
    }
    return true;
}

int32_t points_look_up(const Sweep *sweep, const char *hash)
{
    SweepPoint like = {0};
    snprintf(like.hash, sizeof like.hash, "%s", hash);
    SweepPoint *const *first = tfind(&like, &sweep->by_hash, compare_hashes);
    return first ? (int32_t)(*first - sweep->points) : -1;
}

void points_note_place(void *context, const char *hash, ReportPlace place)
{
    Sweep *sweep = context;
    int32_t point = points_look_up(sweep, hash);
    if (point >= 0) sweep->points[point].place = place;
}

const Scene *point_scene(const Sweep *sweep, int32_t point, Error *err)
{
    return study_scene(&sweep->study, &(PointChoice){.point = point}, sweep->scene, err)
               ? sweep->scene
               : NULL;
}

// Points are found by hash, not by number, so that a study that is changed finds its old points
// again.
void point_path(const Sweep *sweep, int32_t point, const char *file,
                char path[POINT_PATH_SIZE + 16])
{
    snprintf(path, POINT_PATH_SIZE + 16, "%s/points/%s%s%s", sweep->folder,
             sweep->points[point].hash, *file ? "/" : "", file);
}

// Missing is no error; unreadable is. One that a power cut left with zero bytes is cut there, and
// computed again.
char *point_report(const Sweep *sweep, int32_t point, Error *err)
{
    const SweepPoint *first = &sweep->points[sweep->points[point].same_as];
    if (sweep->reports.open)
        return first->place.size > 0 ? reports_read(&sweep->reports, first->place, err) : NULL;
    char path[POINT_PATH_SIZE + 16], *bytes = NULL;
    int32_t size = 0;
    point_path(sweep, point, RUN_REPORT, path);
    if (access(path, F_OK) == 0) text_file_bytes(path, REPORT_BYTES_MAX, &bytes, &size, err);
    return bytes;
}

PointValue point_value(const char *report, const char *path)
{
    PointValue found = {NAN, NAN, NAN, NAN};
    char beside[STUDY_NAME_SIZE + 16];
    if (!report) return found;
    json_find_number(report, path, &found.value);
    snprintf(beside, sizeof beside, "%s_error", path);
    json_find_number(report, beside, &found.error);
    snprintf(beside, sizeof beside, "%s_known_to", path);
    if (!json_find_number(report, beside, &found.known_to))
        found.known_to = isnan(found.error) ? 0 : found.error;
    if (found.error == found.known_to) found.bar = found.error;
    return found;
}

// An interrupted run is not finished, though it left a run.json; nor is one whose run.json a disk
// lost in part.
PointStatus point_status(const char *report)
{
    char status[20] = "", failure[40] = "";
    if (!report || !json_is_whole(report) ||
        !json_find_text(report, "status", status, sizeof status))
        return POINT_PENDING;
    if (strcmp(status, "done") == 0) return POINT_DONE;
    json_find_text(report, "failure", failure, sizeof failure);
    return strcmp(failure, amontons_error_name(ERROR_INTERRUPT)) == 0 ? POINT_PENDING
                                                                      : POINT_FAILED;
}

const char *point_status_name(PointStatus status)
{
    static const char *const names[] = {
        [POINT_PENDING] = "pending", [POINT_DONE] = "done", [POINT_FAILED] = "failed"};
    return names[status];
}

bool point_check_place(const Sweep *sweep, int32_t point, Error *err)
{
    const char *const files[] = {RUN_REPORT, CHECKPOINT,
                                 "history.h5"};   // a fit reads the last one
    char name[POINT_PATH_SIZE];
    for (int k = 0; k < 3 && !sweep->reports.open; k++) {
        snprintf(name, sizeof name, "points/%s/%s", sweep->points[point].hash, files[k]);
        if (!folder_check_inside(sweep->folder, name, err)) return false;
    }
    return true;
}

// run.json, which alone makes a point finished; anew: and what it could be gone on with from. The
// rest is the next run's to overwrite.
bool point_remove(Sweep *sweep, int32_t point, bool anew, Error *err)
{
    const char *const files[] = {RUN_REPORT, CHECKPOINT};
    char path[POINT_PATH_SIZE + 16];
    sweep->points[point].place = (ReportPlace){0};
    if (sweep->reports.open) return true;
    for (int k = 0; k < (anew ? 2 : 1); k++) {
        point_path(sweep, point, files[k], path);
        if (!own_list_refuse_taken(path, err)) return false;
        unlink(path);
    }
    return true;
}

// This is a ReportCallback: the text is the point's only where there is memory for it.
static void take_report(const char *json, void *context)
{
    char **report = context;
    Error ignored = {0};
    memory_free(*report);   // of a run on another mesh
    *report = memory_text(json, &ignored);
}

bool point_keep(Sweep *sweep, int32_t point, const char *report, Error *err)
{
    SweepPoint *at = &sweep->points[point];
    return reports_add(&sweep->reports, at->hash, report, &at->place, err);
}

// An ordinary run, which goes on with what was cut off or is written over what an earlier try may
// have left in the folder.
bool point_run(const Sweep *sweep, int32_t point, char **report, Error *err)
{
    char folder[POINT_PATH_SIZE + 16], checkpoint[POINT_PATH_SIZE + 16];
    RunSummary summary;
    RunOptions options = {.folder = folder, .overwrite = true};
    const Scene *scene = point_scene(sweep, point, err);
    *report = NULL;
    TRY(scene);
    if (sweep->reports.open) {   // without any file
        options = (RunOptions){.on_report = take_report, .context = report};
        amontons_run(scene, &options, &summary, err);
        if (*report) {
            json_drop(*report, "scene");
            json_drop(*report, "results.events");
            json_compact(*report);
        }
        goto cleanup;
    }
    point_path(sweep, point, "", folder);
    point_path(sweep, point, CHECKPOINT, checkpoint);
    options.resume = access(checkpoint, F_OK) == 0 && !(scene->accuracy.mu > 0);
    if (amontons_run(scene, &options, &summary, err) || !options.resume) goto cleanup;
    if (err->code != ERROR_INPUT) goto cleanup;
    *err = (Error){0};   // a checkpoint of another basis, or damaged: from the start
    options.resume = false;
    TRY(amontons_run(scene, &options, &summary, err));
cleanup:
    return error_is_clean(err);
}

// Has the scene in it like every run.json, so that it can be run again by hand.
bool point_write_failure(Sweep *sweep, int32_t point, const char *failure, const char *message,
                         Error *err)
{
    char folder[POINT_PATH_SIZE + 16], path[POINT_PATH_SIZE + 16], *report = NULL;
    bool table = sweep->reports.open;
    const Scene *scene = point_scene(sweep, point, err);
    JsonWriter *json = NULL;
    TRY(scene);
    point_path(sweep, point, "", folder);
    if (!table) mkdir(folder, 0777);   // a failure shows when the list is written
    if (!table) TRY(own_list_make(folder, err));
    point_path(sweep, point, RUN_REPORT, path);
    TRY((json = json_create(table ? NULL : path, err)));
    json_begin_object(json, NULL);
    json_text(json, "status", "failed");
    json_text(json, "failure", failure);
    json_text(json, "message", message);
    json_text(json, "version", AMONTONS_VERSION);
    if (!table) scene_write_json(scene, json, "scene", folder);
    json_end(json);
    if (!table) TRY(json_finish(json, err));
    if (!table) goto cleanup;
    TRY((report = json_take(json, err)));
    json_compact(report);
    TRY(point_keep(sweep, point, report, err));
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

void point_words(const Sweep *sweep, const Scene *scene, char words[POINT_WORDS_SIZE])
{
    words[0] = 0;
    for (int32_t k = 0; k < sweep->study.column_count; k++)
        study_add_words(scene, sweep->study.columns[k], words, POINT_WORDS_SIZE);
}
