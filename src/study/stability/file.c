// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the files of `amontons stability`: numbers in stability.json, mode shapes in stability.h5.
// Lengths are divided by L in the JSON (keys end in _over_L) and are in the scene's units in the
// arrays; NaN becomes null. The JSON is written last: where it exists, the arrays are complete.
#include "study/stability/stability.h"

#include "io/hdf5/array_file.h"
#include "io/text/json_writer.h"
#include "scene/keys.h"

#include <stdio.h>

// stability.json. ERROR_FILE: the folder cannot be written to.
static bool write_numbers(const StabilityPath *path, const StabilitySummary *summary, Error *err)
{
    char file[AMONTONS_PATH_SIZE + 32];
    snprintf(file, sizeof file, "%s/stability.json", path->options->folder);
    JsonWriter *json = json_create(file, err);
    if (!json) return false;
    json_begin_object(json, NULL);
    json_text(json, "status", "done");
    json_text(json, "version", AMONTONS_VERSION);
    scene_write_json(path->model->scene, json, "scene", path->options->folder);
    json_integer(json, "slidings_before", path->options->slidings);

    // Write where stability is lost first. *_at_V and mu_M are at the scene's velocity, the others
    // for V -> 0.
    json_begin_object(json, "results");
    json_numbers_of(json, {"l_sc_certificate_over_L", summary->l_sc_certificate},
                    {"l_sc_over_L", summary->l_sc}, {"l_sc_frequency", summary->frequency},
                    {"l_c_scan_over_L", summary->l_c_scan}, {"l_c_over_L", summary->l_c},
                    {"l_c_at_V_over_L", summary->l_c_rod}, {"A_sc_over_A", summary->area_sc},
                    {"A_c_over_A", summary->area_c}, {"A_c_at_V_over_A", summary->area_c_rod},
                    {"element_over_L", summary->element}, {"mu_l_sc", summary->mu_sc},
                    {"mu_snap", summary->mu_snap}, {"mu_M_adiabatic", summary->mu_c},
                    {"mu_M", summary->mu_rod}, {"U_adiabatic", summary->U_c},
                    {"U", summary->U_rod});
    json_text(json, "pad", summary->pads[summary->pad].name);
    json_numbers_of(json, {"steady_contact", summary->steady_contact},
                    {"nucleation_length", summary->nucleation_length},
                    {"critical_stiffness", summary->pads[summary->pad].critical_stiffness});
    json_begin_list(json, "why");
    for (int32_t k = 0; k < summary->why_count; k++) json_text(json, NULL, summary->why[k]);
    json_end(json);
    json_end(json);

    // Results of pad_growth.c; `mode` is relative to the pad that takes part most.
    json_begin_list(json, "pads");
    for (int32_t p = 0; p < summary->pad_count; p++) {
        const StabilityPad *pad = &summary->pads[p];
        json_begin_object(json, NULL);
        json_text(json, "name", pad->name);
        json_numbers_of(json, {"length", pad->length}, {"pressure", pad->pressure},
                        {"slipping_over_length", pad->slipping / pad->length}, {"mode", pad->mode},
                        {"load", pad->load}, {"l_c_over_length", pad->l_c / pad->length},
                        {"drag", pad->drag}, {"stiffness", pad->stiffness},
                        {"critical_stiffness", pad->critical_stiffness});
        json_end(json);
    }
    json_end(json);

    // The path's table: one entry per front position, rates in 1/time.
    double length = path->model->length;
    json_begin_list(json, "points");
    for (int32_t k = 0; k < path->count; k++) {
        const StabilityPoint *point = &path->points[k];
        json_begin_object(json, NULL);
        json_numbers_of(json, {"l_over_L", point->front / length}, {"slipping", point->slipping},
                        {"slipping_over_A", point->area}, {"U", point->U}, {"mu", point->mu},
                        {"mu_at_V", point->mu_at_V}, {"rate_re", point->rate_re},
                        {"rate_im", point->rate_im}, {"real_rate", point->real_rate},
                        {"load", point->load});
        json_boolean(json, "certified", point->certified);
        json_end(json);
    }
    json_end(json);

    json_object_of(json, "timing_s", {"before", summary->seconds_before},
                   {"path", summary->seconds_path}, {"growth", summary->seconds_growth});
    json_integer(json, "path_steps", summary->path_steps);
    json_end(json);
    return json_finish(json, err);
}

// Shapes: nodes and critical mode [contact nodes], modes [points][2][contact nodes], front
// [points], rate [points][2]. A file that could not be completed never gets its final name.
bool stability_write(const StabilityPath *path, const StabilitySummary *summary, Error *err)
{
    char name[AMONTONS_PATH_SIZE + 32];
    const Interface *interface = &path->model->interface;
    int32_t nodes = interface->contact_count;
    const StabilityPoint *points = path->points;
    int32_t stride = sizeof *points / sizeof(double);
    ArraySeries x = {"nodes/x", ARRAY_FLOAT64, 1, "length", "position of the contact nodes"};
    ArraySeries y = {"nodes/y", ARRAY_FLOAT64, 1, "length", "the same across the drive"};
    ArraySeries critical = {"critical/slip", ARRAY_FLOAT64, 1, "1",
                            "slip of the real growing mode at l_c at the contact nodes, largest 1; "
                            "0 where none was found"};
    ArraySeries modes = {"modes/slip", ARRAY_FLOAT32, 2 * nodes, "1",
                         "slip of the rightmost mode at each point: real part at the contact "
                         "nodes, then imaginary part; largest modulus 1"};
    ArraySeries front = {"points/front", ARRAY_FLOAT64, 1, "length",
                         "l, how far the front is from the trailing end"};
    ArraySeries rate = {"points/rate", ARRAY_FLOAT64, 2, "1/time",
                        "rightmost lambda of exp(lambda t), real and imaginary part"};
    snprintf(name, sizeof name, "%s/stability.h5", path->options->folder);
    ArrayFile *file = array_file_create(name, err);
    if (!file) goto cleanup;
    TRY(array_file_write(file, &x, interface->x, 0, nodes, err));
    if (interface->y) TRY(array_file_write(file, &y, interface->y, 0, nodes, err));
    TRY(array_file_write(file, &critical, path->critical_mode, 0, nodes, err));
    TRY(array_file_write(file, &modes, path->modes, 0, path->count, err));
    TRY(array_file_write(file, &front, &points->front, stride, path->count, err));
    TRY(array_file_write(file, &rate, &points->rate_re, stride, path->count, err));
cleanup:
    if (error_is_clean(err))
        return array_file_close(file, err) && write_numbers(path, summary, err);
    array_file_abandon(file);
    return false;
}
