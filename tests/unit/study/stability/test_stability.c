// SPDX-License-Identifier: GPL-2.0-or-later
// The path on coarse meshes: what it finds against the dynamic run of the same scene, against the
// full mesh, and what it refuses; every allocation that fails.
#include "amontons_stability.h"

#include "base/memory.h"
#include "near.h"

#include <unistd.h>

enum { OVERRIDES_MAX = 12 };

static Scene *read_scene(const char *const *more, int32_t count)
{
    Error err = {0};
    Scene *scene = NULL;
    char path[600];
    const char *overrides[OVERRIDES_MAX] = {"output.figures=[]", "output.fields=none",
                                            "output.history=false", "reduction.cache=false"};
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    for (int32_t k = 0; k < count; k++) overrides[4 + k] = more[k];
    if (!amontons_scene_read(path, overrides, 4 + count, &scene, &err)) fail_msg("%s", err.message);
    return scene;
}

typedef struct Seen {
    int32_t count;
    StabilityPoint first, last;
    bool ascending;   // more slips each time, U never falls
} Seen;

static void see_point(const StabilityPoint *point, void *context)
{
    Seen *seen = context;
    if (seen->count == 0)
        seen->first = *point;
    else
        seen->ascending &= point->slipping > seen->last.slipping && point->U >= seen->last.U;
    seen->last = *point;
    seen->count++;
}

static StabilitySummary follow(const Scene *scene, StabilityOptions options, Seen *seen)
{
    Error err = {0};
    StabilitySummary summary;
    *seen = (Seen){.ascending = true};
    options.on_point = see_point;
    options.context = seen;
    if (!amontons_stability(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    return summary;
}

TEST(test_against_dynamics)
{
    Error err = {0};
    const char *settings[] = {"mesh.set.nx=20", "mesh.set.nz=20", "load.pressure=0.006",
                              "time.until={U: 0.01}"};
    Scene *scene = read_scene(settings, 4);
    RunSummary run;
    RunOptions silent = {0};
    if (!amontons_run(scene, &silent, &run, &err)) fail_msg("%s", err.message);
    Seen seen;
    StabilitySummary found = follow(scene, (StabilityOptions){.slidings = 2}, &seen);
    assert_near("element", found.element, 1. / 20, 1e-12);
    assert_near("l_c at V against the dynamics", found.l_c_rod, run.critical_length, 1. / 20);
    // An element is worth 0.014 of mu here.
    assert_near("mu_M against the dynamics", found.mu_rod, run.mu_M, 0.014);
    // The certificate neglects how pressure couples: lost within an element of the exact l_sc.
    assert_near("certificate", found.l_sc_certificate, found.l_sc, 1. / 20);
    assert_true(found.l_sc < found.l_c_rod && found.l_c_rod <= found.l_c);
    assert_near("scan", found.l_c_scan, found.l_c, 1.5 / 20);
    assert_true(found.mu_rod <= found.mu_c && found.U_rod <= found.U_c);
    assert_true(found.frequency > 0);

    assert_true(seen.ascending && seen.count == found.points);
    assert_true(seen.first.certified && seen.first.rate_re < 0 && seen.first.real_rate == 0);
    assert_true(!seen.last.certified && seen.last.load > 1);
    assert_near("the real rate is the rightmost", seen.last.real_rate, seen.last.rate_re, 0);
    assert_true(seen.last.front < 0.6);   // it stopped soon after l_c
    StabilityOptions whole = {.slidings = 2, .whole = true};
    StabilitySummary again = follow(scene, whole, &seen);
    assert_near("the end of the block", seen.last.front, 1, 1e-9);
    assert_near("the same l_c", again.l_c, found.l_c, 0);
    amontons_scene_destroy(scene);
}

// Full mesh and reduced basis give the same; a bonded rod and a block that crosses before it grows.
TEST(test_full_and_reduced)
{
    const char *settings[] = {"mesh.set.nx=10", "mesh.set.nz=10", "reduction.use=never",
                              "rod.kind=bonded"};
    Seen seen;
    Scene *full = read_scene(settings, 4);
    StabilitySummary wanted = follow(full, (StabilityOptions){0}, &seen);
    settings[2] = "reduction.use=always";
    Scene *reduced = read_scene(settings, 4);
    StabilitySummary found = follow(reduced, (StabilityOptions){0}, &seen);
    assert_near("l_sc", found.l_sc, wanted.l_sc, 2e-3);
    assert_near("l_c", found.l_c, wanted.l_c, 2e-3);
    assert_near("mu", found.mu_c, wanted.mu_c, 1e-3);
    assert_near("frequency", found.frequency, wanted.frequency, 1e-2 * wanted.frequency);
    amontons_scene_destroy(full);
    amontons_scene_destroy(reduced);

    settings[2] = "load.pressure=1e-4";
    Scene *light = read_scene(settings, 4);
    found = follow(light, (StabilityOptions){0}, &seen);
    assert_true(isnan(found.l_sc) && isnan(found.l_sc_certificate) && isnan(found.l_c_scan));
    assert_near("it slides when all of it slips", found.l_c, 1, 1e-9);
    assert_near("against friction mu_S", found.mu_c, 0.38, 1e-3);
    amontons_scene_destroy(light);
}

static void assert_refused(const char *setting, const char *until, int32_t slidings,
                           const char *wanted)
{
    Error err = {0};
    StabilitySummary summary;
    const char *settings[] = {"mesh.set.nx=6", "mesh.set.nz=6", setting, until};
    Scene *scene = read_scene(settings, 4);
    StabilityOptions options = {.slidings = slidings};
    int64_t live = memory_counters().live;
    assert_false(amontons_stability(scene, &options, &summary, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, wanted)) fail_msg("no `%s` in: %s", wanted, err.message);
    assert_int_equal(memory_counters().live, live);
    amontons_scene_destroy(scene);
}

TEST(test_refusals)
{
    assert_refused("rod.kind=none", "time.until={t: 5}", 0, "rod.kind");
    assert_refused("friction={law: coulomb, mu_static: 0}", "time.until={U: 1}", 0, "mu_static");
    assert_refused("time.scheme=explicit", "time.until={U: 1}", 0, "time.scheme=sdirk2");
    assert_refused("rod.kind=push", "time.until={U: 1e-4}", 1, "0 of 1 slidings");
}

// Every allocation that fails, files included: a clean error, nothing leaked, no stability.json.
TEST(test_memory)
{
    const char *settings[] = {"mesh.set.nx=4", "mesh.set.nz=4"};
    char folder[] = "/tmp/amontons-stability-XXXXXX", report[64], arrays[64];
    assert_non_null(mkdtemp(folder));
    snprintf(report, sizeof report, "%s/stability.json", folder);
    snprintf(arrays, sizeof arrays, "%s/stability.h5", folder);
    StabilityOptions options = {.folder = folder, .overwrite = true};
    Scene *scene = read_scene(settings, 2);
    Seen seen;
    follow(scene, options, &seen);   // what is loaded once is loaded
    int64_t before = memory_counters().allocations, live = memory_counters().live;
    follow(scene, options, &seen);
    int64_t all = memory_counters().allocations - before;
    assert_int_equal(access(report, F_OK), 0);
    unlink(report);   // it would stay where a run fails before its result
    for (int64_t k = 0; k < all; k += k < 20 || k > all - 20 ? 1 : 5) {
        Error err = {0};
        StabilitySummary summary;
        memory_fail_after(k);
        bool done = amontons_stability(scene, &options, &summary, &err);
        memory_fail_after(-1);
        assert_false(done);
        assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_int_not_equal(access(report, F_OK), 0);
    }
    unlink(arrays);
    char part[80];
    snprintf(part, sizeof part, "%s.part", arrays);
    unlink(part);
    snprintf(part, sizeof part, "%s/amontons.files", folder);
    unlink(part);
    assert_int_equal(rmdir(folder), 0);
    amontons_scene_destroy(scene);
}
