// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/picture_options.h"

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

// An option that no figure of those asked for takes is refused, of the block's figures, too.
TEST(options_fit_their_figures)
{
    static const char *const density[] = {"contact-density"}, *const two[] = {"force",
                                                                              "precursors"};
    static const char *const field[] = {"field"}, *const plot[] = {"plot"};
    const struct {
        PictureStyle style;
        FieldChoice field;
        const char *const *figures;
        int32_t count;
        const char *says;   // NULL: allowed
    } cases[] = {
        {{.from = "U=1"},
         {0},
         density,
         1,
         "from has no meaning for contact-density: it is an option of force, slip-map, "
         "contact-area, state-map"},
        {{.from = "U=1 parsec"}, {0}, two, 2, NULL},   // force takes it, and looks at its value
        {{0}, {.at = "U=1"}, two, 2, "at has no meaning for force and the others"},
        {{0}, {.at = "U=1"}, field, 1, NULL},
        {{0}, {.edges = true}, two + 1, 1, "edges has no meaning for precursors"},
        {{.pixels = "mean"}, {0}, plot, 1, "pixels has no meaning for plot"},
        {{.limits = "0,1", .width = 100, .warnings = "none"}, {0}, plot, 1, NULL},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        Error err = {0};
        bool fits = picture_options_fit(&cases[k].style, &cases[k].field, cases[k].figures,
                                        cases[k].count, &err);
        if (fits != !cases[k].says) fail_msg("case %zu", k);
        if (!fits && !strstr(err.message, cases[k].says)) fail_msg("%s", err.message);
    }
}

TEST(films_and_pages_take_less)
{
    const PictureStyle shown = {.from = "U=1", .cycle = "last", .title = "none", .depth = 1};
    const PictureStyle wide = {.width = 100}, cycle = {.cycle = "last"};
    Error err = {0};
    assert_true(picture_options_fit_taker(&shown, TAKEN_BY_FILMS, &err));
    assert_true(picture_options_fit_taker(&cycle, TAKEN_BY_PAGES, &err));
    assert_false(picture_options_fit_taker(&wide, TAKEN_BY_FILMS, &err));
    assert_non_null(strstr(err.message, "width has no meaning for a film"));
    error_clear(&err);
    assert_false(picture_options_fit_taker(&shown, TAKEN_BY_PAGES, &err));
    assert_non_null(strstr(err.message, "has no meaning for a page"));
}
