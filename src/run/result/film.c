// SPDX-License-Identifier: GPL-2.0-or-later
// A film of a stored result, by the render module. Where fields of the block are asked for that the
// result has not got, its run is computed once more into a folder inside of it: fields are kept
// between the two times that the film shows, each time the rod, or the fastest point of the
// contact, has moved on by as little as from one frame to the next.
#include "base/child_process.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/module.h"
#include "io/files/part_file.h"
#include "io/files/text_file.h"
#include "io/hdf5/result_file.h"
#include "io/text/json_reader.h"
#include "render/render.h"
#include "run/result/pictures.h"
#include "scene/scene.h"

#include <errno.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    FILM_SECONDS_MAX = 36000,   // of processor time
    OVERRIDES = 6,
    SETTING_SIZE = 120,
    OPEN_FOLDERS = 8
};

// Part of the film's frames for slow slip: rapid slip has the other half.
static const double SLOW_SHARE = 0.5;
static const double BEHIND = 0.01;   // of what the film shows: kept behind it

static bool read_mu(const char *folder, double **mu, int64_t *rows, Error *err)
{
    int32_t width = 0;
    ArrayFile *file = result_file_open(folder, err);
    if (!file) return false;
    bool done = result_file_read_series(file, SERIES_MU, mu, rows, &width, err);
    array_file_close(file, &(Error){0});
    return done;
}

// Computes the run of the result `folder` once more, into the new folder `fields` inside of it.
// ERROR_INPUT: no scene is in the result, or its run does not come out as the stored one.
static bool compute_fields(const char *folder, const FilmRequest *request,
                           char fields[AMONTONS_PATH_SIZE], Error *err)
{
    char report[AMONTONS_PATH_SIZE], path[AMONTONS_PATH_SIZE + 8] = "", window[SETTING_SIZE];
    char *text = NULL;
    int32_t size = 0, length = 0;
    double *mu[2] = {0};
    int64_t rows[2] = {0};
    Scene *scene = NULL;
    RunSummary summary;
    FilmPart part;
    RunOptions options = {.folder = fields, .checkpoint_every = -1, .stop = request->stop};
    RenderFilmPartFunction find_part =
        (RenderFilmPartFunction)module_function("render", "amontons_render_film_part", err);
    TRY(find_part && find_part(folder, request, &part, err));
    if (snprintf(fields, AMONTONS_PATH_SIZE, "%s/film.XXXXXX", folder) >= AMONTONS_PATH_SIZE ||
        !mkdtemp(fields)) {
        fields[0] = '\0';
        FAIL(err, ERROR_FILE, "cannot write into %s: %s", folder, strerror(errno));
    }

    // The scene that run.json holds, as a file beside it, from where its own files are seen.
    snprintf(path, sizeof path, "%s.json", fields);
    if (snprintf(report, sizeof report, "%s/run.json", folder) >= (int)sizeof report)
        FAIL(err, ERROR_INPUT, "the path of the result is too long");
    TRY(text_file_read(report, INT32_MAX / 2, &text, &size, err));
    const char *stored = json_find_raw(text, "scene", &length);
    if (!stored) FAIL(err, ERROR_INPUT, "%s holds no scene to be computed again", report);
    TRY(part_file_put(path, false, stored, length, err));
    memory_free(text);   // it may be long
    text = NULL;

    // It is read with the fields of a film, in the window that the film shows.
    double way = part.to_U - part.from_U;
    const char *overrides[OVERRIDES] = {"output.figures=[]",  "output.compare=''",
                                        "output.fields=film", "output.history=true",
                                        "accuracy.mu=0",      window};
    snprintf(window, sizeof window, "output.window={from_U: %.17g, to_U: %.17g}",
             fmax(part.from_U, 0), part.to_U + BEHIND * way);
    TRY((request->trust ? amontons_scene_read_trusted
                        : amontons_scene_read)(path, overrides, OVERRIDES, &scene, err));
    scene->output.film_step = way / (SLOW_SHARE * part.frames);
    TRY(amontons_run(scene, &options, &summary, err));

    // Both runs are the same to the last bit: else the film would show another run than its result.
    TRY(read_mu(folder, &mu[0], &rows[0], err));
    TRY(read_mu(fields, &mu[1], &rows[1], err));
    if (rows[0] != rows[1] || memcmp(mu[0], mu[1], (size_t)rows[0] * sizeof **mu) != 0)
        FAIL(err, ERROR_INPUT,
             "--fields: the run does not come out as it is stored (another version or computer, a "
             "mesh that has changed, one of several runs of an error bar): run the scene with "
             "output: {fields: film}, and film that");
cleanup:
    if (path[0]) unlink(path);
    amontons_scene_destroy(scene);
    memory_free_all(mu[0], mu[1], text);
    return error_is_clean(err);
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

typedef struct FilmWork {
    const char *folder;
    const FilmRequest *request;
} FilmWork;

static bool film_in_child(void *context, FILE *reply, Error *err)
{
    const FilmWork *film = context;
    RenderFilmFunction render =
        (RenderFilmFunction)module_function("render", "amontons_render_film", err);
    if (!render || !render(film->folder, film->request, err)) return false;
    const double *still = film->request->still;   // this process's
    if (reply && still) fwrite(still, sizeof *still, 1, reply);
    return true;
}

bool amontons_film(const char *folder, const FilmRequest *request, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    FilmWork film = {folder, request};
    ChildWork work = {.path = folder,
                      .reader = "HDF5 or VTK",
                      .seconds = FILM_SECONDS_MAX,
                      .advice = "its history is damaged",
                      .stop = request->stop,
                      .read = film_in_child,
                      .context = &film};
    char fields[AMONTONS_PATH_SIZE] = "";   // the folder of the second result; empty: there is none
    ChildReply reply = {0};
    TRY(pictures_check_folder(folder, err));
    if (request->fields) {
        TRY(compute_fields(folder, request, fields, err));
        film.folder = fields;
    }
    if (!request->still || !child_is_wanted()) {
        TRY(child_do(&work, err));
    } else {
        TRY(child_read(&work, &reply, err));
        memcpy(request->still, reply.bytes, sizeof *request->still);
    }
cleanup:
    child_destroy(&reply);
    if (fields[0]) nftw(fields, remove_one, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
    return error_is_clean(err);
}
