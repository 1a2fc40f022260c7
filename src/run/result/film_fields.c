// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/result/film_fields.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/files/part_file.h"
#include "io/files/text_file.h"
#include "io/hdf5/result_file.h"
#include "io/text/json_reader.h"
#include "render/render.h"
#include "scene/scene.h"

#include <errno.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OVERRIDES = 6, SETTING_SIZE = 120, OPEN_FOLDERS = 8 };

// Part of the film's frames for slow slip: rapid slip has the other half.
static const double SLOW_SHARE = 0.5;
static const double BEHIND = 0.01;   // of what the film shows: kept behind it

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
    TRY(part_file_put(path, false, scene, length, err));
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

static bool read_scene(const char *path, const FilmPart *part, bool trusted, Scene **scene,
                       Error *err)
{
    bool (*read)(const char *, const char *const *, int32_t, Scene **, Error *) =
        trusted ? amontons_scene_read_trusted : amontons_scene_read;
    char window[SETTING_SIZE];
    const char *overrides[OVERRIDES] = {"output.figures=[]", "output.compare=''",
                                        "output.fields=film", "output.history=true",
                                        "accuracy.mu=0"};
    double way = part->to_U - part->from_U;
    snprintf(window, sizeof window, "output.window={from_U: %.17g, to_U: %.17g}",
             fmax(part->from_U, 0), part->to_U + BEHIND * way);
    overrides[OVERRIDES - 1] = window;
    if (!read(path, overrides, OVERRIDES, scene, err)) return false;
    (*scene)->output.film_step = way / (SLOW_SHARE * part->frames);
    return true;
}

static bool read_mu(const char *folder, double **mu, int64_t *rows, Error *err)
{
    int32_t width = 0;
    ArrayFile *file = result_file_open(folder, err);
    if (!file) return false;
    bool done = result_file_read_series(file, SERIES_MU, mu, rows, &width, err);
    array_file_close(file, &(Error){0});
    return done;
}

// To the last bit: else the film would show another run than its result.
static bool check_same(const char *folder, const char *again, Error *err)
{
    double *mu[2] = {0};
    int64_t rows[2] = {0};
    TRY(read_mu(folder, &mu[0], &rows[0], err));
    TRY(read_mu(again, &mu[1], &rows[1], err));
    if (rows[0] != rows[1] || memcmp(mu[0], mu[1], (size_t)rows[0] * sizeof **mu) != 0)
        FAIL(err, ERROR_INPUT,
             "--fields: the run does not come out as it is stored (another version or computer, a "
             "mesh that has changed, one of several runs of an error bar): run the scene with "
             "output: {fields: film}, and film that");
cleanup:
    memory_free_all(mu[0], mu[1]);
    return error_is_clean(err);
}

bool film_fields_make(const char *folder, const FilmRequest *request, FilmFields *fields,
                      Error *err)
{
    char path[AMONTONS_PATH_SIZE + 8] = "";
    Scene *scene = NULL;
    RunSummary summary;
    FilmPart part;
    RunOptions options = {.folder = fields->folder, .checkpoint_every = -1, .stop = request->stop};
    RenderFilmPartFunction find_part =
        (RenderFilmPartFunction)module_function("render", "amontons_render_film_part", err);
    TRY(find_part && find_part(folder, request, &part, err));
    if (snprintf(fields->folder, sizeof fields->folder, "%s/film.XXXXXX", folder) >=
            (int)sizeof fields->folder ||
        !mkdtemp(fields->folder)) {
        fields->folder[0] = '\0';
        FAIL(err, ERROR_FILE, "cannot write into %s: %s", folder, strerror(errno));
    }
    snprintf(path, sizeof path, "%s.json", fields->folder);
    TRY(write_scene(folder, path, err));
    TRY(read_scene(path, &part, request->trust, &scene, err));
    TRY(amontons_run(scene, &options, &summary, err));
    TRY(check_same(folder, fields->folder, err));
cleanup:
    if (path[0]) unlink(path);
    amontons_scene_destroy(scene);
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
