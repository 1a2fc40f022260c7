// SPDX-License-Identifier: GPL-2.0-or-later
// Where legends go: curves that leave one corner free, or none; on the picture, an outer legend
// stands beside the frame. What a legend hides is checked by walking along the curves.
#include "render/plot/legend.h"

#include "near.h"
#include "render/plot/plot_draw.h"

#include "base/memory.h"
#include "canvas_read.h"

#include <string.h>

static const LegendSize SIZE = {.width = 30, .height = 20, .margin = 4, .clearance = 2, .mark = 3};

// Data from 0 to 1 on both axes, 100 pixels each: a hundredth is a pixel.
static const Axes AXES = {.box = {.left = 10, .top = 20, .right = 110, .bottom = 120},
                          .x = {.high = 1, .factor = 1},
                          .y = {.high = 1, .factor = 1}};

// One polyline through the corners in turn; `gap` of it is left out (-1: none). Corners go round
// from the upper right one as in PlotCorner, each two tenths away from the frame's own.
static PlotPanel panel_without(int32_t gap, double x[5], double y[5])
{
    static const double across[4] = {0.9, 0.1, 0.1, 0.9}, up[4] = {0.9, 0.9, 0.1, 0.1};
    PlotPanel panel = {.series_count = 1};
    int32_t count = 0;
    for (int32_t k = 1; k <= 4; k++) {   // begins behind the gap: no segment crosses it
        int32_t corner = (gap + k + 4) % 4;
        if (corner == gap) continue;
        x[count] = across[corner];
        y[count++] = up[corner];
    }
    panel.series[0] = (PlotSeries){.count = count, .x = x, .y = y, .line = LINE_THIN};
    return panel;
}

// Length below the box, by small steps along the line; for lines without gaps.
static double walked(const PlotSeries *series, const Box *box)
{
    enum { STEPS = 20000 };
    double length = 0, near = SIZE.clearance;
    for (int32_t k = 1; k < series->count; k++) {
        Point a = axes_place(&AXES, series->x[k - 1], series->y[k - 1]);
        Point b = axes_place(&AXES, series->x[k], series->y[k]);
        for (int32_t s = 0; s < STEPS; s++) {
            double part = (s + 0.5) / STEPS, X = a.x + part * (b.x - a.x);
            double Y = a.y + part * (b.y - a.y);
            bool below = X > box->left - near && X < box->right + near && Y > box->top - near &&
                         Y < box->bottom + near;
            if (below) length += hypot(b.x - a.x, b.y - a.y) / STEPS;
        }
    }
    return length;
}

TEST(the_free_corner_is_taken)
{
    double x[5], y[5];
    for (int32_t free = 0; free < 4; free++) {
        PlotPanel panel = panel_without(free, x, y);
        assert_int_equal(legend_choose(&panel, &AXES, &SIZE, NULL), CORNER_UPPER_RIGHT + free);
        for (int32_t corner = 0; corner < 4; corner++) {
            Box box = legend_box(&AXES, &SIZE, (PlotCorner)(CORNER_UPPER_RIGHT + corner));
            double hidden = legend_hides(&panel, &AXES, &SIZE, &box);
            assert_near("hidden", hidden, walked(&panel.series[0], &box), 0.02);
            assert_true((hidden > 0) == (corner != free));
            assert_true(box.left >= 10 && box.right <= 110 && box.top >= 20 && box.bottom <= 120);
        }
    }
}

// A curve through all four corners; a legend that would leave the frame little of its width
// outside goes where it hides least: here the upper left corner, crossed by nothing but the line
// along the top.
TEST(no_corner_is_free)
{
    double x[5] = {0.1, 0.9, 0.9, 0.1}, y[5] = {0.9, 0.9, 0.1, 0.1};
    PlotPanel panel = {.series_count = 1};
    panel.series[0] = (PlotSeries){.count = 4, .x = x, .y = y, .line = LINE_SOLID};
    assert_int_equal(legend_choose(&panel, &AXES, &SIZE, NULL), CORNER_OUTSIDE);
    Box box = legend_box(&AXES, &SIZE, CORNER_OUTSIDE);
    assert_true(box.left == 114 && box.top == 24);
    LegendSize wide = SIZE;
    wide.width = 60;
    assert_int_equal(legend_choose(&panel, &AXES, &wide, NULL), CORNER_UPPER_LEFT);
}

// Marks and error bars count as lines do, a line that is not drawn and a gap do not; an inset is
// left alone.
TEST(all_that_is_drawn_counts)
{
    double x[2] = {0.9, 0.5}, y[2] = {0.9, 0.5}, low[2] = {0.02, 0.4}, high[2] = {0.95, 0.6};
    PlotPanel panel = {.series_count = 1};
    PlotSeries *series = &panel.series[0];
    *series = (PlotSeries){.count = 2, .x = x, .y = y, .line = LINE_NONE};
    Box corner = legend_box(&AXES, &SIZE, CORNER_UPPER_RIGHT);
    assert_true(legend_hides(&panel, &AXES, &SIZE, &corner) == 0);
    series->marker = MARKER_CIRCLE;
    assert_true(legend_hides(&panel, &AXES, &SIZE, &corner) == 6);
    assert_int_equal(legend_choose(&panel, &AXES, &SIZE, NULL), CORNER_UPPER_LEFT);
    Box inset = {.left = 15, .top = 20, .right = 50, .bottom = 60};
    assert_int_equal(legend_choose(&panel, &AXES, &SIZE, &inset), CORNER_LOWER_LEFT);
    series->marker = MARKER_NONE;
    series->low = low;
    series->high = high;
    assert_near("bar", legend_hides(&panel, &AXES, &SIZE, &corner), 21, 1e-9);   // 0.95 to 0.74
    corner = legend_box(&AXES, &SIZE, CORNER_LOWER_RIGHT);
    assert_true(legend_hides(&panel, &AXES, &SIZE, &corner) > 0);
    series->low = NULL;
    series->line = LINE_THIN;
    y[1] = NAN;
    corner = legend_box(&AXES, &SIZE, CORNER_UPPER_RIGHT);
    assert_true(legend_hides(&panel, &AXES, &SIZE, &corner) == 0);
}

// The frame's right side: the last column of pixels with ink over half of the picture's height.
static int32_t frame_right(Plot *plot)
{
    Error err = {0};
    enum { WIDTH = 860, HEIGHT = 645 };
    const PictureStyle style = {.dpi = 254};   // 10 pixels a millimetre
    Page page = {0};
    uint8_t *pixels = NULL;
    int32_t right = -1;
    plot->height_over_width = (double)HEIGHT / WIDTH;
    assert_true(plot_draw(&page, plot, &style, NULL, &err));
    assert_true(canvas_read(page.canvas, &pixels, &err));
    for (int32_t column = 0; column < WIDTH; column++) {
        int32_t dark = 0;
        for (int32_t row = 0; row < HEIGHT; row++) dark += pixels[3 * (row * WIDTH + column)] < 128;
        if (dark > HEIGHT / 2) right = column;
    }
    memory_free(pixels);
    page_destroy(&page);
    return right;
}

// A legend beside the frame takes its width from it, one in a corner nothing.
TEST(an_outer_legend_narrows_the_frame)
{
    Error err = {0};
    double x[5] = {0.05, 0.95, 0.95, 0.05, 0.05}, y[5] = {0.95, 0.95, 0.05, 0.05, 0.95};
    Plot *plot = NEW_ARRAY(Plot, 1, &err);
    assert_non_null(plot);
    plot->main = (PlotPanel){.x = AXES.x, .y = AXES.y, .series_count = 1};
    plot->main.series[0] = (PlotSeries){.label = "a curve", .count = 5, .x = x, .y = y};
    plot->main.series[0].line = LINE_THIN;
    plot->main.legend = CORNER_NONE;
    int32_t whole = frame_right(plot);
    plot->main.legend = CORNER_UPPER_LEFT;
    assert_int_equal(frame_right(plot), whole);
    plot->main.legend = CORNER_OUTSIDE;
    int32_t beside = frame_right(plot);
    assert_true(beside < whole - 80 && beside > whole / 2);
    plot->main.legend = CORNER_AUTO;
    assert_int_equal(frame_right(plot), beside);
    plot->main.series[0].count = 2;   // along the top alone
    assert_int_equal(frame_right(plot), whole);
    memory_free(plot);
}

// A legend that leaves the frame no width is refused, where a map would have no pixels to be in.
TEST(an_outer_legend_leaves_a_frame)
{
    Error err = {0};
    double x[4] = {1, 2, 1, 2}, y[4] = {1, 1, 2, 2}, value[4] = {1, 2, 3, 4};
    const PictureStyle style = {.dpi = 254};
    Page page = {0};
    Plot *plot = NEW_ARRAY(Plot, 1, &err);
    assert_non_null(plot);
    *plot = (Plot){.height_over_width = 0.75, .color = {.low = 1, .high = 4, .factor = 1}};
    plot->main = (PlotPanel){.x = {.high = 3, .factor = 1}, .y = {.high = 3, .factor = 1}};
    plot->main.has_map = true;
    plot->main.map = (PlotMap){.count = 4, .x = x, .y = y, .value = value};
    plot->main.series_count = 1;
    plot->main.series[0] = (PlotSeries){.count = 1, .x = x, .y = y};
    memset(plot->main.series[0].label, 'm', PLOT_LABEL_SIZE - 1);
    plot->main.legend = CORNER_OUTSIDE;
    assert_false(plot_draw(&page, plot, &style, NULL, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    page_destroy(&page);
    memory_free(plot);
}
