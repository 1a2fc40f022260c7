// SPDX-License-Identifier: GPL-2.0-or-later
// What a scene asks to be written: recorders are opened before t = 0, pictures drawn from the
// finished history.
#include "run/output.h"

#include "base/clock.h"
#include "base/memory.h"
#include "run/pictures.h"

#include <math.h>
#include <stdio.h>

// A name a line; freed by the caller. NULL: without names, or memory is short.
static char *join_pad_names(const Interface *interface, Error *err)
{
    if (!interface->pad_name) return NULL;
    char *text = memory_array((int64_t)interface->pad_count * GROUP_NAME_SIZE + 1, 1, err);
    for (int32_t p = 0, used = 0; text && p < interface->pad_count; p++)
        used += snprintf(text + used, GROUP_NAME_SIZE + 1, "%s%s", p > 0 ? "\n" : "",
                         interface->pad_name[p]);
    return text;
}

// mu_M and l_c are NaN in the head: they are known at the end only.
bool output_open_history(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    const Model *model = &simulation->model;
    WaveSpeeds speeds = material_speeds(&model->materials.list[model->contact_region]);
    ResultHead head = {
        .title = scene->title,
        .units = scene->units == UNITS_SI ? "si" : "normalised",
        .version = AMONTONS_VERSION,
        .goes_on = simulation->goes_on,
        .rod_on_spring = scene->rod.stiffness > 0 && scene->rod.kind != ROD_NONE,
        .numbers = {[NUMBER_LENGTH] = simulation->model.length,
                    [NUMBER_PRESSURE] = scene->load.pressure,
                    [NUMBER_LOAD] = simulation->model.scales.load,
                    [NUMBER_ROD_VELOCITY] = scene->rod.velocity,
                    [NUMBER_CRITICAL_VELOCITY] = simulation->model.law.critical_velocity,
                    [NUMBER_MU_STATIC] = simulation->model.law.mu_static,
                    [NUMBER_MU_KINETIC] = simulation->model.law.mu_kinetic,
                    [NUMBER_C_LONGITUDINAL] = speeds.longitudinal,
                    [NUMBER_C_SHEAR] = speeds.shear,
                    [NUMBER_C_RAYLEIGH] = speeds.rayleigh,
                    [NUMBER_ROD_LOW] = NAN,
                    [NUMBER_ROD_HIGH] = NAN,
                    [NUMBER_MU_M] = NAN,
                    [NUMBER_L_C] = NAN}};
    if (scene->rod.kind != ROD_NONE) {
        double middle = 0, width = 0;
        model_rod_strip(scene, simulation->model.height, &middle, &width);
        head.numbers[NUMBER_ROD_LOW] = middle - 0.5 * width;
        head.numbers[NUMBER_ROD_HIGH] = middle + 0.5 * width;
    }
    char *pads = join_pad_names(&simulation->model.interface, err);
    head.pads = pads;
    TRY(error_is_clean(err));
    TRY(history_create(simulation->folder.path, &head, &simulation->model.interface,
                       &simulation->contact, &simulation->history, err));
    recorders_add(&simulation->recorders, &simulation->history, history_record);
cleanup:
    memory_free(pads);
    return error_is_clean(err);
}

// One a line, for the pictures: they are drawn from the history alone.
bool output_store_warnings(Simulation *simulation, Error *err)
{
    const RunWarnings *warnings = &simulation->warnings;
    char lines[RUN_WARNINGS_MAX * RUN_WARNING_SIZE];
    size_t used = 0;
    if (warnings->count == 0) return true;
    for (int32_t k = 0; k < warnings->count; k++)
        used += (size_t)snprintf(lines + used, sizeof lines - used, "%s%s", k > 0 ? "\n" : "",
                                 warnings->text[k]);
    return array_file_set_text(simulation->history.file, "warnings", lines, err);
}

bool output_open_fields(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    FieldsDef def = {.every_U = scene->output.fields_every_U,
                     .every_t = scene->output.fields_every_t,
                     .at_events = scene->output.fields_at_events};
    TRY(fields_create(&def, simulation->folder.path, &simulation->model.mesh,
                      &simulation->model.interface, &simulation->fields, err));
    simulation->fields.materials = simulation->model.materials.list;
    simulation->fields.law = &simulation->model.law;
    simulation->fields.events = &simulation->events;
    recorders_add(&simulation->recorders, &simulation->fields, fields_record);
cleanup:
    return error_is_clean(err);
}

// By the module `render`, loaded here and only here.
bool output_draw_figures(Simulation *simulation, Error *err)
{
    const SceneNames *wanted = &simulation->scene.output.figures;
    const char *names[SCENE_LIST_MAX];
    if (wanted->count == 0) return true;
    for (int32_t k = 0; k < wanted->count; k++) names[k] = wanted->name[k];
    PictureRequest request = {.figures = names, .figure_count = wanted->count};
    double started = clock_seconds();
    if (!pictures_draw(simulation->folder.path, &request, err)) return false;
    simulation->figures = wanted->count;
    simulation->figures_seconds = clock_seconds() - started;
    return true;
}
