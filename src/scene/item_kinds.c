// SPDX-License-Identifier: GPL-2.0-or-later
// The table of values that are lists or maps of maps (scene/keys).
#include "scene/keys.h"

static const SceneKey STRESS = {
    .type = KEY_NUMBER, .unit = "stress", .must_be_given = true, .total_unit = "force"};
static const SceneKey PLACE = {.type = KEY_NUMBERS, .unit = "length"};
static const SceneKey FORMULA = {.type = KEY_TEXT};
static const SceneKey DIRECTION = {
    .type = KEY_CHOICE, .choices = (const char *const[]){"x", "y", "z", "both", "all", NULL}};

// A word of an item of the type `of`, at `field`; with a key of its own; with a flag that says
// whether it is given.
#define PART(of, word_, field, ...)                                                                \
    {                                                                                              \
        .word = word_, .offset = offsetof(of, field), __VA_ARGS__                                  \
    }
#define OWN(of, field, ...) PART(of, #field, field, .key = __VA_ARGS__)
#define GIVEN(of, word, field, has) PART(of, word, field, .given = offsetof(of, has))
#define ITEMS(name, list, items)                                                                   \
    .most = sizeof((Scene *)0)->items / sizeof *((Scene *)0)->items,                               \
    .count = offsetof(Scene, list), .first = offsetof(Scene, items),                               \
    .size = sizeof *((Scene *)0)->items, .name_size = sizeof((Scene *)0)->items->name

#define ALONG(axis, k, ...)                                                                        \
    OWN(SceneTraction, axis, &STRESS, .is_total = offsetof(SceneTraction, is_total) + k,           \
        __VA_ARGS__)
static const ScenePart TRACTION[] = {
    ALONG(x, 0, .shown = true), ALONG(y, 1, .shown = false), ALONG(z, 2, .shown = true), {0}};
const SceneItems scene_traction_items = {
    ITEMS(group, load.traction_count, load.tractions), .noun = "a traction",
    .allowed = "a list of at most 32 maps {group: NAME, x: STRESS, z: STRESS}",
    .item = "{group: NAME, x: STRESS, z: STRESS}", .parts = TRACTION};

static const ScenePart SUPPORT[] = {OWN(SceneSupport, direction, &DIRECTION, .must = true,
                                        .given = offsetof(SceneSupport, has_direction)),
                                    {0}};
const SceneItems scene_support_items = {
    ITEMS(group, load.support_count, load.supports), .noun = "a support",
    .allowed = "a list of at most 32 maps {group: NAME, direction: x, z or both}",
    .item = "{group: NAME, direction: x, z or both}", .parts = SUPPORT};

static const ScenePart CONTACT[] = {
    GIVEN(SceneContactLaw, "law", kind, has_law),
    GIVEN(SceneContactLaw, "mu_static", mu_static, has_static),
    GIVEN(SceneContactLaw, "mu_kinetic", mu_kinetic, has_kinetic),
    GIVEN(SceneContactLaw, "critical_velocity", critical_velocity, has_critical),
    PART(SceneContactLaw, "formula", formula),
    PART(SceneContactLaw, "along", along),
    {0}};
const SceneItems scene_contact_items = {
    ITEMS(group, contact_laws.count, contact_laws.item),
    .like = "friction",
    .noun = "an item",
    .allowed = "a list of at most 16 maps {group: NAME, mu_static: NUMBER, ...}",
    .item = "{group: NAME, ...}",
    .parts = CONTACT};

static const ScenePart STATE[] = {OWN(FrictionStateText, rate, &FORMULA, .must = true),
                                  OWN(FrictionStateText, start, &FORMULA),
                                  {0}};
const SceneItems scene_state_items = {
    ITEMS(name, friction_keys.states.count, friction_keys.states.state),
    .named = true,
    .noun = "a state",
    .allowed = "a map of at most 8 maps, as in {theta: {rate: 1 - v*theta/D_c, start: 10}}",
    .item = "{rate: FORMULA, start: FORMULA}",
    .parts = STATE};

#define NUMBER(word, k) GIVEN(SceneMaterial, word, number[k], given[k])
static const ScenePart MATERIAL[] = {NUMBER("young", MATERIAL_YOUNG),
                                     NUMBER("poisson", MATERIAL_POISSON),
                                     NUMBER("density", MATERIAL_DENSITY),
                                     NUMBER("eta1", MATERIAL_ETA1),
                                     NUMBER("eta2", MATERIAL_ETA2),
                                     GIVEN(SceneMaterial, "relaxation", relaxation, has_relaxation),
                                     GIVEN(SceneMaterial, "from", from, has_from),
                                     {0}};
const SceneItems scene_material_items = {
    ITEMS(group, materials.count, materials.region),
    .named = true,
    .like = "material",
    .allowed = "a map of at most 16 maps, as in {pads: {young: 0.01, eta1: 0.1}}",
    .item = "for a region of that name, {young: 0.01, eta1: 0.1}",
    .parts = MATERIAL};

static const ScenePart PROBE[] = {
    OWN(SceneProbe, at, &PLACE, .must = true, .given = offsetof(SceneProbe, has_place)), {0}};
const SceneItems scene_probe_items = {
    ITEMS(name, output.probes.count, output.probes.probe),
    .named = true,
    .noun = "a probe",
    .allowed = "a map of at most 32 maps, as in {gauge1: {at: [0.3, 0.05]}}",
    .item = "{at: [x, z]}",
    .parts = PROBE};
