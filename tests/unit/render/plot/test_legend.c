// SPDX-License-Identifier: GPL-2.0-or-later
// The legend in lines below the frame: a line's height for each, as many as the width asks for.
#include "render/plot/legend.h"

#include "render/plot/plot_draw.h"

#include "base/memory.h"
#include "canvas_read.h"
#include "cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The frame's lower side: the last row of pixels with ink over three quarters of the picture.
static int32_t frame_bottom(Plot *plot)
{
    Error err = {0};
    enum { WIDTH = 860, HEIGHT = 645 };
    const PictureStyle style = {.dpi = 254};   // 10 pixels a millimetre
    Page page = {0};
    uint8_t *pixels = NULL;
    int32_t bottom = -1;
    plot->height_over_width = (double)HEIGHT / WIDTH;
    assert_true(plot_draw(&page, plot, &style, NULL, &err));
    assert_true(canvas_read(page.canvas, &pixels, &err));
    for (int32_t row = 0; row < HEIGHT; row++) {
        int32_t dark = 0;
        for (int32_t column = 0; column < WIDTH; column++)
            dark += pixels[3 * (row * WIDTH + column)] < 128;
        if (4 * dark > 3 * WIDTH) bottom = row;
    }
    memory_free(pixels);
    page_destroy(&page);
    return bottom;
}

TEST(takes_its_lines_from_the_frame)
{
    Error err = {0};
    double x[2] = {0.1, 0.9}, y[2] = {0.2, 0.8};
    Plot *plot = NEW_ARRAY(Plot, 1, &err);
    assert_non_null(plot);
    plot->main = (PlotPanel){.x = {.high = 1, .factor = 1}, .y = {.high = 1, .factor = 1}};
    for (int32_t k = 0; k < 3; k++)
        plot->main.series[k] = (PlotSeries){.count = 2, .x = x, .y = y, .line = LINE_THIN};
    plot->main.series_count = 3;
    int32_t whole = frame_bottom(plot);   // no series has a label

    snprintf(plot->main.series[0].label, PLOT_LABEL_SIZE, "a curve");
    int32_t one = frame_bottom(plot);
    assert_true(one < whole - 20 && one > whole - 60);   // 7 to 8 points, 3.53 pixels each
    snprintf(plot->main.series[1].label, PLOT_LABEL_SIZE, "another");
    assert_int_equal(frame_bottom(plot), one);
    memset(plot->main.series[2].label, 'm', 30);   // wider than what is left of the line
    assert_true(abs(whole - frame_bottom(plot) - 2 * (whole - one)) <= 1);

    // Lines that leave no frame are refused: a map would have no pixels to be in.
    Page page = {0};
    for (int32_t k = 0; k < PLOT_SERIES_MAX; k++) plot->main.series[k] = plot->main.series[2];
    plot->main.series_count = PLOT_SERIES_MAX;
    assert_false(plot_draw(&page, plot, &(PictureStyle){.height = 40}, NULL, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    page_destroy(&page);
    plot->no_legend = true;
    assert_int_equal(frame_bottom(plot), whole);
    memory_free(plot);
}
