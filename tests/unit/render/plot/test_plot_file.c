// SPDX-License-Identifier: GPL-2.0-or-later
// Plots read from files: what they hold, what is wrong where; drawn with memory running out.
#include "render/plot/plot_file.h"

#include "base/memory.h"
#include "canvas_read.h"
#include "cases.h"
#include "render/plot/plot_draw.h"
#include "render/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char path[] = "/tmp/amontons_plot_XXXXXX.yaml", png[40];

static const char WHOLE[] =
    "title: whole\nheight: 0.5\nx: {label: P, scale: log, range: [1e-3, 1]}\ny: {label: mu}\n"
    "legend: none\nseries:\n"
    "  - {label: one, x: [1e-3, 0.1, 1], y: [1, null, 3], low: [0.5, 1, 2], high: [1.5, 3, 4],\n"
    "     color: 2, marker: triangle, filled: false, line: dashed}\n"
    "  - {x: [0.01, 0.1], y: [2, 2], line: none, marker: down}\n"
    "inset: {place: [0.5, 0.1, 0.9, 0.6], series: [{x: [0, 2], y: [5, 5]}]}\n"
    "page: {style: slide, height: 60, limits: '1%,2'}\n";

static const char PANELS[] =
    "x: {label: x, scale: log}\ny: {label: y, unit: Pa}\ncolor: {label: c}\ncontours: {label: l}\n"
    "series: [{label: none, x: [1], y: [null], marker: cross, line: none}]\npanels:\n"
    "  - title: grid\n"
    "    map: {x: [1, 10, 1, 10], y: [0, 0, 1, 1], value: [0, 1, null, 3], contour: [1, 2, 3, 4],\n"
    "          open: [1, 0, 0, 0]}\n"
    "  - {title: apart, map: {x: [1, 5, 10, 4, 2], y: [0, 1, 0.5, 0.6, 0.3], value: [1, 2, 3, 0, "
    "1]}}\n"
    "  - {title: curve, series: [{x: [1, 10], y: [0, 1]}]}\n";

static void write_plot(const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static Plot *plot_make(void)
{
    Error err = {0};
    return NEW_ARRAY(Plot, 1, &err);
}

TEST(holds_what_the_file_says)
{
    Error err = {0};
    Plot *plot = plot_make();
    write_plot(WHOLE);
    if (!plot_file_read(path, plot, &err)) fail_msg("%s", err.message);
    assert_string_equal(plot->title, "whole");
    assert_true(plot->height_over_width == 0.5);
    assert_string_equal(plot->style.style, "slide");
    assert_true(plot->style.height == 60 && !plot->style.legend);
    assert_true(plot->main.x.is_log && plot->main.x.low == 1e-3 && plot->main.x.high == 1);
    assert_true(plot->no_legend);
    assert_int_equal(plot->main.series_count, 2);
    const PlotSeries *one = &plot->main.series[0];
    assert_int_equal(one->count, 3);
    assert_true(one->x[1] == 0.1 && isnan(one->y[1]) && one->high[2] == 4 && one->low[0] == 0.5);
    assert_int_equal(one->color, 2);
    assert_int_equal(one->marker, MARKER_TRIANGLE);
    assert_int_equal(one->line, LINE_DASHED);
    assert_false(one->filled);
    const PlotSeries *two = &plot->main.series[1];
    assert_true(two->filled && !two->low && two->line == LINE_NONE && !two->label[0]);
    // The ends of y: the bars' ends and a twentieth more; of an inset with one value: around it.
    assert_true(fabs(plot->main.y.low - (0.5 - 0.05 * 3.5)) < 1e-12);
    assert_true(fabs(plot->main.y.high - (4 + 0.05 * 3.5)) < 1e-12);
    assert_true(plot->has_inset && plot->inset.y.low < 5 && plot->inset.y.high > 5);
    plot_destroy(plot);
    memory_free(plot);
}

// Where y has names its ends follow from them, and error bars lie along x.
TEST(names_stand_beside_y)
{
    Error err = {0};
    Plot *plot = plot_make();
    write_plot("y: {names: [worst, best]}\n"
               "series: [{x: [2, 4], y: [1, 2], low: [1, 4], high: [3, 11]}]\n");
    if (!plot_file_read(path, plot, &err)) fail_msg("%s", err.message);
    assert_int_equal(plot->main.y.name_count, 2);
    assert_string_equal(plot->main.y.names[1], "best");
    assert_true(plot->main.y.low == 0.5 && plot->main.y.high == 2.5);
    assert_true(fabs(plot->main.x.low - 0.5) < 1e-12 && fabs(plot->main.x.high - 11.5) < 1e-12);
    if (!amontons_render_plot(path, png, NULL, &err)) fail_msg("%s", err.message);
    plot_destroy(plot);
    memory_free(plot);
}

TEST(says_what_is_wrong)
{
    static const struct {
        const char *text, *message;
    } known[] = {
        {"colour: 3\n", "unknown key `colour`"},
        {"title: a\n", "a plot needs `series`"},
        {"series: 3\n", "series: found `3`"},
        {"series: [{x: [1]}]\n", "a series needs its `x` and its `y`"},
        {"series: [{x: [1, 2], y: [1]}]\n", ":1:25: y: found a list of 1; allowed: a list of 2"},
        {"series: [{x: [1, a], y: [1, 2]}]\n", ":1:18: x: found `a`; allowed: a number"},
        {"series: [{x: [1], y: [1], marker: star}]\n",
         "marker: found `star`; allowed: none, circle"},
        {"series: [{x: [1], y: [1], color: 9}]\n", "color: found `9`"},
        {"series: [{x: [1], y: [1], lable: z}]\n", "unknown key `lable`"},
        {"x: {range: [2, 1]}\nseries: []\n", "range: found a list"},
        {"x: {scale: log, range: [0, 1]}\nseries: []\n", "above 0"},
        {"height: 9\nseries: []\n", "height: found `9`"},
        {"series: []\ninset: {series: []}\n", "an inset needs its `place`"},
        {"series: []\ninset: {place: [0.5, 0, 0.4, 1], series: []}\n", "place: found a list"},
        {"[1]\n", "plot: found a list"},
        {"legend: left\nseries: []\n", "legend: found `left`; allowed: below, none"},
        {"y: {names: 3}\nseries: []\n", "names: found `3`; allowed: a list"},
        {"x: {names: [a]}\nseries: []\n", "x: unknown key `names`"},
        {"map: {x: [1], y: [1]}\n", "a map needs its `x`, `y` and `value`"},
        {"map: {x: [1], y: [1], value: [1, 2]}\n",
         "value: found a list of 2; allowed: a list of 1"},
        {"map: {x: none.h5:x, y: [1], value: [1]}\n", "none.h5"},
        {"series: []\npage: {height: 1}\n", ":2:16: page: height 1: a number from 20 to 1000"},
        {"series: []\npage: {hight: 1}\n", "a picture has no option \"hight\""},
        {"series: []\npage: wide\n", "page: found `wide`"},
        {"panels: []\n", "panels: found"},
        {"panels: [{legend: none}]\n", "panels: unknown key `legend`"},
    };
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        Error err = {0};
        Plot *plot = plot_make();
        write_plot(known[k].text);
        assert_false(plot_file_read(path, plot, &err));
        assert_true(err.code == ERROR_INPUT || err.code == ERROR_FILE);
        if (!strstr(err.message, known[k].message))
            fail_msg("%s: \"%s\" lacks \"%s\"", known[k].text, err.message, known[k].message);
        plot_destroy(plot);
        memory_free(plot);
    }
}

// Values 0, 1/3, 1 and none at the corners of a square: each colour of the map covers a quarter of
// the frame, the fourth quarter is paper; the logarithmic axis ends half a decade beyond.
TEST(map_shows_its_values)
{
    Error err = {0};
    Plot *plot = plot_make();
    Page page = {0};
    PictureStyle style = {0};
    uint8_t colors[3 * MAP_SIZE], *pixels = NULL;
    int64_t seen[3] = {0};
    const int32_t entry[3] = {0, 85, 255};
    write_plot("x: {scale: log}\ncolor: {range: [0, 1]}\nlegend: none\n"
               "map: {x: [1, 10, 1, 10], y: [0, 0, 1, 1], value: [0, 0.3333333333, 1, null]}\n");
    if (!plot_file_read(path, plot, &err)) fail_msg("%s", err.message);
    assert_true(fabs(log10(plot->main.x.low) + 0.5) < 1e-9);
    assert_true(fabs(plot->main.y.high - 1.5) < 1e-9);
    assert_true(plot_draw(&page, plot, &style, NULL, &err));
    assert_true(canvas_read(page.canvas, &pixels, &err));
    color_map_fill(colors);
    int32_t width = canvas_width(page.canvas), height = canvas_height(page.canvas);
    for (int32_t k = 0; k < width * height; k++)
        for (int32_t i = 0; i < 3; i++) {
            // The bar right of the frame has these colours, too: a hundredth of the page.
            seen[i] += memcmp(pixels + 3 * (int64_t)k, colors + 3 * entry[i], 3) == 0;
        }
    for (int32_t i = 0; i < 3; i++) {
        assert_true((double)seen[i] > 0.1 * width * height);
        assert_true(fabs((double)seen[i] / (double)seen[0] - 1) < 0.02);
    }
    memory_free(pixels);
    page_destroy(&page);
    plot_destroy(plot);
    memory_free(plot);
}

static void draw_and_free_all(const char *text)
{
    Error err = {0};
    const PictureStyle small = {.width = 100, .dpi = 150, .overwrite = true};
    int64_t live = memory_counters().live, k = 0;
    write_plot(text);
    if (!amontons_render_plot(path, png, &small, &err)) fail_msg("%s", err.message);
    assert_int_equal(access(png, F_OK), 0);
    assert_int_equal(memory_counters().live, live);
    for (bool done = false; !done; k++) {
        err = (Error){0};
        memory_fail_after(k);
        done = amontons_render_plot(path, png, &small, &err);
        memory_fail_after(-1);
        assert_true(done || err.code == ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 2000);
    }
    assert_true(k > 20);
}

FIXTURE(file_make)
{
    int descriptor = mkstemps(path, 5);
    snprintf(png, sizeof png, "%.27s.png", path);
    return descriptor < 0 ? -1 : 0;
}

FIXTURE(file_remove)
{
    return remove(path) || remove(png) ? -1 : 0;
}

TEST(draws_and_frees_a_whole_plot)
{
    draw_and_free_all(WHOLE);
}

// Lines at equal values are sought between the points of a grid: others are drawn without.
TEST(no_contours_without_a_grid)
{
    enum { SIZE = 1 << 20 };
    static char drawn[2][SIZE];
    size_t length[2];
    for (int32_t k = 0; k < 2; k++) {
        Error err = {0};
        write_plot(k ? "map: {x: [1, 2, 3], y: [1, 2, 3], value: [1, 2, 3]}\n"
                     : "map: {x: [1, 2, 3], y: [1, 2, 3], value: [1, 2, 3], contour: [1, 2, 3]}\n");
        if (!amontons_render_plot(path, png, &(PictureStyle){.overwrite = true}, &err))
            fail_msg("%s", err.message);
        FILE *file = fopen(png, "rb");
        assert_non_null(file);
        length[k] = fread(drawn[k], 1, SIZE, file);
        fclose(file);
    }
    assert_true(length[0] > 1000 && length[0] < SIZE && length[0] == length[1]);
    assert_memory_equal(drawn[0], drawn[1], length[0]);
}

TEST(draws_and_frees_panels)
{
    draw_and_free_all(PANELS);
}

GROUP_BETWEEN(file_make, file_remove);
