// SPDX-License-Identifier: GPL-2.0-or-later
// `time.scheme: explicit` against `sdirk2` on the same scene, the paper's on a coarse mesh: two
// programs for one answer. How a run counts and bounds explicit steps.
#include "amontons_simulation.h"
#include "base/memory.h"

#include "near.h"

enum { OVERRIDES_MAX = 10 };
static const char *const coarse[] = {"mesh.set.nx=8", "mesh.set.nz=8", "output.fields=none",
                                     "output.figures=[]", "output.history=false"};
enum { COARSE_COUNT = sizeof coarse / sizeof *coarse };

// The paper's scene, coarse, with up to four more settings; NULL: fewer.
static Scene *read_scene(const char *const more[4])
{
    Error err = {0};
    Scene *scene = NULL;
    const char *source = getenv("AMONTONS_SOURCE"), *overrides[OVERRIDES_MAX];
    char path[1000];
    int32_t count = 0;
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", source ? source : ".");
    for (int32_t k = 0; k < COARSE_COUNT; k++) overrides[count++] = coarse[k];
    for (int32_t k = 0; k < 4 && more[k]; k++) overrides[count++] = more[k];
    if (!amontons_scene_read(path, overrides, count, &scene, &err)) fail_msg("%s", err.message);
    return scene;
}

static RunSummary run_scene(const char *const more[4])
{
    Error err = {0};
    RunOptions options = {0};
    RunSummary summary;
    Scene *scene = read_scene(more);
    if (!amontons_run(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    return summary;
}

// mu at U, between the steps around it.
static double mu_at(const char *scheme, double U)
{
    Error err = {0};
    RunOptions options = {0};
    Simulation *simulation = NULL;
    StepView view = {0}, before;
    bool finished = false;
    const char *more[4] = {scheme, "time.until.U=0.0012", "time.accuracy=fine"};
    Scene *scene = read_scene(more);
    if (!amontons_simulation_create(scene, &options, &simulation, &err))
        fail_msg("%s", err.message);
    do {
        before = view;
        assert_false(finished);
        if (!amontons_simulation_step(simulation, &view, &finished, &err))
            fail_msg("%s", err.message);
    } while (view.U < U);
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
    return before.mu + (view.mu - before.mu) * (U - before.U) / (view.U - before.U);
}

// The block sticks, and mu follows the rod.
TEST(test_ramp)
{
    for (double U = 2e-4; U < 1.1e-3; U += 4e-4) {
        double wanted = mu_at("time.scheme=sdirk2", U);
        assert_true(wanted > 0.1 * U / 1e-3);
        assert_near("mu", mu_at("time.scheme=explicit", U), wanted, 1e-3 * wanted);
    }
}

// The first sliding and what led to it.
TEST(test_peak)
{
    const char *explicit_run[4] = {"time.until.U=0.0033", "time.scheme=explicit"};
    const char *implicit_run[4] = {"time.until.U=0.0033", "time.scheme=sdirk2",
                                   "time.accuracy=fine"};
    RunSummary found = run_scene(explicit_run), wanted = run_scene(implicit_run);
    assert_int_equal(wanted.peaks, 1);
    assert_int_equal(found.peaks, 1);
    assert_int_equal(found.leading, 1);
    assert_near("mu", found.mu_M, wanted.mu_M, 0.01 * wanted.mu_M);
    assert_near("critical length", found.critical_length, wanted.critical_length, 0.126);
    assert_true(found.energy_error < 1e-4);
    assert_true(found.moment_error < 1e-12);
    assert_true(found.complementarity_error < 1e-9);
    assert_int_equal(found.counters.loop_allocations, 0);
}

// The first sliding is seen alike in a run that goes a hundred times as far, in which two thousand
// records alone would be 1.65e-4 apart: longer than it takes.
TEST(test_sliding_of_a_long_run)
{
    const char *more[4] = {"time.until.U=0.33", "time.scheme=explicit"};
    const char *shorter[4] = {"time.until.U=0.0033", "time.scheme=explicit"};
    Error err = {0};
    RunOptions options = {0};
    Simulation *simulation = NULL;
    StepView view = {0};
    bool finished = false;
    double largest = 0;
    Scene *scene = read_scene(more);
    if (!amontons_simulation_create(scene, &options, &simulation, &err))
        fail_msg("%s", err.message);
    while (view.U < 0.0033) {
        if (!amontons_simulation_step(simulation, &view, &finished, &err))
            fail_msg("%s", err.message);
        if (view.slidings == 0) largest = fmax(largest, view.mu);
    }
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
    assert_int_equal(view.slidings, 1);
    assert_near("peak", largest, run_scene(shorter).mu_M, 1e-2 * largest);
}

// Explicit steps are counted, in equal numbers a record; time.step_max shortens them and no more.
TEST(test_counting)
{
    const char *stable[4] = {"time.until={t: 10}", "time.scheme=explicit"};
    const char *shorter[4] = {"time.until={t: 10}", "time.scheme=explicit", "time.step_max=1e-4"};
    const char *longer[4] = {"time.until={t: 10}", "time.scheme=explicit", "time.step_max=10"};
    RunSummary summary = run_scene(stable);
    assert_int_equal(summary.counters.accepted % 2000, 0);
    assert_true(summary.counters.accepted > 2000);
    assert_int_equal(run_scene(longer).counters.accepted, summary.counters.accepted);
    assert_int_equal(run_scene(shorter).counters.accepted, 100000);
    assert_int_equal(summary.counters.rejected, 0);
    Error err = {0};
    Scene *scene = read_scene((const char *[4]){"time.until={t: 1e20}", "time.scheme=explicit"});
    assert_false(amontons_run(scene, &(RunOptions){0}, &summary, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    if (!strstr(err.message, "cannot be counted")) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
}

TEST(test_memory)
{
    const char *more[4] = {"time.until={t: 10}", "time.scheme=explicit"};
    Scene *scene = read_scene(more);
    RunOptions options = {0};
    RunSummary summary;
    Error clean = {0};
    bool done = false;
    MemoryCounters before = memory_counters();
    assert_true(amontons_run(scene, &options, &summary, &clean));
    int64_t needed = memory_counters().allocations - before.allocations;
    for (int64_t allowed = needed - 25; !done; allowed++) {   // the last: the explicit scheme's
        Error err = {0};
        memory_fail_after(allowed);
        done = amontons_run(scene, &options, &summary, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(memory_counters().live, before.live);
    }
    amontons_scene_destroy(scene);
}
