// SPDX-License-Identifier: GPL-2.0-or-later
// A plot is described in a file (render/plot/plot_file.h), which the module `render` draws; the
// file is removed again.
#include "run/info/info_curves.h"

#include "amontons_pictures.h"
#include "base/memory.h"
#include "base/text.h"
#include "friction/friction_start.h"
#include "model/scene_mesh.h"
#include "run/result/figure_file.h"
#include "run/result/pictures.h"
#include "scene/friction_file.h"
#include "scene/friction_law.h"
#include "scene/material_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    PATH_SIZE = 1100,
    FRICTION_SPEEDS = 400,
    MODULUS_POINTS = 300,
    FILES_MAX = SCENE_MATERIALS_MAX + 1
};
static const double BEYOND = 3;   // how far a law is drawn beyond its data, in factors of speed
static const double DECADES = 1e3;   // beyond v_c to either side, where there are no data

bool info_picture_is_of(const char *picture, const char *name)
{
    const char *slash = strrchr(picture, '/'), *first = slash ? slash + 1 : picture;
    const char *dot = strrchr(first, '.');
    size_t length = dot ? (size_t)(dot - first) : strlen(first), size = strlen(name);
    return length >= size && strncmp(first + length - size, name, size) == 0;
}

// Draws the curves into options->picture. NaN: a gap. axes: words, unit and scale of each.
static bool draw_curves(const char *title, const char *const axes[2][3], const Curve *curves,
                        int32_t count, const InfoOptions *options, Error *err)
{
    char folder[PATH_SIZE], path[PATH_SIZE + 16];
    const char *place = getenv("TMPDIR");
    PictureStyle style = {.overwrite = options->overwrite};
    snprintf(folder, sizeof folder, "%s/amontons-XXXXXX", place && *place ? place : "/tmp");
    if (!mkdtemp(folder)) return FAULT(err, ERROR_FILE, "cannot make the folder %s", folder);
    snprintf(path, sizeof path, "%s/plot.json", folder);
    JsonWriter *json = json_create(path, err);
    Figure figure = {.json = json};
    TRY(json);
    json_begin_object(json, NULL);
    json_text(json, "title", title);
    for (int32_t d = 0; d < 2; d++)
        figure_write_axis(&figure, d == 0 ? "x" : "y", axes[d][0], axes[d][1], NULL, axes[d][2]);
    json_begin_list(json, "series");
    for (int32_t k = 0; k < count && error_is_clean(err); k++)
        figure_write_curve(&figure, &curves[k], err);
    json_end(json);
    json_end(json);
    if (!error_is_clean(err))
        json_abandon(json);
    else if (json_finish(json, err))
        pictures_draw_plot(path, options->picture, &style, err);
cleanup:
    unlink(path);
    rmdir(folder);
    return error_is_clean(err);
}

bool info_draw_friction(const Scene *scene, const InfoOptions *options, Error *err)
{
    const FrictionLaw *law = &scene->friction;
    const SceneFrictionKeys *own = &scene->friction_keys;
    FrictionData data = {0};
    double speed[FRICTION_SPEEDS], mu[FRICTION_SPEEDS], least = INFINITY, most = 0;
    double lowest = INFINITY, highest = -INFINITY;
    bool measured = law->kind == FRICTION_TABLE;
    if (scene_law_waits(scene))
        FAIL(err, ERROR_INPUT,
             "%s: mu depends on the pressure, which load.force makes on the mesh only; for its "
             "picture give the pressure: --set load.force=none --set load.pressure=...",
             scene->path);
    if (measured && *own->file) TRY(friction_data_read(scene, &data, err));
    int32_t points = data.count > 0 ? data.count : measured ? own->velocity.count : 0;
    const double *at = data.count > 0 ? data.velocity : own->velocity.value;
    const double *value = data.count > 0 ? data.mu : own->mu.value;

    // Slip rates go from below the slowest to beyond the fastest that was measured; without a
    // measurement they lie around v_c.
    double middle = law->critical_velocity > 0 ? law->critical_velocity : scene->rod.velocity;
    for (int32_t k = 0; k < points; k++)
        if (at[k] > 0) least = fmin(least, at[k] / BEYOND), most = fmax(most, at[k] * BEYOND);
    if (!(most > 0)) {
        if (!(middle > 0)) middle = 1;
        least = middle / DECADES;
        most = middle * DECADES;
    }
    double rod = scene->rod.velocity;
    if (rod > 0) least = fmin(least, rod / BEYOND), most = fmax(most, rod * BEYOND);
    for (int32_t k = 0; k < FRICTION_SPEEDS; k++) {
        speed[k] = least * pow(most / least, (double)k / (FRICTION_SPEEDS - 1));

        // The coefficient mu of a law that remembers is that of steady slip; NaN: none is found.
        FrictionNode node = friction_node(law, 1);
        FrictionRates rates = {.mu = NAN};
        node.pressure = law->pressure;
        if (law->remembers) friction_start_state(&node, node.from);
        if (law->remembers && friction_find_steady(&node, speed[k]))
            friction_rates(&node, speed[k], node.from, &rates);
        mu[k] = law->remembers ? rates.mu : friction_coefficient(&node, speed[k]);
        lowest = fmin(lowest, mu[k]);
        highest = fmax(highest, mu[k]);
    }
    double rest = law->mu_static, ends[2] = {least, most}, level[2] = {rest, rest};
    double driven[2] = {rod, rod}, span[2] = {fmin(lowest, rest), fmax(highest, rest)};
    char at_rest[80];
    snprintf(at_rest, sizeof at_rest, "at rest: %.3g", rest);
    Curve curves[4] = {{law->remembers ? "steady slip" : "the law", "solid", "none", 1,
                        FRICTION_SPEEDS, true, speed, mu, NULL, false}};
    int32_t count = 1;
    if (!law->creeps)
        curves[count++] = (Curve){at_rest, "dashed", "none", 0, 2, true, ends, level, NULL, false};
    if (rod > 0)
        curves[count++] =
            (Curve){"~{V} of the rod", "thin", "none", 2, 2, true, driven, span, NULL, false};
    if (points > 0)
        curves[count++] =
            (Curve){"measured", "none", "circle", 3, points, true, at, value, data.error, false};
    const char *const axes[2][3] = {
        {"slip rate ~{v}", scene->units == UNITS_SI ? "m/s" : NULL, "log"},
        {"coefficient ~{\xCE\xBC}", NULL, "linear"}};
    TRY(draw_curves(*scene->title ? scene->title : "friction", axes, curves, count, options, err));
cleanup:
    friction_data_destroy(&data);
    return error_is_clean(err);
}

// --- materials -----------------------------------------------------------------------------------

static const double TWO_PI = 6.283185307179586;

// Regions whose moduli come from a file; NULL: `material` itself. Returns how many.
static int32_t find_files(const Scene *scene, const SceneMaterial *found[FILES_MAX])
{
    int32_t count = 0;
    if (*scene->material.from) found[count++] = NULL;
    for (int32_t k = 0; k < scene->materials.count; k++)
        if (*scene->materials.region[k].from) found[count++] = &scene->materials.region[k];
    return count;
}

static const char *path_of(const Scene *scene, const SceneMaterial *region)
{
    return region ? region->from : scene->material.from;
}

// The least and the largest place of the data.
static void find_ends(const RelaxationData *data, double ends[2])
{
    ends[0] = INFINITY;
    ends[1] = 0;
    for (int32_t i = 0; i < data->count; i++) {
        ends[0] = fmin(ends[0], data->at[i]);
        ends[1] = fmax(ends[1], data->at[i]);
    }
}

bool info_write_material(const Scene *scene, FILE *out, Error *err)
{
    const SceneMaterial *found[FILES_MAX];
    int32_t count = find_files(scene, found);
    for (int32_t k = 0; k < count; k++) {
        MaterialData data;
        MaterialFit fit;
        const char *key = NULL;
        if (!scene_material_file(scene, found[k], &data, &fit, &key, err)) {
            material_data_destroy(&data);
            return false;
        }
        bool over_time = data.data.over_time;
        double ends[2], per = over_time ? 1 : TWO_PI;
        const char *unit = scene->units != UNITS_SI ? "" : over_time ? " s" : " Hz";
        find_ends(&data.data, ends);
        fprintf(out,
                "\nModuli of %s: %d branches, long-time E %.4g, eta1 %.4g; off by %.2g %% (root "
                "mean square), %.2g %% at most\n  data from %.3g to %.3g%s; outside of them the "
                "fit goes on as its branches do\n",
                path_of(scene, found[k]), fit.relaxation.count, fit.young, fit.eta1,
                100 * fit.misfit, 100 * fit.worst, ends[0] / per, ends[1] / per, unit);
        if (!(fit.eta1 > 0) && !over_time)
            fprintf(out,
                    "  nothing damps what is faster; eta1 = %.3g beside the file is a tenth of the "
                    "loss at the highest frequency\n",
                    material_fit_viscosity(&fit, &data));
        for (int32_t b = 0; b < fit.relaxation.count; b++)
            fprintf(out, "  time %-10.4g shear %-10.4g bulk %.4g\n", fit.relaxation.branch[b].time,
                    fit.relaxation.branch[b].shear, fit.relaxation.branch[b].bulk);
        material_data_destroy(&data);
    }
    return true;
}

bool info_draw_material(const Scene *scene, const InfoOptions *options, Error *err)
{
    const SceneMaterial *regions[FILES_MAX];
    MaterialData data = {0};
    MaterialFit fit;
    double x[MODULUS_POINTS], y[2][MODULUS_POINTS], ends[2], band[2] = {0, 0}, least = INFINITY,
                                                             most = 0;
    double *at = NULL;
    const char *key = NULL;
    bool si = scene->units == UNITS_SI, known = false;
    if (find_files(scene, regions) == 0)
        return REFUSE(err, "%s: no material of the scene comes from a table (`from`)", scene->path);
    TRY(scene_material_file(scene, regions[0], &data, &fit, &key, err));
    const RelaxationData *moduli = &data.data;
    bool over_time = moduli->over_time;
    double per = over_time ? 1 : TWO_PI;
    find_ends(moduli, ends);
    double from = ends[0] / per / BEYOND, to = ends[1] / per * BEYOND;

    // Frequencies between those of the whole run and of a shear wave through the shortest cell of
    // the mesh, Hz; not known where the scene does not say how long it runs.
    if (!over_time) {
        double until = scene->time.until_t;
        if (scene->time.until_U > 0 && scene->rod.velocity > 0)
            until = fmin(until > 0 ? until : INFINITY, scene->time.until_U / scene->rod.velocity);
        const SceneMaterial *region = regions[0];
        double density = region && region->given[MATERIAL_DENSITY]
                             ? region->number[MATERIAL_DENSITY]
                             : scene->material.density;
        double shear = fit.shear.rest;
        for (int32_t k = 0; k < fit.shear.count; k++) shear += fit.shear.modulus[k];
        Mesh mesh = {0};
        bool meshed = scene_mesh_read(scene, NULL, &mesh, NULL, err);
        double cell = meshed ? mesh_summarise(&mesh).edge_min : NAN;
        mesh_destroy(&mesh);
        TRY(meshed);
        known = until > 0;
        band[0] = 1 / until;
        band[1] = sqrt(shear / density) / cell;
    }
    if (known) from = fmin(from, band[0] / BEYOND), to = fmax(to, band[1] * BEYOND);
    TRY(at = NEW_ARRAY(double, moduli->count, err));
    for (int32_t i = 0; i < moduli->count; i++) at[i] = moduli->at[i] / per;
    for (int32_t k = 0; k < MODULUS_POINTS; k++) {
        double value[2];
        x[k] = from * pow(to / from, (double)k / (MODULUS_POINTS - 1));
        material_fit_at(&fit, &data, per * x[k], value);
        for (int32_t d = 0; d < 2; d++) {
            y[d][k] = value[d] > 0 ? value[d] : NAN;
            if (over_time && d == 1) continue;
            least = fmin(least, y[d][k]);
            most = fmax(most, y[d][k]);
        }
    }
    const char *words[2] = {over_time    ? data.shear ? "~{G}" : "~{E}"
                            : data.shear ? "~{G}\u2032"
                                         : "~{E}\u2032",
                            data.shear ? "~{G}\u2033" : "~{E}\u2033"};
    char label[2][80], title[SCENE_TEXT_SIZE + 80];
    const char *path = path_of(scene, regions[0]), *slash = strrchr(path, '/');
    snprintf(label[0], sizeof label[0], "fit: %d branches", fit.relaxation.count);
    snprintf(label[1], sizeof label[1], "%s measured", words[0]);
    snprintf(title, sizeof title, "%s: off by %.2g %%, %.2g %% at most", slash ? slash + 1 : path,
             100 * fit.misfit, 100 * fit.worst);
    char loss[80];
    snprintf(loss, sizeof loss, "%s measured", words[1]);
    double low[2] = {band[0], band[0]}, high[2] = {band[1], band[1]}, span[2] = {least, most};
    Curve curves[6] = {{label[0], "solid", "none", 1, MODULUS_POINTS, true, x, y[0], NULL, false}};
    int32_t count = 1;
    if (!over_time)
        curves[count++] =
            (Curve){"", "solid", "none", 1, MODULUS_POINTS, true, x, y[1], NULL, false};
    int32_t measured = moduli->count;
    curves[count++] =
        (Curve){label[1], "none", "circle", 3, measured, true, at, moduli->storage, NULL, false};
    if (!over_time)
        curves[count++] =
            (Curve){loss, "none", "square", 2, measured, true, at, moduli->loss, NULL, false};
    if (known) {
        const char *rates = "rates of the run: 1/duration, wave/cell";
        curves[count++] = (Curve){rates, "thin", "none", 0, 2, true, low, span, NULL, false};
        curves[count++] = (Curve){"", "thin", "none", 0, 2, true, high, span, NULL, false};
    }
    const char *unit = !si ? NULL : over_time ? "s" : "Hz";
    const char *const axes[2][3] = {{over_time ? "time ~{t}" : "frequency ~{f}", unit, "log"},
                                    {"modulus", si ? "Pa" : NULL, "log"}};
    TRY(draw_curves(title, axes, curves, count, options, err));
cleanup:
    memory_free(at);
    material_data_destroy(&data);
    return error_is_clean(err);
}
