// SPDX-License-Identifier: GPL-2.0-or-later
// Shapes, text and heat maps, counted in the pixels that are read back; and the files.
#include "render/canvas/canvas.h"

#include "base/memory.h"
#include "canvas_read.h"
#include "cases.h"
#include "render/canvas/drawing.h"
#include "render/canvas/text.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { SIZE = 400 };

static const Color BLACK = {0, 0, 0, 1};
static Canvas *canvas;

FIXTURE(canvas_begin)
{
    const CanvasDef def = {.width = SIZE, .height = SIZE, .dpi = 200};
    Error err = {0};
    canvas = canvas_create(&def, &err);
    return canvas ? 0 : -1;
}

FIXTURE(canvas_end)
{
    canvas_destroy(canvas);
    canvas = NULL;
    return 0;
}

static uint8_t *pixels_read(void)
{
    Error err = {0};
    uint8_t *pixels = NULL;
    assert_true(canvas_read(canvas, &pixels, &err));
    return pixels;
}

// How much black is on the page, in pixels.
static double area_read(void)
{
    uint8_t *pixels = pixels_read();
    double area = 0;
    for (int32_t k = 0; k < SIZE * SIZE; ++k) area += 1 - pixels[3 * k] / 255.0;
    memory_free(pixels);
    return area;
}

TEST_BETWEEN(a_new_page_is_white, canvas_begin, canvas_end)
{
    assert_float_equal(area_read(), 0, 0);
}

TEST_BETWEEN(areas_are_right, canvas_begin, canvas_end)
{
    draw_fill(canvas, BLACK, &(Box){10, 20, 60, 50});
    assert_float_equal(area_read(), 1500, 1e-9);
    draw_disc(canvas, BLACK, (Point){200, 200}, 40);
    assert_float_equal(area_read(), 1500 + 5027.0F, 50);
    Stroke stroke = {.color = BLACK, .width = 4};
    draw_segment(canvas, &stroke, (Point){300, 50}, (Point){380, 110});   // 100 long
    assert_float_equal(area_read(), 1500 + 5027.0F + 400, 55);   // the disc has sides
}

TEST_BETWEEN(rows_count_from_the_top, canvas_begin, canvas_end)
{
    draw_fill(canvas, BLACK, &(Box){10, 20, 11, 21});
    uint8_t *pixels = pixels_read();
    assert_int_equal(pixels[3 * (20 * SIZE + 10)], 0);
    assert_int_equal(pixels[3 * (21 * SIZE + 10)], 255);
    memory_free(pixels);
}

TEST_BETWEEN(dashes_leave_gaps, canvas_begin, canvas_end)
{
    Stroke stroke = {.color = BLACK, .width = 2, .dash = 12, .space = 8};
    const Point line[3] = {{50, 100}, {150, 100}, {150, 200}};   // 200 long: ten periods
    draw_line(canvas, &stroke, line, 3);
    assert_float_equal(area_read(), 200 * 2 * 0.6, 6);
}

// A damaged file may ask for a hatch that is 1e12 pixels wide.
TEST_BETWEEN(a_hatch_ends_with_the_page, canvas_begin, canvas_end)
{
    Stroke stroke = {.color = BLACK, .width = 1};
    draw_hatch(canvas, &stroke, &(Box){-1e12, -1e12, 1e12, 1e12}, 10);
    assert_float_equal(area_read(), 0.1414F * SIZE * SIZE, 0.05F * SIZE * SIZE);
}

TEST_BETWEEN(broken_points_break_lines, canvas_begin, canvas_end)
{
    Stroke stroke = {.color = BLACK, .width = 2};
    const Point line[5] = {{50, 100}, {100, 100}, {NAN, 100}, {200, 100}, {250, INFINITY}};
    draw_line(canvas, &stroke, line, 5);
    assert_float_equal(area_read(), 106, 3);
}

TEST_BETWEEN(clips_hold, canvas_begin, canvas_end)
{
    canvas_clip(canvas, &(Box){0, 0, SIZE, 100});
    draw_fill(canvas, BLACK, &(Box){0, 90, 50, 200});
    canvas_clip(canvas, NULL);
    draw_fill(canvas, BLACK, &(Box){100, 90, 110, 200});
    assert_float_equal(area_read(), 500 + 1100, 1e-9);
}

// A line that is stroked in pieces, with a dash that is not.
TEST_BETWEEN(long_lines_are_whole, canvas_begin, canvas_end)
{
    enum { COUNT = 1500 };
    Point line[COUNT];
    Stroke stroke = {.color = BLACK, .width = 2};
    for (int32_t k = 0; k < COUNT; ++k) line[k] = (Point){20 + k * 0.2, 100};
    draw_line(canvas, &stroke, line, COUNT);
    double solid = 2 * (COUNT - 1) * 0.2;
    assert_true(fabs(area_read() - solid - 3.14) < 2);
    stroke.dash = stroke.space = 10;
    for (int32_t k = 0; k < COUNT; ++k) line[k].y = 200;
    draw_line(canvas, &stroke, line, COUNT);
    assert_true(fabs(area_read() - 1.5 * solid - 3.14) < 12);
}

// Red of the colour map's k-th entry.
static int32_t map_red(int32_t k)
{
    uint8_t map[3 * MAP_SIZE];
    color_map_fill(map);
    return map[3 * k];
}

TEST_BETWEEN(heat_shows_levels_and_holes, canvas_begin, canvas_end)
{
    const float values[6] = {0, 1, 5, HEAT_BELOW, HEAT_MISSING, 0.5f};   // two rows of three
    const int32_t expected[6] = {map_red(0), map_red(255),    map_red(255),
                                 77,         255 /* white */, map_red(128)};
    canvas_set_below(canvas, (Color){77 / 255.0f, 0, 0, 1});
    canvas_heat(canvas, &(Box){100, 100, 160, 140}, &(HeatMap){3, 2, values});
    uint8_t *pixels = pixels_read();
    for (int32_t k = 0; k < 6; ++k) {
        int32_t column = 110 + 20 * (k % 3), row = 110 + 20 * (k / 3);
        assert_int_equal(pixels[3 * (row * SIZE + column)], expected[k]);
    }
    assert_int_equal(pixels[3 * (99 * SIZE + 110)], 255);
    memory_free(pixels);
}

// Every level is the table's, the nearest one; NaN is a hole.
TEST_BETWEEN(heat_is_exact, canvas_begin, canvas_end)
{
    enum { COUNT = 100 };
    float values[COUNT];
    for (int32_t k = 0; k < COUNT; ++k) values[k] = (float)k / 99;
    values[7] = NAN;
    canvas_heat(canvas, &(Box){20, 30, 20 + COUNT, 31}, &(HeatMap){COUNT, 1, values});
    uint8_t *pixels = pixels_read();
    for (int32_t k = 0; k < COUNT; ++k)
        assert_int_equal(pixels[3 * (30 * SIZE + 20 + k)],
                         k == 7 ? 255 : map_red((int32_t)lround(255.0 * k / 99)));
    memory_free(pixels);
}

TEST_BETWEEN(a_heat_map_too_large_is_reported, canvas_begin, canvas_end)
{
    Error err = {0};
    uint8_t *pixels = NULL;
    const float value = 0;
    canvas_heat(canvas, &(Box){0, 0, 9, 9}, &(HeatMap){1 << 28, 1, &value});
    assert_false(canvas_read(canvas, &pixels, &err));
    assert_null(pixels);
    assert_int_equal(err.code, ERROR_LIBRARY);
}

// --- text ----------------------------------------------------------------------------------------
static Text *text_begin(void)
{
    Error err = {0};
    Text *text = text_create(canvas, &err);
    assert_non_null(text);
    return text;
}

TEST_BETWEEN(text_has_width_and_ink, canvas_begin, canvas_end)
{
    Text *text = text_begin();
    TextStyle style = {.size = 40, .color = BLACK};
    assert_true(text_width(text, 40, "") == 0);
    double digit = text_width(text, 40, "0");
    assert_true(fabs(digit - 0.636 * 40) < 0.1);   // DejaVu Sans: digits are 1303 / 2048 wide
    assert_true(fabs(text_width(text, 40, "0123456789") - 10 * digit) < 1e-9);
    assert_true(fabs(text_width(text, 40, "~{0}") - digit) < 1e-9);
    assert_true(fabs(text_width(text, 40, "0_{0}^{0}") / digit - 2.4) < 1e-2);
    text_draw(text, &style, (Point){50, 100}, "~{F}_{T} / ~{F}_{N} \u03bc \u00d710^{-3}");
    assert_true(area_read() > 1000);
    text_destroy(text);
}

// A bar is as black upright as it is rising, and stands where it is put.
TEST_BETWEEN(text_turns_and_aligns, canvas_begin, canvas_end)
{
    Text *text = text_begin();
    TextStyle style = {.size = 100, .color = BLACK, .across = 0.5, .up = 0.5};
    text_draw(text, &style, (Point){100, 100}, "0");
    double upright = area_read();
    uint8_t *pixels = pixels_read();
    double x = 0, y = 0;
    for (int32_t k = 0; k < SIZE * SIZE; ++k) {
        x += (1 - pixels[3 * k] / 255.0) * (k % SIZE + 0.5) / upright;
        y += (1 - pixels[3 * k] / 255.0) * (k / SIZE + 0.5) / upright;
    }
    memory_free(pixels);
    assert_true(fabs(x - 100) < 1.5);
    assert_true(fabs(y - 100) < 1.5);
    style.rising = true;
    text_draw(text, &style, (Point){300, 300}, "0");
    assert_true(fabs(area_read() / upright - 2) < 2e-3);
    text_destroy(text);
}

// A letter leaves no point behind from which the next shape would begin.
TEST_BETWEEN(shapes_after_text_are_right, canvas_begin, canvas_end)
{
    const Point corners[] = {{300, 300}, {320, 300}, {320, 320}, {300, 320}};
    Text *text = text_begin();
    TextStyle style = {.size = 40, .color = BLACK};
    text_draw(text, &style, (Point){20, 50}, "0");
    double letter = area_read();
    draw_polygon(canvas, BLACK, corners, 4);
    assert_float_equal(area_read(), letter + 400, 1e-9);
    text_draw(text, &style, (Point){20, 100}, "0");
    double before = area_read();
    draw_disc(canvas, BLACK, (Point){200, 200}, 40);
    assert_float_equal(area_read(), before + 5027, 50);
    text_destroy(text);
}

// Broken UTF-8 and braces draw something and end.
TEST_BETWEEN(odd_words_do_no_harm, canvas_begin, canvas_end)
{
    static const char *const odd[] = {"\xff\xfe", "\xe2\x82",          "\xc3", "_{",
                                      "}",        "^{_{~{^{_{x}}}}}}", "_x",   "\xf0\x9f\x98\x80"};
    Text *text = text_begin();
    TextStyle style = {.size = 20, .color = BLACK};
    for (size_t k = 0; k < sizeof odd / sizeof *odd; ++k)
        text_draw(text, &style, (Point){20, 20 + 30 * (double)k}, odd[k]);
    assert_true(area_read() > 0);
    text_destroy(text);
}

TEST_BETWEEN(sizes_have_limits, canvas_begin, canvas_end)
{
    Error err = {0};
    CanvasDef def = {.width = CANVAS_SIZE_MIN - 1, .height = 300, .dpi = 100};
    assert_null(canvas_create(&def, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    error_clear(&err);
    def = (CanvasDef){.width = 300, .height = CANVAS_SIZE_MAX + 1, .dpi = 100};
    assert_null(canvas_create(&def, &err));
    assert_int_equal(err.code, ERROR_INPUT);
}

// White paper becomes dark, ink light, and a hue stays the same.
TEST(dark_paper_is_inverted_and_keeps_hue)
{
    Color paper = color_on_dark((Color){1, 1, 1, 1}), ink = color_on_dark((Color){0, 0, 0, 0.5F});
    Color red = color_on_dark((Color){0.6F, 0.1F, 0.1F, 1});
    assert_true(paper.red < 0.12F && fabsf(paper.red - paper.blue) < 0.01F);
    assert_true(ink.red > 0.9F && ink.alpha == 0.5F);
    assert_true(red.red > 0.9F && red.green < 0.8F && red.blue < 0.8F);
}

// Memory that runs out while a picture is made is an error, and none is lost. The bytes of a file
// stand in memory of libc, which does not run out here.
TEST(pictures_run_out_of_memory)
{
    const CanvasFormat formats[] = {CANVAS_PNG, CANVAS_PDF, CANVAS_SVG};
    for (int32_t f = 0; f < 3; ++f) {
        const CanvasDef def = {.format = formats[f], .width = 300, .height = 300, .dpi = 100};
        int64_t live = memory_counters().live, k = 0;
        bool done = false;
        for (; !done; ++k) {
            char path[] = "/tmp/amontons_canvas_XXXXXX";
            Error err = {0};
            close(mkstemp(path));
            memory_fail_after(k);
            Canvas *page = canvas_create(&def, &err);
            if (page) draw_disc(page, BLACK, (Point){100, 100}, 50);
            done = page && canvas_write(page, path, "a disc", false, &err);
            memory_fail_after(-1);
            canvas_destroy(page);
            unlink(path);
            assert_int_equal(memory_counters().live, live);
            assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        }
        assert_in_range(k, 2, 100);
    }
}
