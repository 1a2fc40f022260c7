// SPDX-License-Identifier: GPL-2.0-or-later
// A film of a stored result, by the render module in a child process.
#include "base/child_process.h"
#include "base/decimal_point.h"
#include "base/module.h"
#include "render/render.h"
#include "run/result/pictures.h"

#include <stdio.h>
#include <string.h>

enum { FILM_SECONDS_MAX = 36000 };   // of processor time

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
    ChildReply reply = {0};
    if (!pictures_check_folder(folder, err)) return false;
    if (!request->still || !child_is_wanted()) return child_do(&work, err);
    if (child_read(&work, &reply, err)) memcpy(request->still, reply.bytes, sizeof *request->still);
    child_destroy(&reply);
    return error_is_clean(err);
}
