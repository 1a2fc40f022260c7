// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/result/film_fields.h"

#include "base/memory.h"
#include "io/files/part_file.h"
#include "io/files/text_file.h"
#include "io/hdf5/result_file.h"
#include "io/text/json_reader.h"
#include "scene/scene.h"

#include <errno.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES = 600, OVERRIDES = 6, SETTING_SIZE = 120, OPEN_FOLDERS = 8 };

// Of the film's frames, as rapid slip has the other half.
static const double SLOW_SHARE = 0.5;
static const double BEHIND = 0.05;   // of a cycle: kept after its sliding, as the film shows it

// What is stored of a run.
typedef struct StoredRun {
    int64_t rows;
    double *t, *U, *mu;   // [rows] owned
} StoredRun;

static void stored_destroy(StoredRun *run)
{
    memory_free_all(run->t, run->U, run->mu);
}

static bool read_series(ArrayFile *file, ResultSeries series, double **values, int64_t *rows,
                        Error *err)
{
    int32_t width = 0;
    return result_file_read_series(file, series, values, rows, &width, err);
}

// The last cycle's U, with a little behind it.
static bool find_cycle(ArrayFile *file, double span[2], Error *err)
{
    static const ResultTable tables[3] = {EVENTS_KIND, EVENTS_U_STOP, EVENTS_U_START};
    double *column[3] = {0}, before = NAN, last = NAN;
    int32_t count = 0;
    TRY(result_file_read_tables(file, tables, 3, column, &count, err));
    for (int32_t k = 0; k < count; k++) {
        if (column[0][k] != 2 || !isfinite(column[1][k])) continue;   // leading rapid
        before = last;
        last = column[1][k];
    }
    if (isfinite(before)) span[0] = before;
    if (isfinite(last)) span[1] = fmin(span[1], last + BEHIND * (last - span[0]));
cleanup:
    for (int32_t k = 0; k < 3; k++) memory_free(column[k]);
    return error_is_clean(err);
}

// "U=0.0117", or of "t=120" where the rod was; what is neither is refused by the film.
static void take_moment(const char *at, const StoredRun *run, double *U)
{
    if (!at) return;
    double value = strtod(strlen(at) > 2 ? at + 2 : at, NULL);
    if (at[0] == 'U') *U = value;
    for (int64_t row = 0; at[0] == 't' && row < run->rows; row++)
        if (run->t[row] <= value) *U = run->U[row];
}

// What is stored in `folder`, and, where `span` is wanted, the part of U that the film shows.
static bool read_stored(const char *folder, const FilmRequest *request, StoredRun *run,
                        double span[2], Error *err)
{
    int64_t rows[3] = {0};
    ArrayFile *file = result_file_open(folder, err);
    TRY(file);
    TRY(read_series(file, SERIES_TIME, &run->t, &rows[0], err));
    TRY(read_series(file, SERIES_ROD, &run->U, &rows[1], err));
    TRY(read_series(file, SERIES_MU, &run->mu, &rows[2], err));
    run->rows = rows[0];
    if (rows[0] < 2 || rows[1] != rows[0] || rows[2] != rows[0])
        FAIL(err, ERROR_INPUT, "%s: a film needs a finished history of two steps at least", folder);
    span[0] = run->U[0];
    span[1] = run->U[run->rows - 1];
    if (request->last_cycle) TRY(find_cycle(file, span, err));
    take_moment(request->begin, run, &span[0]);
    take_moment(request->end, run, &span[1]);
cleanup:
    if (file) array_file_close(file, &(Error){0});
    return error_is_clean(err);
}

// The scene that run.json holds, as a file beside it, from where its own files are seen.
static bool write_scene(const char *folder, const char *path, Error *err)
{
    char report[AMONTONS_PATH_SIZE], *text = NULL;
    int32_t size = 0, length = 0;
    if (snprintf(report, sizeof report, "%s/run.json", folder) >= (int)sizeof report)
        FAIL(err, ERROR_INPUT, "the path of the result is too long");
    TRY(text_file_read(report, INT32_MAX / 2, &text, &size, err));
    const char *scene = json_find_raw(text, "scene", &length);
    if (!scene) FAIL(err, ERROR_INPUT, "%s holds no scene to be computed again", report);
    TRY(part_file_put(path, scene, length, err));
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

static bool read_scene(const char *path, const double span[2], double step, Scene **scene,
                       Error *err)
{
    char window[SETTING_SIZE];
    const char *overrides[OVERRIDES] = {"output.figures=[]", "output.compare=''",
                                        "output.fields=film", "output.history=true",
                                        "accuracy.mu=0"};
    snprintf(window, sizeof window, "output.window={from_U: %.17g, to_U: %.17g}", fmax(span[0], 0),
             span[1]);
    overrides[OVERRIDES - 1] = window;
    if (!amontons_scene_read(path, overrides, OVERRIDES, scene, err)) return false;
    (*scene)->output.film_step = step;
    return true;
}

// To the last bit: else the film would show another run than its result.
static bool check_same(const char *folder, const StoredRun *run, const FilmRequest *request,
                       Error *err)
{
    StoredRun again = {0};
    double span[2];
    TRY(read_stored(folder, request, &again, span, err));
    if (again.rows != run->rows ||
        memcmp(again.mu, run->mu, (size_t)run->rows * sizeof *run->mu) != 0)
        FAIL(err, ERROR_INPUT,
             "--fields: the run does not come out as it is stored (another version or computer, a "
             "mesh that has changed, one of several runs of an error bar): run the scene with "
             "output: {fields: film}, and film that");
cleanup:
    stored_destroy(&again);
    return error_is_clean(err);
}

bool film_fields_make(const char *folder, const FilmRequest *request, FilmFields *fields,
                      Error *err)
{
    char path[AMONTONS_PATH_SIZE + 8] = "";
    Scene *scene = NULL;
    StoredRun run = {0};
    RunSummary summary;
    double span[2], frames = request->seconds > 0 && request->rate > 0
                                 ? request->seconds * request->rate
                                 : FRAMES;
    RunOptions options = {.folder = fields->folder, .checkpoint_every = -1, .stop = request->stop};
    TRY(read_stored(folder, request, &run, span, err));
    if (snprintf(fields->folder, sizeof fields->folder, "%s/film.XXXXXX", folder) >=
            (int)sizeof fields->folder ||
        !mkdtemp(fields->folder)) {
        fields->folder[0] = '\0';
        FAIL(err, ERROR_FILE, "cannot write into %s: %s", folder, strerror(errno));
    }
    snprintf(path, sizeof path, "%s.json", fields->folder);
    TRY(write_scene(folder, path, err));
    TRY(read_scene(path, span, (span[1] - span[0]) / (SLOW_SHARE * frames), &scene, err));
    TRY(amontons_run(scene, &options, &summary, err));
    TRY(check_same(fields->folder, &run, request, err));
cleanup:
    if (path[0]) unlink(path);
    amontons_scene_destroy(scene);
    stored_destroy(&run);
    return error_is_clean(err);
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

void film_fields_remove(FilmFields *fields)
{
    if (fields->folder[0]) nftw(fields->folder, remove_one, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
    fields->folder[0] = '\0';
}
