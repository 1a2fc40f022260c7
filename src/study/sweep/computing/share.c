// SPDX-License-Identifier: GPL-2.0-or-later
// An element is a pool of one worker over its share: a crash costs one point, as on one's own
// computer. It writes whole lines, so what is there when Slurm ends it is as good as the rest.
#include "study/sweep/computing/share.h"

#include "base/memory.h"
#include "io/files/text_file.h"
#include "io/text/text_writer.h"
#include "study/sweep/computing/point.h"
#include "study/sweep/reading/study.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    SHARE_PATH_SIZE = POINT_PATH_SIZE + 64,
    SHARE_BYTES_MAX = 1 << 28,
    LINE_SIZE = HASH_TEXT_SIZE + 60
};

static void share_path(const Sweep *sweep, int32_t share, const char *what,
                       char path[SHARE_PATH_SIZE])
{
    snprintf(path, SHARE_PATH_SIZE, "%s/slurm/share-%d.%s", sweep->folder, share, what);
}

bool share_write(const Sweep *sweep, int32_t share, const int32_t *points, int32_t count,
                 int32_t step, Error *err)
{
    char path[SHARE_PATH_SIZE];
    share_path(sweep, share, "points", path);
    TextWriter *text = text_writer_create(path, false, err);
    if (!text) return false;
    for (int32_t k = share; k < count; k += step) {
        const SweepPoint *point = &sweep->points[points[k]];
        fprintf(text->out, "%d %s\n", points[k], point->hash);
    }
    return text_writer_finish(text, err);
}

bool share_write_designs(const Sweep *sweep, Error *err)
{
    const Study *study = &sweep->study;
    char path[SHARE_PATH_SIZE];
    snprintf(path, sizeof path, "%s/slurm/designs", sweep->folder);
    TextWriter *text = text_writer_create(path, false, err);
    if (!text) return false;
    for (int32_t k = 0; k < study->design_count; k++)
        fwrite(study->designs[k].text, strlen(study->designs[k].text) + 1, 1, text->out);
    return text_writer_finish(text, err);
}

// --- in the process of the element --------------------------------------------------------------

bool share_run(Sweep *sweep, int32_t share, Error *err)
{
    char path[SHARE_PATH_SIZE], *designs = NULL, *text = NULL, *rest = NULL;
    int32_t size = 0;
    if (sweep->study.search.node != YAML_NO_NODE) {
        snprintf(path, sizeof path, "%s/slurm/designs", sweep->folder);
        TRY(text_file_bytes(path, SHARE_BYTES_MAX, &designs, &size, err));
        for (const char *one = designs; one < designs + size; one += strlen(one) + 1)
            TRY(study_add_designs(&sweep->study, one, err));
    }

    share_path(sweep, share, "points", path);
    TRY((sweep->points = NEW_ARRAY(SweepPoint, sweep->study.point_count, err)));
    for (int32_t k = 0; k < sweep->study.point_count; k++) sweep->points[k].same_as = -1;
    TRY(text_file_read(path, SHARE_BYTES_MAX, &text, &size, err));

    // Each line names a point that waits. Its scene must have the hash that it had when the sweep
    // began: a study that was changed meanwhile would answer another question.
    for (const char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        char hash[HASH_TEXT_SIZE] = "";
        int point = -1;
        if (sscanf(line, "%d %32s", &point, hash) < 2 || point < 0 ||
            point >= sweep->study.point_count)
            FAIL(err, ERROR_INPUT, "%s has fewer points than when the sweep began",
                 sweep->study.path);
        SweepPoint *at = &sweep->points[point];
        const Scene *scene = point_scene(sweep, point, err);
        TRY(scene && point_hash(sweep, scene, at->hash, err));
        if (strcmp(hash, at->hash) != 0)
            FAIL(err, ERROR_INPUT,
                 "the study, its scene or a mesh was changed after the sweep began");
        at->same_as = point;
    }

    share_path(sweep, share, "reports", path);
    if (sweep->study.keep_table) TRY(reports_open(&sweep->reports, path, true, err));
    sweep->checked = true;   // what is recorded: by the sweep
    TRY(pool_run(sweep, 1, 1, err));
cleanup:
    reports_close(&sweep->reports);
    memory_free_all(designs, text);
    return error_is_clean(err);
}

// --- in the sweep's -----------------------------------------------------------------------------

typedef struct Taking {
    Sweep *sweep;
    Reports from;
    Error *err;
} Taking;

// This is a ReportFound.
static void take_line(void *context, const char *hash, ReportPlace place)
{
    Taking *taking = context;
    char *report = NULL;
    if (!error_is_clean(taking->err)) return;
    report = reports_read(&taking->from, place, taking->err);
    if (report && reports_add(&taking->sweep->reports, hash, report, &place, taking->err))
        points_note_place(taking->sweep, hash, place);
    memory_free(report);
}

bool share_take(Sweep *sweep, int32_t share, Error *err)
{
    Taking taking = {.sweep = sweep, .err = err};
    char path[SHARE_PATH_SIZE];
    share_path(sweep, share, "reports", path);
    if (access(path, F_OK) == 0) {
        TRY(reports_open(&taking.from, path, false, err));
        TRY(reports_list(&taking.from, take_line, &taking, err));
    }
    unlink(path);
    share_path(sweep, share, "points", path);
    unlink(path);
cleanup:
    reports_close(&taking.from);
    return error_is_clean(err);
}

bool share_take_all(Sweep *sweep, Error *err)
{
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/slurm", sweep->folder);
    DIR *folder = opendir(path);
    if (!folder) return true;   // Slurm was never asked
    for (const struct dirent *entry; (entry = readdir(folder));) {
        int share = -1;
        if (sscanf(entry->d_name, "share-%d.points", &share) == 1 && share >= 0)
            TRY(share_take(sweep, share, err));
    }
cleanup:
    closedir(folder);
    return error_is_clean(err);
}
