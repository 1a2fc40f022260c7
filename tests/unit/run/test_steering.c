// SPDX-License-Identifier: GPL-2.0-or-later
// Rod velocity and pressure set between steps: against runs that had them from the start, against
// linear elasticity, and by the energy ledger.
#include "amontons_simulation.h"
#include "base/memory.h"
#include "result_place.h"
#include "small_scene.h"

#include <math.h>

static const double V = 1e-5;

typedef struct Steered {
    Scene *scene;
    Simulation *simulation;
    StepView view;
    bool finished;
} Steered;

static Steered begin(const char *const *settings)
{
    Error err = {0};
    Steered steered = {.scene = small_scene(settings)};
    RunOptions options = {.whole_block = true};
    if (!amontons_simulation_create(steered.scene, &options, &steered.simulation, &err))
        fail_msg("%s", err.message);
    amontons_simulation_view(steered.simulation, &steered.view);
    return steered;
}

static void step(Steered *steered)
{
    Error err = {0};
    if (!amontons_simulation_step(steered->simulation, &steered->view, &steered->finished, &err))
        fail_msg("%s", err.message);
}

static RunSummary end(Steered *steered)
{
    Error err = {0};
    RunSummary summary;
    assert_true(amontons_simulation_finish(steered->simulation, &summary, &err));
    amontons_simulation_destroy(steered->simulation);
    amontons_scene_destroy(steered->scene);
    return summary;
}

static void set_velocity(Steered *steered, double velocity)
{
    Error err = {0};
    if (!amontons_simulation_set_rod_velocity(steered->simulation, velocity, &err))
        fail_msg("%s", err.message);
}

// mu when the rod comes to `U`, between two steps.
static double mu_at(Steered *steered, double U)
{
    StepView before = steered->view;
    while (steered->view.U < U) {
        before = steered->view;
        step(steered);
    }
    double part = (U - before.U) / (steered->view.U - before.U);
    return before.mu + part * (steered->view.mu - before.mu);
}

// Some viscous times after the change mu is what it is under a rod that had this velocity from the
// start.
TEST(test_rod_goes_on_from_where_it_is)
{
    const char *const settings[] = {NULL}, *const fast[] = {"rod.velocity=3e-5", NULL};
    Steered slow = begin(settings), usual = begin(fast), steered = begin(settings);
    mu_at(&steered, 0.0008);
    double t = steered.view.t, U = steered.view.U;
    assert_near("U", U, V * t, 1e-15);
    set_velocity(&steered, 3 * V);
    for (int k = 0; k < 5; k++) step(&steered);
    assert_near("U", steered.view.U, U + 3 * V * (steered.view.t - t), 1e-15);
    double mu = mu_at(&usual, 0.0015);
    assert_near("mu", mu_at(&steered, 0.0015), mu, 2e-3 * mu);
    // Held, it loses the viscous part, which goes with the velocity; pulled back, it falls.
    double viscous = 1.5 * (mu - mu_at(&slow, 0.0015));
    set_velocity(&steered, 0);
    U = steered.view.U;
    mu = steered.view.mu;
    for (int k = 0; k < 10; k++) step(&steered);
    assert_true(steered.view.U == U);
    assert_near("mu", steered.view.mu, mu - viscous, 0.05 * viscous);
    set_velocity(&steered, -V);
    while (steered.view.U > U - 2e-4) step(&steered);
    assert_true(steered.view.mu < 0.9 * mu);
    set_velocity(&steered, 2 * V);
    while (!steered.finished) step(&steered);
    assert_near("the end", steered.view.U, 0.0055, 1e-5);   // as the scene says
    RunSummary summary = end(&steered);
    assert_true(summary.energy_error < 1e-3 && summary.complementarity_error < 1e-8);
    end(&usual);
    end(&slow);
}

// A rod that is a hundred times as fast all at once hits the block. The ledger closes the better
// the smaller the steps are.
TEST(test_energy_of_a_jump)
{
    const char *const tolerances[][3] = {{"time.tolerance=1e-2", "reduction.use=never", NULL},
                                         {"time.tolerance=1e-4", "reduction.use=never", NULL}};
    double error[2];
    for (int k = 0; k < 2; k++) {
        Steered steered = begin(tolerances[k]);
        mu_at(&steered, 0.0008);
        set_velocity(&steered, 100 * V);
        mu_at(&steered, 0.003);
        set_velocity(&steered, V);
        mu_at(&steered, 0.0032);
        error[k] = end(&steered).energy_error;
    }
    assert_true(error[0] < 2e-3 && error[1] < 0.6 * error[0]);
}

// Without friction the block under its load is a linear problem with one parameter: all
// displacements at rest go with the pressure.
TEST(test_pressure_of_a_block_without_friction)
{
    Error err = {0};
    BlockView block;
    const char *const settings[] = {"friction={law: coulomb, mu_static: 1e-9}", "rod.kind=none",
                                    "time.until={t: 300}", "reduction.use=never", NULL};
    Steered steered = begin(settings);
    assert_true(amontons_simulation_block(steered.simulation, &block, &err));
    double *before = NEW_ARRAY(double, 2 * (int64_t)block.nodes, &err);
    memcpy(before, block.displacement, 2 * (size_t)block.nodes * sizeof *before);
    assert_true(amontons_simulation_set_pressure(steered.simulation, 0.0075, &err));
    while (!steered.finished) step(&steered);
    assert_true(amontons_simulation_block(steered.simulation, &block, &err));
    double largest = 0, load = 0;
    for (int32_t k = 1; k < 2 * block.nodes; k += 2) largest = fmax(largest, fabs(before[k]));
    for (int32_t k = 0; k < 2 * block.nodes; k++) {
        double moved = k % 2 == 0 ? block.displacement[0] - 2.5 * before[0] : 0;   // as a whole
        assert_near("displacement", block.displacement[k], 2.5 * before[k] + moved, 1e-4 * largest);
    }
    const ContactView *contact = &steered.view.contact;
    for (int32_t i = 0; i < contact->count; i++)
        load += 0.1 * (i == 0 || i == contact->count - 1 ? 0.5 : 1) * contact->pressure[i];
    assert_near("load", load, 0.0075, 1e-6);
    memory_free(before);
    assert_true(end(&steered).energy_error < 1e-3);
}

// mu is over the load that acts: with Poisson's ratio 0 the rod's force stays when the pressure is
// doubled.
TEST(test_mu_is_over_the_load_that_acts)
{
    Error err = {0};
    const char *const settings[] = {"reduction.use=never", "material.poisson=0", NULL};
    Steered steered = begin(settings);
    mu_at(&steered, 0.001);
    set_velocity(&steered, 0);
    for (int k = 0; k < 5; k++) step(&steered);
    double mu = steered.view.mu;
    assert_true(amontons_simulation_set_pressure(steered.simulation, 0.006, &err));
    double t = steered.view.t;
    while (steered.view.t < t + 100) step(&steered);
    assert_near("mu", steered.view.mu, 0.5 * mu, 0.1 * mu);
    assert_true(end(&steered).energy_error < 1e-3);
}

// A rod of its own speed ends a run at the scene's U; one that stands ends it at t alone.
TEST(test_ends)
{
    Steered twice = begin((const char *const[]){"time.until={U: 0.002}", NULL});
    set_velocity(&twice, 2 * V);
    while (!twice.finished) step(&twice);
    assert_near("U", twice.view.U, 0.002, 1e-6);
    assert_near("t", twice.view.t, 100, 0.05);
    end(&twice);
    Steered stopped = begin((const char *const[]){"time.until={U: 0.002, t: 300}", NULL});
    set_velocity(&stopped, 0);
    while (!stopped.finished) step(&stopped);
    assert_near("t", stopped.view.t, 300, 0.05);
    assert_near("U", stopped.view.U, 0, 0);
    end(&stopped);
}

// A state of a steered run, put into a scene that ends elsewhere: there, by the rod's speed now.
TEST(test_end_of_another_scene)
{
    Error err = {0};
    SavedState saved = {0};
    Steered first = begin((const char *const[]){"time.until={U: 0.004}", NULL});
    Steered other = begin((const char *const[]){"time.until={U: 0.002}", NULL});
    set_velocity(&first, 2 * V);
    for (int32_t k = 0; k < 10; k++) step(&first);
    assert_true(amontons_simulation_save(first.simulation, &saved, &err));
    if (!amontons_simulation_restore(other.simulation, &saved, &err)) fail_msg("%s", err.message);
    while (!other.finished) step(&other);
    assert_near("U", other.view.U, 0.002, 1e-6);
    assert_near("t", other.view.t, 100, 0.05);
    amontons_state_free(&saved);
    end(&first);
    end(&other);
}

TEST(test_what_is_refused)
{
    const struct {
        const char *settings[4];
        double velocity, pressure;   // NAN: not tried
        const char *says;
    } cases[] = {{{NULL}, INFINITY, NAN, "inf"},
                 {{NULL}, -1e308, NAN, "of a size from 1e-60 to 1e+60"},
                 {{NULL}, 5e-324, NAN, "of a size"},
                 {{"reduction.use=never", NULL}, NAN, 1e300, "of a size"},
                 {{NULL}, NAN, 0.006, "reduction.use to never"},
                 {{"reduction.use=never", NULL}, NAN, 0, "above 0"},
                 {{"rod.kind=none", "time.until={t: 5}", NULL}, 1e-5, NAN, "rod.kind none"},
                 {{"time.scheme=explicit", NULL}, 1e-5, NAN, "explicit"},
                 {{"reduction.use=never", "load.tractions=[{group: top, z: -0.001}]", NULL},
                  NAN,
                  0.006,
                  "only load"},
                 {{"reduction.use=never", NULL}, NAN, INFINITY, "above 0"},
                 {{"rod.program={t: [0, 1], factor: [1, 2]}", NULL}, 1e-5, NAN, "rod.program"},
                 {{"load.program={t: [0, 1], factor: [1, 2]}", NULL}, NAN, 0.006, "load.program"},
                 {{"reduction.use=never",
                   "load={pressure: 0, supports: [{group: top, direction: "
                   "z}]}",
                   NULL},
                  NAN,
                  0.006,
                  "only load"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Error err = {0};
        Steered steered = begin(cases[k].settings);
        bool done =
            isnan(cases[k].velocity)
                ? amontons_simulation_set_pressure(steered.simulation, cases[k].pressure, &err)
                : amontons_simulation_set_rod_velocity(steered.simulation, cases[k].velocity, &err);
        assert_false(done);
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, cases[k].says)) fail_msg("%s", err.message);
        end(&steered);
    }
}

// Its history is closed, and its events have ended.
TEST(test_nothing_follows_the_end)
{
    Error err = {0};
    RunSummary summary;
    SavedState saved = {0}, later = {0};
    Steered steered = {.scene = small_scene((const char *const[]){NULL})};
    char place[PLACE_SIZE];
    place_make(place);
    RunOptions options = {.folder = place};
    assert_true(amontons_simulation_create(steered.scene, &options, &steered.simulation, &err));
    step(&steered);
    Simulation *simulation = steered.simulation;
    assert_true(amontons_simulation_save(simulation, &saved, &err));
    assert_true(amontons_simulation_finish(simulation, &summary, &err));
    for (int32_t k = 0; k < 6; k++) {
        bool done = k == 0   ? amontons_simulation_step(simulation, NULL, &steered.finished, &err)
                    : k == 1 ? amontons_simulation_finish(simulation, &summary, &err)
                    : k == 2 ? amontons_simulation_save(simulation, &later, &err)
                    : k == 3 ? amontons_simulation_restore(simulation, &saved, &err)
                    : k == 4 ? amontons_simulation_set_rod_velocity(simulation, V, &err)
                             : amontons_simulation_set_pressure(simulation, 0.006, &err);
        assert_false(done);
        assert_int_equal(err.code, ERROR_INPUT);
        assert_non_null(strstr(err.message, "is finished"));
        err = (Error){0};
    }
    assert_null(later.bytes);
    amontons_state_free(&saved);
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(steered.scene);
    place_remove(place);
}
