// SPDX-License-Identifier: GPL-2.0-or-later
// The start of a run: the state at t = 0 under each of a scene's words, what steps and ends are
// taken from it, and scenes that cannot be computed.
#include "run/simulation_state.h"

#include "base/memory.h"
#include "plane.h"
#include "small_scene.h"

static const double PRESSURE = 0.003;

static Simulation *simulation_of(const char *const *more)
{
    Error err = {0};
    RunOptions options = {0};
    Simulation *simulation = NULL;
    Scene *scene = small_scene(more);
    if (!amontons_simulation_create(scene, &options, &simulation, &err))
        fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    return simulation;
}

static double normal_force(const Simulation *simulation)
{
    double sum = 0;
    for (int32_t i = 0; i < simulation->model.interface.contact_count; i++)
        sum += simulation->control.now.reaction[plane_normal(i)];
    return sum;
}

static double shear_force(const Simulation *simulation)
{
    double sum = 0;
    for (int32_t i = 0; i < simulation->model.interface.contact_count; i++)
        sum += simulation->control.now.reaction[plane_tangent(i)];
    return sum;
}

// Relaxed with friction, the bottom cannot spread as it wants; without, it does, and p is even.
TEST(test_friction_while_relaxing)
{
    for (int on = 0; on < 2; on++) {
        Simulation *simulation = simulation_of(
            (const char *const[]){on ? "start.friction=on" : "start.friction=off", NULL});
        const State *now = &simulation->control.now;
        double largest = 0, uneven = 0;
        for (int32_t i = 0; i < simulation->model.interface.contact_count; i++) {
            double weight = simulation->model.interface.weight[i];
            double p = now->reaction[plane_normal(i)] / weight;
            largest = fmax(largest, fabs(now->reaction[plane_tangent(i)] / weight));
            uneven = fmax(uneven, fabs(p - PRESSURE));
        }
        assert_near("normal", normal_force(simulation), PRESSURE, 1e-7 * PRESSURE);
        assert_near("shear", shear_force(simulation), 0, 1e-6 * PRESSURE);
        if (on) assert_true(largest > 0.05 * PRESSURE && uneven > 0.01 * PRESSURE);
        if (!on) assert_true(largest < 1e-6 * PRESSURE && uneven < 1e-6 * PRESSURE);
        assert_int_equal(simulation->friction.whole.law->kind,
                         FRICTION_LINEAR_WEAKENING);   // the scene's again
        assert_near("mu_S", simulation->friction.mu_static, 0.38, 0);
        assert_near("t", now->time, 0, 0);
        amontons_simulation_destroy(simulation);
    }
}

// A node that never sticks relaxes on mu at its reference velocity, times the factor of its place.
TEST(test_creep_while_relaxing)
{
    Simulation *simulation = simulation_of((const char *const[]){
        "start.friction=on",
        "friction={law: rate-and-state, direct_effect: 0.01, evolution_effect: 0.015, "
        "mu_reference: 0.3, reference_velocity: 2e-5, slip_distance: 1e-4, "
        "along: \"points(x, 0, 0.1, 1, 0.5)\"}",
        NULL});
    const State *now = &simulation->control.now;
    int32_t loaded = 0;
    for (int32_t i = 0; i < simulation->model.interface.contact_count; i++) {
        double limit = 0.3 * friction_at(&simulation->friction, i)->factor *
                       now->reaction[plane_normal(i)];
        double shear = fabs(now->reaction[plane_tangent(i)]);
        assert_true(shear < (1 + 1e-6) * limit);
        loaded += shear > 0.5 * limit;
    }
    assert_true(loaded > 0);
    assert_int_equal(friction_at(&simulation->friction, 0)->law->kind, FRICTION_RATE_STATE);
    amontons_simulation_destroy(simulation);
}

// The rod comes to the relaxed face, or stands there while the block spreads against it: then it
// presses, and a bonded one would pull as well.
TEST(test_rod_at_the_start)
{
    const struct {
        const char *kind, *start;
        RodKind found;
        bool presses;
    } cases[] = {{"rod.kind=push", "start.rod=away", ROD_PUSHES, false},
                 {"rod.kind=bonded", "start.rod=away", ROD_IS_BONDED, false},
                 {"rod.kind=push", "start.rod=held", ROD_PUSHES, true},
                 {"rod.kind=bonded", "start.rod=held", ROD_IS_BONDED, true},
                 {"rod.kind=none", "start.rod=away", ROD_AWAY, false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Simulation *simulation = simulation_of(
            (const char *const[]){cases[k].kind, cases[k].start, "time.until={t: 10}", NULL});
        assert_int_equal(simulation->rod.kind, cases[k].found);
        double force = rod_force(&simulation->model.interface, simulation->control.now.reaction);
        if (cases[k].presses) assert_true(force > 1e-3 * PRESSURE);
        if (!cases[k].presses) assert_near("F_T", force, 0, 1e-6 * PRESSURE);
        assert_near("balance", shear_force(simulation), -force, 1e-6 * PRESSURE);
        for (int32_t j = 0; j < simulation->model.interface.rod_count; j++) {
            int32_t at = interface_rod(&simulation->model.interface, j);
            double u =
                simulation->control.now.displacement[simulation->model.system.interface_dofs[at]];
            double wanted = strstr(cases[k].start, "held") ? 0 : u;
            assert_near("touches", simulation->rod.origin[j], wanted, 1e-18);
        }
        if (simulation->model.interface.rod_count > 0)
            assert_near("V", simulation->rod.velocity, 1e-5, 0);
        amontons_simulation_destroy(simulation);
    }
}

// Loads add up, whatever they are called; F_N is what presses.
TEST(test_loads)
{
    Simulation *simulation = simulation_of((const char *const[]){
        "load.tractions=[{group: top, x: 1e-4, z: -1e-3}, {group: leading, x: -2e-4, z: 0}]",
        NULL});
    assert_near("F_N", simulation->model.scales.load, 0.004, 1e-15);
    assert_near("normal", normal_force(simulation), 0.004, 1e-9);
    // 1e-4 on the top, length 1; -2e-4 on the leading face, height 0.5: nothing for friction.
    assert_near("shear", shear_force(simulation), 0, 1e-8);
    amontons_simulation_destroy(simulation);
}

// E, nu, rho and eta reach the bulk: u_z of the top of a frictionless block is -P H (1 - nu^2)/E in
// plane strain.
TEST(test_material)
{
    Simulation *simulation = simulation_of((const char *const[]){
        "material={young: 2, poisson: 0.3, density: 3, eta1: 0.5, eta2: 0.7, plane: strain}",
        "start.friction=off", "reduction.use=never", NULL});
    const Material *material = &simulation->model.materials.mean;
    assert_true(material->young == 2 && material->poisson == 0.3 && material->plane_strain);
    assert_true(material->density == 3 && material->eta1 == 0.5 && material->eta2 == 0.7);
    const Mesh *mesh = &simulation->model.mesh;
    for (int32_t node = 0; node < mesh->node_count; node++) {
        if (mesh->position[2 * node + 1] < 0.5 - 1e-12) continue;
        double wanted = -PRESSURE * 0.5 * (1 - 0.3 * 0.3) / 2;
        assert_near("u_z", simulation->control.now.displacement[2 * node + 1], wanted, 1e-9);
    }
    assert_near("mass", simulation->model.system.mass_total, 3 * 0.5, 1e-12);
    amontons_simulation_destroy(simulation);
}

// Whichever of U and t comes first ends the run; steps are no longer than asked.
TEST(test_end_and_steps)
{
    // 0.2 of the slip that the drop of friction drives, 0.28 * 0.003 * 0.5, are 8.4 time units; the
    // next 2^k times the wave step, 0.2 L / c_L with c_L^2 = 1 / (1 - 0.34^2), k = 6:
    const double slip_step = 64 * 0.2 * sqrt(1 - 0.34 * 0.34);
    const struct {
        const char *until, *step_max;
        double t_end, longest;
    } cases[] = {{"time.until={U: 0.001}", "time.step_max=0", 100, slip_step},
                 {"time.until={t: 40}", "time.step_max=0", 40, slip_step},
                 {"time.until={U: 0.001, t: 40}", "time.step_max=0", 40, slip_step},
                 {"time.until={U: 0.0001, t: 40}", "time.step_max=0", 10, slip_step},
                 {"time.until={U: 1}", "time.step_max=0", 1e5, slip_step},
                 {"time.until={U: 1}", "time.step_max=0.3", 1e5, 0.3}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Simulation *simulation =
            simulation_of((const char *const[]){cases[k].until, cases[k].step_max, NULL});
        assert_near("end", simulation->t_end, cases[k].t_end, 1e-9 * cases[k].t_end);
        assert_near("longest", simulation->control.def.step_max, cases[k].longest, 1e-12);
        amontons_simulation_destroy(simulation);
    }
}

// A periodic regime ends the run where the scene says so.
TEST(test_until_periodic)
{
    Error err = {0};
    RunOptions options = {0};
    RunSummary summary[2];
    for (int periodic = 0; periodic < 2; periodic++) {
        Scene *scene = small_scene((const char *const[]){
            periodic ? "time.until={U: 0.03, periodic: true}" : "time.until={U: 0.03}",
            "time.periodic_tolerance=0.03", NULL});
        if (!amontons_run(scene, &options, &summary[periodic], &err)) fail_msg("%s", err.message);
        amontons_scene_destroy(scene);
    }
    assert_true(summary[1].peaks < summary[0].peaks && summary[1].peaks_counted >= 3);
    assert_near("mu_M", summary[1].mu_M, summary[0].mu_M, 0.03 * summary[0].mu_M);
}

// A free run of 1e-7 time units takes steps of 2e-9 and yet relaxes in a few dozen; a rod that
// hardly moves leaves a shortest step far below the waves'.
TEST(test_extreme_speeds)
{
    Simulation *simulation =
        simulation_of((const char *const[]){"time.until={t: 1e-7}", "rod.kind=none", NULL});
    assert_true(simulation->relaxation_steps < 200);
    const StepControl *control = &simulation->control;
    assert_near("longest step", dt_level_step(&control->dt_levels, control->coarsest), 2e-9, 1e-20);
    amontons_simulation_destroy(simulation);
    simulation = simulation_of((const char *const[]){"rod.velocity=1e-16", NULL});
    assert_true(simulation->control.def.step_min < 1e-9 * simulation->control.def.wave_step);
    assert_near("shortest level",
                dt_level_step(&simulation->control.dt_levels,
                              simulation->control.dt_levels.level_count - 1),
                simulation->control.def.step_min, simulation->control.def.step_min);
    amontons_simulation_destroy(simulation);
}

TEST(test_refused)
{
    const struct {
        const char *setting, *words;
    } cases[] = {
        {"load.tractions=[{group: top, x: 0, z: 0.01}]", "do not press the block onto the plane"},
        {"load.tractions=[{group: topp, x: 0, z: 0}]", "did you mean 'top'?"},
        {"groups.top=rood", "did you mean 'rod'?"},
        {"groups.contact=leading", "z = 0"},
        {"rod.height=0.7", "no node of group \"rod\""},
        {"groups.rod=leading", "cannot push"},
        {"mesh.set.nx=0", "nx"},
    };
    int64_t live = memory_counters().live;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Error err = {0};
        RunOptions options = {0};
        RunSummary summary;
        Scene *scene = small_scene((const char *const[]){"rod.width=0.01", cases[k].setting, NULL});
        assert_false(amontons_run(scene, &options, &summary, &err));
        amontons_scene_destroy(scene);
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, cases[k].words))
            fail_msg("'%s' is not in: %s", cases[k].words, err.message);
        assert_int_equal(memory_counters().live, live);
    }
}
