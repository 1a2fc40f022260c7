// SPDX-License-Identifier: GPL-2.0-or-later
// Lines before, on and behind a square in space that OpenGL draws: what of them is on the page.
#include "render/figures/surface_draw.h"

#include "base/memory.h"
#include "canvas_read.h"
#include "cases.h"

#include <stdlib.h>

enum { SIZE = 300, LEFT = 40, TOP = 30, WIDTH = 200, HEIGHT = 150, BLACK_MOST = 60 };
enum { FROM = 50, TO = 120, ABOVE = 20, BELOW = 100 };   // the square in its box, pixels

// Which pixels from the left edge of the box to its right one are black after a line of these
// depths at the ends was drawn in row `y` of the box, over a square of depth 0.5.
static void draw(double y, double first, double last, bool black[WIDTH])
{
    static const Color ink = {0, 0, 0, 1};
    static const GlCorner square[6] = {{FROM, ABOVE, 0, 0.5F}, {TO, ABOVE, 0, 0.5F},
                                       {TO, BELOW, 0, 0.5F},   {FROM, ABOVE, 0, 0.5F},
                                       {TO, BELOW, 0, 0.5F},   {FROM, BELOW, 0, 0.5F}};
    const CanvasDef def = {.width = SIZE, .height = SIZE, .dpi = 200};
    const Stroke stroke = {.color = ink, .width = 2};
    DepthImage image = {.box = {LEFT, TOP, LEFT + WIDTH, TOP + HEIGHT},
                        .columns = WIDTH,
                        .rows = HEIGHT,
                        .slack = 0.01};
    const DepthPoint ends[2] = {{{LEFT, TOP + y}, first}, {{LEFT + WIDTH, TOP + y}, last}};
    Error err = {0};
    uint8_t *pixels = NULL;
    Canvas *canvas = canvas_create(&def, &err);
    assert_non_null(canvas);
    assert_non_null(image.depth = NEW_ARRAY(float, WIDTH *HEIGHT, &err));
    canvas_heat_triangles(canvas, &image.box, square, 6, image.depth);
    depth_image_line(&image, canvas, &stroke, ends);
    assert_true(canvas_read(canvas, &pixels, &err));
    for (int32_t k = 0; k < WIDTH; ++k)
        black[k] = pixels[3 * ((TOP + (int32_t)y) * SIZE + LEFT + k)] < BLACK_MOST;
    memory_free_all(pixels, image.depth);
    canvas_destroy(canvas);
}

// Everything but the pixels from `first` to before `last` is black, up to `off` pixels.
static void check_hidden(const bool black[WIDTH], int32_t first, int32_t last, int32_t off)
{
    for (int32_t k = 0; k < WIDTH; ++k)
        if (abs(k - first) > off && abs(k - last) > off)
            assert_int_equal(black[k], k < first || k >= last);
}

TEST(a_line_behind_is_hidden)
{
    bool black[WIDTH];
    draw(60, 0.8, 0.8, black);
    check_hidden(black, FROM, TO, 3);
    draw(BELOW + 10, 0.8, 0.8, black);   // below the square
    check_hidden(black, 0, 0, 0);
    draw(ABOVE - 10, 0.8, 0.8, black);
    check_hidden(black, 0, 0, 0);
}

TEST(a_line_before_or_on_it_is_drawn)
{
    bool black[WIDTH];
    draw(60, 0.2, 0.2, black);
    check_hidden(black, 0, 0, 0);
    draw(60, 0.505, 0.505, black);
    check_hidden(black, 0, 0, 0);
    draw(60, 0.515, 0.515, black);
    check_hidden(black, FROM, TO, 3);
    draw(BELOW - 0.1, 0.8, 0.8, black);   // on its edge
    check_hidden(black, 0, 0, 0);
}

// Depth 0.3 + 0.5 x / 200 is 0.51 at x = 84.
TEST(a_line_that_goes_through_ends_there)
{
    bool black[WIDTH];
    draw(60, 0.3, 0.8, black);
    check_hidden(black, 84, TO, 3);
    draw(60, 0.8, 0.3, black);
    check_hidden(black, FROM, WIDTH - 84, 3);
}
