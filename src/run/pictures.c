// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a stored result, by the render module, which is opened on first use.
#include "run/pictures.h"

#include "base/apart.h"
#include "base/module.h"
#include "render/render.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

// Some minutes: far above what the longest history takes.
enum { SECONDS_MAX = 600 };

bool pictures_draw(const char *folder, const char *const *figures, int32_t figure_count, Error *err)
{
    RenderFunction render = (RenderFunction)module_function("render", "amontons_render", err);
    RenderRequest request = {.folder = folder, .figures = figures, .figure_count = figure_count};
    return render && render(&request, err);
}

typedef struct DrawRequest {
    const char *folder;
    const char *const *figures;
    int32_t figure_count;
} DrawRequest;

static bool draw_apart(void *context, FILE *reply, Error *err)
{
    const DrawRequest *request = context;
    (void)reply;   // pictures are files
    return pictures_draw(request->folder, request->figures, request->figure_count, err);
}

// A stranger's history may crash HDF5, or keep it busy for ever.
bool amontons_render_result(const char *folder, const char *const *figures, int32_t figure_count,
                            Error *err)
{
    struct stat status;
    ApartReply reply = {0};
    DrawRequest request = {folder, figures, figure_count};
    ApartWork work = {.path = folder,
                      .reader = "HDF5",
                      .seconds = SECONDS_MAX,
                      .advice = "its history is damaged",
                      .read = draw_apart,
                      .context = &request};
    if (stat(folder, &status) != 0)
        FAIL(err, ERROR_INPUT, "cannot open the result %s: %s", folder, strerror(errno));
    if (!S_ISDIR(status.st_mode))
        FAIL(err, ERROR_INPUT, "%s is a file, not a result folder", folder);
    TRY(apart_is_wanted() ? apart_read(&work, &reply, err) : draw_apart(&request, NULL, err));
cleanup:
    apart_destroy(&reply);
    return error_is_clean(err);
}

bool amontons_render_plot_file(const char *plot, const char *png, Error *err)
{
    RenderPlotFunction render =
        (RenderPlotFunction)module_function("render", "amontons_render_plot", err);
    TRY(render);
    TRY(render(plot, png, err));
cleanup:
    return error_is_clean(err);
}
