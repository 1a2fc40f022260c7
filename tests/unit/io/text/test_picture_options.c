// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/text/picture_options.h"

#include "cases.h"

#include <math.h>
#include <string.h>

TEST(each_is_checked)
{
    static const struct {
        const char *name, *value, *says;   // says NULL: allowed
    } cases[] = {{"width", "178", NULL},
                 {"width", "19", "width 19: a number from 20 to 1000"},
                 {"width", "nan", "a number from 20"},
                 {"dpi", "3e2", NULL},
                 {"style", "columns", NULL},
                 {"style", "column ", "one of these"},
                 {"style", "", "one of these"},
                 {"title", "", NULL},
                 {"limits", "0,2e-3", NULL},
                 {"limits", "1%,99%", NULL},
                 {"limits", "-1,99%", NULL},
                 {"limits", "2,1", "two rising numbers"},
                 {"limits", "1%,101%", "two rising numbers"},
                 {"limits", "1,2,3", "two rising numbers"},
                 {"limits", "1", "two rising numbers"},
                 {"colour", "red", "no option \"colour\"; known are: style, width"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        Error err = {0};
        PictureStyle style = {0};
        bool good = picture_option_set(&style, cases[k].name, cases[k].value, &err);
        if (good != !cases[k].says) fail_msg("%s %s", cases[k].name, cases[k].value);
        if (!good && !strstr(err.message, cases[k].says)) fail_msg("%s", err.message);
    }
}

TEST(limits_are_numbers_or_parts)
{
    bool is_part = true;
    PictureStyle style = {.limits = "-0.5,98%"};
    assert_float_equal(picture_limit(&style, 0, &is_part), -0.5, 0);
    assert_false(is_part);
    assert_float_equal(picture_limit(&style, 1, &is_part), 0.98, 1e-15);
    assert_true(is_part);
    style.limits = NULL;
    assert_true(isnan(picture_limit(&style, 0, &is_part)));
}

TEST(what_is_given_goes_before)
{
    PictureStyle style = {.width = 100, .legend = "none"};
    const PictureStyle base = {.width = 50, .height = 30, .legend = "below", .title = "words"};
    picture_style_complete(&style, &base);
    assert_float_equal(style.width, 100, 0);
    assert_float_equal(style.height, 30, 0);
    assert_string_equal(style.legend, "none");
    assert_string_equal(style.title, "words");
    assert_null(style.limits);
}
