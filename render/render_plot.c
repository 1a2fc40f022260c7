// SPDX-License-Identifier: GPL-2.0-or-later
// The module's second entry: one plot from its description to its PNG file.
#include "render/render.h"

#include "base/memory.h"
#include "render/context.h"
#include "render/figure_curves.h"
#include "render/png_file.h"

#include <math.h>

enum { WIDTH = 1720 };   // pixels: 20 a millimetre of a journal's column

__attribute__((visibility("default"))) bool amontons_render_plot(const char *path, const char *png,
                                                                 Error *err)
{
    Page page = {.point = WIDTH / COLUMN_WIDTH_POINTS};
    RenderContext *context = NULL;
    uint8_t *pixels = NULL;
    Plot *plot = NEW_ARRAY(Plot, 1, err);
    TRY(plot);
    TRY(plot_file_read(path, plot, err));
    TRY((context = context_create(err)));
    int32_t height = (int32_t)lround(WIDTH * plot->height_over_width);
    TRY((page.canvas = canvas_create(WIDTH, height, err)));
    TRY((page.text = text_create(page.canvas, err)));
    TRY(figure_curves(&page, plot, err));
    TRY(canvas_read(page.canvas, &pixels, err));
    PngPicture picture = {.width = WIDTH,
                          .height = height,
                          .pixels = pixels,
                          .pixels_per_metre = WIDTH / (1e-3 * COLUMN_WIDTH_MM),
                          .title = plot->title};
    TRY(png_file_write(png, &picture, err));
cleanup:
    text_destroy(page.text);
    canvas_destroy(page.canvas);
    context_destroy(context);
    memory_free(pixels);
    if (plot) plot_destroy(plot);
    memory_free(plot);
    return error_is_clean(err);
}
