// SPDX-License-Identifier: GPL-2.0-or-later
// How stages are counted: what must follow from the numbers of a drive, whatever the constants.
#include "model/stages.h"

#include "near.h"

// mu_S = 0.4 and mu_K = 0.2, the rod at V = 2; slidings where it is at 0.4, 0.6, ...
static Scene scene_by_hand(double until)
{
    Scene scene = {.rod = {.kind = ROD_PUSH, .velocity = 2}, .time = {.until_U = until}};
    scene.friction.mu_static = 0.4;
    scene.friction.mu_kinetic = 0.2;
    scene.friction.critical_velocity = 4;
    return scene;
}

// It weakens far more than its inertia and damping withstand.
static Drive runaway(void)
{
    return (Drive){.load = 0.5, .yield = 2, .damping = 0, .mass = 1, .weakening = 100};
}

TEST(test_slidings)
{
    Scene scene = scene_by_hand(0.3);
    Drive drive = runaway();
    double rest = stages_expect(&scene, &drive);
    assert_true(rest > 0);   // relaxing, and the way to the first
    scene.time.until_U = 0.6;
    double sliding = stages_expect(&scene, &drive) - rest;
    assert_true(sliding > 0);
    scene.time.until_U = 1.4;
    assert_near("five", stages_expect(&scene, &drive), rest + 5 * sliding, 1e-9);
    scene.time.until_U = 0;
    scene.time.until_t = 0.7;
    assert_near("as long", stages_expect(&scene, &drive), rest + 5 * sliding, 1e-9);
    scene.time.until_slidings = 2;
    assert_near("two asked for", stages_expect(&scene, &drive), rest + 2 * sliding, 1e-9);
    scene.time.until_slidings = 0;
    scene.time.until_t = 1e6;
    scene.time.until_periodic = true;
    assert_true(stages_expect(&scene, &drive) < rest + 20 * sliding);
    scene.time.until_periodic = false;
    scene.time.step_max = 1;   // a million steps of two stages, should that be more
    assert_true(stages_expect(&scene, &drive) >= 2e6);
    scene.time.step_max = 0;
    scene.rod.kind = ROD_NONE;
    scene.rod.velocity = 0;
    assert_near("no rod", stages_expect(&scene, &drive), rest, 0);
}

// A slower rod pays more a sliding, a longer way costs nothing where the block slides steadily.
TEST(test_slow_and_steady)
{
    Scene scene = scene_by_hand(20), longer = scene_by_hand(2000);
    Drive drive = runaway(), damped = runaway();
    double usual = stages_expect(&scene, &drive);
    scene.rod.velocity = 1e-3;
    assert_true(stages_expect(&scene, &drive) > 2 * usual);
    damped.damping = 200;
    assert_true(stages_expect(&scene, &damped) < 0.3 * usual);
    assert_near("of any length", stages_expect(&scene, &damped), stages_expect(&longer, &damped),
                0);
    damped.damping = 0;
    damped.weakening = 0;   // Coulomb, or faster than v_c
    assert_near("Coulomb", stages_expect(&scene, &damped), stages_expect(&longer, &damped), 0);
    damped.weakening = -1;
    assert_near("strengthens", stages_expect(&scene, &damped), stages_expect(&longer, &damped), 0);
    scene.friction.mu_static = scene.friction.mu_kinetic = 0;
    assert_true(isfinite(stages_expect(&scene, &damped)));
}

// Slip that grows too slowly to run away: the block sticks again after half a period, so that a
// tenth of V makes ten times as many drops of a tenth each, on the same way.
TEST(test_small_oscillations)
{
    Scene scene = scene_by_hand(20);
    Drive drive = runaway();
    drive.weakening = 0.3;   // 2 sqrt(M/y) is 1.41
    scene.rod.velocity = 1e-4;
    scene.friction.critical_velocity = 1;
    double some = stages_expect(&scene, &drive);
    scene.rod.velocity = 1e-5;
    double many = stages_expect(&scene, &drive);
    assert_near("ten times as many", many / some, 10, 0.01);
    drive.weakening = 3;
    assert_true(stages_expect(&scene, &drive) < 0.1 * many);
}

// A stiff block of 1 x 0.5 on a layer of 0.1 with a wave speed of a hundredth of the block's.
static Model model_on_layer(const Scene *scene, double *weight, double layer_young)
{
    Model model = {.scene = scene,
                   .length = 1,
                   .height = 0.5,
                   .breadth = 1,
                   .contact_region = 1,
                   .scales = {.load = 0.5},
                   .interface = {.contact_count = 5, .weight = weight}};
    Materials *materials = &model.materials;
    materials->count = 2;
    materials->list[0] = (Material){.young = 1, .density = 1, .eta1 = 3};
    materials->list[1] = (Material){.young = layer_young, .density = 1, .eta1 = 2e-4};
    materials->area[0] = 0.4, materials->area[1] = 0.1;
    materials->width[0] = materials->width[1] = 1;
    materials_find_mean(materials);
    return model;
}

// Waves through the layer, 0.1 by 0.01, where that is slower than along the block, 1 by 1.
TEST(test_soft_floor)
{
    double weight[5] = {0.1, 0.25, 0.3, 0.25, 0.1};
    Scene scene = scene_by_hand(1e6);
    Model soft = model_on_layer(&scene, weight, 1e-4);
    assert_near("through the layer", model_crossing(&soft), 10, 1e-12);
    Drive drive = stages_drive(&soft);
    assert_int_equal(drive.watched, 5);
    double layer = 0.1 / 0.5e-4, block = drive.yield - layer;   // sheared over its height: h/(G L)
    assert_true(block > 1 && block < 5);   // as of the block alone, of E = 1
    assert_near("damped", drive.damping * drive.yield * drive.yield, block * 3 + layer * 2, 1e-9);
    drive.weakening = 1e3 * drive.damping;
    double watched = stages_expect(&scene, &drive);
    drive.watched = 0;
    assert_true(watched > stages_expect(&scene, &drive));
    Model hard = model_on_layer(&scene, weight, 0.25);
    assert_near("along the block", model_crossing(&hard), 1, 1e-12);
    assert_int_equal(stages_drive(&hard).watched, 0);
    soft.materials.width[1] = 0.5;   // half of the contact is of something else
    assert_near("beside others", model_crossing(&soft), 1, 1e-12);
}
