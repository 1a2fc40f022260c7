// SPDX-License-Identifier: GPL-2.0-or-later
// Plots of a table written by hand: curves and maps with panels, formulas, points without a value
// or with a warning; what their descriptions hold, and what is refused.
#include "amontons_pictures.h"

#include "io/files/own_list.h"
#include "io/hdf5/array_file.h"
#include "result_place.h"

enum { TEXT_SIZE = 200000 };

static char place[PLACE_SIZE];

static void add_column(ArrayFile *file, const char *name, const double *values, int64_t count)
{
    Error err = {0};
    const ArraySeries series = {
        .name = name, .type = ARRAY_FLOAT64, .width = 1, .unit = "1", .description = ""};
    if (!array_file_add_series(file, &series, &err) ||
        !array_file_append(file, name, values, count, &err))
        fail_msg("%s", err.message);
}

typedef struct Table {
    const char *name, *title, *columns;   // of the folder; NULL: left out
    int32_t pressures, lengths;   // a grid of points
    bool old;   // as an earlier version wrote it
    double word;   // added to the numbers of words
    bool unwarned;   // no row says whether a point is warned
} Table;

// mu_M is pressure + length, hold NaN where the pressure is 1, and where the length is 1 the run
// has a warning.
static void write_table(Table table)
{
    static double pressure[4000], length[4000], kind[4000], mu[4000], hold[4000], warned[4000],
        error[4000];
    char path[3 * PLACE_SIZE];
    Error err = {0};
    int64_t count = 0;
    for (int32_t j = 0; j < table.lengths; j++)
        for (int32_t i = 0; i < table.pressures; i++, count++) {
            pressure[count] = i + 1;
            length[count] = j + 1;
            kind[count] = j % 2 + table.word;
            mu[count] = i + j + 2;
            hold[count] = i == 0 ? NAN : 0.5 * (i + j);
            warned[count] = j == 0;
            error[count] = 0.1;
        }
    snprintf(path, sizeof path, "%s/%s", place, table.name);
    mkdir(path, 0777);
    assert_true(own_list_make(path, &(Error){0}));
    strcat(path, "/sweep.h5");
    ArrayFile *file = array_file_create(path, &err);
    if (!file) fail_msg("%s", err.message);
    if (table.title) array_file_set_text(file, "title", table.title, &err);
    array_file_set_text(file, "units", "si", &err);
    if (table.columns) array_file_set_text(file, "columns", table.columns, &err);
    array_file_set_text(file, "rod.kind words", "push|bonded", &err);
    add_column(file, "scene/load.pressure", pressure, count);
    add_column(file, "scene/mesh.set.length", length, count);
    add_column(file, "scene/rod.kind", kind, count);
    add_column(file, "result/mu_M", mu, count);
    add_column(file, "result/mu_M_error", error, count);
    add_column(file, "result/mu_hold", hold, count);
    add_column(file, "result/short", mu, count - 1);
    if (!table.old) add_column(file, "result/warned", warned, table.unwarned ? 0 : count);
    if (!array_file_close(file, &err)) fail_msg("%s", err.message);
}

static bool draw(const char *name, const char *plot, Error *err)
{
    char folder[2 * PLACE_SIZE];
    const PictureStyle style = {.format = "svg", .width = 120};
    snprintf(folder, sizeof folder, "%s/%s", place, name);
    *err = (Error){0};
    return amontons_render_sweep(folder, plot, &style, err);
}

// The description that `plot` makes, in figures/NAME.json.
static const char *description(const char *name, const char *plot, const char *file)
{
    static char text[TEXT_SIZE];
    char path[PLACE_SIZE];
    Error err;
    if (!draw(name, plot, &err)) fail_msg("%s: %s", plot, err.message);
    snprintf(path, sizeof path, "%s/figures/%s.json", name, file);
    place_read(place, path, text, sizeof text);
    return text;
}

static void assert_says(const char *said, const char *words)
{
    if (!strstr(said, words)) fail_msg("'%s' is not in\n%.3000s", words, said);
}

static void assert_refused(const char *name, const char *plot, const char *words)
{
    Error err;
    if (draw(name, plot, &err)) fail_msg("%s: not refused", plot);
    if (!strstr(err.message, words)) fail_msg("%s: '%s', not '%s'", plot, err.message, words);
}

TEST(test_curves)
{
    const char *said = description(
        "one", "{x: load.pressure, y: mu_M, series: mesh.set.length, log: both}", "plot");
    assert_says(said, "\"y\": [2, 3, 4]");
    assert_says(said, "\"y\": [3, 4, 5]");
    assert_says(said, "open: warned");
    said = description(
        "one", "{x: load.pressure, y: = mu_M * load.pressure, panels: rod.kind, name: a}", "a");
    assert_says(said, "\"title\": \"kind = push\"");
    assert_says(said, "\"y\": [3, 8, 15]");   // mu_M is 3, 4, 5 at length 2
    said = description(
        "one", "{x: load.pressure, y: 'twice ~{m}, % = 2 * mu_M', panels: rod.kind, name: n}", "n");
    assert_says(said, "\"label\": \"twice ~{m}, %\"");
    assert_says(said, "\"column\": \"2 * mu_M\"");
    assert_says(said, "\"y\": [4, 6, 8]");
    said = description("one", "{x: load.pressure, y: mu_hold, series: rod.kind, name: b}", "b");
    assert_says(said, "\"x\": [2, 3]");   // the first has no value
    said = description("untitled", "{x: load.pressure, y: mu_M, series: rod.kind}", "plot");
    assert_says(said, "\"label\": \"kind = push\"");
}

TEST(test_maps)
{
    const char *said = description(
        "one", "{x: load.pressure, y: mesh.set.length, color: mu_hold, contours: mu_M}", "map");
    assert_says(said, "\"contour\": [2, 3, 4, 3, 4, 5]");
    assert_says(said, "\"value\": [null, 0.5, 1, null, 1, 1.5]");
    assert_says(said, "\"label\": \"no ");
    said = description(
        "one", "{x: load.pressure, y: mesh.set.length, color: mu_M, panels: rod.kind, log: none}",
        "map");
    assert_says(said, "\"title\": \"kind = push\"");
    // No point has a value of the key that tells panels apart.
    said = description("one",
                       "{x: load.pressure, y: mesh.set.length, color: mu_M, contours: mu_hold, "
                       "panels: = log(-mu_M), name: none}",
                       "none");
    assert_says(said, "\"value\": []");
    // A number a point is written into the text while it is short, else into an array file.
    said = description("large", "{x: load.pressure, y: mesh.set.length, color: mu_M}", "map");
    assert_says(said, "\"value\": \"map.h5:value_");
    assert_true(place_has(place, "large/figures/map.h5"));
}

TEST(test_refused)
{
    assert_refused("none", "{x: a, y: b}", "there is no sweep.h5 in it");
    assert_refused("old", "{x: a, y: b}", "was written by an earlier version");
    assert_refused("one", "{x: load.presure, y: mu_M}", "did you mean `load.pressure`?");
    assert_refused("one", "{x: zzzzzzzz, y: mu_M}",
                   "has no column `zzzzzzzz`; it has: load.pressure");
    assert_refused("one", "{x: load.pressure, y: = mu_M *}", "= ");
    assert_refused("one", "{x: load.pressure, y: = mu_N + 1}", "did you mean");
    assert_refused("one", "{x: load.pressure, y: short}", "has not one number a point");
    assert_refused("one", "{x: load.pressure, y: mesh.set.length, color: mu_M, name: '.'}", "name");
    assert_refused("one", "{x: = 0 * mu_M, y: = 0 * mu_M, color: mu_M}",
                   "shows one point at a place");
    assert_refused("many", "{x: load.pressure, y: mu_M, series: mesh.set.length}", "too many");
}

// All that would become an index is looked at, as the table may be anybody's.
TEST(test_indices)
{
    static const char *const names[] = {"beyond", "behind", "before", "between"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        assert_refused(names[k], "{x: load.pressure, y: mu_M, series: rod.kind}",
                       "not the number of one of its 2 words");
        assert_refused(names[k], "{x: load.pressure, y: mu_M, panels: rod.kind}",
                       "not the number of one of its 2 words");
    }
    assert_refused("unwarned", "{x: load.pressure, y: mu_M}", "has not one number a point");
}

FIXTURE(make)
{
    static const char columns[] = "load.pressure|mesh.set.length|rod.kind|mu_M|mu_hold|short";
    place_make(place);
    write_table((Table){"one", "First", columns, 3, 2, .old = false});
    write_table((Table){"untitled", NULL, NULL, 3, 2, .old = false});
    write_table((Table){"old", "Old", columns, 3, 2, .old = true});
    write_table((Table){"many", "Many", columns, 2, 17, .old = false});
    write_table((Table){"large", "Large", columns, 60, 50, .old = false});
    write_table((Table){"beyond", "Words", columns, 3, 2, .old = false, .word = 1e6});
    write_table((Table){"behind", "Words", columns, 3, 2, .old = false, .word = 1});
    write_table((Table){"before", "Words", columns, 3, 2, .old = false, .word = -1});
    write_table((Table){"between", "Words", columns, 3, 2, .old = false, .word = 0.5});
    write_table((Table){"unwarned", "Words", columns, 3, 2, .old = false, .unwarned = true});
    mkdir(place_path(place, "none"), 0777);
    return 0;
}

FIXTURE(drop)
{
    place_remove(place);
    return 0;
}

GROUP_BETWEEN(make, drop);
