// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a stored result, by the render module, which is opened on first use.
#include "run/pictures.h"

#include "base/apart.h"
#include "base/module.h"
#include "io/text/picture_options.h"
#include "run/film_fields.h"
#include "render/render.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

// Processor time. Some minutes: far above what the longest history takes; of a film hours.
enum { SECONDS_MAX = 600, FILM_SECONDS_MAX = 36000 };

bool pictures_draw(const char *folder, const PictureRequest *request, Error *err)
{
    RenderFunction render = (RenderFunction)module_function("render", "amontons_render", err);
    return render && render(folder, request, err);
}

bool amontons_picture_option(PictureStyle *style, const char *name, const char *value, Error *err)
{
    return picture_option_set(style, name, value, err);
}

static bool check_folder(const char *folder, Error *err)
{
    struct stat status;
    if (stat(folder, &status) != 0)
        FAIL(err, ERROR_INPUT, "cannot open the result %s: %s", folder, strerror(errno));
    if (!S_ISDIR(status.st_mode))
        FAIL(err, ERROR_INPUT, "%s is a file, not a result folder", folder);
cleanup:
    return error_is_clean(err);
}

typedef struct DrawRequest {
    const char *folder;
    const PictureRequest *request;
} DrawRequest;

static bool draw_apart(void *context, FILE *reply, Error *err)
{
    const DrawRequest *draw = context;
    (void)reply;   // pictures are files
    return pictures_draw(draw->folder, draw->request, err);
}

// A stranger's history may crash HDF5, or keep it busy for ever.
bool amontons_render_result(const char *folder, const PictureRequest *request, Error *err)
{
    static const PictureRequest all = {0};
    DrawRequest draw = {folder, request ? request : &all};
    ApartWork work = {.path = folder,
                      .reader = "HDF5 or VTK",
                      .seconds = SECONDS_MAX,
                      .advice = "its history is damaged",
                      .read = draw_apart,
                      .context = &draw};
    return check_folder(folder, err) && apart_do(&work, err);
}

typedef struct FilmWork {
    const char *folder;
    const FilmRequest *request;
} FilmWork;

static bool film_apart(void *context, FILE *reply, Error *err)
{
    const FilmWork *film = context;
    (void)reply;
    RenderFilmFunction render =
        (RenderFilmFunction)module_function("render", "amontons_render_film", err);
    return render && render(film->folder, film->request, err);
}

bool amontons_film(const char *folder, const FilmRequest *request, Error *err)
{
    FilmWork film = {folder, request};
    ApartWork work = {.path = folder,
                      .reader = "HDF5 or VTK",
                      .seconds = FILM_SECONDS_MAX,
                      .advice = "its history is damaged",
                      .stop = request->stop,
                      .read = film_apart,
                      .context = &film};
    FilmFields fields = {0};
    TRY(check_folder(folder, err));
    if (request->fields) {
        TRY(film_fields_make(folder, request, &fields, err));
        film.folder = fields.folder;
    }
    TRY(apart_do(&work, err));
cleanup:
    film_fields_remove(&fields);
    return error_is_clean(err);
}

bool amontons_render_plot_file(const char *plot, const char *picture, const PictureStyle *style,
                               Error *err)
{
    RenderPlotFunction render =
        (RenderPlotFunction)module_function("render", "amontons_render_plot", err);
    TRY(render);
    TRY(render(plot, picture, style, err));
cleanup:
    return error_is_clean(err);
}
