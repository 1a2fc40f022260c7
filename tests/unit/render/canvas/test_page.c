// SPDX-License-Identifier: GPL-2.0-or-later
// How many pixels a page has: by its purpose, by what is asked, and where it is very long.
#include "render/canvas/page.h"

#include "cases.h"

#include <math.h>

// Finds the size in pixels, 0 where it is refused; returns those of a point.
static double pixels_of(const PictureStyle *style, double height, double size[2])
{
    const PageDef def = {.style = style, .height = height, .foot = 20};
    Page page = {0};
    Error err = {0};
    size[0] = size[1] = 0;
    if (page_begin(&page, &def, &err)) {
        size[0] = canvas_width(page.canvas);
        size[1] = canvas_height(page.canvas);
    }
    double point = page.point;
    page_destroy(&page);
    return point;
}

TEST(a_long_page_has_fewer_dots)
{
    double size[2];
    PictureStyle style = {.style = "columns"};
    pixels_of(&style, 0.5, size);
    assert_int_equal((int)size[0], 4205);   // 178 mm at 600 dots per inch
    double point = pixels_of(&style, 2.5, size);
    assert_true(size[1] > 8000 && size[1] <= CANVAS_SIZE_MAX);
    assert_true(fabs((size[1] - 20 * point) / size[0] - 2.5) < 1e-3);   // of the same shape

    // Who asks for dots per inch gets these, or a refusal.
    style.dpi = 300;
    pixels_of(&style, 2.5, size);
    assert_int_equal((int)size[0], 2102);
    style.dpi = 600;
    pixels_of(&style, 2.5, size);
    assert_true(size[0] == 0);
}
