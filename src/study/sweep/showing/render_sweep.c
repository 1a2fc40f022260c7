// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a stored sweep: those that its study had drawn, once more, or another one.
#include "amontons.h"

#include "base/child_process.h"
#include "base/decimal_point.h"
#include "base/text.h"
#include "io/files/folder.h"
#include "io/text/yaml_document.h"
#include "run/result/pictures.h"
#include "study/sweep/reading/study.h"
#include "study/sweep/showing/sweep_plot.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { SECONDS_MAX = 600 };   // far above what the largest sweep takes

typedef struct DrawSweep {
    const char *folder, *plot;
    const PictureStyle *style;
} DrawSweep;

static bool draw_in_child(void *context, FILE *reply, Error *err)
{
    const DrawSweep *draw = context;
    const char *ending = draw->style && draw->style->format ? draw->style->format : "png";
    char path[AMONTONS_PATH_SIZE], picture[AMONTONS_PATH_SIZE];
    YamlDocument *document = NULL;
    DIR *listing = NULL;
    StudyPlot plot;
    (void)reply;   // pictures are files
    if (draw->plot) {
        TRY(yaml_parse("the plot", draw->plot, 0, &document, err));
        TRY(plot_read(document, YAML_ROOT, &plot, err));
        TRY(sweep_plot_draw(draw->folder, NULL, &plot, draw->style, err));
        goto cleanup;
    }

    // Without a plot, each figures/NAME.json becomes a picture beside it, in the style's format.
    snprintf(path, sizeof path, "%.1000s/figures", draw->folder);
    if (!(listing = opendir(path)))
        FAIL(err, ERROR_INPUT, "cannot open %s: %s: its study asks for no `plot`; --plot does",
             path, strerror(errno));
    for (const struct dirent *entry; (entry = readdir(listing));) {
        if (!text_ends_with(entry->d_name, ".json")) continue;
        int stem = (int)strlen(entry->d_name) - 5;
        if (snprintf(path, sizeof path, "%s/figures/%s", draw->folder, entry->d_name) >=
                (int)sizeof path ||
            snprintf(picture, sizeof picture, "%s/figures/%.*s.%s", draw->folder, stem,
                     entry->d_name, ending) >= (int)sizeof picture)
            FAIL(err, ERROR_INPUT, "the path of the sweep is too long");
        TRY(folder_check_inside(draw->folder, path + strlen(draw->folder) + 1, err));
        TRY(pictures_draw_plot(path, picture, draw->style, err));
    }
cleanup:
    if (listing) closedir(listing);
    yaml_destroy(document);
    return error_is_clean(err);
}

// A stranger's table may crash HDF5.
bool amontons_render_sweep(const char *folder, const char *plot, const PictureStyle *style,
                           Error *err)
{
    NUMBERS_HAVE_A_POINT;
    DrawSweep draw = {folder, plot, style};
    ChildWork work = {.path = folder,
                      .reader = "HDF5",
                      .seconds = SECONDS_MAX,
                      .advice = "its table is damaged",
                      .read = draw_in_child,
                      .context = &draw};
    return child_do(&work, err);
}
