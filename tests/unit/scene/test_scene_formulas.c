// SPDX-License-Identifier: GPL-2.0-or-later
// Formulas in a scene file: in whatever order they stand, beside --set and in many scenes of one
// file.
#include "scene/scene.h"

#include "cases.h"
#include "scene/keys.h"
#include "scene_of_text.h"
#include "unit/scene/scene_texts.h"

#include <stdlib.h>

static const char FORMULAS[] = "mesh: {file: block.geo, set: {length: 2, height: = 0.25 * "
                               "mesh.set.length, nx: = 3 + 1}}\n"
                               "rod: {velocity: = time.until.U / 10, height: = 0.5 * "
                               "mesh.set.height}\n"
                               "time: {until: {U: = 6 * load.pressure}}\n"
                               "material: {poisson: 0.3, eta1: = 2 * material.young}\n"
                               "materials: {layer: {young: = material.young / 100, eta1: 3}}\n";

static void write_scene(const char *path, const char *formulas)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "%s%s\n%s\n", formulas, scene_lines[4], scene_lines[5]);
    assert_int_equal(fclose(file), 0);
}

static double parameter(const Scene *scene, const char *name)
{
    for (int32_t k = 0; k < scene->mesh.parameter_count; k++)
        if (strcmp(scene->mesh.parameters[k].name, name) == 0)
            return scene->mesh.parameters[k].value;
    return NAN;
}

TEST(formulas_of_a_file)
{
    Error err = {0};
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    write_scene("formulas.yaml", FORMULAS);
    if (!scene_read("formulas.yaml", NULL, 0, false, scene, &err)) fail_msg("%s", err.message);
    assert_true(parameter(scene, "height") == 0.5);
    assert_true(parameter(scene, "nx") == 4);
    assert_near("number", scene->time.until_U, 0.06, 1e-15);
    assert_near("number", scene->rod.velocity, 0.006, 1e-15);
    assert_true(scene->rod.height == 0.25);
    assert_true(scene->material.eta1 == 2);
    assert_int_equal(scene->materials.count, 1);
    assert_true(scene->materials.region[0].given[MATERIAL_YOUNG]);
    assert_near("number", scene->materials.region[0].number[MATERIAL_YOUNG], 0.01, 1e-15);
    unlink("formulas.yaml");
    free(scene);
}

// A setting changes the value of a formula, or replaces the formula.
TEST(settings_beside_formulas)
{
    static const char *const settings[] = {"load.pressure=0.02", "mesh.set.height=1",
                                           "rod.velocity== 2 * load.pressure"};
    Error err = {0};
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    write_scene("formulas.yaml", FORMULAS);
    if (!scene_read("formulas.yaml", settings, 3, false, scene, &err)) fail_msg("%s", err.message);
    assert_near("number", scene->time.until_U, 0.12, 1e-15);
    assert_true(scene->rod.height == 0.5);
    assert_near("number", scene->rod.velocity, 0.04, 1e-15);
    static const char *const whole[] = {"mesh.set={nx: 7}", "time.until={t: 3}",
                                        "rod={velocity: 1}"};
    if (!scene_read("formulas.yaml", whole, 3, false, scene, &err)) fail_msg("%s", err.message);
    assert_true(isnan(parameter(scene, "height")) && parameter(scene, "nx") == 7);
    assert_true(scene->time.until_U == 0 && scene->rod.velocity == 1);
    unlink("formulas.yaml");
    free(scene);
}

TEST(formulas_of_many_scenes)
{
    Error err = {0};
    SceneSource *source = NULL;
    YamlDocument *value = NULL;
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    write_scene("formulas.yaml", FORMULAS);
    assert_true(scene_source_open("formulas.yaml", false, &source, &err));
    for (int32_t k = 1; k < 4; k++) {
        char text[20];
        snprintf(text, sizeof text, "%g", 0.01 * k);
        assert_true(yaml_parse("value", text, 0, &value, &err));
        SceneSetting settings[] = {{"load.pressure", value, YAML_ROOT},
                                   {"material.young", value, YAML_ROOT}};
        if (!scene_source_make(source, settings, 1, scene, &err)) fail_msg("%s", err.message);
        assert_near("number", scene->time.until_U, 0.06 * k, 1e-14);
        assert_true(scene_source_make(source, settings, 2, scene, &err));
        assert_near("number", scene->material.eta1, 0.02 * k, 1e-14);
        yaml_destroy(value);
    }
    scene_source_close(source);
    unlink("formulas.yaml");
    free(scene);
}

// A formula in every list and map of numbers; a region may be called as a key that takes a text.
static const char LISTS[] =
    "units: normalised\nmesh: {file: block.geo}\n"
    "material:\n"
    "  poisson: 0.3\n"
    "  eta1: = material.relaxation.0.shear\n"
    "  relaxation: [{time: = 1 + 1, shear: = 0.5 * material.young},\n"
    "               {time: 3, shear: = 2 * material.relaxation.0.shear, bulk: = 1 / 4}]\n"
    "materials:\n"
    "  from: {relaxation: [{time: 1, shear: = material.young / 8}]}\n"
    "friction: {law: table, velocity: [0, = 1 / 8, 1], mu: [= 1 / 2, = 1 / 4, = 1 / 4],\n"
    "  contacts: [{group: contact_1, law: coulomb, mu_static: = load.pressure}]}\n"
    "rod: {velocity: 1, program: {U: [0, = 2 * load.pressure], factor: [1, = 1 / 2]}}\n"
    "load:\n"
    "  pressure: 0.25\n"
    "  program: {t: [0, = time.until.t / 2, = time.until.t], factor: [1, = 1 + 1, 1]}\n"
    "  tractions: [{group: top, x: = 2 * load.pressure, z: 1}, {group: rod, x: 0, z: = -3 + 1}]\n"
    "time: {until: {t: = 40 * load.pressure}}\n"
    "output: {probes: {gauge: {at: [= load.pressure, = 0.5 * rod.velocity]}}}\n";

TEST(formulas_in_lists)
{
    static const char *const settings[] = {
        "load.pressure=0.5", "load.tractions=[{group: top, x: = load.pressure / 8, z: 0}]"};
    for (int32_t k = 0; k < 2; k++) {
        Error err = {0};
        double pressure = k ? 0.5 : 0.25;
        Scene *scene = calloc(1, sizeof *scene);
        FILE *file = fopen("lists.yaml", "w");
        assert_true(scene && file && fputs(LISTS, file) >= 0);
        assert_int_equal(fclose(file), 0);
        if (!scene_read("lists.yaml", settings, 2 * k, false, scene, &err))
            fail_msg("%s", err.message);
        const SceneBranch *branch = scene->material.relaxation.branch;
        assert_true(branch[0].time == 2 && branch[0].shear == 0.5 && scene->material.eta1 == 0.5);
        assert_true(branch[1].shear == 1 && branch[1].bulk == 0.25);
        assert_true(scene->materials.region[0].relaxation.branch[0].shear == 0.125);
        assert_true(scene->friction_keys.velocity.value[1] == 0.125);
        assert_true(scene->friction_keys.mu.value[0] == 0.5);
        assert_true(scene->contact_laws.item[0].mu_static == pressure);
        assert_true(scene->rod.program.U.value[1] == 2 * pressure);
        assert_true(scene->rod.program.factor.value[1] == 0.5);
        assert_true(scene->load.program.t.value[2] == 40 * pressure);
        assert_true(scene->load.program.factor.value[1] == 2);
        assert_int_equal(scene->load.traction_count, 2 - k);
        assert_true(scene->load.tractions[0].x == (k ? 0.0625 : 0.5));
        assert_true(k || scene->load.tractions[1].z == -2);
        assert_true(scene->output.probes.probe[0].at.value[0] == pressure);
        unlink("lists.yaml");
        free(scene);
    }
}

// Every key that takes a number or a list of them takes a formula in its place: what is said of it,
// if anything, is not that it is none.
TEST(formulas_of_every_key)
{
    int32_t count = 0, tried = 0;
    const SceneKey *keys = scene_keys(&count);
    Scene *scene = calloc(1, sizeof *scene);
    for (int32_t k = 0; k < count; k++) {
        char text[SCENE_TEXT_MAX], line[200];
        Error err = {0};
        bool list = keys[k].type == KEY_NUMBERS;
        if (keys[k].type != KEY_NUMBER && !list) continue;
        FILE *file = fopen("key.yaml", "w");
        scene_text_with(0, "", text);
        assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
        snprintf(line, sizeof line, list ? "%s=[= 1 / 4]" : "%s== 1 / 4", keys[k].name);
        const char *const setting[] = {line};
        bool done = scene_read("key.yaml", setting, 1, false, scene, &err);
        if (!done && strstr(err.message, "found `=")) fail_msg("%s", err.message);
        if (list && done) {
            const SceneNumbers *numbers =
                (const SceneNumbers *)(const void *)((char *)scene + keys[k].offset);
            if (numbers->value[0] != 0.25) fail_msg("%s: %g", line, numbers->value[0]);
        }
        tried++;
        unlink("key.yaml");
    }
    assert_true(tried > 50);
    free(scene);
}

TEST(wrong_formulas)
{
    static const struct {
        const char *line, *words;
    } wrong[] = {
        {"rod: {velocity: = 2 * load.presure}", "s.yaml:7:17: rod.velocity: "},
        {"rod: {velocity: = 2 * rod.velocity}", "s.yaml:7:17: rod.velocity: a formula over itself"},
        {"rod: {velocity: = rod.height, height: = rod.velocity}", "a formula over itself, or over"},
        {"rod: {velocity: = -load.pressure}", "s.yaml:7:17: rod.velocity: found `-0.01`; allowed"},
        {"rod: {velocity: 1, program: {t: [0, = 2 * load.presure], factor: [1, 1]}}",
         "s.yaml:7:37: rod.program.t.1: `load.presure` is no number"},
        {"rod: {velocity: 1, program: {t: [0, = -load.pressure], factor: [1, 1]}}",
         "s.yaml:7:37: rod.program.t: found `-0.01`; allowed"},
        {"rod: {velocity: 1, program: = 3}", "rod.program: found `= 3`"},
        {"rod: {velocity: '= load.pressure'}", "s.yaml:7:17: rod.velocity: found `= load"},
    };
    Scene *scene = calloc(1, sizeof *scene);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char text[SCENE_TEXT_MAX];
        Error err = {0};
        scene_text_with(7, wrong[k].line, text);
        assert_false(scene_of_text("s.yaml", text, scene, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, wrong[k].words)) fail_msg("%s", err.message);
    }
    free(scene);
}
