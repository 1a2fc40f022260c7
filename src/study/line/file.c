// SPDX-License-Identifier: GPL-2.0-or-later
// The files of `amontons model1d`: numbers in model1d.json, curves in model1d.h5. The simulation's
// steps are in history.h5, as those of a block (record/history). Lengths are over L in the JSON
// (keys end in _over_L), in the scene's units in the arrays. The JSON is written last.
#include "study/line/model1d.h"

#include "io/hdf5/array_file.h"
#include "io/text/json_writer.h"
#include "scene/keys.h"

#include <stddef.h>
#include <stdio.h>

enum { PROFILE_POINTS = 201 };

// A curve over the points of the theory's table. X(member, name, unit, description)
#define POINT_CURVES(X)                                                                            \
    X(front, "points/front", "length", "l, position of the quasi-static front")                    \
    X(U, "points/U", "length", "rod displacement since sliding stopped that leads it there")       \
    X(mu, "points/mu", "1", "F_T/F_N of the adiabatic solution")                                   \
    X(mu_line, "points/mu_line", "1", "mu_K + (mu_S - mu_K) l/L")                                  \
    X(omega_re, "points/omega_re", "1/time", "Re omega_0, off-diagonal terms neglected")           \
    X(omega_im, "points/omega_im", "1/time", "Im omega_0 >= 0")                                    \
    X(rate_re, "points/rate_re", "1/time", "real part of the rightmost rate, all terms kept")      \
    X(rate_im, "points/rate_im", "1/time", "its imaginary part >= 0")                              \
    X(front_seen, "points/front_seen", "length", "simulated front at the same U; nan: slid")       \
    X(mu_seen, "points/mu_seen", "1", "simulated F_T/F_N at the same U; nan: slid")

static bool write_numbers(const Model1dSimulation *simulation, const Model1dSummary *summary,
                          Error *err)
{
    char file[AMONTONS_PATH_SIZE + 32];
    snprintf(file, sizeof file, "%s/model1d.json", simulation->options->folder);
    JsonWriter *json = json_create(file, err);
    if (!json) return false;
    json_begin_object(json, NULL);
    json_text(json, "status", "done");
    json_text(json, "version", AMONTONS_VERSION);
    scene_write_json(simulation->scene, json, "scene", simulation->options->folder);

    // The constants of equation 1 in the scene's units, to solve it by other means.
    const Model1d *model = &simulation->model;
    json_begin_object(json, "model");
    json_numbers_of(
        json, {"alpha", model->alpha}, {"length", model->length}, {"height", model->height},
        {"drive_height", model->drive}, {"E_1", model->elastic_x}, {"E_2", model->elastic_shear},
        {"eta_t", model->viscous_x}, {"eta_s", model->viscous_shear}, {"modes", MODEL1D_MODES});
    if (!simulation->options->theory_only) json_integer(json, "nodes", simulation->options->nodes);
    json_end(json);

    // Plain names: the paper's formula (couplings neglected). *_full: all terms. *_at_V: at the
    // scene's velocity. null: not up to L.
    json_object_of(json, "theory", {"range_over_L", summary->range}, {"l_sc_over_L", summary->l_sc},
                   {"l_c_over_L", summary->l_c}, {"l_c_small_over_L", summary->l_c_small},
                   {"mu_M", summary->mu_c}, {"l_sc_full_over_L", summary->l_sc_full},
                   {"l_c_full_over_L", summary->l_c_full},
                   {"l_c_at_V_full_over_L", summary->l_rod_full}, {"mu_M_full", summary->mu_c_full},
                   {"mu_M_at_V_full", summary->mu_rod_full});

    if (summary->simulated) {
        // first_*: the first peak, which starts from u_0; the others are means over the periodic
        // regime.
        json_begin_object(json, "simulation");
        json_numbers_of(json, {"first_mu", summary->first_mu},
                        {"first_l_sc_over_L", summary->first_l_sc},
                        {"first_l_c_over_L", summary->first_l_c}, {"mu_M", summary->mu_M},
                        {"mu_M_spread", summary->mu_M_spread}, {"period", summary->period},
                        {"l_sc_over_L", summary->l_sc_seen}, {"l_c_over_L", summary->l_c_seen},
                        {"bounded", summary->bounded}, {"leading", summary->leading},
                        {"quasi_static_error", summary->quasi_static_error},
                        {"energy_error", summary->energy_error},
                        {"complementarity_error", summary->contact_error});
        json_integer(json, "accepted", summary->accepted);
        json_integer(json, "rejected", summary->rejected);
        Answers answers = answers_of(&simulation->drops);
        answers_write_peaks(&answers, &simulation->drops, simulation->model.length, json);
        json_end(json);
    }

    json_number(json, "seconds", summary->seconds);
    json_end(json);
    return json_finish(json, err);
}

// A file that could not be completed never gets its final name.
bool model1d_write(const Model1dSimulation *simulation, const Model1dSummary *summary, Error *err)
{
    static const struct {
        const char *name, *unit, *description;
        size_t offset;
    } curves[] = {
#define X(member, name, unit, description)                                                         \
    {name, unit, description, offsetof(Model1dPoint, member)},
        POINT_CURVES(X)
#undef X
    };
    ArraySeries position = {"profile/x", ARRAY_FLOAT64, 1, "length", "position along the line"};
    ArraySeries rest = {"profile/u_0", ARRAY_FLOAT64, 1, "length",
                        "displacement after sliding, tau = mu_K p everywhere, U = 0"};
    ArraySeries slip = {"profile/u_a", ARRAY_FLOAT64, simulation->point_count, "length",
                        "adiabatic displacement at each front of points/front, one a column"};
    const Model1d *model = &simulation->model;
    char name[AMONTONS_PATH_SIZE + 32];
    snprintf(name, sizeof name, "%s/model1d.h5", simulation->options->folder);
    ArrayFile *file = array_file_create(name, err);
    if (!file) goto cleanup;
    for (size_t k = 0; k < sizeof curves / sizeof curves[0]; k++) {
        ArraySeries series = {curves[k].name, ARRAY_FLOAT64, 1, curves[k].unit,
                              curves[k].description};
        const char *first = (const char *)simulation->points + curves[k].offset;
        TRY(array_file_write(file, &series, (const double *)(const void *)first,
                             sizeof(Model1dPoint) / sizeof(double), simulation->point_count, err));
    }

    // u_0 and, for each of the table's fronts, u_a.
    TRY(array_file_add_series(file, &position, err));
    TRY(array_file_add_series(file, &rest, err));
    TRY(array_file_add_series(file, &slip, err));
    for (int32_t i = 0; i < PROFILE_POINTS; i++) {
        double x = model->length * i / (PROFILE_POINTS - 1), u = model1d_rest(model, x);
        double row[MODEL1D_POINTS] = {0};
        for (int32_t k = 0; k < simulation->point_count; k++)
            row[k] = u + model1d_slip(model, simulation->points[k].front, x);
        TRY(array_file_append(file, position.name, &x, 1, err));
        TRY(array_file_append(file, rest.name, &u, 1, err));
        TRY(array_file_append(file, slip.name, row, 1, err));
    }
cleanup:
    if (error_is_clean(err))
        return array_file_close(file, err) && write_numbers(simulation, summary, err);
    array_file_abandon(file);
    return false;
}
