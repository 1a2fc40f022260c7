// SPDX-License-Identifier: GPL-2.0-or-later
// amontons_model1d on scenes: simulation against theory, tolerance, what it refuses, what it
// leaves, every allocation that fails.
#include "amontons_model1d.h"

#include "base/memory.h"
#include "near.h"
#include "result_place.h"
#include "scene/scene.h"

enum { OVERRIDES_MAX = 12, FIXED = 2 };

static Scene *read_scene(const char *const *more, int32_t count)
{
    Error err = {0};
    Scene *scene = NULL;
    char path[600];
    const char *overrides[OVERRIDES_MAX] = {"mesh.set.nx=4", "mesh.set.nz=4"};
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    for (int32_t k = 0; k < count; k++) overrides[FIXED + k] = more[k];
    if (!amontons_scene_read(path, overrides, FIXED + count, &scene, &err))
        fail_msg("%s", err.message);
    return scene;
}

static Model1dSummary run_line(const Scene *scene, const Model1dOptions *options)
{
    Error err = {0};
    Model1dSummary summary;
    if (!amontons_model1d(scene, options, &summary, &err)) fail_msg("%s", err.message);
    return summary;
}

TEST(test_against_theory)
{
    const char *settings[] = {"load.pressure=0.03", "time.until={U: 0.03, periodic: true}"};
    Scene *scene = read_scene(settings, 2);
    Model1dOptions options = amontons_model1d_options();
    Model1dSummary summary = run_line(scene, &options);
    double element = 1. / (options.nodes - 1);
    assert_true(summary.simulated && summary.leading == summary.peaks && summary.peaks >= 4);
    // The certificate goes with viscosity alone, a little before l_sc.
    assert_near("l_sc", summary.first_l_sc, summary.l_sc_full, 2 * element);
    assert_near("l_c", summary.first_l_c, summary.l_rod_full, 2 * element);
    assert_near("mu_M", summary.first_mu / summary.mu_rod_full, 1, 0.02);
    assert_near("periodic", summary.mu_M / summary.mu_rod_full, 1, 0.02);
    assert_int_equal(summary.period, 1);
    assert_true(summary.bounded > 0);
    assert_near("quasi-static mu", summary.quasi_static_error, 0, 1e-3);
    assert_true(summary.energy_error < 5e-4 && summary.contact_error < 1e-9);
    amontons_scene_destroy(scene);
}

// The ledger closes with the tolerance, and the peaks stay where they are. Steps are not shortened
// for the ledger's sake here: that would close it at any tolerance.
TEST(test_tolerance)
{
    Model1dOptions options = amontons_model1d_options();
    options.nodes = 41;
    const char *loose[] = {"load.pressure=0.03", "time.until={U: 0.012}", "time.tolerance=1e-3",
                           "time.energy_tolerance=1"};
    const char *tight[] = {"load.pressure=0.03", "time.until={U: 0.012}", "time.tolerance=1e-5",
                           "time.energy_tolerance=1"};
    Scene *scenes[] = {read_scene(loose, 4), read_scene(tight, 4)};
    Model1dSummary coarse = run_line(scenes[0], &options), fine = run_line(scenes[1], &options);
    assert_true(fine.energy_error < 0.25 * coarse.energy_error);
    assert_true(fine.accepted > coarse.accepted);
    assert_near("first peak", coarse.first_mu / fine.first_mu, 1, 5e-3);
    for (int k = 0; k < 2; k++) amontons_scene_destroy(scenes[k]);
}

// On a short, lightly loaded line slow slip reaches the end: mu comes near mu_S.
TEST(test_no_instability)
{
    const char *settings[] = {"time.until={U: 0.002}", "rod.velocity=1e-6"};
    Scene *scene = read_scene(settings, 2);
    Model1dOptions options = amontons_model1d_options();
    Model1dSummary summary = run_line(scene, &options);
    assert_true(summary.l_c > 1 && isnan(summary.l_c_full));
    assert_near("theory", summary.mu_c_full, 0.38, 1e-12);
    assert_near("simulated", summary.first_mu, 0.38, 2e-3);
    amontons_scene_destroy(scene);
}

typedef struct Seen {
    int32_t points, steps, stop_after;
    double front, mu;
    bool ascending, compared;
    volatile sig_atomic_t stop;
} Seen;

static void see_point(const Model1dPoint *point, void *context)
{
    Seen *seen = context;
    seen->ascending &= point->front > seen->front && point->mu > seen->mu;
    seen->compared |= !isnan(point->mu_seen);
    seen->front = point->front;
    seen->mu = point->mu;
    seen->points++;
}

static void see_step(const StepView *view, void *context)
{
    Seen *seen = context;
    assert_true(view->fraction >= 0 && view->fraction <= 1);
    if (++seen->steps == seen->stop_after) seen->stop = 1;
}

TEST(test_callbacks)
{
    Error err = {0};
    const char *settings[] = {"load.pressure=0.03", "time.until={U: 0.004}"};
    Scene *scene = read_scene(settings, 2);
    Seen seen = {.ascending = true};
    Model1dOptions options = amontons_model1d_options();
    options.nodes = 21;
    options.on_point = see_point;
    options.on_step = see_step;
    options.context = &seen;
    options.stop = &seen.stop;
    Model1dSummary summary = run_line(scene, &options);
    assert_true(seen.ascending && seen.compared && seen.points == 40);
    assert_near("the last front is L", seen.front, 1, 1e-15);
    assert_int_equal(seen.steps, summary.accepted + 1);   // and the start
    seen = (Seen){.ascending = true};
    options.theory_only = true;
    Model1dSummary theory = run_line(scene, &options);
    assert_true(seen.steps == 0 && seen.points == 40 && !seen.compared && !theory.simulated);
    assert_near("same theory", theory.l_c_full, summary.l_c_full, 0);
    assert_true(isnan(theory.mu_M) && isnan(theory.first_mu));
    seen = (Seen){.stop_after = 5};
    options.theory_only = false;
    assert_false(amontons_model1d(scene, &options, &summary, &err));
    assert_int_equal(err.code, ERROR_INTERRUPT);
    amontons_scene_destroy(scene);
}

// mus scale with P L, lengths with L, when the units do: rho, E, eta in SI give the same numbers.
TEST(test_units)
{
    Model1dOptions options = amontons_model1d_options();
    options.theory_only = true;
    const char *plain[] = {"load.pressure=0.03"};
    // E = 4, rho = 1/4, eta = 2: length 2, time 1/2, velocity 4, stress 4
    const char *scaled[] = {
        "material={young: 4, poisson: 0.34, density: 0.25, eta1: 2, eta2: 2}",
        "friction={mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 1.36e-3}",
        "load.pressure=0.12",
        "rod={velocity: 4e-5, height: 0.5, width: 0.1}",
        "mesh.set.length=2",
        "mesh.set.height=1"};
    Scene *scenes[] = {read_scene(plain, 1), read_scene(scaled, 6)};
    Model1dSummary one = run_line(scenes[0], &options), other = run_line(scenes[1], &options);
    double pairs[][2] = {{one.l_sc, other.l_sc},           {one.l_c, other.l_c},
                         {one.l_c_small, other.l_c_small}, {one.l_sc_full, other.l_sc_full},
                         {one.l_c_full, other.l_c_full},   {one.l_rod_full, other.l_rod_full},
                         {one.mu_c, other.mu_c},           {one.mu_rod_full, other.mu_rod_full},
                         {one.range, other.range}};
    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; k++)
        assert_near("the same number", pairs[k][1] / pairs[k][0], 1, 1e-6);
    for (int k = 0; k < 2; k++) amontons_scene_destroy(scenes[k]);
}

// Plane strain is plane stress of a material with nu/(1 - nu) and E/(1 - nu^2).
TEST(test_plane_strain)
{
    Model1dOptions options = amontons_model1d_options();
    options.theory_only = true;
    char young[40], poisson[40];
    snprintf(young, sizeof young, "material.young=%.17g", 1 / (1 - 0.3 * 0.3));
    snprintf(poisson, sizeof poisson, "material.poisson=%.17g", 0.3 / 0.7);
    const char *strain[] = {"load.pressure=0.03", "material.plane=strain", "material.poisson=0.3"};
    const char *stress[] = {"load.pressure=0.03", young, poisson};
    Scene *scenes[] = {read_scene(strain, 3), read_scene(stress, 3)};
    Model1dSummary one = run_line(scenes[0], &options), other = run_line(scenes[1], &options);
    assert_near("l_sc", other.l_sc / one.l_sc, 1, 1e-9);
    assert_near("l_c", other.l_c / one.l_c, 1, 1e-9);
    assert_near("kappa r", other.range / one.range, 1, 1e-9);
    for (int k = 0; k < 2; k++) amontons_scene_destroy(scenes[k]);
}

TEST(test_refusals)
{
    static const struct {
        const char *setting, *says;
    } cases[] = {
        {"friction={law: coulomb, mu_static: 0.38}", "weakening friction.law"},
        {"friction.mu_kinetic=0.38", "mu_static above"},
        {"load={pressure: 0, tractions: [{group: top, x: 0, z: -1e-3}]}", "load.pressure"},
        {"load.tractions=[{group: top, x: 1e-4, z: 0}]", "load.tractions"},
        {"time.scheme=explicit", "time.scheme=sdirk2"},
        {"rod.program={t: [0, 1], factor: [1, 2]}", "rod.program: the 1D model has one load"},
        {"load.program={t: [0, 1], factor: [1, 2]}", "load.program: the 1D model has one load"},
        {"time.until={U: 0.01, slidings: 2}", "not by slidings or mu_below"},
        {"time.until={U: 0.01, mu_below: 0.2}", "not by slidings or mu_below"},
        {"rod.stiffness=1", "rod.stiffness"},
        {"friction.contacts=[{group: contact, along: '1 + x'}]", "one law along its line"},
        {"friction.along='1 + x'", "one law along its line"},
        {"contact.gap='0.001*x'", "lies on a flat substrate"},
        {"load.supports=[{group: leading, direction: x}]", "load.supports"},
        {"mesh.set.crown=0.01", "that are not flat"},
        {"mesh={file: ../../meshes/grooves.geo, set: {}}", "contact curves"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Error err = {0};
        Model1dSummary summary;
        Scene *scene = read_scene(&cases[k].setting, 1);
        Model1dOptions options = amontons_model1d_options();
        assert_false(amontons_model1d(scene, &options, &summary, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, cases[k].says))
            fail_msg("%s: \"%s\" does not say %s", cases[k].setting, err.message, cases[k].says);
        amontons_scene_destroy(scene);
    }
    Scene *scene = read_scene(NULL, 0);
    double velocity = scene->rod.velocity, until = scene->time.until_U;
    Model1dOptions plain = amontons_model1d_options();
    Model1dSummary nothing;
    Error refused = {0};
    scene->rod.velocity = 0;   // of a static scene
    assert_false(amontons_model1d(scene, &plain, &nothing, &refused));
    assert_non_null(strstr(refused.message, "rod.velocity must be above 0"));
    scene->rod.velocity = velocity;
    int32_t kind = scene->rod.kind;
    scene->rod.kind = ROD_NONE;
    refused = (Error){0};
    assert_false(amontons_model1d(scene, &plain, &nothing, &refused));
    assert_non_null(strstr(refused.message, "driven by a rod"));
    scene->rod.kind = kind;
    scene->time.until_U = 0;
    refused = (Error){0};
    assert_false(amontons_model1d(scene, &plain, &nothing, &refused));
    assert_non_null(strstr(refused.message, "says not when to stop"));
    scene->time.until_U = until;
    scene->friction.kind = (FrictionKind)99;   // a law that the model knows nothing of, by its name
    Model1dOptions usual = amontons_model1d_options();
    Model1dSummary none;
    Error unknown = {0};
    assert_false(amontons_model1d(scene, &usual, &none, &unknown));
    assert_int_equal(unknown.code, ERROR_INPUT);
    assert_non_null(strstr(unknown.message, "`unknown`"));
    amontons_scene_destroy(scene);
}

TEST(test_wrong_options)
{
    Scene *scene = read_scene(NULL, 0);
    Model1dOptions wrong[] = {{.alpha = 0, .nodes = 81},  {.alpha = -1, .nodes = 81},
                              {.alpha = 11, .nodes = 81}, {.alpha = NAN, .nodes = 81},
                              {.alpha = 0.2, .nodes = 2}, {.alpha = 0.2, .nodes = 2001}};
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        Error err = {0};
        Model1dSummary summary;
        assert_false(amontons_model1d(scene, &wrong[k], &summary, &err));
        assert_int_equal(err.code, ERROR_INPUT);
    }
    amontons_scene_destroy(scene);
}

TEST(test_memory)
{
    char place[PLACE_SIZE];
    const char *settings[] = {"load.pressure=0.03", "time.until={U: 1e-4}"};
    Scene *scene = read_scene(settings, 2);
    Model1dOptions options = amontons_model1d_options();
    options.nodes = 5;
    options.overwrite = true;
    place_make(place);
    options.folder = place;
    run_line(scene, &options);   // modules opened
    unlink(place_path(place, "model1d.json"));   // it would stay where the input is not accepted
    int64_t live = memory_counters().live;
    int32_t k = 0;
    for (bool done = false; !done; k += 7) {
        Error err = {0};
        Model1dSummary summary;
        memory_fail_after(k);
        done = amontons_model1d(scene, &options, &summary, &err);
        memory_fail_after(-1);
        if (!done && err.code != ERROR_MEMORY) fail_msg("%d: %s", k, err.message);
        if (!done) assert_false(place_has(place, "model1d.json"));
        assert_int_equal(memory_counters().live, live);
    }
    assert_true(k > 100);
    assert_true(place_has(place, "model1d.json") && place_has(place, "history.h5"));
    amontons_scene_destroy(scene);
    place_remove(place);
}
