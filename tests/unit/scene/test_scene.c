// SPDX-License-Identifier: GPL-2.0-or-later
// Good scenes: values against the file's own text, overrides, units; faults and mutated texts.
#include "amontons.h"
#include "base/memory.h"
#include "cases.h"
#include "scene/scene.h"
#include "scene/keys.h"
#include "scene/materials.h"
#include "scene_of_text.h"
#include "unit/scene/scene_texts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char fig1[600];

static Scene read_fig1(const char *const *overrides, int32_t count)
{
    Scene scene;
    Error err = {0};
    if (!scene_read(fig1, overrides, count, false, &scene, &err)) fail_msg("%s", err.message);
    return scene;
}

static Scene read_with(int32_t line, const char *text)
{
    char whole[SCENE_TEXT_MAX];
    Scene scene;
    Error err = {0};
    scene_text_with(line, text, whole);
    if (!scene_of_text("folder/s.yaml", whole, &scene, &err)) fail_msg("%s", err.message);
    return scene;
}

TEST(test_figure_1)
{
    Scene scene = read_fig1(NULL, 0);
    assert_string_equal(scene.title, "Figure 1 of the paper");
    assert_int_equal(scene.units, UNITS_NORMALISED);
    assert_non_null(strstr(scene.mesh.file, "validation/paper/../../meshes/block.geo"));
    assert_int_equal(scene.mesh.parameter_count, 6);
    static const struct {
        const char *name;
        double value;
        const char *text;
    } parameters[] = {{"length", 1, ""}, {"height", 0.5, ""},  {"nx", 80, ""},
                      {"nz", 80, ""},    {"shape", 0, "quad"}, {"order", 1, ""}};
    for (int32_t i = 0; i < 6; i++) {
        assert_string_equal(scene.mesh.parameters[i].name, parameters[i].name);
        assert_true(scene.mesh.parameters[i].value == parameters[i].value);
        assert_string_equal(scene.mesh.parameters[i].text, parameters[i].text);
    }
    assert_true(scene.material.young == 1 && scene.material.poisson == 0.34);
    assert_true(scene.material.density == 1 && scene.material.eta1 == 1);
    assert_true(scene.material.eta2 == 1 && scene.material.plane == PLANE_STRESS);
    assert_int_equal(scene.friction.kind, FRICTION_LINEAR_WEAKENING);
    assert_true(scene.friction.mu_static == 0.38 && scene.friction.mu_kinetic == 0.1);
    assert_true(scene.friction.critical_velocity == 3.4e-4);
    assert_true(scene.load.pressure == 0.003 && scene.load.traction_count == 0);
    assert_true(scene.rod.velocity == 1e-5 && scene.rod.height == 0.25 && scene.rod.width == 0.05);
    assert_int_equal(scene.rod.kind, ROD_PUSH);
    assert_int_equal(scene.start.friction, START_FRICTION_ON);
    assert_true(scene.time.until_U == 0.012 && scene.time.until_t == 0);
    assert_false(scene.time.until_periodic);
    assert_int_equal(scene.time.scheme, SCHEME_SDIRK2);
    assert_int_equal(scene.time.accuracy, ACCURACY_STANDARD);
    assert_true(scene.output.history && scene.output.fields && scene.output.fields_at_events);
    assert_true(scene.output.fields_every_U == 2e-4 && scene.output.fields_every_t == 0);
    assert_int_equal(scene.output.figures.count, 3);
    assert_string_equal(scene.output.figures.name[1], "slip-map");
}

TEST(test_defaults)
{
    Scene scene = read_with(1, "title: Defaults");
    assert_string_equal(scene.mesh.file, "folder/block.geo");
    assert_string_equal(scene.groups.top, "top");
    assert_string_equal(scene.groups.rod, "rod");
    assert_int_equal(scene.groups.contact.count, 0);
    assert_true(scene.material.young == 1 && scene.material.density == 1);
    assert_true(scene.material.eta1 == 1 && scene.material.eta2 == 1);
    assert_int_equal(scene.friction.kind, FRICTION_LINEAR_WEAKENING);
    assert_true(scene.rod.height == 0 && scene.rod.width == 0 && scene.rod.kind == ROD_PUSH);
    assert_int_equal(scene.start.friction, START_FRICTION_ON);
    assert_int_equal(scene.start.rod, START_ROD_AWAY);
    assert_true(scene.start.tolerance == 1e-6);
    assert_true(scene.time.certificate && scene.time.accuracy == ACCURACY_STANDARD);
    assert_true(scene.time.energy_tolerance == 1e-3 && scene.time.periodic_tolerance == 1e-2);
    assert_true(scene.output.history && !scene.output.fields && scene.output.figures.count == 0);
    assert_true(scene.given[scene_key_index("title")]);
    assert_false(scene.given[scene_key_index("material.young")]);
}

TEST(test_overrides)
{
    static const char *const texts[] = {
        "load.pressure=0.006",
        "mesh.set.nx=40",
        "mesh.set.grading=2.5",
        "mesh.set.shape=tri",
        "output.figures=[]",
        "output.fields=none",
        "rod.kind=bonded",
        "time.until={t: 12}",
        "groups.contact=[contact_1, contact_2]",
        "title=\"a = b\"",
        "load.pressure=0.007",
        "load.tractions=[{group: top, x: 1e-3}]",
        "load.supports=[{group: top, direction: x}, {group: rod, direction: both}]",
        "start.velocity_z=-2",
    };
    Scene scene = read_fig1(texts, sizeof texts / sizeof texts[0]);
    assert_true(scene.load.pressure == 0.007);   // the later one
    assert_int_equal(scene.mesh.parameter_count, 7);
    assert_true(scene.mesh.parameters[2].value == 40 && scene.mesh.parameters[3].value == 80);
    assert_string_equal(scene.mesh.parameters[4].text, "tri");
    assert_string_equal(scene.mesh.parameters[6].name, "grading");
    assert_true(scene.mesh.parameters[6].value == 2.5);
    assert_int_equal(scene.output.figures.count, 0);
    assert_false(scene.output.fields);
    assert_false(scene.given[scene_key_index("output.fields.every_U")]);
    assert_true(scene.output.fields_every_U == 0 && !scene.output.fields_at_events);
    assert_int_equal(scene.rod.kind, ROD_BONDED);
    assert_true(scene.time.until_U == 0 && scene.time.until_t == 12);   // the map is replaced
    assert_int_equal(scene.groups.contact.count, 2);
    assert_string_equal(scene.groups.contact.name[1], "contact_2");
    assert_string_equal(scene.title, "a = b");
    assert_int_equal(scene.load.traction_count, 1);
    assert_true(scene.load.tractions[0].x == 1e-3 && scene.load.tractions[0].z == 0);
    assert_int_equal(scene.load.support_count, 2);
    assert_string_equal(scene.load.supports[1].group, "rod");
    assert_true(scene.load.supports[0].x && !scene.load.supports[0].z);
    assert_true(scene.load.supports[1].x && scene.load.supports[1].z);
    assert_true(scene.start.velocity_z == -2 && scene.start.velocity_x == 0);
}

// A formula of --set is worked out over all that is set, and over those before it.
TEST(test_formulas)
{
    static const char *const texts[] = {
        "time.until.U== 6*load.pressure",
        "load.pressure=0.007",
        "mesh.set.height== mesh.set.length / 4",
        "rod.height== 2 * mesh.set.height - time.until.U",
        "title=\"= 3\"",
    };
    Scene scene = read_fig1(texts, sizeof texts / sizeof texts[0]);
    assert_true(fabs(scene.time.until_U - 0.042) < 1e-15);
    assert_true(scene.mesh.parameters[1].value == 0.25);
    assert_true(fabs(scene.rod.height - (0.5 - 0.042)) < 1e-15);
    assert_string_equal(scene.title, "= 3");   // in quotes it is none
}

TEST(test_override_of_a_part)
{
    static const char *const some[] = {"output.fields=none", "output.fields.every_t=5"};
    Scene scene = read_fig1(some, 2);
    assert_true(scene.output.fields && scene.output.fields_every_t == 5);
    assert_true(scene.output.fields_every_U == 0);
    static const char *const more[] = {"time.until.periodic=true", "mesh.set={nx: 3}",
                                       "output.fields={}"};
    scene = read_fig1(more, 3);
    assert_true(scene.time.until_periodic && scene.time.until_U == 0.012);
    assert_int_equal(scene.mesh.parameter_count, 1);
    assert_true(scene.output.fields && scene.output.fields_every_U == 0);
    static const char *const units[] = {"load.pressure=3 kPa", "units=si"};
    scene = read_fig1(units, 2);   // `units` holds wherever it stands
    assert_true(scene.load.pressure == 3000);
}

// Nothing where a list or map may stand is an empty one, and a region without numbers is one of
// `material`.
TEST(test_what_may_be_empty)
{
    Scene scene = read_with(3, "mesh: {file: block.geo, set: }");
    assert_int_equal(scene.mesh.parameter_count, 0);
    scene = read_with(0, "groups: {contact: }");
    assert_int_equal(scene.groups.contact.count, 0);
    scene = read_with(6, "load: {pressure: 1, supports: , tractions: }");
    assert_int_equal(scene.load.support_count + scene.load.traction_count, 0);
    scene = read_with(0, "materials:");
    assert_int_equal(scene.materials.count, 0);
    scene = read_with(0, "materials: {pads: , top: {young: 2}}");
    assert_int_equal(scene.materials.count, 2);
    assert_string_equal(scene.materials.region[0].group, "pads");
    assert_true(scene_material_number(&scene, &scene.materials.region[0], MATERIAL_YOUNG) == 1);
    assert_true(scene_material_number(&scene, &scene.materials.region[1], MATERIAL_YOUNG) == 2);
}

// By the path that a formula may name.
TEST(test_numbers_of_regions)
{
    Scene scene = read_with(0, "materials: {pads: {young: 2}}");
    double number = 0;
    assert_true(scene_materials_find(&scene, "materials.pads.young", &number) && number == 2);
    static const char *const unknown[] = {"materials.pads.eta1",  "materials.pads.yung",
                                          "materials.none.young", "materials.young",
                                          "materials_pads.young", "material.young"};
    for (size_t k = 0; k < sizeof unknown / sizeof *unknown; k++)
        if (scene_materials_find(&scene, unknown[k], &number)) fail_msg("%s", unknown[k]);
}

// A word of an item with a name may be set alone, be it a number or a formula.
TEST(test_one_word_of_an_item)
{
    static const char *const overrides[] = {
        "friction={law: formula, formula: '0.3 * theta / (1 + theta)', slip_distance: 1e-3, "
        "state: {theta: {rate: 1 - v * theta / D_c, start: 10}}}",
        "friction.state.theta.start=7", "materials={pads: {young: 2}}", "materials.pads.eta1=3"};
    Scene scene = read_fig1(overrides, 4);
    assert_int_equal(scene.friction_keys.states.count, 1);
    assert_string_equal(scene.friction_keys.states.state[0].start, "7");
    assert_string_equal(scene.friction_keys.states.state[0].rate, "1 - v * theta / D_c");
    assert_int_equal(scene.materials.count, 1);
    assert_true(scene.materials.region[0].number[MATERIAL_YOUNG] == 2);
    assert_true(scene.materials.region[0].number[MATERIAL_ETA1] == 3);
}

// Warned of: weakening where nothing damps. Of one material without viscosity only the mesh tells
// whether it touches the floor.
TEST(test_scenes_without_viscosity)
{
    Scene scene = read_with(0, "materials: {pads: {young: 2}}");
    assert_null(amontons_scene_warning(&scene));
    scene = read_with(0, "materials: {top: {young: 2}, pads: {eta1: 0}}");
    assert_null(amontons_scene_warning(&scene));
    scene = read_with(4, "material: {poisson: 0.3, eta1: 0}\nmaterials: {pads: {eta1: 1}}");
    assert_null(amontons_scene_warning(&scene));
    scene = read_with(4, "material: {poisson: 0.3, eta1: 0}");
    assert_non_null(strstr(amontons_scene_warning(&scene), "material.eta1 is 0"));
}

// As other programs write it back: YAML 1.1 reads `on` as true; YAML 1.2 has True and TRUE, too.
TEST(test_written_by_other_programs)
{
    static const char *const words[2][4] = {{"off", "false", "False", "FALSE"},
                                            {"on", "true", "True", "TRUE"}};
    for (int32_t k = 0; k < 8; k++) {
        char line[80];
        snprintf(line, sizeof line, "start: {friction: %s}", words[k / 4][k % 4]);
        assert_int_equal(read_with(0, line).start.friction,
                         k / 4 ? START_FRICTION_ON : START_FRICTION_OFF);
        snprintf(line, sizeof line, "output: {history: %s}", words[k / 4][k % 4]);
        if (k % 4) assert_int_equal(read_with(0, line).output.history, k / 4);
    }
    assert_int_equal(read_with(0, "materials: Null").materials.count, 0);
}

// Values that are refused only together with others.
TEST(test_allowed_together)
{
    Scene scene = read_with(5, "friction: {law: coulomb, mu_static: 0.3, mu_kinetic: 0.3}");
    assert_true(scene.friction.mu_static == 0.3);
    scene =
        read_with(4, "material: {poisson: 0.3, plane: strain}\nmaterials: {pads: {poisson: 0.4}}");
    assert_int_equal(scene.material.plane, PLANE_STRAIN);
    scene = read_with(4, "material: {poisson: 0.5}\nmaterials: {pads: {poisson: 0.5}}");
    assert_int_equal(scene.material.plane, PLANE_STRESS);
}

TEST(test_si_units)
{
    static const char text[] =
        "units: si\n"
        "mesh: {file: /proc/b.msh, set: {length: 10 mm, nx: 4, name: \"3 kg\"}}\n"
        "material: {young: 3 GPa, poisson: 0.3, density: 1.2 g/cm3, eta1: 2 MPa s, eta2: 5}\n"
        "friction: {law: exponential-weakening, mu_static: 0.5, mu_kinetic: 0.2,\n"
        "           critical_velocity: 10um/s}\n"
        "load: {pressure: 3 kPa, tractions: [{group: side, x: -2 MPa}]}\n"
        "rod: {velocity: '100 um/s', height: 4 mm}\n"
        "time: {until: {U: 20 um, t: 3 ms}}\n";
    Scene scene;
    Error err = {0};
    if (!scene_of_text("s.yaml", text, &scene, &err)) fail_msg("%s", err.message);
    assert_string_equal(scene.mesh.file, "/proc/b.msh");
    assert_true(scene.mesh.parameters[0].value == 0.01);
    assert_string_equal(scene.mesh.parameters[2].text, "3 kg");
    assert_true(scene.material.young == 3e9 && scene.material.density == 1200);
    assert_true(scene.material.eta1 == 2e6 && scene.material.eta2 == 5);
    assert_true(scene.friction.critical_velocity == 1e-5);
    assert_true(scene.load.pressure == 3000 && scene.load.tractions[0].x == -2e6);
    assert_true(scene.rod.velocity == 1e-4 && scene.rod.height == 0.004);
    assert_true(scene.time.until_U == 2e-5 && scene.time.until_t == 0.003);
}

TEST(test_special_cases)
{
    Scene scene = read_with(5, "friction: {law: coulomb, mu_static: 0.4}");
    assert_true(scene.friction.mu_kinetic == 0.4);
    scene = read_with(0, "groups: {contact: base}");
    assert_int_equal(scene.groups.contact.count, 1);
    assert_string_equal(scene.groups.contact.name[0], "base");
    scene = read_with(0, "output: {figures: force}");
    assert_int_equal(scene.output.figures.count, 1);
    char text[SCENE_TEXT_MAX];
    scene_text_with(7, "rod: {kind: none}", text);
    char *until = strstr(text, "{U: 0.1}");
    until[1] = 't';
    Error err = {0};
    assert_true(scene_of_text("s.yaml", text, &scene, &err));
    assert_int_equal(scene.rod.kind, ROD_NONE);
    assert_string_equal(scene.mesh.file, "block.geo");   // the scene stands in this folder
}

TEST(test_public_face)
{
    Error err = {0};
    Scene *scene = NULL;
    const char *override = "title=Mine";
    assert_true(amontons_scene_read(fig1, &override, 1, &scene, &err));
    assert_string_equal(amontons_scene_title(scene), "Mine");
    amontons_scene_destroy(scene);
    assert_false(amontons_scene_read("/proc/none.yaml", NULL, 0, &scene, &err));
    assert_null(scene);
    amontons_scene_destroy(NULL);
}

TEST(test_memory_faults)
{
    static const char *const overrides[] = {"load.pressure=1", "output.figures=[force]"};
    int64_t live = memory_counters().live;
    bool done = false;
    for (int64_t k = 0; !done; k++) {
        assert_true(k < 400);
        Error err = {0};
        Scene *scene = NULL;
        memory_fail_after(k);
        done = amontons_scene_read(fig1, overrides, 2, &scene, &err);
        memory_fail_after(-1);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        amontons_scene_destroy(scene);
        assert_int_equal(memory_counters().live, live);
    }
}

static uint32_t next_random(uint32_t *random)
{
    *random = *random * 1664525u + 1013904223u;
    return *random >> 8;
}

// Whatever a text holds, reading ends with a scene or with ERROR_INPUT, and frees all.
TEST(test_mutated_scenes)
{
    static const char *const pieces[] = {"{",   "}",    "[",  "]",   ": ",  ",",   "-1", "1e999",
                                         "~",   "none", "\n", "\n ", "'",   "\"",  "#",  "&a ",
                                         "*a ", "!!x ", "|",  ">",   "nan", " Pa", "0",  "\xff"};
    enum { PIECES = sizeof pieces / sizeof pieces[0] };
    uint32_t random = 2013;
    int64_t live = memory_counters().live;
    char good[SCENE_TEXT_MAX];
    int32_t valid = 0;
    scene_text_with(
        0, "groups: {contact: [a, b]}\noutput: {fields: {every_U: 1}, figures: [force]}", good);
    for (int32_t k = 0; k < 4000; k++) {
        char text[2 * SCENE_TEXT_MAX];
        strcpy(text, good);
        for (int32_t i = 0; i <= k % 4; i++) {
            const char *piece = pieces[next_random(&random) % PIECES];
            size_t at = next_random(&random) % strlen(text), size = strlen(text);
            size_t cut = next_random(&random) % 4;
            if (at + cut > size) cut = 0;
            memmove(text + at + strlen(piece), text + at + cut, size - at - cut + 1);
            memcpy(text + at, piece, strlen(piece));
        }
        Scene scene;
        Error err = {0};
        bool done = scene_of_text("fuzz.yaml", text, &scene, &err);
        if (!done && err.code != ERROR_INPUT) fail_msg("%s\nof\n%s", err.message, text);
        valid += done;
    }
    assert_in_range(valid, 10, 3000);   // some mutations do no harm
    assert_int_equal(memory_counters().live, live);
}

FIXTURE(group_begin)
{
    snprintf(fig1, sizeof fig1, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    return 0;
}

GROUP_BETWEEN(group_begin, NULL);
