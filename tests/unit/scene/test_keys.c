// SPDX-License-Identifier: GPL-2.0-or-later
// The key table itself, and what is written by it: a scene written as JSON must read back as the
// same scene.
#include "base/memory.h"
#include "cases.h"
#include "scene/keys.h"
#include "scene_of_text.h"
#include "unit/scene/scene_texts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

TEST(test_every_key_is_complete)
{
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    assert_true(count > 40);
    for (int32_t k = 0; k < count; k++) {
        const SceneKey *key = &keys[k];
        char allowed[300];
        assert_int_equal(scene_key_index(key->name), k);   // no name twice
        assert_true(strlen(key->sentence) > 10);
        assert_int_equal(key->sentence[strlen(key->sentence) - 1], '.');
        assert_null(strchr(key->sentence, '|'));   // it stands in a Markdown table
        assert_true(key->offset < sizeof(Scene));
        assert_int_equal(key->type == KEY_CHOICE && !key->choices, 0);
        scene_key_allowed(key, allowed, sizeof allowed);
        assert_true(strlen(allowed) > 4);
        if (key->type != KEY_NUMBER || !key->standard) continue;
        if (!scene_range_holds(key->range, strtod(key->standard, NULL)))
            fail_msg("%s: the default %s is out of range", key->name, key->standard);
    }
}

// No two keys share a byte of the scene (but for output.fields, whose flag stands alone).
TEST(test_fields_do_not_overlap)
{
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    for (int32_t i = 0; i < count; i++)
        for (int32_t k = i + 1; k < count; k++) {
            if (keys[i].type == KEY_PARAMETERS || keys[k].type == KEY_PARAMETERS) continue;
            assert_int_not_equal(keys[i].offset, keys[k].offset);
        }
}

TEST(test_ranges)
{
    assert_true(scene_range_holds(RANGE_ANY, -1e300));
    assert_false(scene_range_holds(RANGE_ANY, NAN));
    assert_false(scene_range_holds(RANGE_ANY, INFINITY));
    assert_false(scene_range_holds(RANGE_POSITIVE, 0));
    assert_true(scene_range_holds(RANGE_NOT_NEGATIVE, 0));
    assert_false(scene_range_holds(RANGE_POISSON, -1));
    assert_true(scene_range_holds(RANGE_POISSON, 0.5));
    assert_true(scene_range_holds(RANGE_PART, 1));
    assert_false(scene_range_holds(RANGE_PART, 0));
    assert_true(scene_range_holds(RANGE_PART_OR_ZERO, 0));
}

TEST(test_groups_and_suggestions)
{
    assert_true(scene_key_is_group("material"));
    assert_true(scene_key_is_group("time.until"));
    assert_false(scene_key_is_group("mat"));
    assert_false(scene_key_is_group("material.young"));
    assert_string_equal(scene_key_nearest("meterial"), "material");
    assert_string_equal(scene_key_nearest("velocity"), "rod.velocity");
    assert_string_equal(scene_key_nearest("load.velocity"), "rod.velocity");
    assert_string_equal(scene_key_nearest("yuong"), "material.young");
    assert_null(scene_key_nearest("xyzzyxyzzy"));
}

TEST(test_reference_has_every_key)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    scene_write_reference(out);
    fclose(out);
    int32_t count = 0, lines = 0;
    const SceneKey *keys = scene_keys(&count);
    for (const char *c = text; *c; c++) lines += *c == '\n';
    assert_int_equal(lines, count + 2);
    for (int32_t k = 0; k < count; k++) {
        char cell[100];
        snprintf(cell, sizeof cell, "| `%s` |", keys[k].name);
        if (!strstr(text, cell)) fail_msg("%s is missing", cell);
        assert_non_null(strstr(text, keys[k].sentence));
    }
    free(text);
}

// --- run.json ---------------------------------------------------------------------------------

static char *read_all(const char *path)
{
    static char text[20000];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t size = fread(text, 1, sizeof text - 1, file);
    text[size] = 0;
    fclose(file);
    return text;
}

// Writes the scene and takes the object "scene" out of the document by its braces.
static char *scene_as_json(const Scene *scene, const char *path)
{
    Error err = {0};
    JsonWriter *json = json_create(path, &err);
    assert_non_null(json);
    json_begin_object(json, NULL);
    scene_write_json(scene, json, "scene", ".");
    json_integer(json, "after", 1);
    json_end(json);
    if (!json_finish(json, &err)) fail_msg("%s", err.message);
    char *text = read_all(path), *start = strstr(text, "\"scene\": ");
    char *end = strstr(text, "\"after\"");
    assert_non_null(start);
    assert_non_null(end);
    while (*end != ',') end--;
    *end = 0;
    return start + strlen("\"scene\": ");
}

static void assert_round_trip(const char *text)
{
    char folder[] = "/tmp/scene-json-XXXXXX", path[100];
    static Scene scene, again;
    Error err = {0};
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/run.json", folder);
    if (!scene_of_text("s.yaml", text, &scene, &err)) fail_msg("%s", err.message);
    char *json = scene_as_json(&scene, path);
    if (!scene_of_text("s.yaml", json, &again, &err)) fail_msg("%s\n%s", err.message, json);
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    for (int32_t k = 0; k < count; k++) {
        char before[1200], after[1200];
        scene_key_value(&keys[k], &scene, before, sizeof before);
        scene_key_value(&keys[k], &again, after, sizeof after);
        assert_string_equal(before, after);
        if (keys[k].type != KEY_NUMBER) continue;
        double stored = 0;
        memcpy(&stored, (const char *)&scene + keys[k].offset, sizeof stored);
        assert_true(strtod(before, NULL) == stored);   // no digit is lost in the text
    }
    memset(scene.given, 0, sizeof scene.given);
    memset(again.given, 0, sizeof again.given);
    memset(scene.line, 0, sizeof scene.line);   // two texts
    memset(again.line, 0, sizeof again.line);
    assert_memory_equal(&scene, &again, sizeof scene);
    unlink(path);
    rmdir(folder);
}

TEST(test_scenes_round_trip)
{
    char text[SCENE_TEXT_MAX];
    scene_text_with(1, "title: 'with \"quotes\" and \\ and é'", text);
    assert_round_trip(text);
    scene_text_with(0,
                    "groups: {top: lid, contact: [foot_1, foot_2]}\n"
                    "start: {friction: off, rod: held, tolerance: 0.1}\n"
                    "output: {history: true, fields: {every_t: 0.1, at_events: true},\n"
                    "         figures: [force, slip-map]}\n",
                    text);
    assert_round_trip(text);
    scene_text_with(5,
                    "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3,\n"
                    "  contacts: [{group: a, mu_static: 0.7, critical_velocity: 2e-3},\n"
                    "    {group: b, law: formula, formula: '0.3 + 0.1*exp(-v)', along: '1 + x'},\n"
                    "    {group: c, mu_kinetic: 0.1, along: '2'}]}\n"
                    "materials: {pads: {young: 4}, c: {}}",
                    text);
    assert_round_trip(text);
    scene_text_with(6,
                    "load: {pressure: 0.1, supports: [{group: a, direction: x},\n"
                    "  {group: b, direction: z}, {group: c, direction: both}]}\n",
                    text);
    assert_round_trip(text);
    scene_text_with(6,
                    "load: {pressure: 0.1, tractions: [{group: a, x: 1}, {group: b, z: -2}]}\n"
                    "output: {fields: {}}",
                    text);
    assert_round_trip(text);
    scene_text_with(5,
                    "friction: {law: coulomb, mu_static: 0.3333333333333333}\n"
                    "output: {history: false}",
                    text);
    assert_round_trip(text);
    assert_round_trip("units: si\nmesh: {file: a.msh, set: {shape: tri, nx: 7}}\n"
                      "material: {young: 1 GPa, poisson: 0.1, density: 1, eta1: 1, eta2: 1}\n"
                      "friction: {mu_static: 1, mu_kinetic: 1, critical_velocity: 1 um/s}\n"
                      "load: {pressure: 1 MPa}\nrod: {kind: none}\ntime: {until: {t: 1 ms}}\n");
}

// The nesting, against a text written by hand.
TEST(test_json_is_nested_as_the_scene)
{
    char text[SCENE_TEXT_MAX], folder[] = "/tmp/scene-json-XXXXXX", path[100];
    static Scene scene;
    Error err = {0};
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/run.json", folder);
    scene_text_with(0, "", text);
    assert_true(scene_of_text("s.yaml", text, &scene, &err));
    char *json = scene_as_json(&scene, path), compact[4000];
    size_t used = 0;
    for (char *c = json; *c; c++)
        if (*c != ' ' && *c != '\n') compact[used++] = *c;
    compact[used] = 0;
    static const char *const parts[] = {
        "\"mesh\":{\"file\":\"block.geo\",\"set\":{\"nx\":4},\"scale\":1},\"groups\":{",
        "\"load\":{\"pressure\":0.01,\"tractions\":[],\"supports\":[]}",
        "\"time\":{\"until\":{\"U\":0.1,\"t\":0,\"periodic\":false},\"scheme\":\"sdirk2\"",
        "\"output\":{\"history\":true,\"fields\":\"none\",\"figures\":[]}",
        "\"material\":{\"young\":1,\"poisson\":0.3,",
    };
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++)
        if (!strstr(compact, parts[k])) fail_msg("no %s in\n%s", parts[k], compact);
    unlink(path);
    rmdir(folder);
}
