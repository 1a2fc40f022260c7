// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a stored result, by the render module, which is opened on first use.
#include "run/result/pictures.h"

#include "base/child_process.h"
#include "base/decimal_point.h"
#include "base/module.h"
#include "io/text/csv_reader.h"
#include "render/picture_options.h"
#include "render/render.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

// Processor time. Some minutes: far above what the longest history takes.
enum { SECONDS_MAX = 600 };

bool pictures_draw(const char *folder, const PictureRequest *request, Error *err)
{
    RenderFunction render = (RenderFunction)module_function("render", "amontons_render", err);
    return render && render(folder, request, err);
}

bool amontons_picture_option(PictureStyle *style, const char *name, const char *value, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    return picture_option_set(style, name, value, err);
}

bool pictures_check_folder(const char *folder, Error *err)
{
    struct stat status;
    if (stat(folder, &status) != 0)
        return REFUSE(err, "cannot open the result %s: %s", folder, strerror(errno));
    if (!S_ISDIR(status.st_mode)) return REFUSE(err, "%s is a file, not a result folder", folder);
    return true;
}

typedef struct DrawRequest {
    const char *folder;
    const PictureRequest *request;
} DrawRequest;

static bool draw_in_child(void *context, FILE *reply, Error *err)
{
    const DrawRequest *draw = context;
    (void)reply;   // pictures are files
    return pictures_draw(draw->folder, draw->request, err);
}

// A stranger's history may crash HDF5, or keep it busy for ever.
bool amontons_render_result(const char *folder, const PictureRequest *request, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    static const PictureRequest all = {0};
    DrawRequest draw = {folder, request ? request : &all};
    ChildWork work = {.path = folder,
                      .reader = "HDF5 or VTK",
                      .seconds = SECONDS_MAX,
                      .advice = "its history is damaged",
                      .read = draw_in_child,
                      .context = &draw};
    return pictures_check_folder(folder, err) && child_do(&work, err);
}

bool pictures_draw_plot(const char *plot, const char *picture, const PictureStyle *style,
                        Error *err)
{
    RenderPlotFunction render =
        (RenderPlotFunction)module_function("render", "amontons_render_plot", err);
    return render && render(plot, picture, style, err);
}

typedef struct PlotRequest {
    const char *plot, *picture;
    const PictureStyle *style;
} PlotRequest;

static bool draw_plot_in_child(void *context, FILE *reply, Error *err)
{
    const PlotRequest *draw = context;
    (void)reply;   // the picture is a file
    return pictures_draw_plot(draw->plot, draw->picture, draw->style, err);
}

// A plot file names others, which may be histories: what is said of those above holds here.
bool amontons_render_plot_file(const char *plot, const char *picture, const PictureStyle *style,
                               Error *err)
{
    NUMBERS_HAVE_A_POINT;
    PlotRequest draw = {plot, picture, style};
    ChildWork work = {.path = plot,
                      .reader = "HDF5",
                      .seconds = SECONDS_MAX,
                      .advice = "a file that it draws from is damaged",
                      .read = draw_plot_in_child,
                      .context = &draw};
    return child_do(&work, err);
}

bool amontons_compare(const char *folder, const char *measured, const PictureStyle *style,
                      char *words, int32_t size, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    static const char *const figure = "measured";
    PictureRequest request = {.figures = &figure, .figure_count = 1};
    if (style) request.style = *style;
    request.style.compare = measured;
    if (size > 0) words[0] = 0;
    if (!amontons_render_result(folder, &request, err)) return false;

    // figures/misfit.csv of the folder (render/figure_data) has a line for each figure.
    CsvTable table = {0};
    char path[AMONTONS_PATH_SIZE + 40];
    int32_t used = 0;
    bool lengths = false;
    snprintf(path, sizeof path, "%s/figures/misfit.csv", folder);
    TRY(csv_read(path, &table, err));
    for (int32_t row = 0; row < table.rows && used < size; row++) {
        double covered = csv_value(&table, row, 2), errors = csv_value(&table, row, 5);
        const char *over = csv_cell(&table, row, 4);
        char misfit[80] = "there is none", in_errors[60] = "";
        lengths = lengths || strcmp(csv_cell(&table, row, 0), "precursors") == 0;
        if (covered > 0)
            snprintf(misfit, sizeof misfit, "%.3g%s%s", csv_value(&table, row, 3), *over ? " " : "",
                     over);
        if (isfinite(errors)) snprintf(in_errors, sizeof in_errors, ", %.3g of the errors", errors);
        used += snprintf(words + used, (size_t)(size - used),
                         "  %-16s misfit %s%s, %s of %s points\n", csv_cell(&table, row, 0), misfit,
                         in_errors, csv_cell(&table, row, 2), csv_cell(&table, row, 1));
    }
    if (used < size)
        used += snprintf(
            words + used, (size_t)(size - used),
            "  misfit: root of the mean square of measured less computed, over the points that "
            "the result covers\n");
    if (lengths && used < size)
        snprintf(words + used, (size_t)(size - used),
                 "          a measured precursor stands beside the computed one nearest in load\n");
cleanup:
    csv_destroy(&table);
    return error_is_clean(err);
}
