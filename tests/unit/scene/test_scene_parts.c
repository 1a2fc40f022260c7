// SPDX-License-Identifier: GPL-2.0-or-later
// Bad scenes, as in test_scene_errors.c: laws of contact groups, regions, programs, windows, rods.
// Lines and columns were counted by hand.
#include "unit/scene/bad_scenes.h"

static const BadScene bad_parts[] = {
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [a]}",
     "s.yaml:5:81: friction.contacts: found `a`",
     {"a map {group: NAME, ...}"}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: "
     "''}]}",
     "s.yaml:5:89: friction.contacts.group: found ``",
     {"a name of 1 to 63 bytes"}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{law: "
     "coulomb}]}",
     "s.yaml:5:81: friction.contacts: an item needs its `group`",
     {0}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: a, "
     "formula: ''}]}",
     "s.yaml:5:101: friction.contacts.formula: found ``",
     {"a text"}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: a, "
     "mu: 1}]}",
     "s.yaml:5:92: friction.contacts: unknown key `mu`",
     {"critical_velocity, formula"}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: a, "
     "law: formula}]}",
     "s.yaml:5:81: friction.contacts: a: the law `formula` needs a formula",
     {0}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: a, "
     "formula: '1'}]}",
     "s.yaml:5:81: friction.contacts: a: the law `linear-weakening` does not read a formula",
     {0}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: a, "
     "law: table}]}",
     "s.yaml:5:81: friction.contacts: a: a table is for the whole contact",
     {0}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: a, "
     "mu_kinetic: 0.6}]}",
     "s.yaml:5:81: friction.contacts: a: mu_kinetic: 0.6 is more than mu_static (0.5)",
     {0}},
    {5,
     "friction: {law: coulomb, mu_static: 0.5, contacts: [{group: a, law: linear-weakening, "
     "mu_kinetic: 0.1}]}",
     "s.yaml:5:53: friction.contacts: a: critical_velocity: a weakening law needs it",
     {0}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: a, "
     "law: formula, formula: 'v('}]}",
     "s.yaml:5:81: friction.contacts: a: ",
     {0}},
    {4,
     "material: {poisson: 0.3, plane: strain}\nmaterials: {pads: {poisson: 0.5}}",
     "s.yaml:5:12: materials: pads.poisson: 0.5",
     {"less than 0.5"}},
    {4,
     "material: {poisson: 0.3}\nmaterials: {pads: 3}",
     "s.yaml:5:19: materials.pads: found `3`",
     {"a map for a region of that name"}},
    {4,
     "material: {poisson: 0.3}\nmaterials: {'': {young: 1}}",
     "s.yaml:5:13: materials: at most",
     {"names of 1 to 63 bytes"}},
    {0, "groups: {contact: top}", "s.yaml:9:19: groups.contact: `top` is groups.top as well", {0}},
    {7,
     "rod: {velocity: 1e-4, program: {t: [0], factor: [1]}}",
     "s.yaml:7:",
     {"rod.program.t: a program needs two points or more"}},
    {7,
     "rod: {velocity: 1e-4, program: {factor: [1]}}",
     "s.yaml:7:",
     {"a program needs two points or more"}},
    {7,
     "rod: {velocity: 1e-4, program: {repeat: true}}",
     "s.yaml:7:",
     {"a program needs two points or more"}},
    {7,
     "rod: {velocity: 1e-4, program: {t: [0, 0, 1], factor: [1, 1, 2]}}",
     "s.yaml:7:",
     {"rod.program.t: 0 stands twice: say what it begins with"}},
    {7,
     "rod: {velocity: 1e-4, program: {t: [0, 1, 1, 1], factor: [1, 1, 2, 3]}}",
     "s.yaml:7:",
     {"rod.program.t: 1 stands three times"}},
    {7,
     "rod: {kind: none, program: {t: [0, 1], factor: [1, 2]}}\ntime: {until: {t: 1}}",
     "s.yaml:",
     {"time"}},
    {6,
     "load: {pressure: 0.01, program: {t: [0], factor: [1]}}",
     "s.yaml:6:",
     {"load.program.t: a program needs two points"}},
    {8,
     "time: {until: {U: 0.1, slidings: 1.5}}",
     "s.yaml:8:",
     {"time.until.slidings: 1.5 is no whole number"}},
    {0,
     "output: {fields: {}, window: {from_t: 2, to_t: 1}}",
     "s.yaml:9:48: output.window.to_t: 1 is not more than from_t (2)",
     {0}},
    {0,
     "output: {figures: [field-strip]}",
     "s.yaml:9:",
     {"`field-strip` needs a sliding, which no run is sure to have"}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: 3}",
     "s.yaml:5:80: friction.contacts: found `3`",
     {"a list"}},
    {5,
     "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3, contacts: [{group: "
     "a2345678901234567890123456789012345678901234567890123456789012345}]}",
     "s.yaml:5:89: friction.contacts.group: found `a23",
     {"a name of 1 to 63 bytes"}},
    {1, "title: \"a\\tb\"", "s.yaml:1:8: title: found", {"a text of at most 511 bytes"}},
    {7, "rod: {velocity: 1e-4, program: {repeat: true}}", "s.yaml:", {"two points or more"}},
    {0, "output: {figures: [field]}", "s.yaml:9:", {"it needs output.fields"}},
    {0, "output: {fields: 3}", "s.yaml:9:18: output.fields: found `3`", {0}},
    {1,
     "a_key_that_is_longer_than_any_key_of_a_scene_could_ever_be_in_its_life_or_later_on: 1",
     "s.yaml:1:1: a_key_that_is",
     {"unknown key"}},
};

TEST(test_bad_parts)
{
    assert_all_bad(bad_parts, sizeof bad_parts / sizeof bad_parts[0]);
}

// Without a rod nothing can follow its way, or drive it.
TEST(test_without_a_rod)
{
    static const BadScene cases[] = {
        {0,
         "rod: {kind: none, program: {t: [0, 1], factor: [1, 2]}}",
         "s.yaml:7:19: rod.program",
         {"the scene has no rod"}},
        {0,
         "rod: {kind: none}\nload: {pressure: 0.01, program: {U: [0, 1], factor: [1, 2]}}",
         "s.yaml:8:",
         {"load.program.U: the scene has no rod", "give t"}},
        {0,
         "rod: {kind: none, stiffness: 1}",
         "s.yaml:7:",
         {"rod.stiffness: the scene has no rod"}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[SCENE_TEXT_MAX] = "";
        bool loads = strstr(cases[k].text, "load:") != NULL;
        for (int32_t i = 1; i <= 5; i++) strcat(strcat(text, scene_lines[i - 1]), "\n");
        strcat(strcat(text, loads ? "" : scene_lines[5]), loads ? "time: {until: {t: 1}}\n" : "\n");
        strcat(text, cases[k].text);
        if (!loads) strcat(text, "\ntime: {until: {t: 1}}");
        assert_bad(&cases[k], text);
    }
}
