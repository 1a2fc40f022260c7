// SPDX-License-Identifier: GPL-2.0-or-later
// Output that a scene asks for: recorders are opened before t = 0, pictures are drawn from the
// finished history.
#include "run/simulation_state.h"

#include "base/memory.h"
#include "base/module.h"
#include "friction/friction.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "run/result/pictures.h"
#include "run/warnings.h"
#include "scene/programs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FILM_PARTS = 300 };   // of the way that the rod goes, between two files of a film

bool output_check(const Scene *scene, Error *err)
{
    bool possible = (!scene->output.fields || module_check("vtk", err)) &&
                    (scene->output.figures.count == 0 || module_check("render", err));
    if (!possible) error_context(err, "%s", scene->path);
    return possible;
}

// A line for each of `count`: those of the scene's formulas by their names; and their unit.
static const char *state_names(const Scene *scene, int32_t count, char *names, size_t size)
{
    const SceneStates *own = &scene->friction_keys.states;
    bool numbered = friction_is_own(&scene->friction) && own->count == 0;
    names[0] = 0;
    for (int32_t k = 0; k < count; k++) {
        size_t used = strlen(names);
        const char *name = k < own->count ? own->state[k].name
                                          : friction_state_name(&scene->friction);
        used += (size_t)snprintf(names + used, size - used, "%s%s", k > 0 ? "\n" : "", name);
        if (numbered) snprintf(names + used, size - used, "_%d", k + 1);
    }
    return friction_state_unit(&scene->friction);
}

// mu_M and l_c are NaN in the head: they are known at the end only.
static bool open_history(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    const Model *model = &simulation->model;
    const Material *material = &model->materials.list[model->contact_region];
    WaveSpeeds speeds = material_speeds(material);
    bool creeps = model->friction.whole.law->creeps;
    char names[STATES_MAX * (STATE_NAME_SIZE + 1)];
    ResultHead head = {
        .title = scene->title,
        .units = scene->units == UNITS_SI ? "si" : "normalised",
        .version = AMONTONS_VERSION,
        .goes_on = simulation->goes_on,
        .states = simulation->contact.states,
        .has_area = simulation->contact.area != NULL,
        .state_names = names,
        .state_unit = state_names(scene, simulation->contact.states, names, sizeof names),
        .rod_on_spring = scene->rod.stiffness > 0 && scene->rod.kind != ROD_NONE,
        .numbers = {[NUMBER_LENGTH] = simulation->model.length,
                    [NUMBER_TRAILING] = simulation->model.scales.trailing,
                    [NUMBER_PRESSURE] = model->pressure,
                    [NUMBER_THICKNESS] = scene->thickness > 0 ? scene->thickness : NAN,
                    [NUMBER_LOAD] = simulation->model.scales.load,
                    [NUMBER_ROD_VELOCITY] = scene->rod.velocity,
                    [NUMBER_CRITICAL_VELOCITY] = simulation->model.friction.critical_velocity,
                    // For a law under which nothing sticks they are scales, not levels to draw.
                    [NUMBER_MU_STATIC] = creeps ? NAN : simulation->model.friction.mu_static,
                    [NUMBER_MU_KINETIC] = creeps ? NAN : simulation->model.friction.mu_kinetic,
                    [NUMBER_C_LONGITUDINAL] = speeds.longitudinal,
                    [NUMBER_C_SHEAR] = speeds.shear,
                    [NUMBER_C_RAYLEIGH] = speeds.rayleigh,
                    [NUMBER_WAVE_DAMPING] =
                        material_wave_damping(material, fmax(model->length, model->height)),
                    [NUMBER_ROD_LOW] = NAN,
                    [NUMBER_ROD_HIGH] = NAN,
                    [NUMBER_ROD_BREADTH] = NAN,
                    [NUMBER_MU_M] = NAN,
                    [NUMBER_L_C] = NAN}};
    if (scene->rod.kind != ROD_NONE) {
        double middle = 0, width = 0;
        model_rod_strip(scene, simulation->model.height, &middle, &width);
        const double *face = model->interface.rod_face;
        head.numbers[NUMBER_ROD_LOW] = scene->rod.whole ? face[0] : middle - 0.5 * width;
        head.numbers[NUMBER_ROD_HIGH] = scene->rod.whole ? face[1] : middle + 0.5 * width;
        if (scene->rod.breadth > 0) head.numbers[NUMBER_ROD_BREADTH] = scene->rod.breadth;
    }

    // Names of the probes, a line each, and their places.
    const SceneProbes *probes = &scene->output.probes;
    char probe_names[SCENE_PROBES_MAX * (GROUP_NAME_SIZE + 1)];
    double probe_places[SCENE_PROBES_MAX * DIM_MAX];
    int32_t dim = model->mesh.dim, used = 0;
    for (int32_t k = 0; k < probes->count; k++) {
        used += snprintf(probe_names + used, GROUP_NAME_SIZE + 1, "%s%s", k > 0 ? "\n" : "",
                         probes->probe[k].name);
        memcpy(probe_places + (int64_t)k * dim, probes->probe[k].at.value,
               (size_t)dim * sizeof *probe_places);
    }
    head.probes = probes->count;
    head.probe_names = probe_names;
    head.probe_places = probe_places;

    // Names of the pads, a line each; faces of the contact, as numbers.
    const Interface *interface = &model->interface;
    const ContactFaces *faces = &interface->faces;
    int64_t point_count = (int64_t)faces->count * faces->width;
    double *points = NEW_ARRAY(double, point_count, err);
    char *pads = memory_array((int64_t)interface->pad_count * GROUP_NAME_SIZE + 1, 1, err);
    TRY(error_is_clean(err));
    used = 0;
    for (int32_t p = 0; p < interface->pad_count; p++)
        used += snprintf(pads + used, GROUP_NAME_SIZE + 1, "%s%s", p > 0 ? "\n" : "",
                         interface->pad_name[p]);
    head.pads = pads;
    for (int64_t k = 0; k < point_count; k++) points[k] = faces->point[k];
    if (point_count > 0) {
        head.faces[FACES_NODES].rows = faces->count;
        head.faces[FACES_NODES].width = faces->width;
        head.faces[FACES_NODES].values = points;
        head.faces[FACES_CORNERS].rows = faces->corner_count;
        head.faces[FACES_CORNERS].width = 2;
        head.faces[FACES_CORNERS].values = faces->corner;
    }

    TRY(probes_create(model->probes, head.probes, &model->mesh, &model->system,
                      model->materials.list, &model->bulk.spectrum, &simulation->probes, err));
    TRY(history_create(simulation->folder.path, &head, interface, &simulation->contact,
                       &simulation->history, err));
    if (head.probes > 0) simulation->history.probes = &simulation->probes;
cleanup:
    memory_free_all(points, pads);
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

// In a part of the run only what is inside the window is written: fields, and the history where it
// is asked.
bool output_open(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    Window *window = &simulation->window;
    WindowDef def = window->def = scene_window(scene);
    const char *compared = scene->output.compare;   // not found out when all is computed
    if (*compared && !scene_blame(scene, "output.compare", open_check(compared, err), err))
        return false;
    if (scene->output.figures.count > 0 && simulation->folder.path[0] &&
        !folder_check_inside(simulation->folder.path, "figures", err))
        return false;
    if (scene->output.history) {
        if (!open_history(simulation, err)) return false;
        bool in_part = def.given && scene->output.window.history;
        recorders_add(in_part ? &window->inside : &simulation->recorders, &simulation->history,
                      history_record);
    }
    if (scene->output.fields) {
        FieldsDef fields = {.every_U = scene->output.fields_every_U,
                            .every_t = scene->output.fields_every_t,
                            .every_step = scene->output.fields_every_step,
                            .at_events = scene->output.fields_at_events};
        if (scene->output.fields_film) {
            double V = fabs(scene->rod.velocity), U = scene->time.until_U;
            double way = U > 0 ? U : V * scene->time.until_t;
            double begin = fmax(def.from_U, V * def.from_t);
            double end = fmin(way, fmin(def.to_U, V * def.to_t));
            if (end > begin) way = end - begin;   // the window's part of it
            fields.at_events = true;
            fields.every_U = fields.every_slip = way / FILM_PARTS;
        }
        if (!fields_create(&fields, simulation->folder.path, &simulation->model.mesh,
                           &simulation->model.interface, &simulation->fields, err))
            return false;
        simulation->fields.files.materials = simulation->model.materials.list;
        simulation->fields.files.spectrum = &simulation->model.bulk.spectrum;
        simulation->fields.friction = &simulation->model.friction;
        simulation->fields.events = &simulation->events;
        recorders_add(def.given ? &window->inside : &simulation->recorders, &simulation->fields,
                      fields_record);
    }
    if (def.given) recorders_add(&simulation->recorders, window, window_record);
    return true;
}

void output_warn_of_window(Simulation *simulation)
{
    const Window *window = &simulation->window;
    if (!window->def.given || window->steps > 0) return;
    warnings_add(
        &simulation->warnings,
        "nothing written in output.window: the run, to U = %g and t = %g, does not come to "
        "it",
        simulation->seen.U, simulation->seen.t);
}

// The module `render` draws; it is loaded here and only here.
bool output_draw_figures(Simulation *simulation, Error *err)
{
    const SceneNames *wanted = &simulation->scene.output.figures;
    const char *names[SCENE_LIST_MAX];
    int32_t count = 0;

    // A picture of a window that the run did not reach is not drawn; the run was warned.
    bool rows = !simulation->window.def.given || simulation->history.end.rows > 1;
    bool fields = !simulation->window.def.given || simulation->fields.written > 0;
    for (int32_t k = 0; k < wanted->count; k++)
        if (rows && (fields || strcmp(wanted->name[k], "field") != 0))
            names[count++] = wanted->name[k];
    if (count == 0) return true;
    PictureRequest request = {.figures = names, .figure_count = count};
    const char *compare = simulation->scene.output.compare;
    if (compare[0]) request.style.compare = compare;
    if (simulation->scene.output.cycle[0]) request.style.cycle = simulation->scene.output.cycle;

    // All at once; else one after the other. What this result has nothing for is a warning: what
    // was computed is there.
    bool drawn = pictures_draw(simulation->folder.path, &request, err);
    simulation->figures = count;
    if (!drawn) {
        if (err->code != ERROR_INPUT) return false;
        *err = (Error){0};
        simulation->figures = 0;
    }
    for (int32_t k = 0; k < count && !drawn; k++) {
        PictureRequest one = request;
        one.figures = &names[k];
        one.figure_count = 1;
        if (pictures_draw(simulation->folder.path, &one, err)) {
            simulation->figures++;
            continue;
        }
        if (err->code != ERROR_INPUT) return false;
        warnings_add(&simulation->warnings, "a picture is not drawn: %.300s", err->message);
        *err = (Error){0};
    }
    return true;
}

bool output_begin_result(Simulation *simulation, Error *err)
{
    return (!simulation->folder.aside || history_sync(&simulation->history, err)) &&
           result_folder_settle(&simulation->folder, err);
}
