// SPDX-License-Identifier: GPL-2.0-or-later
// Which scenes are warned of: by theory the viscosity of one node does not depend on the mesh and
// its weakening is as its weight, so the ratio of both follows pressure, v_c, eta and element size.
#include "run/warnings.h"

#include "run/simulation_state.h"
#include "small_scene.h"

#include <string.h>

static RunWarnings warnings_of(const char *setting, const char *more)
{
    Error err = {0};
    RunOptions options = {0};
    Simulation *simulation = NULL;
    Scene *scene =
        small_scene((const char *const[]){"start.state=undeformed", setting, more, NULL});
    if (!amontons_simulation_create(scene, &options, &simulation, &err))
        fail_msg("%s", err.message);
    RunWarnings found = simulation->warnings;
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
    return found;
}

// The factor by which elements should be shorter; 1 where nothing was said.
static double factor_of(const char *setting, const char *more)
{
    RunWarnings found = warnings_of(setting, more);
    for (int32_t k = 0; k < found.count; k++) {
        const char *words = strstr(found.text[k], "; elements ");
        if (words) return strtod(words + strlen("; elements "), NULL);
        assert_non_null(strstr(found.text[k], "branches of `relaxation`"));   // and nothing else
    }
    return 1;
}

TEST(test_resolution)
{
    assert_int_equal(warnings_of("load.pressure=0.003", NULL).count, 0);
    double hundred = factor_of("load.pressure=0.3", NULL);
    assert_true(hundred < 0.2);
    // Ten times: the pressure, the weakening, the thinness.
    assert_near("P", factor_of("load.pressure=3", NULL), 0.1 * hundred, 0.006 * hundred);
    assert_near("v_c", factor_of("load.pressure=0.3", "friction.critical_velocity=3.4e-5"),
                0.1 * hundred, 0.006 * hundred);
    assert_near("law", factor_of("load.pressure=0.3", "friction.law=exponential-weakening"),
                hundred, 0.06 * hundred);
    // On elements a fourth as long each node bears about four times as much.
    double finer =
        factor_of("load.pressure=0.3", "mesh.set={length: 1, height: 0.5, nx: 40, nz: 40}");
    assert_true(finer > 2.5 * hundred && finer < 6 * hundred);
}

// A branch that relaxes faster than slip can grow damps as a viscosity of its modulus times its
// time does; one that hardly relaxes is a spring, and damps nothing.
TEST(test_resolution_with_branches)
{
    const char *load = "load.pressure=0.3";
    double alone = factor_of(load, NULL), viscous = factor_of(load, "material.eta1=2");
    double fast = factor_of(load, "material.relaxation=[{time: 1e-3, shear: 500}]");
    double slow = factor_of(load, "material.relaxation=[{time: 1e6, shear: 0.1}]");
    assert_true(fast > 1.3 * alone);
    assert_near("fast", fast, viscous, 0.2 * viscous);
    assert_true(slow >= alone && slow < 1.5 * alone);
}

// With rate and state that length is G D_c/(b p); G = 1/2.68.
TEST(test_memory)
{
    const char *law = "friction={law: rate-and-state, mu_reference: 0.3, reference_velocity: 1e-5, "
                      "direct_effect: 0.01, evolution_effect: 0.02, slip_distance: 1e-3}";
    assert_int_equal(warnings_of(law, "load.pressure=0.001").count, 0);
    RunWarnings found = warnings_of(law, "load.pressure=0.03");
    assert_int_equal(found.count, 1);
    assert_non_null(strstr(found.text[0], "it turns unstable on 0.62 of length"));
}

TEST(test_without_viscosity)
{
    RunWarnings found = warnings_of("material.eta1=0", "material.eta2=1");
    assert_int_equal(found.count, 1);
    assert_non_null(strstr(found.text[0], "ill-posed"));
    // Friction that does not weaken has an answer also without viscosity.
    assert_int_equal(
        warnings_of("material.eta1=0", "friction={law: coulomb, mu_static: 0.3}").count, 0);
}

// A holder of steel without viscosity above a sole that has some is none of friction's business; a
// sole without it is.
TEST(test_one_material_without_viscosity)
{
    const char *mesh = "mesh={file: ../../meshes/layers.geo, set: {nx: 10, nz: 10, nz_layer: 2}}";
    assert_int_equal(warnings_of(mesh, "materials={body: {eta1: 0}}").count, 0);
    RunWarnings found = warnings_of(mesh, "materials={layer: {eta1: 0}}");
    assert_true(found.count >= 1);   // where it is ill-posed slip is not resolved either
    assert_non_null(strstr(found.text[0], "eta1 is 0 in layer, which touches the floor"));
}

// Strip 0.2 to 0.3 of a face from 0 to 0.5; then half of it above the face, then a fifth below.
TEST(test_rod_beside_its_face)
{
    assert_int_equal(warnings_of("rod.height=0.25", "rod.width=0.1").count, 0);
    assert_int_equal(warnings_of("rod.height=0.45", "rod.width=0.1").count, 0);   // to the edge
    RunWarnings found = warnings_of("rod.height=0.5", "rod.width=0.1");
    assert_int_equal(found.count, 1);
    assert_non_null(strstr(found.text[0], "strip is 0.45 <= z <= 0.55"));
    assert_non_null(strstr(found.text[0], "is 0 <= z <= 0.5; only 50 % of the strip"));
    found = warnings_of("rod.height=0.03", "rod.width=0.1");
    assert_int_equal(found.count, 1);
    assert_non_null(strstr(found.text[0], "only 80 % of the strip"));
    assert_int_equal(warnings_of("rod.height=0.03", "rod.whole=true").count, 0);   // no strip
}

TEST(test_tall_block)
{
    const char *const lengths[] = {"mesh.set={length: 0.04, nx: 4}", "mesh.set={length: 2}",
                                   "mesh.set={length: 0.04, height: 0.1}"};
    for (int32_t k = 0; k < 3; k++) {
        Scene *scene = small_scene((const char *const[]){lengths[k], NULL});
        RunWarnings found = {0};
        warnings_of_shape(scene, k == 1 ? 2 : 0.04, k == 2 ? 0.1 : 0.5, &found);
        assert_int_equal(found.count, k == 0);
        if (k == 0) assert_non_null(strstr(found.text[0], "12.5 times as high as long"));
        amontons_scene_destroy(scene);
    }
}

static bool is_warned(const char *setting, const char *more, const char *words)
{
    RunWarnings found = warnings_of(setting, more);
    for (int32_t k = 0; k < found.count; k++)
        if (strstr(found.text[k], words)) return true;
    return false;
}

TEST(test_gaps)
{
    static const char large[] = "a gap as large as the block", steep[] = "the floor is steep";
    assert_true(is_warned("contact={gap: 0.6 * x}", NULL, large));
    assert_true(is_warned("contact={gap: 0.6 * x}", NULL, steep));
    assert_true(is_warned("contact={gap: 0.3 * abs(x - 0.5)}", NULL, steep));
    assert_false(is_warned("contact={gap: 0.3 * abs(x - 0.5)}", NULL, large));
    assert_int_equal(warnings_of("contact={gap: 0.1 * x}", NULL).count, 0);
    // Steeper where the block will not touch it: no harm.
    assert_int_equal(warnings_of("contact={gap: 'max(0, 0.5 - x)^2 / 2'}", NULL).count, 0);
}

// A block as a drawing in mm makes it, and moduli in GPa, in an SI scene.
TEST(test_units)
{
    static const struct {
        const char *setting;
        double length, young;
        const char *words;
    } rows[] = {{"units=si", 0.2, 3.3e9, NULL},
                {"units=si", 200, 3.3e9, "a block of 200 m"},
                {"mesh.unit=mm", 200, 3.3e9, NULL},
                {"units=si", 0.2, 3.3, "sound of 0.05"},
                {"units=normalised", 200, 3.3, NULL}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char young[60];
        snprintf(young, sizeof young, "material.young=%g", rows[k].young);
        Scene *scene = small_scene((const char *const[]){
            "units=si", "material.density=1190", "material.eta1=1", young, rows[k].setting, NULL});
        Model model = model_of(scene);
        RunWarnings found = {0};
        model.length = rows[k].length;
        warnings_of_units(&model, &found);
        assert_int_equal(found.count, rows[k].words != NULL);
        if (rows[k].words && !strstr(found.text[0], rows[k].words)) fail_msg("%s", found.text[0]);
        amontons_scene_destroy(scene);
    }
}

// The warning about an event before which so many cells slipped on pad 1 of two, or of one.
static void slip_warning(double cells, int32_t pads, const char *setting, RunWarnings *found)
{
    Scene *scene = small_scene((const char *const[]){setting, NULL});
    char names[2][GROUP_NAME_SIZE] = {"left", "right"};
    Interface interface = {.pad_count = pads, .pad_name = names};
    Event event = {.pad = pads - 1, .slip_length = 0.0375, .slip_cells = cells};
    *found = (RunWarnings){0};
    warnings_of_slip(scene, &interface, &event, found);
    amontons_scene_destroy(scene);
}

TEST(test_too_few_cells)
{
    RunWarnings found = {0};
    warnings_of_slip(NULL, NULL, NULL, &found);   // nothing dropped
    assert_int_equal(found.count, 0);
    slip_warning(8, 2, NULL, &found);
    assert_int_equal(found.count, 0);
    slip_warning(7.5, 2, NULL, &found);
    assert_int_equal(found.count, 1);
    assert_non_null(strstr(found.text[0], "only 7.5 cells of pad \"right\" slipped"));
    assert_non_null(strstr(found.text[0], "a length of 0.0375"));
    assert_non_null(strstr(found.text[0], "double mesh.set.nx"));
    slip_warning(0, 1, "mesh.set={size_contact: 0.1}", &found);
    assert_int_equal(found.count, 1);
    assert_non_null(strstr(found.text[0], "a node went from rest to fast slip at once"));
    assert_non_null(strstr(found.text[0], "halve mesh.set.size_contact"));
}

// An answer of the last mesh outside the bar of all is told beside the other; the bar is as long as
// they are apart only where there is one.
TEST(test_last_mesh_apart)
{
    RunWarnings found = {0};
    Levels levels = {.count = 1};
    Level *last = &levels.list[0];
    last->run_count = 1;
    last->runs[0].answer[ANSWER_MU_HOLD] = (Estimate){0.23, NAN};
    last->answer[ANSWER_MU_HOLD] = (ErrorBar){.value = 0.2, .bar = 0.03};
    warnings_of_last_mesh(&levels, &found);
    assert_int_equal(found.count, 0);
    last->answer[ANSWER_MU_HOLD].apart = true;
    warnings_of_last_mesh(&levels, &found);
    assert_int_equal(found.count, 1);
    assert_non_null(strstr(found.text[0], "mu_hold is 0.2300 there and 0.2000 by all, so the"));
    last->answer[ANSWER_MU_HOLD].bar = NAN;
    warnings_of_last_mesh(&levels, &found);
    assert_string_equal(strstr(found.text[1], "0.2000"), "0.2000 by all");
}

TEST(test_list_is_bounded)
{
    RunWarnings warnings = {0};
    for (int k = 0; k < RUN_WARNINGS_MAX + 3; k++) warnings_add(&warnings, "%d %600d", k, k);
    assert_int_equal(warnings.count, RUN_WARNINGS_MAX);
    assert_int_equal(strlen(warnings.text[RUN_WARNINGS_MAX - 1]), RUN_WARNING_SIZE - 1);
    assert_true(warnings.text[1][0] == '1');
}
