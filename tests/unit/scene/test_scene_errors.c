// SPDX-License-Identifier: GPL-2.0-or-later
// Bad scenes: each error must stand at the right place and say what is wrong and what is allowed.
// Lines and columns were counted by hand.
#include "unit/scene/bad_scenes.h"

static const BadScene bad_values[] = {
    // unknown keys, with the nearest known one
    {4,
     "material: {poison: 0.3}",
     "s.yaml:4:12: material.poison: unknown key",
     {"did you mean `material.poisson`?"}},
    {4,
     "materials: {poisson: 0.3}",
     "s.yaml:4:22: materials.poisson: found `0.3`",
     {"a region", "of the whole block is `material.poisson`"}},
    {4,
     "materials: {pads: {poison: 0.3}}",
     "s.yaml:4:20: materials.pads: unknown key `poison`",
     {"allowed: young, poisson, density, eta1, eta2"}},
    {4,
     "materials: {pads: {plane: strain}}",
     "s.yaml:4:20: materials.pads: unknown key `plane`",
     {"the whole block", "material.plane"}},
    {4,
     "materials: {pads: {poisson: 0.7}}",
     "s.yaml:4:29: materials.pads.poisson: found `0.7`",
     {"a number > -1 and <= 0.5"}},
    {4, "materials: [pads]", "s.yaml:4:12: materials: found", {"as in {pads:"}},
    {1, "pressure: 0.1", "s.yaml:1:1: pressure: unknown key", {"did you mean `load.pressure`?"}},
    {8,
     "time: {until: {u: 0.1}}",
     "s.yaml:8:16: time.until.u: unknown key",
     {"did you mean `time.until.U`?"}},
    {1, "zzzzzzzz: 1", "s.yaml:1:1: zzzzzzzz: unknown key (`amontons info keys`", {0}},
    {0, "output: {fields: {every: 1}}", "s.yaml:9:19: output.fields.every: unknown key", {0}},
    {1, "1: 2", "s.yaml:1:1: 1: unknown key", {0}},
    // keys of earlier versions
    {4,
     "contact: {radius: 3}",
     "s.yaml:4:11: contact.radius: this key of an earlier version is gone",
     {"`contact.gap: \"(x - X)^2 / (2 * R)\"`"}},
    {0,
     "output: {fields: {}, window: {around: sliding 3}}",
     "s.yaml:9:31: output.window.around: this key of an earlier version is gone",
     {"runs repeat to the bit", "run again with from_U and to_U"}},
    {0,
     "output: {fields: {}, window: {last: 2 slidings}}",
     "s.yaml:9:31: output.window.last: this key of an earlier version is gone",
     {"U_start and U_stop"}},
    // wrong types
    {4,
     "material: {poisson: abc}",
     "s.yaml:4:21: material.poisson: found `abc`",
     {"allowed: a number > -1 and <= 0.5", "    4 | material: {poisson: abc}",
      "      |                     ^"}},
    {4, "material: {poisson: [0.3]}", "s.yaml:4:21: ", {"found a list of 1", "allowed: a number"}},
    {4, "material: {poisson: {a: 1}}", "s.yaml:4:21: ", {"found a map of 1 keys"}},
    {4, "material: {poisson: }", "s.yaml:4:12: material.poisson: found nothing", {0}},
    {4, "material: 3", "s.yaml:4:11: material: found `3`; allowed: a map of keys", {0}},
    {4, "material: [poisson]", "s.yaml:4:11: material: found a list of 1", {0}},
    {1, "title: [a]", "s.yaml:1:8: title: found a list of 1; allowed: a text", {0}},
    {3, "mesh: {file: {a: b}}", "s.yaml:3:14: mesh.file", {"a text of at most 511 bytes"}},
    {3, "mesh: {file: b.geo, set: 3}", "s.yaml:3:26: mesh.set: found `3`", {"a map of at most 32"}},
    {3, "mesh: {file: b.geo, set: {nx: [1]}}", "s.yaml:3:31: mesh.set: found a list", {0}},
    {0,
     "output: {history: 1}",
     "s.yaml:9:19: output.history: found `1`",
     {"allowed: true or false"}},
    {0, "output: {history: yes}", "s.yaml:9:19: output.history: found `yes`", {0}},
    {0,
     "output: {fields: some}",
     "s.yaml:9:18: output.fields: found `some`",
     {"none, film, or a map of every_U, every_t, every_step, at_events, film"}},
    {0,
     "output: {fields: {}, window: {from_U: 0.2, to_U: 0.1}}",
     "s.yaml:9:50: output.window.to_U: 0.1 is not more than from_U (0.2)",
     {0}},
    {0,
     "output: {window: {from_t: 5}}",
     "s.yaml:9:10: output.window: nothing is written in it",
     {"{every_step: true}", "history: true"}},
    {0,
     "output: {history: false, window: {from_t: 5, history: true}}",
     "s.yaml:9:55: output.window.history: output.history is false",
     {0}},
    {0,
     "output: {window: {form_t: 5}}",
     "s.yaml:9:19: output.window.form_t: unknown key; did you mean `output.window.from_t`?",
     {0}},
    {0, "groups: {top: ''}", "s.yaml:9:15: groups.top: found ``", {"a name of 1 to 63 bytes"}},
    {0,
     "groups: {contact: {a: b}}",
     "s.yaml:9:19: groups.contact: found a map",
     {"a name or a list of at most 32 names"}},
    // numbers
    {6, "load: {pressure: .inf}", "s.yaml:6:18: load.pressure: found `.inf`", {0}},
    {6, "load: {pressure: .nan}", "s.yaml:6:18: load.pressure: found `.nan`", {0}},
    {6, "load: {pressure: inf}", "s.yaml:6:18: load.pressure: found `inf`", {0}},
    {6, "load: {pressure: nan}", "s.yaml:6:18: load.pressure: found `nan`", {0}},
    {6, "load: {pressure: 1e400}", "s.yaml:6:18: load.pressure: found `1e400`", {0}},
    {6, "load: {pressure: 0x10}", "s.yaml:6:18: load.pressure: found `0x10`", {0}},
    {6,
     "load: {pressure: -0.1}",
     "s.yaml:6:18: load.pressure: found `-0.1`",
     {"allowed: a number >= 0"}},
    {6, "load: {pressure: 1 2}", "s.yaml:6:18: load.pressure: found `1 2`, with a unit", {0}},
    {6,
     "load: {pressure: 3 kPa}",
     "s.yaml:6:18: load.pressure: found `3 kPa`, with a unit",
     {"normalised", "`units: si`"}},
    {4, "material: {poisson: 0.6}", "s.yaml:4:21: material.poisson: found `0.6`", {0}},
    {4, "material: {poisson: -1}", "s.yaml:4:21: material.poisson: found `-1`", {0}},
    {4,
     "material: {poisson: 0.3, young: 0}",
     "s.yaml:4:33: material.young: found `0`",
     {"allowed: a number > 0"}},
    {4, "material: {poisson: 0.3, density: -1}", "s.yaml:4:35: material.density", {0}},
    {4, "material: {poisson: 0.3, eta1: -1}", "s.yaml:4:32: material.eta1", {0}},
    {7, "rod: {velocity: 0}", "s.yaml:7:17: rod.velocity: found `0`; allowed: a number > 0", {0}},
    {7, "rod: {velocity: 1, width: -1}", "s.yaml:7:27: rod.width", {0}},
    {8,
     "time: {until: {U: 0.1}, tolerance: 2}",
     "s.yaml:8:36: time.tolerance",
     {"a number from 0 to 1"}},
    {3, "mesh: {file: b.geo, set: {nx: 1e999}}", "s.yaml:3:31: mesh.set: found `1e999`", {0}},
    {6,
     "load: {pressure: 1, tractions: [{group: a, z: -1e999}]}",
     "s.yaml:6:47: load.tractions.z: found `-1e999`",
     {0}},
    // choices
    {2,
     "units: SI",
     "s.yaml:2:8: units: found `SI`, did you mean `si`?",
     {"one of normalised, si"}},
    {2, "units: metric", "s.yaml:2:8: units: found `metric`; allowed: one of normalised, si", {0}},
    {7,
     "rod: {velocity: 1, kind: pull}",
     "s.yaml:7:26: rod.kind: found `pull`",
     {"one of push, bonded, none"}},
    {0,
     "start: {friction: no}",
     "s.yaml:9:19: start.friction: found `no`, did you mean `off`?",
     {"one of off, on"}},
    {0,
     "start: {friction: Yes}",
     "s.yaml:9:19: start.friction: found `Yes`, did you mean `on`?",
     {"one of off, on"}},
    {0,
     "output: {figures: [force, slipmap]}",
     "s.yaml:9:27: output.figures: found `slipmap`",
     {"did you mean `slip-map`?", "a list of: force, slip-map, contact-density"}},
    {0,
     "output: {figures: [force, force]}",
     "s.yaml:9:27: output.figures: `force` stands twice",
     {0}},
    {0, "load: {pressure: 1}", "s.yaml:9:1: the key `load` stands twice (first in line 6)", {0}},
    // supports
    {6,
     "load: {pressure: 1, supports: [{direction: x}]}",
     "s.yaml:6:32: load.supports",
     {"a support needs its `group`"}},
    {6,
     "load: {pressure: 1, supports: [{group: a}]}",
     "s.yaml:6:32: load.supports",
     {"a support needs its `direction`"}},
    {6,
     "load: {pressure: 1, supports: [{group: a, direction: w}]}",
     "s.yaml:6:54: load.supports.direction: found `w`",
     {"one of x, y, z, both, all"}},
    {6,
     "load: {pressure: 1, supports: [{group: a, side: x}]}",
     "s.yaml:6:43: load.supports: unknown key `side`",
     {"allowed: group, direction"}},
    {6,
     "load: {pressure: 1, supports: top}",
     "s.yaml:6:31: load.supports: found `top`",
     {"a list of at most 32 maps"}},
    // tractions
    {6,
     "load: {pressure: 1, tractions: [{x: 1}]}",
     "s.yaml:6:33: load.tractions",
     {"a traction needs its `group`"}},
    {6,
     "load: {pressure: 1, tractions: [{group: a, w: 1}]}",
     "s.yaml:6:44: load.tractions",
     {"unknown key `w`", "group, x, y, z"}},
    {6,
     "load: {pressure: 1, tractions: [{group: a, x: b}]}",
     "s.yaml:6:47: load.tractions.x",
     {"allowed: a number"}},
    {6,
     "load: {pressure: 1, tractions: {group: a}}",
     "s.yaml:6:32: load.tractions: found a map",
     {0}},
    {6, "load: {pressure: 1, tractions: [a]}", "s.yaml:6:33: load.tractions: found `a`", {0}},
};

static const BadScene bad_combinations[] = {
    {3, "mesh: {set: {nx: 4}}", "s.yaml:3:1: mesh.file: missing", {"The mesh: a .msh file"}},
    {3, "", "s.yaml:1:1: mesh.file: missing", {0}},
    {4, "", "s.yaml:1:1: material.poisson: missing; allowed: a number > -1", {0}},
    {6, "", "s.yaml:1:1: load.pressure: missing", {0}},
    {6, "load:", "s.yaml:6:1: load.pressure: missing", {0}},
    {7, "", "s.yaml:1:1: rod.velocity: missing", {0}},
    {8, "", "s.yaml:1:1: time.until: says not when to stop", {"{U: LENGTH}", "{t: TIME}"}},
    {8, "time: {until: {periodic: true}}", "s.yaml:8:8: time.until: says not when", {0}},
    {8, "time: {until: {U: 0}}", "s.yaml:8:8: time.until: says not when", {0}},
    {5,
     "friction: {mu_static: 0.1, mu_kinetic: 0.2, critical_velocity: 1}",
     "s.yaml:5:40: friction.mu_kinetic: 0.2 is more than mu_static (0.1)",
     {0}},
    {5,
     "friction: {mu_static: 0.5, critical_velocity: 1}",
     "s.yaml:5:1: friction.mu_kinetic: missing",
     {0}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2}",
     "s.yaml:5:1: friction.critical_velocity: a weakening law needs it",
     {"a number > 0"}},
    {5,
     "friction: {law: coulomb, mu_static: 0.5, mu_kinetic: 0.2}",
     "s.yaml:5:54: friction.mu_kinetic: the law `coulomb` has one coefficient",
     {0}},
    {4,
     "material: {poisson: 0.5, plane: strain}",
     "s.yaml:4:21: material.poisson: 0.5",
     {"plane strain needs less than 0.5"}},
    {6, "load: {pressure: 0}", "s.yaml:6:18: load.pressure: 0, and no load.tractions", {0}},
    {7, "rod: {kind: none}", "s.yaml:8:19: time.until.U: the scene has no rod", {0}},
    {8,
     "time: {until: {U: 1}, step_max: 1e-3, step_min: 1e-2}",
     "s.yaml:8:49: time.step_min",
     {"0.01 is more than step_max (0.001)"}},
    {0, "groups: {rod: top}", "s.yaml:9:15: groups.rod: `top` is groups.top as well", {0}},
    {0,
     "groups: {contact: [a, rod]}",
     "s.yaml:9:19: groups.contact: `rod` is groups.rod as well",
     {0}},
    {0,
     "output: {history: false, figures: [force]}",
     "s.yaml:9:35: output.figures: pictures are",
     {"output.history: true"}},
    {2, "units: si", "s.yaml:4:1: material.young: missing, which an SI scene must give", {0}},
};

static const BadScene bad_units[] = {
    {6,
     "load: {pressure: 3 um/s}",
     "s.yaml:6:18: load.pressure: found `3 um/s`",
     {"`um/s` is no unit of stress", "allowed: Pa, kPa, MPa, GPa"}},
    {6, "load: {pressure: 3 kpa}", "s.yaml:6:18: ", {"`kpa` is no unit of stress"}},
    {7,
     "rod: {velocity: 1 m}",
     "s.yaml:7:17: ",
     {"`m` is no unit of velocity", "m/s, mm/s, um/s; divide it by a time"}},
    {6,
     "load: {pressure: 3 kN}",
     "s.yaml:6:18: ",
     {"divide it by an area (that of groups.top", "`load.force`"}},
    {6, "load: {force: 3 kN/m}", "s.yaml:6:15: ", {"multiply it by a length", "`thickness`"}},
    {6,
     "load: {force: 3 kN, pressure: 3}",
     "s.yaml:6:15: load.force: give either this or load.pressure",
     {0}},
    {7,
     "rod: {velocity: 1 m/s, stiffness: 1 kN}",
     "s.yaml:7:35: ",
     {"GPa, N/m, kN/m, N/mm; divide it by"}},
    {7, "rod: {velocity: 1 m/s/s}", "s.yaml:7:17: ", {"no unit of velocity"}},
    {7, "rod: {velocity: -1 m/s}", "s.yaml:7:17: rod.velocity: found `-1 m/s`", {"> 0"}},
    {7, "rod: {velocity: 1 m/s, height: 1 s}", "s.yaml:7:32: ", {"m, mm, um"}},
    {8, "time: {until: {t: 1 d}}", "s.yaml:8:19: ", {"`d` is no unit of time", "s, ms, us"}},
    {8, "time: {until: {t: 1}, tolerance: 1 s}", "s.yaml:8:34: ", {"this number has no unit"}},
    {3, "mesh: {file: a.geo, set: {nx: 4 kg}}", "s.yaml:3:31: ", {"`kg` is no unit of length"}},
};

TEST(test_bad_values)
{
    assert_all_bad(bad_values, sizeof bad_values / sizeof bad_values[0]);
}

TEST(test_bad_combinations)
{
    assert_all_bad(bad_combinations, sizeof bad_combinations / sizeof bad_combinations[0]);
}

// The good scene in SI differs in its lines 2 and 4.
TEST(test_bad_units)
{
    for (size_t k = 0; k < sizeof bad_units / sizeof bad_units[0]; k++) {
        char text[SCENE_TEXT_MAX] = "";
        for (int32_t i = 1; i <= SCENE_LINES; i++) {
            const char *line = scene_lines[i - 1];
            if (i == 2) line = "units: si";
            if (i == 4) line = "material: {poisson: 0.3, young: 1, density: 1, eta1: 1, eta2: 1}";
            if (i == bad_units[k].line) line = bad_units[k].text;
            strcat(strcat(text, line), "\n");
        }
        assert_bad(&bad_units[k], text);
    }
}

TEST(test_not_scenes)
{
    static const BadScene cases[] = {
        {0, "", "s.yaml:1:1: the scene is empty", {"a map of keys"}},
        {0, "# a comment\n", "s.yaml:2:1: the scene is empty", {0}},
        {0, "just words", "s.yaml:1:1: not a scene", {0}},
        {0, "- a\n- b\n", "s.yaml:1:1: not a scene", {0}},
        {0, "a: [1", "s.yaml:1:", {"not YAML"}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        assert_bad(&cases[k], cases[k].text);
}

TEST(test_lists_that_are_too_long)
{
    char line[3000] = "groups: {contact: [";
    for (int i = 0; i < 33; i++) snprintf(line + strlen(line), 20, "c%d, ", i);
    strcat(line, "]}");
    char text[SCENE_TEXT_MAX];
    scene_text_with(0, line, text);
    BadScene bad = {0, line, "s.yaml:9:", {"at most 32 names"}};
    assert_bad(&bad, text);
    strcpy(line, "mesh: {file: a.geo, set: {");
    for (int i = 0; i < 33; i++) snprintf(line + strlen(line), 20, "p%d: 1, ", i);
    strcat(line, "}}");
    scene_text_with(3, line, text);
    bad = (BadScene){3, line, "s.yaml:3:", {"at most 32 parameters"}};
    assert_bad(&bad, text);
    static const struct {
        const char *begin, *each, *end;
        int32_t count, replaced;
        const char *says;
    } lists[] = {
        {"rod: {velocity: 1, program: {t: [", "%d, ", "], factor: [1, 1]}}", 200, 7,
         "rod.program.t"},
        {"load: {pressure: 1, supports: [", "{group: g%d, direction: x}, ", "]}", 33, 6,
         "at most 32 maps"},
        {"load: {pressure: 1, tractions: [", "{group: g%d, x: 1}, ", "]}", 33, 6,
         "at most 32 maps"},
        {"friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1, contacts: [",
         "{group: g%d, along: '2'}, ", "]}", 17, 5, "a list of 17; allowed: a list of at most 16"},
        {"materials: {", "m%d: {young: 1}, ", "}", 40, 0,
         "materials: found a map of 40 keys; allowed: a map of at most 16"},
        {"groups: {top: a", "%d", "}", 60, 0, "a name of 1 to 63 bytes"},
        {"mesh: {set: {p", "%d", ": 1}, file: a.msh}", 60, 3, "names of 1 to 63 bytes"},
    };
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        strcpy(line, lists[k].begin);
        for (int i = 0; i < lists[k].count; i++)
            snprintf(line + strlen(line), 40, lists[k].each, i);
        strcat(line, lists[k].end);
        scene_text_with(lists[k].replaced, line, text);
        bad = (BadScene){lists[k].replaced, line, "s.yaml:", {lists[k].says}};
        assert_bad(&bad, text);
    }
    snprintf(line, sizeof line, "title: %0600d", 1);
    scene_text_with(1, line, text);
    bad = (BadScene){1, line, "s.yaml:1:8: title", {"at most 511 bytes"}};
    assert_bad(&bad, text);
}

TEST(test_bad_files)
{
    static Scene scene;
    static const struct {
        const char *path, *words;
    } cases[] = {{"/tmp", "/tmp is a folder"},
                 {"/tmp/no-such-scene.yaml", "No such file"},
                 {"/bin/true", "not a text file"}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Error err = {0};
        assert_false(scene_read(cases[k].path, NULL, 0, false, &scene, &err));
        if (err.code != ERROR_INPUT || !strstr(err.message, cases[k].words))
            fail_msg("%s", err.message);
    }
    char path[1500], text[SCENE_TEXT_MAX];
    Error err = {0};
    snprintf(path, sizeof path, "%s/validation/paper/", getenv("AMONTONS_SOURCE"));
    for (int k = 0; k < 260; k++) strcat(path, "./");
    strcat(path, "fig1.yaml");
    assert_false(scene_read(path, NULL, 0, false, &scene, &err));
    assert_non_null(strstr(err.message, "a path of more than 511 bytes"));
    snprintf(path, sizeof path, "mesh: {file: %0500d.msh}", 1);
    scene_text_with(3, path, text);
    err = (Error){0};
    assert_false(scene_of_text("a_folder/s.yaml", text, &scene, &err));
    if (!strstr(err.message, "is longer than 511 bytes")) fail_msg("%s", err.message);
    snprintf(path, sizeof path, "%0100d: 1", 1);
    scene_text_with(1, path, text);
    err = (Error){0};
    assert_false(scene_of_text("s.yaml", text, &scene, &err));
    if (!strstr(err.message, "unknown key")) fail_msg("%s", err.message);
}

TEST(test_too_many_overrides)
{
    static const char *words[20000];
    static Scene scene;
    char path[600];
    Error err = {0};
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    for (int k = 0; k < 20000; k++) words[k] = "rod.width=0.1";
    assert_false(scene_read(path, words, 20000, false, &scene, &err));
    if (!strstr(err.message, "settings of keys")) fail_msg("%s", err.message);
}

TEST(test_bad_overrides)
{
    static const struct {
        const char *text, *place, *words;
    } cases[] = {
        {"load.pressure=abc", "--set load.pressure:1:15: load.pressure: found `abc`", "a number"},
        {"load.presure=1", "--set load.presure:1:1: load.presure: unknown key", "`load.pressure`"},
        {"contact.radius=3", "--set contact.radius:1:1: contact.radius: ", "`contact.gap: "},
        {"time.until.U== 6*load.presure",
         "--set time.until.U:1:14: time.until.U: ", "load.presure"},
        {"time.until.U== 0 - 1", "--set time.until.U:1:14: time.until.U: found `-1`",
         "time.until.U== 0 - 1"},
        {"load.pressure", "--set load.pressure: wanted is key=value", "load.pressure=0.006"},
        {"=1", "--set =1: wanted is key=value", ""},
        {"load.pressure=", "--set load.pressure:1:15: load.pressure: found nothing", ""},
        {"load.pressure=1 kPa", "--set load.pressure:1:15: ", "with a unit"},
        {"output.figures=[force", "--set output.figures:1:", "not YAML"},
        {"load=3", "--set load:1:6: load: found `3`; allowed: a map of keys", ""},
        {"load={presure: 3}", "--set load:1:7: load.presure: unknown key", "load.pressure"},
        {"material={young: 2}", "", "material.poisson: missing"},
        {"mesh.set.=3", "--set mesh.set.:1:1: ", "names of 1 to 63 bytes"},
        {"rod.kind=pusch", "--set rod.kind:1:10: ", "did you mean `push`?"},
        {"friction.mu_kinetic=2", "--set friction.mu_kinetic:1:21: ", "more than mu_static (0.38)"},
        {"output=[1", "--set output:1:", "not YAML"},
        {"materials.pads.young=-1", "--set materials.pads.young:1:", "a number > 0"},
        {"materials.pads.yung=1", "--set materials.pads.yung:1:", "unknown key"},
        {"rod.program.t=[0, a]", "--set rod.program.t:1:", "found"},
        {"output.figures=force\nslip-map", "--set output.figures:1:", "found"},
        {"materials.pads=3", "--set materials.pads:1:", "materials"},
        {"a.key.that.is.longer.than.any.key.of.a.scene.may.be.so.that.it.cannot.be.one.at.all.=1",
         "--set a.key", ""},
        {"a.key.of.a.scene.has.at.most.95.bytes.so.that.one.of.100.and.more.is.no.key=and.what."
         "looks."
         "like.one=1",
         "--set a.key", "unknown key"},
    };
    char path[600];
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        static Scene scene;
        Error err = {0};
        assert_false(scene_read(path, &cases[k].text, 1, false, &scene, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (strncmp(err.message, cases[k].place, strlen(cases[k].place)) != 0 ||
            !strstr(err.message, cases[k].words))
            fail_msg("%s gave\n%s", cases[k].text, err.message);
    }
}
