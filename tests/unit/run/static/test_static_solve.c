// SPDX-License-Identifier: GPL-2.0-or-later
// Equilibria whose answer is known without solving: uniform pressure, a block that nothing holds, a
// rod that slides the block, a base that lifts; and what happens when memory or the disk fails.
#include "amontons.h"
#include "base/memory.h"
#include "cases.h"
#include "scene/scene.h"
#include "scene_of_text.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TEXT_SIZE = 2000 };

// A 4 x 2 block, 1 x 0.5, E = 1, nu = 0.3, with `more` lines.
static Scene read_scene(const char *more)
{
    char text[TEXT_SIZE], path[TEXT_SIZE];
    const char *source = getenv("AMONTONS_SOURCE");
    Scene scene;
    Error err = {0};
    snprintf(path, sizeof path, "%s/validation/exact/test.yaml", source ? source : ".");
    snprintf(text, sizeof text,
             "mesh: {file: ../../meshes/block.geo, set: {nx: 4, nz: 2}}\n"
             "material: {poisson: 0.3}\n%s\n",
             more);
    if (!scene_of_text(path, text, &scene, &err)) fail_msg("%s", err.message);
    return scene;
}

static StaticSummary solve(const char *more)
{
    Scene scene = read_scene(more);
    StaticSummary summary;
    Error err = {0};
    if (!amontons_static(&scene, NULL, false, &summary, &err)) fail_msg("%s", err.message);
    assert_true(summary.residual < 1e-12 && summary.force_balance < 1e-12);
    assert_true(summary.moment_balance < 1e-12 && summary.energy_balance < 1e-11);
    assert_true(summary.complementarity < 1e-10);
    return summary;
}

static const char *const UNIFORM =
    "friction: {law: coulomb, mu_static: 0}\n"
    "load: {pressure: 0.01, supports: [{group: rod, direction: x}]}\n"
    "rod: {kind: none}";

TEST(test_uniform_pressure)
{
    StaticSummary summary = solve(UNIFORM);
    assert_int_equal(summary.nodes, 15);
    assert_int_equal(summary.contact_nodes, 5);
    assert_int_equal(summary.open, 0);
    assert_true(fabs(summary.normal_force - 0.01) < 1e-14);
    assert_true(fabs(summary.shear_force) < 1e-14);
    assert_true(fabs(summary.pressure_moment - 0.005) < 1e-14);
    assert_true(fabs(summary.elastic_energy - 0.5 * 1e-4 * 0.5) < 1e-15);   // P^2/(2 E) area
    assert_true(fabs(summary.load_work - 2 * summary.elastic_energy) < 1e-15);
    assert_true(isnan(summary.rod_height));
}

TEST(test_rod_slides_the_block)
{
    StaticSummary summary = solve("friction: {law: coulomb, mu_static: 0.2}\n"
                                  "load: {pressure: 0.01}\n"
                                  "rod: {displacement: 0.05, height: 0.25, width: 0.1}");
    assert_int_equal(summary.slipping, 5);
    assert_int_equal(summary.rod_nodes, 1);
    assert_true(fabs(summary.rod_force - 0.002) < 1e-13);   // mu N
    assert_true(fabs(summary.shear_force + 0.002) < 1e-13);
    assert_true(fabs(summary.rod_height - 0.25) < 1e-9);
    // moments about the origin: pressure on top, rod, contact
    assert_true(fabs(summary.pressure_moment - (0.01 * 0.5 + 0.002 * 0.25)) < 1e-11);
}

TEST(test_push_never_pulls)
{
    StaticSummary pushed = solve("friction: {law: coulomb, mu_static: 0.5}\n"
                                 "load: {pressure: 0.01}\n"
                                 "rod: {displacement: -0.01, height: 0.25, width: 0.1}");
    assert_true(pushed.rod_force == 0);
    StaticSummary glued =
        solve("friction: {law: coulomb, mu_static: 0.5}\n"
              "load: {pressure: 0.01}\n"
              "rod: {kind: bonded, displacement: -0.01, height: 0.25, width: 0.1}");
    assert_true(glued.rod_force < -1e-4);
}

TEST(test_cylinder_touches_in_the_middle)
{
    StaticSummary summary = solve("friction: {law: coulomb, mu_static: 0.2}\n"
                                  "contact: {gap: (x - 0.5)^2 / 20}\n"
                                  "load: {pressure: 0.01}\n"
                                  "rod: {kind: none}");
    assert_int_equal(summary.open,
                     2);   // Hertz: a = sqrt(4 P' R / (pi E)) = 0.36, nodes at 0.25, 0.5
    assert_true(fabs(summary.normal_force - 0.01) < 1e-12);
    assert_true(fabs(summary.pressure_moment - 0.005) < 1e-11);
}

TEST(test_nothing_holds)
{
    Scene scene = read_scene("friction: {law: coulomb, mu_static: 0.2}\n"
                             "load: {pressure: 0.01, tractions: [{group: top, x: 0.0021, z: 0}]}\n"
                             "rod: {kind: none}");
    StaticSummary summary;
    Error err = {0};
    assert_false(amontons_static(&scene, NULL, false, &summary, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_non_null(strstr(err.message, "is the block held"));
    RunSummary run;
    RunOptions options = {0};
    error_clear(&err);
    assert_false(amontons_run(&scene, &options, &run, &err));   // it says nothing of time
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "amontons static"));
}

TEST(test_unknown_support)
{
    Scene scene = read_scene("friction: {law: coulomb, mu_static: 0}\n"
                             "load: {pressure: 0.01, supports: [{group: lid, direction: x}]}\n"
                             "rod: {kind: none}");
    StaticSummary summary;
    Error err = {0};
    assert_false(amontons_static(&scene, NULL, false, &summary, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "lid"));
    assert_non_null(strstr(err.message, "leading"));
}

static void remove_results(const char *folder)
{
    static const char *const names[] = {"static.json", "static.h5", "static.vtu", "amontons.files"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        char path[TEXT_SIZE];
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        assert_int_equal(unlink(path), 0);
    }
    assert_int_equal(rmdir(folder), 0);   // nothing else was left
}

TEST(test_memory_faults)
{
    char folder[] = "/tmp/static-faults-XXXXXX";
    assert_non_null(mkdtemp(folder));
    Scene scene = read_scene(UNIFORM);
    StaticSummary summary;
    Error err = {0};
    int64_t live = memory_counters().live;
    bool done = false;
    for (int64_t k = 0; !done && k < 2000; k++) {
        error_clear(&err);
        memory_fail_after(k);
        done = amontons_static(&scene, folder, true, &summary, &err);
        memory_fail_after(-1);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
    }
    assert_true(done);
    remove_results(folder);
}

TEST(test_folder)
{
    char folder[] = "/tmp/static-folder-XXXXXX";
    assert_non_null(mkdtemp(folder));
    Scene scene = read_scene(UNIFORM);
    StaticSummary summary;
    Error err = {0};
    assert_true(amontons_static(&scene, folder, false, &summary, &err));
    assert_false(amontons_static(&scene, folder, false, &summary, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "--overwrite"));
    error_clear(&err);
    assert_true(amontons_static(&scene, folder, true, &summary, &err));
    remove_results(folder);
}
