// SPDX-License-Identifier: GPL-2.0-or-later
// Weakening that a pad bears alone: the shear column, whose drag, stiffness and critical weakening
// are known, and against the path of a block of one pad and of three.
#include "amontons_stability.h"

#include "near.h"

#include <stdio.h>

static StabilitySummary follow(const char *file, const char *const *overrides, int32_t count,
                               int32_t slidings)
{
    Error err = {0};
    Scene *scene = NULL;
    StabilitySummary summary;
    StabilityOptions options = {.slidings = slidings};
    char path[600];
    snprintf(path, sizeof path, "%s/validation/%s", getenv("AMONTONS_SOURCE"), file);
    if (!amontons_scene_read(path, overrides, count, &scene, &err)) fail_msg("%s", err.message);
    if (!amontons_stability(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    return summary;
}

// Shear viscosity eta1/2 = 0.05 and G = E/(2(1+nu)) over a height of 1; real growth begins where
// (G + eta s) q coth q = s w, q^2 = rho s^2/(G + eta s), has a double root.
TEST(test_column)
{
    static const double eta = 0.05, G = 1 / (2 * 1.34), mu = 4e-4, v_c = 1e-6, w = 0.5;
    char traction[96];
    snprintf(traction, sizeof traction, "load.tractions=[{group: contact, x: 0, z: %.17g}]",
             -w * v_c / mu);
    const char *overrides[] = {traction,
                               "friction.mu_static=4e-4",
                               "friction.critical_velocity=1e-6",
                               "start.velocity_x=0",
                               "rod.velocity=1e-9",
                               "mesh.set={width: 1, nx: 8, nz: 50}"};
    StabilitySummary found = follow("exact/column.yaml", overrides, 6, 0);
    assert_int_equal(found.pad_count, 1);
    const StabilityPad *pad = &found.pads[0];
    assert_near("length", pad->length, 1, 1e-12);
    assert_near("pressure", pad->pressure, w * v_c / mu, 1e-3 * w * v_c / mu);
    assert_near("drag", pad->drag, eta, 1e-6 * eta);
    assert_near("stiffness", pad->stiffness, G, 1e-6 * G);
    double borne = INFINITY;
    for (double s = 0.05; s < 20; s *= 1.001) {
        double modulus = G + eta * s, q = s / sqrt(modulus);
        borne = fmin(borne, modulus * q / tanh(q) / s);
    }
    assert_near("load", pad->load, w / borne, 1e-2 * w / borne);
    assert_true(isnan(pad->l_c) && pad->load < 1);
    assert_near("all of it slips", pad->slipping, pad->length, 1e-12);
}

// Coarse block in one piece: alone, it runs away at the length the path finds in the scan.
TEST(test_one_pad)
{
    const char *overrides[] = {"mesh.set.nx=20", "mesh.set.nz=20", "load.pressure=0.006",
                               "output.figures=[]", "output.fields=none"};
    StabilitySummary found = follow("paper/fig1.yaml", overrides, 5, 0);
    assert_int_equal(found.pad_count, 1);
    const StabilityPad *pad = &found.pads[0];
    assert_near("l_c", pad->l_c, found.l_c_scan, 1. / 20);
    assert_near("mode", pad->mode, 1, 1e-12);
    assert_true(pad->load > 1 && pad->slipping < pad->length);
}

// Three pads carry the load; the trailing one takes part most. At a light load each of them bears
// slip over all its length.
TEST(test_three_pads)
{
    const char *overrides[] = {"mesh.set.n=3", "mesh.set.size_contact=0.05",
                               "mesh.set.size_bulk=0.1", "output.figures=[]",
                               "load.pressure=0.006"};
    StabilitySummary heavy = follow("pads/pads.yaml", overrides, 5, 1);
    overrides[4] = "load.pressure=1e-4";
    StabilitySummary light = follow("pads/pads.yaml", overrides, 5, 0);
    assert_int_equal(heavy.pad_count, 3);
    double force = 0;
    for (int32_t p = 0; p < 3; p++) {
        const StabilityPad *pad = &heavy.pads[p];
        force += pad->pressure * pad->length;
        assert_near("length", pad->length, 0.2, 1e-9);
        assert_true(pad->load > 1 && pad->l_c > 0 && pad->l_c <= pad->length);
        assert_true(light.pads[p].load < 1 && isnan(light.pads[p].l_c));
        // A matter of shape alone. The pads' own order of size: E, eta over their length.
        assert_near("drag", light.pads[p].drag, pad->drag, 1e-6 * pad->drag);
        assert_true(pad->drag * pad->length > 0.1 && pad->drag * pad->length < 2);
        assert_true(pad->stiffness * pad->length > 0.1 && pad->stiffness * pad->length < 2);
    }
    assert_near("load", force, 0.006, 1e-4 * 0.006);
    assert_near("mode", heavy.pads[0].mode, 1, 1e-12);
    assert_true(heavy.pads[2].mode < 0.1);
    assert_string_equal(heavy.pads[2].name, "contact_3");
}
