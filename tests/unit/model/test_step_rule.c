// SPDX-License-Identifier: GPL-2.0-or-later
// Which steps a scene gets, from numbers chosen so that they can be worked out in the head.
#include "model/step_rule.h"

#include "near.h"

// The rod at V = 0.5 moves a fifth of the slip 0.25 in 0.1.
static Scene scene_by_hand(void)
{
    Scene scene = {.rod = {.kind = ROD_PUSH, .velocity = 0.5},
                   .time = {.until_U = 20, .wave_step = 0.02, .watch = 3, .certificate = true}};
    scene.time.energy_tolerance = 0.01;
    return scene;
}

static const StepSizes SIZES = {.slip = 0.25, .crossing = 2, .tolerance = 1e-3};

TEST(test_driven)
{
    Scene scene = scene_by_hand();
    StepControlDef def = step_rule(&scene, &SIZES);
    assert_near("tolerance", def.tolerance, 2.5e-4, 1e-18);
    assert_near("wave step", def.wave_step, 0.04, 1e-16);
    assert_near("0.04, 0.08, 0.16: not below 0.1", def.step_max, 0.16, 1e-15);
    assert_near("watch", def.watch_time, 6, 1e-15);
    StepSizes remembers = SIZES;
    remembers.memory = 0.5;
    assert_near("0.2 D_c/V = 0.2", step_rule(&scene, &remembers).step_max, 0.32, 1e-15);
    remembers.memory = 0.01;
    assert_near("the drop's slip", step_rule(&scene, &remembers).step_max, 0.16, 1e-15);
    assert_near("shortest", def.step_min, 4e-12, 1e-24);
    assert_true(def.use_certificate && def.energy_tolerance == 0.01);
    scene.time.tolerance = 0.1;
    scene.time.step_max = 5;
    scene.time.step_min = 1e-3;
    def = step_rule(&scene, &SIZES);
    assert_near("the scene's own", def.tolerance, 0.025, 1e-17);
    assert_true(def.step_max == 5 && def.step_min == 1e-3);
}

// For a slow rod or a fast one the wave step stays a level: their ratio is a power of 2.
TEST(test_the_wave_step_is_a_level)
{
    Scene scene = scene_by_hand();
    for (double V = 1e-9; V < 1e3; V *= 3.7) {
        scene.rod.velocity = V;
        StepControlDef def = step_rule(&scene, &SIZES);
        double levels = log2(def.step_max / def.wave_step), longest = 0.2 * SIZES.slip / V;
        assert_near("levels", levels, round(levels), 1e-9);
        assert_true(def.step_max >= longest * (1 - 1e-12) && def.step_max < 2 * longest);
    }
}

// Keys of steps mean the explicit scheme, not the one that relaxes the block before it.
TEST(test_explicit_keeps_its_keys)
{
    Scene scene = scene_by_hand();
    scene.time.scheme = SCHEME_EXPLICIT;
    scene.time.step_max = 1e-6;
    scene.time.step_min = 1e-7;
    StepControlDef def = step_rule(&scene, &SIZES);
    assert_near("longest", def.step_max, 0.16, 1e-15);
    assert_near("shortest", def.step_min, 4e-12, 1e-24);
}

TEST(test_end)
{
    Scene scene = scene_by_hand();
    assert_near("by the rod", step_rule_end(&scene), 40, 0);
    scene.time.until_t = 50;
    assert_near("whichever comes first", step_rule_end(&scene), 40, 0);
    scene.time.until_t = 30;
    assert_near("whichever comes first", step_rule_end(&scene), 30, 0);
    scene.time.until_U = 0;
    scene.rod.kind = ROD_NONE;
    assert_near("by time", step_rule_end(&scene), 30, 0);
    assert_near("at least 50 steps", step_rule(&scene, &SIZES).step_max, 0.6, 1e-15);
}
