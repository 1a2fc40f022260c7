// SPDX-License-Identifier: GPL-2.0-or-later
// A plot is described in a file (render/plot/plot_file.h), which the module `render` draws; the
// file is removed again.
#include "run/info/info_curves.h"

#include "amontons_pictures.h"
#include "base/memory.h"
#include "base/text.h"
#include "friction/friction_start.h"
#include "io/text/json_writer.h"
#include "scene/friction_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 1100, FRICTION_SPEEDS = 400 };
static const double BEYOND = 3;   // how far a law is drawn beyond its data, in factors of speed
static const double DECADES = 1e3;   // beyond v_c to either side, where there are no data

bool info_picture_is_of(const char *picture, const char *name)
{
    const char *slash = strrchr(picture, '/'), *first = slash ? slash + 1 : picture;
    const char *dot = strrchr(first, '.');
    size_t length = dot ? (size_t)(dot - first) : strlen(first), size = strlen(name);
    return length >= size && strncmp(first + length - size, name, size) == 0;
}

static void write_list(JsonWriter *json, const char *name, const double *value, const double *error,
                       double sign, int32_t count)
{
    json_begin_list(json, name);
    for (int32_t k = 0; k < count; k++)
        json_number(json, NULL, value[k] + (error ? sign * error[k] : 0));
    json_end(json);
}

static void write_plot(JsonWriter *json, const char *title, const InfoAxis axes[2],
                       const InfoCurve *curves, int32_t count)
{
    json_begin_object(json, NULL);
    json_text(json, "title", title);
    for (int32_t d = 0; d < 2; d++) {
        json_begin_object(json, d == 0 ? "x" : "y");
        json_text(json, "label", axes[d].label);
        if (axes[d].unit) json_text(json, "unit", axes[d].unit);
        json_text(json, "scale", axes[d].by_log ? "log" : "linear");
        json_end(json);
    }
    json_begin_list(json, "series");
    for (int32_t k = 0; k < count; k++) {
        const InfoCurve *curve = &curves[k];
        json_begin_object(json, NULL);
        json_text(json, "label", curve->label);
        write_list(json, "x", curve->x, NULL, 0, curve->count);
        write_list(json, "y", curve->y, NULL, 0, curve->count);
        if (curve->error) {
            write_list(json, "low", curve->y, curve->error, -1, curve->count);
            write_list(json, "high", curve->y, curve->error, 1, curve->count);
        }
        json_integer(json, "color", curve->color);
        json_text(json, "marker", curve->marker);
        json_boolean(json, "filled", true);
        json_text(json, "line", curve->line);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}

bool info_draw_curves(const char *title, const InfoAxis axes[2], const InfoCurve *curves,
                      int32_t count, const InfoOptions *options, Error *err)
{
    char folder[PATH_SIZE], path[PATH_SIZE + 16];
    const char *place = getenv("TMPDIR");
    PictureStyle style = {.overwrite = options->overwrite};
    snprintf(folder, sizeof folder, "%s/amontons-XXXXXX", place && *place ? place : "/tmp");
    if (!mkdtemp(folder)) return FAULT(err, ERROR_FILE, "cannot make the folder %s", folder);
    snprintf(path, sizeof path, "%s/plot.json", folder);
    JsonWriter *json = json_create(path, err);
    if (json) write_plot(json, title, axes, curves, count);
    bool done = json && json_finish(json, err) &&
                amontons_render_plot_file(path, options->picture, &style, err);
    unlink(path);
    rmdir(folder);
    return done;
}

// mu at a slip rate, of a law that remembers in steady slip; NaN: no such state is found.
static double steady_mu(const FrictionLaw *law, double speed)
{
    FrictionNode node = friction_node(law, 1);
    FrictionRates rates = {0};
    node.pressure = law->pressure;
    if (!law->remembers) return friction_coefficient(&node, speed);
    friction_start_state(&node, node.from);
    if (!friction_find_steady(&node, speed)) return NAN;
    friction_rates(&node, speed, node.from, &rates);
    return rates.mu;
}

bool info_draw_friction(const Scene *scene, const InfoOptions *options, Error *err)
{
    const FrictionLaw *law = &scene->friction;
    const SceneOwnFriction *own = &scene->own_friction;
    FrictionData data = {0};
    double speed[FRICTION_SPEEDS], mu[FRICTION_SPEEDS], least = INFINITY, most = 0;
    double lowest = INFINITY, highest = -INFINITY;
    bool measured = law->kind == FRICTION_TABLE;
    if (measured && *own->file) TRY(friction_data_read(scene, &data, err));
    int32_t points = data.count > 0 ? data.count : measured ? own->velocity.count : 0;
    const double *at = data.count > 0 ? data.velocity : own->velocity.value;
    const double *value = data.count > 0 ? data.mu : own->mu.value;

    // From below the slowest to beyond the fastest that was measured, else around v_c.
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
        mu[k] = steady_mu(law, speed[k]);
        lowest = fmin(lowest, mu[k]);
        highest = fmax(highest, mu[k]);
    }
    double rest = law->mu_static, ends[2] = {least, most}, level[2] = {rest, rest};
    double driven[2] = {rod, rod}, span[2] = {fmin(lowest, rest), fmax(highest, rest)};
    char at_rest[80];
    snprintf(at_rest, sizeof at_rest, "at rest: %.3g", rest);
    InfoCurve curves[4] = {{law->remembers ? "steady slip" : "the law", "solid", "none", 1,
                            FRICTION_SPEEDS, speed, mu, NULL}};
    int32_t count = 1;
    if (!law->creeps)
        curves[count++] = (InfoCurve){at_rest, "dashed", "none", 0, 2, ends, level, NULL};
    if (rod > 0)
        curves[count++] = (InfoCurve){"~{V} of the rod", "thin", "none", 2, 2, driven, span, NULL};
    if (points > 0)
        curves[count++] =
            (InfoCurve){"measured", "none", "circle", 3, points, at, value, data.error};
    InfoAxis axes[2] = {{"slip rate ~{v}", scene->units == UNITS_SI ? "m/s" : NULL, true},
                        {"coefficient ~{\xCE\xBC}", NULL, false}};
    TRY(info_draw_curves(*scene->title ? scene->title : "friction", axes, curves, count, options,
                         err));
cleanup:
    friction_data_destroy(&data);
    return error_is_clean(err);
}
