// SPDX-License-Identifier: GPL-2.0-or-later
// Tables of moduli as instruments write them; what they say of a material, against moduli computed
// here from branches that are known.
#include "scene/material_file.h"

#include "base/memory.h"
#include "cases.h"
#include "scene/keys.h"
#include "scene_of_text.h"
#include "unit/scene/scene_texts.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

static const char PATH[] = "material_file_test.csv";

static void write_table(const char *text)
{
    FILE *file = fopen(PATH, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

// Three frequencies of E' and E'' in Pa, 1, 10 and 100 rad/s.
TEST(tables_as_they_are_written)
{
    static const struct {
        const char *text;
        bool shear;
    } same[] = {
        {"omega (rad/s),E' (MPa),E'' (MPa)\n1,2,0.2\n10,3,0.6\n100,4,0.4\n", false},
        {"omega/(1/s);G'/kPa;G''/kPa\n1;2000;200\n10;3000;600\n100;4000;400\n", true},
        {"# DMA\nf (Hz);storage (MPa);tan_delta (-)\n0,15915494309189535;2;0,1\n"
         "1,5915494309189535;3;0,2\n15,915494309189535;4;0,1\n",
         false},
        {"Freq [rad/s]\tE' [Pa]\tE\" [Pa]\tremark\n1\t2e6\t2e5\t\n10\t3e6\t6e5\tx\n"
         "100\t4e6\t4e5\t\n",
         false},
        {"Time\tAng. Frequency\tStorage Modulus\tLoss "
         "Modulus\ns\trad/s\tN/mm\xC2\xB2\tN/mm\xC2\xB2\n"
         "5\t1\t2\t0.2\n6\t10\t3\t0.6\n7\t100\t4\t0.4\n",
         false},
        {"sep=;\nAngular frequency (rad/s);E\xE2\x80\xB2 (MPa);E\xE2\x80\xB3 (MPa)\n1;2;0,2\n"
         "10;3;0,6\n100;4;0,4\n",
         false},
    };
    const double storage[] = {2e6, 3e6, 4e6}, loss[] = {2e5, 6e5, 4e5};
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        Error err = {0};
        MaterialData data;
        write_table(same[k].text);
        if (!material_data_read(PATH, UNITS_SI, NULL, 1, &data, &err)) fail_msg("%s", err.message);
        assert_int_equal(data.data.count, 3);
        assert_true(data.shear == same[k].shear && !data.data.over_time);
        for (int32_t i = 0; i < 3; i++) {
            assert_near("frequency", data.data.at[i], pow(10, i), 1e-12 * pow(10, i));
            assert_near("storage", data.data.storage[i], storage[i], 1e-6);
            assert_near("loss", data.data.loss[i], loss[i], 1e-6);
        }
        material_data_destroy(&data);
    }
    Error err = {0};
    MaterialData data;
    write_table("Time (ms),E(t) (MPa)\n1,3\n10,2\n");
    assert_true(material_data_read(PATH, UNITS_SI, NULL, 10, &data, &err));
    assert_true(data.data.over_time && !data.data.loss);
    assert_near("time, ten times as long", data.data.at[1], 0.1, 1e-15);
    material_data_destroy(&data);
    unlink(PATH);
}

// Rows of two temperatures: what is slow and cold is what is fast and warm.
TEST(shifted_by_temperature)
{
    Error err = {0};
    MaterialData data;
    const double wlf[] = {8, 100, 20, 40};   // at 40 degrees log10 a_T = -8 * 20 / 120
    write_table("f (Hz),E' (MPa),E'' (MPa),T\n1,2,0.1,20\n1,2,0.1,40\n");
    assert_true(material_data_read(PATH, UNITS_SI, wlf, 1, &data, &err));
    double factor = pow(10, 8.0 * 20 / 120);
    assert_near("measured there", data.data.at[1], 2 * M_PI, 1e-12);
    assert_near("measured at T_ref", data.data.at[0], 2 * M_PI * factor, 1e-9 * factor);
    material_data_destroy(&data);
    unlink(PATH);
}

// A solid with three branches in shear and an elastic volume, or one that relaxes alike.
TEST(branches_of_known_moduli)
{
    enum { COUNT = 33 };
    const double time[] = {1e-3, 2e-2, 0.5}, modulus[] = {2e6, 8e5, 3e5}, rest = 1e6;
    for (int32_t relaxes = 0; relaxes < 2; relaxes++) {
        double poisson = relaxes ? 0.35 : 0.499, at[COUNT], storage[COUNT], loss[COUNT];
        double over_G = 2 * (1 + poisson) / (3 * (1 - 2 * poisson));
        for (int32_t i = 0; i < COUNT; i++) {
            at[i] = 0.5 * pow(10, 0.125 * i);
            double complex G = rest;
            for (int32_t k = 0; k < 3; k++)
                G += modulus[k] * I * at[i] * time[k] / (1 + I * at[i] * time[k]);
            double complex K = relaxes ? over_G * G : over_G * rest, E = 9 * K * G / (3 * K + G);
            storage[i] = creal(E);
            loss[i] = cimag(E);
        }
        Error err = {0};
        MaterialFit fit;
        MaterialData data = {{COUNT, false, at, storage, loss}, false};
        if (!material_fit(&data, poisson, relaxes, NAN, &fit, &err)) fail_msg("%s", err.message);
        assert_true(fit.misfit < 0.01 && fit.worst < 0.03);
        assert_near("young", fit.young / (2 * (1 + poisson) * rest), 1, 0.01);
        double sum = 0;
        for (int32_t k = 0; k < fit.relaxation.count; k++) {
            sum += fit.relaxation.branch[k].shear;
            assert_near("bulk", fit.relaxation.branch[k].bulk,
                        relaxes ? over_G * fit.relaxation.branch[k].shear : 0, 1);
        }
        assert_near("all branches", sum / 3.1e6, 1, 0.02);
        // A viscosity that is given is a part of the loss: what is left is the branches'.
        assert_true(material_fit(&data, poisson, relaxes, 1, &fit, &err));
        assert_true(fit.eta1 == 1 && fit.misfit < 0.01);
        assert_false(material_fit(&data, poisson, relaxes, 1e4, &fit, &err));
        assert_non_null(strstr(err.message, "eta1 alone, 10000, damps more"));
    }
}

TEST(a_scene_that_names_a_file)
{
    static const char TABLE[] = "f,E',E''\n0.1,1.1,0.1\n1,1.3,0.15\n10,1.6,0.2\n100,2,0.25\n";
    static const struct {
        const char *material, *words;   // words NULL: it is right
    } cases[] = {
        {"material: {from: material_file_test.csv, poisson: 0.45, eta1: 1e-5}", NULL},
        {"material: {from: material_file_test.csv, poisson: 0.45, young: 1}",
         "leave these out beside it"},
        {"material: {poisson: 0.45}\nmaterials: {pads: {from: material_file_test.csv}}", NULL},
        {"material: {poisson: 0.45}\nmaterials: {pads: {from: material_file_test.csv, young: 3}}",
         "materials: pads: `from` gives young and relaxation"},
        {"material: {from: none.csv, poisson: 0.45}", "material.from"},
        {"material: {from: material_file_test.csv, poisson: 0.45, wlf: [1, 2]}",
         "c1, c2, T_ref, T"},
        {"material: {from: material_file_test.csv, poisson: -0.5}", "more than an elastic volume"},
    };
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[SCENE_TEXT_MAX], path[PATH_MAX], place[PATH_MAX - 40];
        Error err = {0};
        write_table(TABLE);
        scene_text_with(4, cases[k].material, text);
        assert_non_null(getcwd(place, sizeof place));
        snprintf(path, sizeof path, "%s/material_scene_test.yaml", place);
        bool done = scene_of_text(path, text, scene, &err);
        if (done != !cases[k].words) fail_msg("%zu: %s", k, done ? "read" : err.message);
        if (!done && !strstr(err.message, cases[k].words)) fail_msg("%s", err.message);
        if (!done) continue;
        const SceneMaterial *region = scene->materials.count > 0 ? scene->materials.region : NULL;
        const SceneRelaxation *found = region ? &region->relaxation : &scene->material.relaxation;
        double young = region ? region->number[MATERIAL_YOUNG] : scene->material.young;
        assert_true(found->count >= 2 && young > 0.8 && young < 1.1);
        // The kept scene needs no file: the scene of a result is read as it was computed.
        char *kept = NULL;
        JsonWriter *json = json_create(NULL, &err);
        json_begin_object(json, NULL);
        scene_write_json(scene, json, "scene", place);
        json_end(json);
        kept = json_take(json, &err);
        assert_non_null(kept);
        assert_null(strstr(kept, "material_file_test.csv"));
        assert_non_null(strstr(kept, "relaxation"));
        memory_free(kept);
    }
    unlink(PATH);
    free(scene);
}

TEST(wrong_tables)
{
    static const char *const wrong[][2] = {
        {"f (Hz),E' (MPa)\n1,2\n2,3\n", "columns are missing; wanted: f, E' and E''"},
        {"f (Hz),E' (MPa),E'' (MPa)\n1,2,0.1\n2,3,-0.1\n",
         "test.csv:3:5: E'' (MPa): `-0.1`: a number above"},
        {"f (mm),E' (MPa),E'' (MPa)\n1,2,0.1\n2,3,0.1\n", "no unit of frequency; allowed: Hz"},
        {"f (Hz),E' (MPa),E'' (MPa),G' (MPa)\n1,2,0.1,1\n2,3,0.1,1\n", "stands beside E' (MPa)"},
        {"f (Hz),E' (MPa),E'' (MPa)\n1,2,0.1\n", "1 rows"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        Error err = {0};
        MaterialData data;
        write_table(wrong[k][0]);
        assert_false(material_data_read(PATH, UNITS_SI, NULL, 1, &data, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, wrong[k][1])) fail_msg("%s", err.message);
        material_data_destroy(&data);
    }
    unlink(PATH);
}
