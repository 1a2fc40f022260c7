// SPDX-License-Identifier: GPL-2.0-or-later
// friction.file: what was measured becomes the law, whichever way the file is written.
#include "scene/friction_file.h"

#include "cases.h"
#include "scene_of_text.h"
#include "unit/scene/scene_texts.h"

#include <stdlib.h>

static const char LAW[] =
    "friction: {law: table, file: friction_file_test.csv, interpolation: log}";

static bool read_with(const char *table, const char *law, bool si, Scene *scene, Error *err)
{
    static const char SCENE[] =
        "units: %s\nmesh: {file: block.geo}\nmaterial: {poisson: 0.3%s}\n%s\n"
        "load: {pressure: 0.01}\nrod: {velocity: 1e-4}\n"
        "time: {until: {U: 0.1}}\n";
    char text[SCENE_TEXT_MAX], path[PATH_MAX], place[PATH_MAX - 40];
    FILE *file = fopen("friction_file_test.csv", "w");
    assert_non_null(file);
    fputs(table, file);
    fclose(file);
    snprintf(text, sizeof text, SCENE, si ? "si" : "normalised",
             si ? ", young: 1e6, density: 1e3, eta1: 1, eta2: 1" : "", law);
    assert_non_null(getcwd(place, sizeof place));
    snprintf(path, sizeof path, "%s/friction_scene_test.yaml", place);
    bool done = scene_of_text(path, text, scene, err);
    unlink("friction_file_test.csv");
    return done;
}

TEST(measured_laws)
{
    static const struct {
        const char *table;
        bool si;
    } same[] = {
        {"v,mu\n1e-4,0.4\n1e-3,0.3\n1e-2,0.2\n", false},
        {"v (mm/s);mu (-);mu_error\n10;0,2;0,01\n0,1;0,41;0,02\n0,1;0,39;0,02\n1;0,3;0,01\n", true},
        {"# steel on rubber\n1e-4 0.4\n1e-3 0.3\n1e-2 0.2\n", false},
        {"velocity [um/s]\tCOF/%\n100\t40\n1000\t30\n10000\t20\n", true},
        {"v,F_T/F_N,remark\n1e-4,0.4,slow\n5e-4,,lost\n1e-3,0.3,\n1e-2,0.2,fast\n", false},
    };
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        Error err = {0};
        if (!read_with(same[k].table, LAW, same[k].si, scene, &err)) fail_msg("%s", err.message);
        FrictionNode node = friction_node(&scene->friction, 1);
        assert_near("at rest", friction_coefficient(&node, 0), 0.4, 1e-12);
        assert_near("a point", friction_coefficient(&node, 1e-3), 0.3, 1e-12);
        assert_near("between", friction_coefficient(&node, 1e-2 / sqrt(10)), 0.25, 1e-12);
        assert_near("beyond", friction_coefficient(&node, 1), 0.2, 1e-12);
    }
    free(scene);
}

TEST(what_is_wrong_in_a_file)
{
    static const struct {
        const char *table, *law, *words;
        bool si;
    } wrong[] = {
        {"v,mu\n1e-4,0.4\n-1e-3,0.3\n", LAW, "friction_file_test.csv:3:1: v: -0.001: a slip rate",
         false},
        {"v,mu\n1e-4,x\n1e-3,0.3\n", LAW, "friction_file_test.csv:2:6: mu: `x` is no number",
         false},
        {"v,force\n1e-4,1\n1e-3,0.3\n", LAW, "no column of the coefficient mu", false},
        {"v (mm),mu\n1,1\n2,0.3\n", LAW,
         "friction_file_test.csv:1:1: v (mm) has `mm`, which is no unit of "
         "velocity",
         true},
        {"v (mm/s),mu\n1,1\n2,0.3\n", LAW, "a normalised scene has plain numbers", false},
        {"v,V,mu\n1,1,1\n2,2,0.3\n", LAW, ":1:3: V is the same as column 1, v", false},
        {"v,mu\n1,1\n", LAW, "1 point; two or more", false},
        {"v,mu\n1,1\n2,1\n",
         "friction: {law: table, file: friction_file_test.csv, velocity: [0, 1], mu: [1, 1]}",
         "friction.file: give either a file or velocity and mu", false},
        {"v,mu\n1,1\n2,1\n", "friction: {law: table}", "friction.velocity: missing", false},
    };
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        Error err = {0};
        assert_false(read_with(wrong[k].table, wrong[k].law, wrong[k].si, scene, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, wrong[k].words)) fail_msg("%s", err.message);
    }
    free(scene);
}
