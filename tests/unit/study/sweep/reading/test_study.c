// SPDX-License-Identifier: GPL-2.0-or-later
// Studies: which points they stand for, what each point's scene holds, and what is wrong where.
#include "study/sweep/reading/study.h"

#include "base/memory.h"
#include "cases.h"
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char path[] = "/tmp/amontons_study_XXXXXX.yaml";
static char head[700];

// A study of figure 1's scene with `body` below it, in the test's file.
static void write_study(const char *body)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "%s%s", head, body);
    fclose(file);
}

static Study *read_with(const char *body, const char *const *overrides, int32_t count)
{
    Error err = {0};
    write_study(body);
    Study *study = NEW_ARRAY(Study, 1, &err);
    if (!study_read(path, overrides, count, false, study, &err)) fail_msg("%s", err.message);
    return study;
}

static Study *read_body(const char *body)
{
    return read_with(body, NULL, 0);
}

static void drop(Study *study)
{
    study_destroy(study);
    memory_free(study);
}

static Scene *scene_at(const Study *study, int32_t point)
{
    Error err = {0};
    Scene *scene = NEW_ARRAY(Scene, 1, &err);
    if (!study_scene(study, &(PointChoice){.point = point}, scene, &err))
        fail_msg("%s", err.message);
    return scene;
}

static double value_at(const Study *study, int32_t point, const char *key)
{
    char words[200];
    double number = NAN;
    Scene *scene = scene_at(study, point);
    study_scene_value(scene, key, words, sizeof words, &number);
    memory_free(scene);
    return number;
}

TEST(test_product)
{
    Study *study = read_body("set: {mesh.set.height: = 0.5 * mesh.set.length, time.until.U: 0.01}\n"
                             "cases:\n  - {rod.kind: push}\n  - {rod.kind: bonded}\n"
                             "vary:\n  mesh.set.length: [0.25, 4]\n"
                             "  load.pressure: {log: [1e-3, 1e-1], points: 3}\n");
    assert_int_equal(study->point_count, 12);
    for (int32_t k = 0; k < 12; k++) {
        static const double lengths[] = {0.25, 4}, pressures[] = {1e-3, 1e-2, 1e-1};
        Scene *scene = scene_at(study, k);
        assert_int_equal(scene->rod.kind, k < 6 ? ROD_PUSH : ROD_BONDED);
        assert_true(scene->load.pressure == pressures[k % 3]);
        assert_true(value_at(study, k, "mesh.set.length") == lengths[k / 3 % 2]);
        assert_true(value_at(study, k, "mesh.set.height") == 0.5 * lengths[k / 3 % 2]);
        assert_true(scene->time.until_U == 0.01);
        memory_free(scene);
    }
    static const char *const columns[] = {"rod.kind", "mesh.set.length", "load.pressure",
                                          "mesh.set.height"};
    assert_int_equal(study->column_count, 4);
    for (int32_t k = 0; k < 4; k++) assert_string_equal(study->columns[k], columns[k]);
    drop(study);
}

// A sweep's own settings, which a study can change.
TEST(test_standard)
{
    Study *study = read_body("vary: {load.pressure: [1, 2]}\n");
    Scene *scene = scene_at(study, 1);
    assert_true(scene->time.until_periodic && scene->time.until_U == 0.012);
    assert_false(scene->output.history || scene->output.fields);
    assert_int_equal(scene->output.figures.count, 0);
    memory_free(scene);
    drop(study);
    study = read_body("set: {time.until: {U: 5}, output.history: true}\n");
    assert_int_equal(study->point_count, 1);
    scene = scene_at(study, 0);
    assert_false(scene->time.until_periodic);
    assert_true(scene->output.history);
    memory_free(scene);
    drop(study);
}

TEST(test_ranges)
{
    Study *study = read_body("vary: {load.pressure: {log: [2e-4, 0.7123456789], points: 9}}\n");
    for (int32_t k = 0; k < 9; k++) {
        double exact = 2e-4 * pow(0.7123456789 / 2e-4, k / 8.0);
        double value = value_at(study, k, "load.pressure");
        assert_true(fabs(value - exact) <= 1e-5 * exact);
        if (k == 0 || k == 8) assert_true(value == (k ? 0.7123456789 : 2e-4));
    }
    drop(study);
    study = read_body("vary: {rod.height: {linear: [0, 0.3], points: 4}}\n");
    for (int32_t k = 0; k < 4; k++)
        assert_true(fabs(value_at(study, k, "rod.height") - 0.1 * k) < 1e-15);
    drop(study);
    study = read_body("vary: {load.pressure: {log: [0.25, 9], points: 1}}\n");
    assert_int_equal(study->point_count, 1);
    assert_true(value_at(study, 0, "load.pressure") == 0.25);
    drop(study);
}

// In the unit of the key, of what it is of the whole block, of a region, a branch or the mesh.
TEST(ranges_with_units)
{
    static const struct {
        const char *key, *ends, *first;
    } ranges[] = {
        {"load.force", "[1 kN, 2 kN]", "1000 N"},
        {"rod.stiffness", "[1 MPa, 2 MPa]", "1000000 Pa"},
        {"rod.stiffness", "[1e3 N/mm, 2e6 N/m]", "1000000 N/m"},
        {"rod.stiffness", "[1 N/m, 2 Pa]", NULL},
        {"mesh.set.length", "[10 mm, 20 mm]", "0.01 m"},
        {"materials.pads.young", "[10 kPa, 20 kPa]", "10000 Pa"},
        {"materials.pads.relaxation.0.time", "[1 ms, 2 ms]", "0.001 s"},
        {"material.relaxation.1.shear", "[10 kPa, 20 kPa]", "10000 Pa"},
        {"material.relaxation.1.shear", "[10 s, 20 s]", NULL},
    };
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++) {
        double pair[2];
        char unit[STUDY_UNIT_SIZE], shown[80];
        Error err = {0};
        Study study = {0};
        assert_true(yaml_parse("ends", ranges[k].ends, 0, &study.file, &err));
        bool read = study_pair(&study, YAML_ROOT, ranges[k].key, pair, unit);
        if (read != (ranges[k].first != NULL)) fail_msg("%s", ranges[k].ends);
        snprintf(shown, sizeof shown, "%.9g%s", pair[0], unit);
        if (read) assert_string_equal(shown, ranges[k].first);
        yaml_destroy(study.file);
    }
}

// base scene < set < --set < cases < vary < formulas; --set replaces a formula of `set`.
TEST(test_order)
{
    static const char body[] =
        "set: {material.eta2: 2, rod.width: = 3 * load.pressure, rod.height: 0.1}\n"
        "cases: [{rod.height: = load.pressure + rod.width, material.young: 4}]\n"
        "vary: {load.pressure: [0.5]}\n";
    Study *study = read_body(body);
    assert_true(value_at(study, 0, "rod.width") == 1.5);
    assert_true(value_at(study, 0, "rod.height") == 2);   // over the width just worked out
    assert_true(value_at(study, 0, "material.eta2") == 2);
    drop(study);
    static const char *const overrides[] = {"rod.width=7", "material.eta2=3", "mesh.set.nx=5"};
    study = read_with(body, overrides, 3);
    assert_true(value_at(study, 0, "rod.width") == 7);
    assert_true(value_at(study, 0, "rod.height") == 7.5);
    assert_true(value_at(study, 0, "material.eta2") == 3);
    assert_true(value_at(study, 0, "mesh.set.nx") == 5);
    drop(study);
}

// Points are made from one reading of the base scene: nothing of one is left in the next, in any
// order, and units that a case sets are those of all its numbers.
TEST(test_points_are_apart)
{
    Study *study = read_body("set: {rod.height: = 0.4 * mesh.set.height}\n"
                             "cases:\n  - {load.pressure: 3 kPa, rod.stiffness: 7, units: si}\n"
                             "  - {mesh.set: {height: 2}, time.until: {t: 5}, mesh.file: a.geo}\n"
                             "  - {load.pressure: 0.004}\n");
    static const int32_t orders[] = {0, 1, 2, 0, 2, 1, 0};
    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        int32_t k = orders[i];
        Scene *scene = scene_at(study, k);
        assert_int_equal(scene->units, k == 0 ? UNITS_SI : UNITS_NORMALISED);
        assert_true(scene->load.pressure == (k == 0 ? 3000 : k == 1 ? 0.003 : 0.004));
        assert_true(scene->rod.stiffness == (k == 0 ? 7 : 0));
        assert_true(scene->rod.height == (k == 1 ? 0.8 : 0.2));
        assert_int_equal(scene->mesh.parameter_count, k == 1 ? 1 : 6);
        assert_true(scene->time.until_U == (k == 1 ? 0 : 0.012));
        assert_true(scene->time.until_t == (k == 1 ? 5 : 0));
        assert_true(strstr(scene->mesh.file, k == 1 ? "paper/a.geo" : "block.geo") != NULL);
        memory_free(scene);
    }
    drop(study);
}

TEST(test_records)
{
    Study *study = read_body("vary: {load.pressure: [1]}\nrecord: [mu_M, results.mu_max]\n");
    assert_int_equal(study->record_count, 2);
    assert_string_equal(study->records[0].path, "results.mu_M");
    assert_string_equal(study->records[1].name, "results.mu_max");
    assert_string_equal(study->records[1].path, "results.mu_max");
    drop(study);
    study = read_body("vary: {load.pressure: [1]}\n");
    assert_string_equal(study->records[0].name, "mu_M");
    assert_true(study->record_count > 10);
    drop(study);
}

// A map, whose quantities become columns, and a plot of a formula.
TEST(test_several_plots)
{
    Study *study = read_body(
        "vary: {load.pressure: [1, 2], mesh.set.length: [1, 2], rod.kind: [push, bonded]}\n"
        "record: [period]\n"
        "plot:\n"
        "  - {x: load.pressure, y: mesh.set.length, color: mu_M, contours: = l_c * load.pressure,\n"
        "     panels: rod.kind}\n"
        "  - {x: = load.pressure * mesh.set.length, y: mu_hold, name: hold}\n");
    assert_int_equal(study->plot_count, 2);
    const StudyPlot *map = &study->plots[0], *curves = &study->plots[1];
    assert_string_equal(map->name, "map");
    assert_string_equal(map->text[PLOT_CONTOURS], "= l_c * load.pressure");
    assert_false(map->log_given);
    assert_string_equal(curves->name, "hold");
    assert_int_equal(study->record_count, 4);   // period, mu_M, l_c, mu_hold
    for (int32_t k = 0; k < 4; k++) {
        bool is_shown = strncmp(study->records[k].name, "mu_", 3) == 0;
        assert_true(study->records[k].is_shown == is_shown);   // lines need not be everywhere
    }
    drop(study);
}

// Maps below a group are columns of their own.
TEST(test_rank_and_plot)
{
    Study *study = read_body("vary: {load.pressure: [1, 2], rod.kind: [push, bonded]}\n"
                             "record: [period]\n"
                             "rank: {by: l_c, order: lowest, top: 3, against: {rod.kind: push}}\n"
                             "plot: {x: load.pressure, y: mu_M, series: rod.kind, log: both}\n");
    assert_true(study->rank.wanted && study->rank.lowest);
    assert_int_equal(study->rank.top, 3);
    assert_string_equal(study->records[study->rank.record].path, "results.l_c_over_L");
    assert_int_equal(study->record_count, 3);   // period, and what rank and plot need besides
    assert_int_equal(study->plot_count, 1);
    const StudyPlot *plot = &study->plots[0];
    assert_true(plot->log_given && plot->log_x && plot->log_y);
    assert_string_equal(plot->name, "plot");
    assert_string_equal(plot->text[PLOT_X], "load.pressure");
    assert_string_equal(plot->text[PLOT_SERIES], "rod.kind");
    assert_true(study->records[study->record_count - 1].is_shown);
    assert_false(study->records[0].is_shown);
    Error err = {0};
    Scene *scene = NEW_ARRAY(Scene, 1, &err);
    for (int32_t k = 0; k < 4; k++) {
        assert_true(study_scene(study, &(PointChoice){.point = k, .baseline = true}, scene, &err));
        assert_int_equal(scene->rod.kind, ROD_PUSH);
        assert_true(scene->load.pressure == (k < 2 ? 1 : 2));
    }
    memory_free(scene);
    drop(study);
    study = read_body("set: {rod.width: = 2 * rod.height}\ncases:\n  - {mesh.set: {nx: 4}}\n"
                      "vary: {rod.height: [1]}\nrank: {by: mu_M}\n");
    assert_true(study->rank.against == AGAINST_FIRST && !study->rank.lowest);
    assert_int_equal(study->rank.top, 10);
    assert_int_equal(study->column_count, 3);
    assert_true(study->chosen[study_column(study, "mesh.set.nx")]);
    assert_true(study->chosen[study_column(study, "rod.height")]);
    assert_false(study->chosen[study_column(study, "rod.width")]);
    assert_false(study->plot_count > 0 || study->rank.refine > 0);
    drop(study);
    study = read_body("vary: {rod: [{kind: push}, {kind: bonded}]}\n"   // a map as a whole
                      "rank: {by: mu_M, against: {rod: {kind: push}}}\n");
    assert_true(study->rank.against == AGAINST_KEYS);
    assert_true(study->chosen[study_column(study, "rod.kind")]);
    drop(study);
    study = read_body("vary: {rod.height: [1]}\nrank: {by: mu_M, refine: 0.5%}\n");
    assert_true(study->rank.refine == 0.5 / 100);
    assert_string_equal(study->columns[1], "accuracy.mu");
    drop(study);
}

TEST(test_columns_of_maps)
{
    Study *study = read_body("vary:\n  mesh.set: [{nx: 5, nz: 6}, {nx: 7, nz: 8}]\n");
    assert_int_equal(study->column_count, 2);
    assert_string_equal(study->columns[1], "mesh.set.nz");
    assert_true(value_at(study, 1, "mesh.set.nz") == 8);
    drop(study);
    study = read_body("vary:\n  materials.pads: [{young: 5, eta1: 2}, {young: 7, eta1: 3}]\n");
    assert_int_equal(study->column_count, 2);
    assert_string_equal(study->columns[0], "materials.pads.young");
    assert_true(value_at(study, 1, "materials.pads.eta1") == 3);
    drop(study);
    study = read_body("vary:\n  materials: [{pads: {young: 5}}, {top: {young: 2}}]\n");
    assert_string_equal(study->columns[1], "materials.top.young");
    assert_true(isnan(value_at(study, 0, "materials.top.young")));
    drop(study);
    study = read_body("cases:\n  - {rod.stiffness: 0.5}\n  - {rod.kind: bonded}\n");
    assert_true(value_at(study, 0, "rod.stiffness") == 0.5);
    assert_true(isnan(value_at(study, 1, "rod.stiffness")));
    drop(study);
    study = read_body("set: {rod.stiffness: 2}\ncases:\n  - {rod.stiffness: none}\n  - {}\n");
    assert_true(isnan(value_at(study, 0, "rod.stiffness")));   // also one that was given before
    drop(study);
    study = read_body("vary:\n  rod.stiffness: [none, 0.5]\n");
    assert_true(isnan(value_at(study, 0, "rod.stiffness")));
    assert_true(value_at(study, 1, "rod.stiffness") == 0.5);
    drop(study);
}

// Lines count from the study's first, which names the scene.
TEST(test_faults)
{
    static const struct {
        const char *body, *message;
    } known[] = {
        {"varry: {}\n", ":2:1: study: unknown key `varry`; did you mean `vary`?"},
        {"vary: {load.presure: [1]}\n", ":2:8: load.presure: unknown key; did you mean"},
        {"vary: {contact.radius: [1, 2]}\n",
         ":2:8: contact.radius: this key of an earlier version is gone"},
        {"set: {colour: red}\n", ":2:7: colour: unknown key ("},
        {"cases: [{}, {rod: {kind: glued}}]\n", "rod.kind: found `glued`"},
        {"vary: {load.pressure: [1, -2]}\n", ":2:27: load.pressure: found `-2`; allowed"},
        {"vary: {load.pressure: 3}\n", ":2:23: load.pressure: found `3`; allowed: a list"},
        {"vary: {load.pressure: []}\n", "allowed: a list of values"},
        {"vary: {load.pressure: {log: [0, 1], points: 3}}\n", ":2:29: load.pressure: "},
        {"vary: {load.pressure: {log: [1, 2, 3], points: 3}}\n", "[from, to]"},
        {"vary: {load.pressure: {log: [1, 2], points: 2.5}}\n", "points: found"},
        {"vary: {load.pressure: {log: [1, 2], points: 0x2}}\n", "points: found"},
        {"vary: {load.pressure: {log: [0x1, 2], points: 2}}\n", "two numbers"},
        {"vary: {load.pressure: {log: [1, 2 kPa], points: 2}}\n", "both with a unit of the key's"},
        {"vary: {load.pressure: {log: [1 mm, 2 mm], points: 2}}\n",
         "both with a unit of the key's"},
        {"vary: {load.pressure: {log: [1 kPa, 2 kPa], points: 2}}\n", "normalised"},
        {"vary: {load.pressure: {log: [1, 2], linear: [1, 2], points: 2}}\n", "allowed: a list"},
        {"vary: {load.pressure: {log: [1, 2]}}\n", "allowed: a list"},
        {"vary: [1]\n", "vary: found a list"},
        {"cases: {a: 1}\n", "cases: found a map"},
        {"cases: [3]\n", ":2:9: cases: found `3`; allowed: a map"},
        {"set: 3\n", "set: found `3`; allowed: a map"},
        {"set: {rod.width: = 2 * rod.heigth}\n", ":2:18: rod.width: `rod.heigth` is no number"},
        {"set: {rod.width: = -1}\n", ":2:18: rod.width: found `-1`; allowed"},
        {"record: [mu_N]\n", ":2:10: record: unknown name `mu_N`; did you mean `mu_M`?"},
        {"record: [qqqqqq]\n", "a path in run.json"},
        {"record: 3\n", "record: found `3`"},
        {"title: [1]\n", "title: found a list"},
        {"set: {load.pressure: 1}\nvary: {load.pressure: [1, 2]}\n",
         ":2:7: load.pressure: given by `set` and again by `vary`"},
        {"set: {load: {pressure: 1}}\nvary: {load.pressure: [1, 2]}\n",
         ":2:7: load.pressure: given by `set` and again by `vary`"},
        {"set: {load.pressure: = 3}\nvary: {load: [{pressure: 1}, {pressure: 2}]}\n",
         ":2:7: load.pressure: given by `set` and again by `vary`"},
        {"cases: [{rod.kind: push}, {load.pressure: 1}]\nvary: {load.pressure: [1, 2]}\n",
         ":2:28: load.pressure: given by `cases` and again by `vary`"},
        {"cases: [{load.pressure: = 2 * rod.width}]\nvary: {load.pressure: [1, 2]}\n",
         ":2:10: load.pressure: given by `cases` and again by `vary`"},
        {"vary: {mesh.set.nx: [4, 5], mesh.set: [{nz: 3}, {nx: 4}]}\n",
         ":2:29: mesh.set.nx: varied twice"},
        {"rank: mu_M\n", "rank: found `mu_M`; allowed: a map"},
        {"rank: {order: lowest}\n", "`by` must be given"},
        {"rank: {by: mu_N}\n", ":2:12: by: unknown name `mu_N`; did you mean `mu_M`?"},
        {"rank: {by: mu_M, order: best}\n", "order: found `best`; allowed: highest, lowest"},
        {"rank: {by: mu_M, top: 0}\n", ":2:23: top: found `0`; allowed: a whole number"},
        {"rank: {by: mu_M, bottom: 3}\n",
         "unknown key `bottom`; allowed: by, order, top, against, refine"},
        {"rank: {by: mu_M, refine: 100%}\n", ":2:26: refine: found `100%`; allowed: the smallest"},
        {"rank: {by: mu_M, against: last}\n", "against: found `last`; allowed: first, best"},
        {"rank: {by: mu_M, against: {load.pressure: 1}}\n", "neither `vary` nor `cases` has"},
        {"plot: {y: mu_M}\n", "plot: `x` must be given"},
        {"plot: {x: load.pressure, y: mu_M}\n", "x: `load.pressure` does not vary"},
        {"plot: {x: mu_M, y: l_c, series: a}\n", "series: found `a`; allowed: a key that varies"},
        {"plot: {x: mu_M, y: l_c, log: z}\n", "log: found `z`; allowed: none, x, y, both"},
    };
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        Error err = {0};
        int64_t live = memory_counters().live;
        write_study(known[k].body);
        Study *study = NEW_ARRAY(Study, 1, &err);
        Scene *scene = NEW_ARRAY(Scene, 1, &err);
        bool done = study_read(path, NULL, 0, false, study, &err);
        for (int32_t i = 0; done && i < study->point_count; i++)
            done = study_scene(study, &(PointChoice){.point = i}, scene, &err);
        if (done) fail_msg("%s: not refused", known[k].body);
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, known[k].message) || !strstr(err.message, path))
            fail_msg("%s: \"%s\" lacks \"%s\"", known[k].body, err.message, known[k].message);
        memory_free(scene);
        drop(study);
        assert_int_equal(memory_counters().live, live);
    }
}

TEST(test_faults_of_plots)
{
    static const char *const known[][2] = {
        {"plot: {x: mu_M, y: = l_c * mu_N}\n", "y: unknown name `mu_N`; did you mean `mu_M`?"},
        {"plot: {x: mu_M, y: = l_c *}\n", "y: the formula ends where"},
        {"plot: {x: mu_M, y: l_c, contours: l_sc}\n", "contours: only a map has them"},
        {"plot: {x: mu_M, y: l_c, name: ../a}\n", "name: found `../a`; allowed: a name of letters"},
        {"plot: [{x: mu_M, y: l_c}, {x: l_c, y: mu_M}]\n", "a `name` that no other plot"},
    };
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        Error err = {0};
        write_study(known[k][0]);
        Study *study = NEW_ARRAY(Study, 1, &err);
        assert_false(study_read(path, NULL, 0, false, study, &err));
        if (!strstr(err.message, known[k][1])) fail_msg("%s", err.message);
        drop(study);
    }
}

TEST(test_faults_of_overrides)
{
    static const char *const overrides[][2] = {{"load.pressure=3", "varies load.pressure"},
                                               {"load={pressure: 3}", "varies load.pressure"},
                                               {"=3", "wanted is key=value"},
                                               {"a", "wanted"}};
    for (size_t k = 0; k < 4; k++) {
        Error err = {0};
        write_study("vary: {load.pressure: [1]}\n");
        Study *study = NEW_ARRAY(Study, 1, &err);
        assert_false(study_read(path, &overrides[k][0], 1, false, study, &err));
        assert_non_null(strstr(err.message, overrides[k][1]));
        drop(study);
    }
}

TEST(test_memory)
{
    int64_t failures = 0;
    write_study("set: {rod.width: = 2 * load.pressure}\nvary:\n"
                "  load.pressure: {log: [1, 2], points: 2}\n");
    static const char *const overrides[] = {"mesh.set.nx=5"};
    Error err = {0};
    Study *study = NEW_ARRAY(Study, 1, &err);
    Scene *scene = NEW_ARRAY(Scene, 1, &err);
    int64_t live = memory_counters().live;
    for (bool done = false; !done; failures++) {
        err = (Error){0};
        memory_fail_after(failures);
        done = study_read(path, overrides, 1, false, study, &err) &&
               study_scene(study, &(PointChoice){.point = 1}, scene, &err);
        memory_fail_after(-1);
        study_destroy(study);
        assert_true(done || err.code == ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_true(failures < 2000);
    }
    assert_true(failures > 20);
    memory_free(scene);
    memory_free(study);
}

FIXTURE(make_file)
{
    int descriptor = mkstemps(path, 5);
    snprintf(head, sizeof head, "scene: %s/validation/paper/fig1.yaml\n",
             getenv("AMONTONS_SOURCE") ? getenv("AMONTONS_SOURCE") : "../..");
    return descriptor < 0 ? -1 : 0;
}

FIXTURE(remove_file)
{
    return remove(path);
}

GROUP_BETWEEN(make_file, remove_file);
