// SPDX-License-Identifier: GPL-2.0-or-later
// Studies that are none, or have too much of something, and words that are nearly right: what is
// refused, and where.
#include "study/sweep/reading/study.h"

#include "base/memory.h"
#include "result_place.h"

enum { TEXT_SIZE = 400000 };

static char place[PLACE_SIZE], path[2 * PLACE_SIZE], text[TEXT_SIZE];

// Reads the study `text` [with `count` words of --set].
static void assert_refused(const char *const *overrides, int32_t count, const char *says)
{
    Error err = {0};
    int64_t live = memory_counters().live;
    place_write(place, "study.yaml", text);
    Study *study = NEW_ARRAY(Study, 1, &err);
    Scene *scene = NEW_ARRAY(Scene, 1, &err);
    bool done = study_read(path, overrides, count, false, study, &err);
    for (int32_t k = 0; done && k < study->point_count; k++)
        done = study_scene(study, &(PointChoice){.point = k}, scene, &err);
    if (done || err.code != ERROR_INPUT || !strstr(err.message, says))
        fail_msg("%.300s: \"%s\" lacks \"%s\"", text, err.message, says);
    memory_free(scene);
    study_destroy(study);
    memory_free(study);
    assert_int_equal(memory_counters().live, live);
}

static void begin(const char *more)
{
    snprintf(text, sizeof text, "scene: %s/validation/paper/fig1.yaml\n%s",
             getenv("AMONTONS_SOURCE"), more);
}

// `format` with the numbers from 0 on, then `end`.
static void add_many(int32_t count, const char *format, const char *end)
{
    size_t used = strlen(text);
    for (int32_t k = 0; k < count; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, format, k);
    snprintf(text + used, sizeof text - used, "%s", end);
}

TEST(test_words)
{
    static const char *const known[][2] = {
        {"zzzzzzzzzz: 1\n", ":2:1: study: unknown key `zzzzzzzzzz`; allowed: title, scene"},
        {"keep: some\n", ":2:7: keep: found `some`; allowed: points, table"},
        {"keep: [table]\n", "allowed: points, table"},
        {"cases: []\n", "cases: found a list of 0"},
        {"record: []\n", "record: found a list of 0"},
        {"vary: {load.pressure: {log: [1, 2], points: 0}}\n", "points: found"},
        {"vary: {load.pressure: {log: [1, 2], points: 20000}}\n", "points: found"},
        {"vary: {load.pressure: {log: [1, 0], points: 3}}\n", "load.pressure: "},
        {"vary: {load.pressure: {linear: [1, b], points: 3}}\n", "two numbers"},
        {"vary: {load.pressure: {linear: 3, points: 3}}\n", "[from, to]"},
        {"vary: {load.pressure: {points: 3}}\n", "allowed: a list"},
        {"vary: {load.pressure: {linear: [1, 2], points: 3, step: 1}}\n",
         "unknown key `step`; allowed: log, linear, points"},
        {"rank: {by: mu_M, top: 1.5}\n", "top: found `1.5`"},
        {"rank: {by: mu_M, top: 2000}\n", "top: found `2000`"},
        {"rank: {by: mu_M, top: many}\n", "top: found `many`"},
        {"rank: {by: mu_M, against: [1]}\n", "against: found a list of 1"},
        {"rank: {by: mu_M, refine: soon}\n", "refine: found `soon`"},
        {"rank: {by: mu_M, refine: 0.5 s}\n", "refine: found `0.5 s`"},
        {"rank: {by: mu_M, refine: 0}\n", "refine: found `0`"},
        {"plot: {x: load, y: mu_M}\n", "x: unknown name `load`"},
        {"plot: {x: mesh.set.nx, y: mu_M}\n", "x: `mesh.set.nx` does not vary"},
        {"plot: {x: '', y: mu_M}\n", "x: found ``; allowed: a name or a formula"},
        {"plot: {x: mu_M}\n", "plot: `y` must be given"},
        {"plot: {x: mu_M, y: l_c, name: ranking}\n", "but not `ranking`"},
        {"plot: {x: mu_M, y: l_c, name: ''}\n", "name: found ``"},
        {"plot: {x: mu_M, y: l_c, name: a_b-c.png}\n", "a name of letters, digits, - and _"},
        {"vary: {load.pressure: {linear: [1, 2], log: [1, 2], points: 3}}\n", "allowed: a list"},
        {"vary: {load.pressure: [1]}\nset: {load: {pressure: 2}}\n", "again by `vary`"},
        {"vary: {materials.pads.young: [1]}\nset: {materials: {pads: {young: 2}}}\n",
         "again by `vary`"},
        {"vary: {load.pressure: [1]}\ncases: [{load.pressure: = 2 * rod.width}]\n",
         "again by `vary`"},
        {"plot: {x: mu_M, y: l_c, with: other}\n", "in `vary`, and as `series` of its plot"},
        {"vary: {rod.kind: [push]}\nplot: {x: mu_M, y: l_c, color: mu_hold, series: rod.kind}\n",
         "series: a map has none"},
    };
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        begin(known[k][0]);
        assert_refused(NULL, 0, known[k][1]);
    }
}

TEST(test_no_studies)
{
    Error err = {0};
    static char longer[700];
    snprintf(text, sizeof text, "- a list\n");
    assert_refused(NULL, 0, ":1:1: not a study: a study is a map of keys");
    snprintf(text, sizeof text, "title: nothing to vary\n");
    assert_refused(NULL, 0, "scene: must be given");
    snprintf(text, sizeof text, "scene: %0500d\n", 1);
    assert_refused(NULL, 0, "the path of the scene is longer than 511 bytes");
    snprintf(text, sizeof text, "scene: %0600d\n", 1);
    assert_refused(NULL, 0, "scene: found");
    Study *study = NEW_ARRAY(Study, 1, &err);
    memset(longer, 'x', 600);
    assert_false(study_read(longer, NULL, 0, false, study, &err));
    assert_non_null(strstr(err.message, "a path of more than 511 bytes"));
    study_destroy(study);
    memory_free(study);
}

TEST(test_too_many)
{
    static const char *words[300];
    static const struct {
        const char *first;
        int32_t count;
        const char *piece, *last, *said;
    } studies[] = {
        {"vary: {mesh.set: [{", 65, "p%d: 1, ", "}]}\n", "more than 64 keys vary"},
        {"record: [", 65, "results.r%d, ", "]\n", "a list of at most 64 names"},
        {"record: [", 64, "results.r%d, ", "]\nrank: {by: mu_M}\n", "by: more than 64 columns"},
        {"plot: [", 9, "{x: mu_M, y: l_c, name: p%d}, ", "]\n", "at most 8 plots"},
        {"vary: {", 17, "mesh.set.p%d: [1], ", "}\n", "vary: found a map of 17"},
        {"vary: {", 7, "mesh.set.p%d: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], ", "}\n",
         "more than 1000000 points"},
        {"set: {", 1, "mesh.set.p%0100d: 1", "}\n", "a key of more than"},
        {"set: {mesh.set: {", 40, "p%d: 1, ", "}}\n", "mesh.set"},
        {"vary: {load.pressure: [1]}\nset: {", 201, "mesh.set.p%d: 1, ", "}\n",
         "more than 200 settings for a point"},
        {"record: [results.", 60, "%03d", "]\n", "record: "},
        {"plot: {x: mu_M, y: ", 300, "l%d", "}\n", "not too long"}};
    for (size_t k = 0; k < sizeof studies / sizeof *studies; k++) {
        begin(studies[k].first);
        add_many(studies[k].count, studies[k].piece, studies[k].last);
        assert_refused(NULL, 0, studies[k].said);
    }
    begin("");
    for (int32_t k = 0; k < 300; k++) words[k] = "rod.width=1";
    assert_refused(words, 300, "settings by --set");
    words[0] = "one.more.an.override.whose.key.is.longer.than.any.key.of.a.scene.may.be.so.that.it."
               "cannot.be.one.of.them=1";
    assert_refused(words, 1, "wanted is key=value");
}

FIXTURE(make)
{
    place_make(place);
    snprintf(path, sizeof path, "%s/study.yaml", place);
    return 0;
}

FIXTURE(drop)
{
    place_remove(place);
    return 0;
}

GROUP_BETWEEN(make, drop);
