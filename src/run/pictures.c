// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a stored result, by the render module, which is opened on first use.
#include "amontons.h"
#include "base/module.h"
#include "render/render.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

bool amontons_render_result(const char *folder, const char *const *figures, int32_t figure_count,
                            Error *err)
{
    struct stat status;
    if (stat(folder, &status) != 0)
        FAIL(err, ERROR_INPUT, "cannot open the result %s: %s", folder, strerror(errno));
    if (!S_ISDIR(status.st_mode))
        FAIL(err, ERROR_INPUT, "%s is a file, not a result folder", folder);
    RenderFunction render = (RenderFunction)module_function("render", "amontons_render", err);
    TRY(render);
    RenderRequest request = {.folder = folder, .figures = figures, .figure_count = figure_count};
    TRY(render(&request, err));
cleanup:
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
