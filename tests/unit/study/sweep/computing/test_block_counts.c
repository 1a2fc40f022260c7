// SPDX-License-Identifier: GPL-2.0-or-later
// Which points of a study step on one basis: those whose blocks differ in nothing that it depends
// on, in whatever order they come.
#include "study/sweep/computing/block_counts.h"

#include "near.h"

enum { POINTS = 12 };

// runs[k] of the point whose scene has the --set word `words`[k].
static void count(const char *const *words, int32_t points, int32_t *runs)
{
    Error err = {0};
    PointMesh mesh = {0};
    SweepPoint list[POINTS] = {0};
    char path[1000];
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    for (int32_t k = 0; k < points; k++) {
        Scene *scene = NULL;
        if (!amontons_scene_read(path, &words[k], 1, &scene, &err)) fail_msg("%s", err.message);
        assert_true(block_note(scene, &mesh, &list[k], &err));
        amontons_scene_destroy(scene);
    }
    assert_true(blocks_count(list, points, &err));
    for (int32_t k = 0; k < points; k++) runs[k] = list[k].runs;
}

TEST(test_what_makes_another_block)
{
    static const char *const words[] = {
        "mesh.set.nx=40",       "mesh.set.nx=60",
        "mesh.set.nx=40",       "material.poisson=0.3",
        "material.poisson=0.3", "mesh.set.nx=40",
        "rod.height=0.3",       "reduction.tolerance=1e-3",
        "material.eta2=2",      "load.tractions=[{group: leading, x: 1e-4}]"};
    static const int32_t wanted[] = {3, 1, 3, 2, 2, 3, 1, 1, 1, 1};
    int32_t runs[POINTS];
    count(words, 10, runs);
    assert_memory_equal(runs, wanted, sizeof wanted);
}

TEST(test_what_does_not)
{
    static const char *const words[] = {
        "load.pressure=0.001", "rod.velocity=1e-6",  "friction.mu_static=0.5",
        "time.until.U=0.1",    "output.fields=none", "material.density=3",
        "title=other",         "start.friction=off", "friction.law=exponential-weakening"};
    int32_t runs[POINTS];
    count(words, 9, runs);
    for (int32_t k = 0; k < 9; k++) assert_int_equal(runs[k], 9);
}
