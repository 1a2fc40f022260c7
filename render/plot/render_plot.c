// SPDX-License-Identifier: GPL-2.0-or-later
// The module's second entry: one plot from its description to its file.
#include "render/render.h"

#include "base/memory.h"
#include "render/plot/figure_curves.h"
#include "render/plot/plot_compare.h"
#include "render/plot/plot_file.h"

__attribute__((visibility("default"))) bool
amontons_render_plot(const char *path, const char *picture, const PictureStyle *style, Error *err)
{
    PictureStyle used = style ? *style : (PictureStyle){0};
    Page page = {0};
    Plot *plot = NEW_ARRAY(Plot, 1, err);
    TRY(plot);
    TRY(page_style_of_name(picture, &used, err));
    TRY(plot_file_read(path, plot, err));
    TRY(figure_plot(&page, plot, &used, plot->title, err));
    TRY(page_finish(&page, picture, plot->title, err));
    TRY(plot_compare_write(plot, picture, err));
cleanup:
    page_destroy(&page);
    if (plot) plot_destroy(plot);
    memory_free(plot);
    return error_is_clean(err);
}
