// SPDX-License-Identifier: GPL-2.0-or-later
// run.json, one object, written when all else is: a folder without it holds no finished result.
// Scripts read it by key: keys may be added, none may change its name or meaning. A number that is
// NaN or infinite is written as null (io/text/json_writer), and says that there was none. `length`
// below is the block's: lengths are given over it where the key says over_L.
#include "run/simulation_state.h"

#include "answers/program_results.h"
#include "answers/answers.h"
#include "base/computation.h"
#include "base/kernels.h"
#include "io/text/json_writer.h"
#include "model/loads.h"
#include "run/warnings.h"
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>

// Writes `model` and, for a block on a base, `base`: how unlike the two are, and how far the block
// slid over it.
static void write_model(JsonWriter *json, const Simulation *simulation)
{
    const Model *model = &simulation->model;
    const Material *block = &model->materials.list[model->contact_region];
    const Material *base = &model->materials.list[model->floor_region];
    WaveSpeeds speeds = material_speeds(block);
    json_begin_object(json, "model");
    json_numbers_of(json, {"contact_nodes", model->interface.contact_count},
                    {"rod_nodes", model->interface.rod_count},
                    {"elements", model->mesh.element_count}, {"full_dofs", model->bulk.dof_count});
    json_integer(json, "reduced_dofs", model->system.dof_count);
    json_boolean(json, "by_halves", model->reduced.part_count > 1);
    json_text(json, "mesh_by", model->mesh_origin == MESH_OF_CACHE ? "cache" : "gmsh");
    json_boolean(json, "from_cache", model->from_cache);
    json_number(json, "mesh_scale", model->mesh.move.scale);
    json_number_list(json, "mesh_shift", model->mesh.move.shift, model->mesh.dim);
    json_numbers_of(json, {"length", model->length}, {"height", model->height},
                    {"pressure", model->pressure});
    json_object_of(json, "wave_speeds", {"longitudinal", speeds.longitudinal},
                   {"shear", speeds.shear}, {"rayleigh", speeds.rayleigh});
    json_number(json, "wave_damping",
                material_wave_damping(block, fmax(model->length, model->height)));
    json_integer(json, "relaxation_steps", simulation->relaxation_steps);
    json_text(json, "cache_note", model->cache_note[0] ? model->cache_note : NULL);
    json_end(json);

    double slip = base_slip(model, &simulation->control.now);   // NaN: the floor is rigid
    if (!isnan(slip)) {
        Dundurs dundurs = materials_dundurs(block, base);
        json_begin_object(json, "base");
        json_boolean(json, "matches", model->mesh.floor.matches);
        json_numbers_of(
            json, {"slip_over_contact", slip}, {"dundurs_alpha", dundurs.alpha},
            {"dundurs_beta", dundurs.beta},
            {"shear_impedance_over_block", base->density * material_speeds(base).shear /
                                               (block->density * material_speeds(block).shear)});
        json_end(json);
    }
}

// Writes the length of a pad over which slow slip turned fast. A slow event has none.
static void write_slip(JsonWriter *json, const Event *event, const Pads *pads)
{
    bool named = event && event->pad >= 0 && event->pad < pads->count &&
                 *pads->list[event->pad].name;
    json_text(json, "slip_pad", named ? pads->list[event->pad].name : NULL);
    json_numbers_of(json, {"slip_length", event ? event->slip_length : NAN},
                    {"slip_cells", event ? event->slip_cells : NAN});
}

static void write_results(JsonWriter *json, const Simulation *simulation)
{
    const Answers *answers = &simulation->answers;
    const Model *model = &simulation->model;
    json_begin_object(json, "results");
    answers_write_json(answers, &simulation->drops, model->length, json);

    // Forces of the whole block at the load ratios of the answers; in the plane with `thickness`
    // only.
    double load = model->scales.load * scene_whole_force(&simulation->scene, model->interface.dim);
    if (!isnan(load))
        json_numbers_of(json, {"F_N", load}, {"F_T_M", load * answers->mu_M.value},
                        {"F_T_hold", load * answers->mu_hold.value},
                        {"F_T_max", load * answers->mu_max});
    steady_write_json(&simulation->steady, answers, json);
    write_slip(json, simulation->least_resolved, &simulation->pads);
    pads_write_json(&simulation->pads, json);
    if (simulation->rotation.contact && model->interface.dim > 2)
        rotation_write_json(&simulation->rotation, json);
    if (simulation->readings.course) program_results_json(&simulation->readings, json);

    // Events in order of time, slow ones too; only rapid ones have a front to follow.
    const Events *events = &simulation->events;
    const Material *material =
        model->materials.count > 0 ? &model->materials.list[model->contact_region] : NULL;
    double wave_speed = material ? material_speeds(material).longitudinal : (double)NAN;
    json_begin_list(json, "events");
    for (int32_t k = 0; k < events->count; k++) {
        const Event *event = &events->list[k];
        json_begin_object(json, NULL);
        json_text(json, "kind", event_name(event->kind));
        json_numbers_of(json, {"U_start", event->U_start}, {"U_stop", event->U_stop},
                        {"t_start", event->t_start}, {"t_stop", event->t_stop},
                        {"front_start", event->front_start}, {"reach", event->reach});
        if (events->in_space) {
            json_numbers_of(json, {"slipped_over_A", event->slipped / events->size},
                            {"slip_before_over_A", event->slip_before / events->size});
        }
        json_numbers_of(json, {"peak_slip_rate", event->peak_slip_rate},
                        {"front_speed", event->front_speed});
        if (event->kind != EVENT_QUASI_STATIC) {
            write_slip(json, event, &simulation->pads);

            // Write when the front of a rapid event came to each station, how fast it went in
            // between, and if that is faster than the fastest wave anywhere.
            double speeds[FRONT_STATIONS - 1];
            bool faster = fabs(event->front_speed) > wave_speed;
            for (int32_t s = 0; s < FRONT_STATIONS - 1; s++) {
                speeds[s] = front_path_speed(&events->path, event->front_times, s);
                faster = faster || fabs(speeds[s]) > wave_speed;
            }
            json_boolean(json, "faster_than_waves", faster);
            json_number_list(json, "front_times", event->front_times, FRONT_STATIONS);
            json_number_list(json, "front_speeds", speeds, FRONT_STATIONS - 1);
        }
        json_end(json);
    }
    json_end(json);
    json_end(json);
}

// Writes where the work since the rod's start went, per width in the plane. A run that failed
// before there was a block to step has none.
static void write_energy(JsonWriter *json, const Simulation *simulation)
{
    const EnergyLedger *ledger = &simulation->control.ledger;
    const BulkOperator *system = &simulation->model.system;
    const Spectrum *spectrum = bulk_operator_spectrum(system);
    if (system->dof_count == 0) return;
    json_begin_object(json, "energy");
    json_numbers_of(json, {"rod_work", ledger->rod_work}, {"load_work", ledger->load_work},
                    {"viscous", ledger->viscous}, {"frictional", ledger->frictional},
                    {"elastic", ledger->elastic}, {"kinetic", ledger->kinetic},
                    {"stored_at_start", ledger->stored_at_start});
    json_begin_list(json, "branches");
    for (int32_t k = 0; k < spectrum->count; k++)
        json_object_of(json, NULL, {"time", spectrum->time[k]},
                       {"stored", ledger->branch[k].stored},
                       {"dissipated", ledger->branch[k].dissipated});
    json_end(json);
    json_end(json);
}

static void write_all(const Simulation *simulation, const Error *failure, const char *folder,
                      JsonWriter *json)
{
    char sources[HASH_TEXT_SIZE];
    Hash computation = computation_hash();
    hash_write(&computation, sources);
    json_begin_object(json, NULL);
    json_text(json, "status", failure ? "failed" : "done");
    if (failure) {
        json_text(json, "failure", amontons_error_name(failure->code));
        json_text(json, "message", failure->message);
    }
    json_text(json, "version", AMONTONS_VERSION);

    // Rounding depends on the kernels: writes those of OpenBLAS, and those that this processor
    // could run.
    json_begin_object(json, "kernels");
    json_text(json, "openblas", kernels_name());
    json_text(json, "possible", kernels_possible());
    json_end(json);

    json_text(json, "sources", sources);
    json_integer(json, "resumed", simulation->resumed);

    json_begin_list(json, "warnings");
    for (int32_t k = 0; k < simulation->warnings.count; k++)
        json_text(json, NULL, simulation->warnings.text[k]);
    json_end(json);

    scene_write_json(&simulation->scene, json, "scene", folder);

    // The counters of amontons.h, name by name: a benchmark reads them here.
    const RunCounters *steps = &simulation->counters;
    json_begin_object(json, "steps");
    json_integer(json, "accepted", steps->accepted);
    json_integer(json, "rejected", steps->rejected);
    json_integer(json, "rejected_uncertified", steps->rejected_uncertified);
    json_integer(json, "stepped_over_oscillations", steps->stepped_over_oscillations);
    json_integer(json, "unsolved_retries", steps->unsolved_retries);
    json_integer(json, "factorisations", steps->factorisations);
    json_integer(json, "solves", steps->solves);
    json_integer(json, "contact_solves", steps->contact_solves);
    json_integer(json, "contact_iterations", steps->contact_iterations);
    json_integer(json, "contact_fallbacks", steps->contact_fallbacks);
    json_integer(json, "contact_rescued", steps->contact_rescued);
    json_integer(json, "certificates", steps->certificates);
    json_integer(json, "loop_allocations", steps->loop_allocations);
    json_end(json);

    // Levels on which a step was accepted, the longest first.
    const DtLevels *dt_levels = &simulation->control.dt_levels;
    json_begin_list(json, "step_sizes");
    for (int32_t k = 0; k < dt_levels->level_count; k++) {
        if (dt_levels->accepted[k] == 0) continue;
        json_begin_object(json, NULL);
        json_number(json, "dt", dt_level_step(dt_levels, k));
        json_integer(json, "accepted", dt_levels->accepted[k]);
        json_end(json);
    }
    json_end(json);

    // Wall seconds by stage; bulk is what is left of relaxing and solving, its products and
    // substitutions. outside_loop_cpu is processor time, of all but the loop of steps and relaxing.
    const RunTiming *timing = &simulation->timing;
    const StepControl *control = &simulation->control;
    double levels = control->dt_levels.seconds, contact = control->scheme.solver.seconds;
    double certificate = control->certificate.seconds;
    double bulk = fmax(timing->relax + timing->solve - levels - contact - certificate, 0);
    json_object_of(json, "timing_s", {"mesh", simulation->model.seconds_mesh},
                   {"reduce", simulation->model.seconds_reduce}, {"relax", timing->relax},
                   {"solve", timing->solve}, {"levels", levels}, {"contact", contact},
                   {"certificate", certificate}, {"bulk", bulk}, {"output", timing->output},
                   {"total", timing->total}, {"outside_loop_cpu", timing->outside});

    write_model(json, simulation);
    write_results(json, simulation);
    if (simulation->levels) levels_write_json(simulation->levels, json);
    write_energy(json, simulation);

    const RunErrors *errors = &simulation->errors;
    json_object_of(json, "errors", {"energy", errors->energy},
                   {"complementarity", errors->complementarity},
                   {"penetration", errors->penetration}, {"moment", errors->moment},
                   {"moment_quasi_static", errors->moment_quasi_static},
                   {"equation", errors->equation}, {"reduction", errors->reduction});

    json_end(json);
}

// Written beside its name and renamed: never half a report.
bool report_write(const Simulation *simulation, const Error *failure, const char *folder,
                  Error *err)
{
    char path[AMONTONS_PATH_SIZE + 16];
    snprintf(path, sizeof path, "%s/run.json", folder);
    JsonWriter *json = json_create(path, err);
    if (!json) return false;
    write_all(simulation, failure, folder, json);
    return json_finish(json, err);
}

char *report_text(const Simulation *simulation, const Error *failure, const char *folder,
                  Error *err)
{
    JsonWriter *json = json_create(NULL, err);
    if (!json) return NULL;
    write_all(simulation, failure, folder, json);
    return json_take(json, err);
}
