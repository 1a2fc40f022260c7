// SPDX-License-Identifier: GPL-2.0-or-later
// A recorder: at the times that the scene asks for the bulk is recovered, u = V q, its stresses
// found and written as .vtu, the interface as .vtp. What does not change in a run (points, cells)
// is laid out once, in the 64-bit integers and three coordinates that VTK wants; z of the model is
// VTK's y. VTK itself stays in its module: io/field_file.
#include "record/fields.h"

#include "base/clock.h"
#include "base/memory.h"
#include "io/folder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PATH_SIZE = 1200, FIRST_ROOM = 64, NAME_SIZE = 32, LINE_ARRAYS = 6 };

// VTK's numbers of our element kinds; the node orders are the same.
static uint8_t vtk_cell_type(ElementKind kind)
{
    static const uint8_t types[] = {[ELEMENT_T3] = 5,
                                    [ELEMENT_T6] = 22,
                                    [ELEMENT_Q4] = 9,
                                    [ELEMENT_Q8] = 23,
                                    [ELEMENT_Q9] = 28};
    return types[kind];
}

// Of a point: points that follow the nodes stand where materials meet (bulk/recovery).
static int64_t node_of(const Fields *fields, int64_t point)
{
    int64_t nodes = fields->mesh->node_count;
    return point < nodes ? point : fields->stress.extra_node[point - nodes];
}

// VTK's cells: offsets [cells + 1] into connectivity, and a type each. Third coordinates stay 0.
static bool fill_bulk_grid(Fields *fields, Error *err)
{
    const Mesh *mesh = fields->mesh;
    int64_t nodes = mesh->node_count, cells = mesh->element_count;
    int64_t corners = mesh->first_node[cells], points = fields->stress.point_count;
    fields->points = NEW_ARRAY(double, 3 * points, err);
    fields->vectors = NEW_ARRAY(double, 6 * points, err);
    fields->displacement = NEW_ARRAY(double, 2 * nodes, err);
    fields->velocity = NEW_ARRAY(double, 2 * nodes, err);
    fields->offsets = NEW_ARRAY(int64_t, cells + 1, err);
    fields->connectivity = NEW_ARRAY(int64_t, corners, err);
    fields->cell_types = NEW_ARRAY(uint8_t, cells, err);
    if (!error_is_clean(err)) return false;
    for (int64_t i = 0; i < points; i++) {
        int64_t node = node_of(fields, i);
        fields->points[3 * i] = mesh->position[2 * node];
        fields->points[3 * i + 1] = mesh->position[2 * node + 1];
    }
    const int32_t *all = nodal_stress_points(&fields->stress, mesh, 0);
    for (int64_t e = 0; e <= cells; e++) fields->offsets[e] = mesh->first_node[e];
    for (int64_t k = 0; k < corners; k++) fields->connectivity[k] = all[k];
    for (int64_t e = 0; e < cells; e++) fields->cell_types[e] = vtk_cell_type(mesh->kind[e]);
    return true;
}

// One segment between neighbours of the same pad: gaps between pads stay gaps.
static bool fill_line_grid(Fields *fields, const Interface *interface, Error *err)
{
    int64_t count = interface->contact_count;
    fields->line_points = NEW_ARRAY(double, 3 * count, err);
    fields->line_values = NEW_ARRAY(double, LINE_ARRAYS *count, err);
    fields->line_offsets = NEW_ARRAY(int64_t, count + 1, err);
    fields->line_connectivity = NEW_ARRAY(int64_t, 2 * count, err);
    fields->line_types = NEW_ARRAY(uint8_t, count, err);
    if (!error_is_clean(err)) return false;
    for (int32_t i = 0; i < count; i++) {
        fields->line_points[3 * i] = interface->x[i];
        if (i == 0 || interface->pad[i] != interface->pad[i - 1]) continue;
        int32_t line = fields->line_count++;
        fields->line_connectivity[2 * line] = i - 1;
        fields->line_connectivity[2 * line + 1] = i;
        fields->line_offsets[line + 1] = 2 * (line + 1);
        fields->line_types[line] = 3;   // VTK_LINE
    }
    return true;
}

// What one state needs, without a folder: for `amontons static`, which calls fields_write_bulk
// itself. mesh is borrowed; materials are the caller's to set.
bool fields_prepare(const Mesh *mesh, const Interface *interface, Fields *fields, Error *err)
{
    *fields = (Fields){.mesh = mesh};
    return nodal_stress_create(mesh, &fields->stress, err) && fill_bulk_grid(fields, err) &&
           fill_line_grid(fields, interface, err);
}

// folder, mesh and what is in `def` are borrowed. The first record is always due: next_U and next_t
// lie before everything.
bool fields_create(const FieldsDef *def, const char *folder, const Mesh *mesh,
                   const Interface *interface, Fields *fields, Error *err)
{
    char path[PATH_SIZE];
    TRY(fields_prepare(mesh, interface, fields, err));
    fields->def = *def;
    fields->folder = folder;
    fields->room = FIRST_ROOM;
    fields->next_U = fields->next_t = -INFINITY;   // the start is written in any case
    fields->entries = NEW_ARRAY(FieldSeriesEntry, 2 * FIRST_ROOM, err);
    fields->names = memory_array(2 * FIRST_ROOM, NAME_SIZE, err);
    if (!fields->entries || !fields->names) goto cleanup;
    snprintf(path, sizeof path, "%s/fields", folder);
    TRY(folder_make(path, err));
cleanup:
    return error_is_clean(err);
}

void fields_destroy(Fields *fields)
{
    nodal_stress_destroy(&fields->stress);
    memory_free(fields->points);
    memory_free(fields->vectors);
    memory_free(fields->displacement);
    memory_free(fields->velocity);
    memory_free(fields->offsets);
    memory_free(fields->connectivity);
    memory_free(fields->cell_types);
    memory_free(fields->line_points);
    memory_free(fields->line_values);
    memory_free(fields->line_offsets);
    memory_free(fields->line_connectivity);
    memory_free(fields->line_types);
    memory_free(fields->entries);
    memory_free(fields->names);
    *fields = (Fields){0};
}

// state: [2 * nodes] displacement and velocity of the mesh. Three components, the third 0, as VTK
// has no vectors of two.
bool fields_write_bulk(Fields *fields, const FieldState *state, const char *path, Error *err)
{
    const Mesh *mesh = fields->mesh;
    int64_t points = fields->stress.point_count;
    double *displacement = fields->vectors, *velocity = fields->vectors + 3 * points;
    for (int64_t i = 0; i < points; i++) {
        int64_t node = node_of(fields, i);
        for (int d = 0; d < 2; d++) {
            displacement[3 * i + d] = state->displacement[2 * node + d];
            velocity[3 * i + d] = state->velocity[2 * node + d];
        }
    }
    nodal_stress_recover(mesh, fields->materials, state->displacement, state->velocity,
                         &fields->stress);
    FieldArray arrays[] = {
        {.name = "displacement", .components = 3, .values = displacement},
        {.name = "velocity", .components = 3, .values = velocity},
        {.name = "stress_elastic", .components = 3, .values = fields->stress.elastic},
        {.name = "stress", .components = 3, .values = fields->stress.total},
        {.name = "von_mises", .components = 1, .values = fields->stress.von_mises}};
    FieldGrid grid = {.point_count = points,
                      .points = fields->points,
                      .cell_count = mesh->element_count,
                      .offsets = fields->offsets,
                      .connectivity = fields->connectivity,
                      .cell_types = fields->cell_types,
                      .time = state->time,
                      .point_array_count = (int32_t)(sizeof arrays / sizeof arrays[0]),
                      .point_arrays = arrays};
    return field_file_write_vtu(path, &grid, err);
}

// From the system's own unknowns, reduced or full.
static bool write_bulk(Fields *fields, const Observation *seen, const char *name, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/fields/%s", fields->folder, name);
    bulk_operator_recover(seen->system, seen->state->displacement, fields->displacement);
    bulk_operator_recover(seen->system, seen->state->velocity, fields->velocity);
    FieldState state = {
        .displacement = fields->displacement, .velocity = fields->velocity, .time = seen->t};
    return fields_write_bulk(fields, &state, path, err);
}

// Names and order are those of docs/results.md. line_values: [LINE_ARRAYS][contact_count].
static bool write_line(Fields *fields, const Observation *seen, const char *name, Error *err)
{
    const Interface *interface = seen->interface;
    const State *state = seen->state;
    const int32_t *dofs = seen->system->interface_dofs;
    int64_t count = interface->contact_count;
    double *columns[LINE_ARRAYS];
    for (int k = 0; k < LINE_ARRAYS; k++) columns[k] = fields->line_values + k * count;
    for (int32_t i = 0; i < count; i++) {
        int32_t t = interface_tangent(i), n = interface_normal(i);
        double slip_rate = state->slip_rate[t];
        columns[0][i] = slip_rate;
        columns[1][i] = state->displacement[dofs[t]];
        columns[2][i] = state->displacement[dofs[n]] + interface_gap(interface, i);
        columns[3][i] = state->reaction[n] / interface->weight[i];
        columns[4][i] = -state->reaction[t] / interface->weight[i];
        columns[5][i] =
            state->status[i] == CONTACT_OPEN
                ? 0
                : friction_contact_density(friction_at(fields->law, i), fabs(slip_rate));
    }
    static const char *const names[LINE_ARRAYS] = {"slip_rate", "displacement_x", "gap", "pressure",
                                                   "shear",     "contact_density"};
    FieldArray arrays[LINE_ARRAYS];
    for (int k = 0; k < LINE_ARRAYS; k++)
        arrays[k] = (FieldArray){.name = names[k], .components = 1, .values = columns[k]};
    FieldGrid grid = {.point_count = count,
                      .points = fields->line_points,
                      .cell_count = fields->line_count,
                      .offsets = fields->line_offsets,
                      .connectivity = fields->line_connectivity,
                      .cell_types = fields->line_types,
                      .time = seen->t,
                      .point_array_count = LINE_ARRAYS,
                      .point_arrays = arrays};
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/fields/%s", fields->folder, name);
    return field_file_write_vtp(path, &grid, err);
}

// Room for two more entries; their names stay where they are pointed to.
static bool make_room(Fields *fields, Error *err)
{
    if (fields->entry_count + 2 <= 2 * fields->room) return true;
    int64_t old = 2 * (int64_t)fields->room;
    FieldSeriesEntry *entries =
        memory_resize(fields->entries, old, 2 * old, sizeof(FieldSeriesEntry), err);
    if (!entries) return false;
    fields->entries = entries;
    void *names = memory_resize(fields->names, old, 2 * old, NAME_SIZE, err);
    if (!names) return false;
    fields->names = names;
    fields->room *= 2;
    for (int32_t k = 0; k < fields->entry_count; k++) fields->entries[k].file = fields->names[k];
    return true;
}

static void name_files(int32_t number, char bulk[NAME_SIZE - 8], char line[NAME_SIZE - 8])
{
    snprintf(bulk, NAME_SIZE - 8, "bulk_%06d.vtu", number);
    snprintf(line, NAME_SIZE - 8, "interface_%06d.vtp", number);
}

static void add_entry(Fields *fields, double time, const char *part, const char *name)
{
    int32_t k = fields->entry_count++;
    snprintf(fields->names[k], NAME_SIZE, "fields/%s", name);
    fields->entries[k] = (FieldSeriesEntry){.time = time, .part = part, .file = fields->names[k]};
}

// Room is there already: a record that fails half way leaves the list as it was.
static void add_time(Fields *fields, double time)
{
    char bulk[NAME_SIZE - 8], line[NAME_SIZE - 8];
    name_files(fields->written++, bulk, line);
    add_entry(fields, time, "bulk", bulk);
    add_entry(fields, time, "interface", line);
}

// U has come back over the multiple of every_U at or beyond which a file was written last; not by
// rounding, as a rod that is held on it would.
static bool comes_back(const Fields *fields, double U)
{
    double reached = fields->next_U - fields->def.every_U;
    return U < reached - 1e-6 * fields->def.every_U;
}

// Multiples of every_U and every_t, at the first step at or beyond each; a step that passes several
// is written once. With at_events also steps in which a rapid event begins, crosses the interface
// or ends.
static bool is_due(Fields *fields, const Observation *seen)
{
    bool due = fields->written == 0 || fields->def.every_step;
    if (fields->def.every_U > 0 && (seen->U >= fields->next_U || comes_back(fields, seen->U))) {
        fields->next_U = (floor(seen->U / fields->def.every_U) + 1) * fields->def.every_U;
        due = true;
    }
    if (fields->def.every_t > 0 && seen->t >= fields->next_t) {
        fields->next_t = (floor(seen->t / fields->def.every_t) + 1) * fields->def.every_t;
        due = true;
    }
    const Events *events = fields->events;
    bool happens = events->began || events->crossed || events->ended;
    return due || (fields->def.at_events && happens);
}

// A run that is killed keeps every time that was written, each file whole (io/part_file).
bool fields_record(void *self, const Observation *seen, Error *err)
{
    Fields *fields = self;
    if (!is_due(fields, seen)) return true;
    double started = clock_seconds();
    char bulk[NAME_SIZE - 8], line[NAME_SIZE - 8], path[PATH_SIZE];
    name_files(fields->written, bulk, line);
    TRY(make_room(fields, err));
    TRY(write_bulk(fields, seen, bulk, err));
    TRY(write_line(fields, seen, line, err));
    add_time(fields, seen->t);
    // The list is written anew each time: a run that is cut off leaves one that opens.
    snprintf(path, sizeof path, "%s/fields.pvd", fields->folder);
    TRY(field_file_write_pvd(path, fields->entries, fields->entry_count, err));
    fields->seconds += clock_seconds() - started;
cleanup:
    return error_is_clean(err);
}

// Without a folder there is no list: what a state with fields has of it is passed over.
bool fields_archive(Fields *fields, Archive *archive, Error *err)
{
    int32_t written = fields->written;
    archive_section(archive, "fields");
    archive_integer(archive, &written);
    archive_number(archive, &fields->next_U);
    archive_number(archive, &fields->next_t);
    if (archive_reads(archive)) fields->written = fields->entry_count = 0;
    for (int32_t k = 0; k < written && !archive->failed; k++) {
        double time = archive_reads(archive) ? NAN : fields->entries[2 * k].time;
        archive_number(archive, &time);
        if (!archive_reads(archive) || !fields->folder) continue;
        TRY(make_room(fields, err));
        add_time(fields, time);
    }
cleanup:
    return error_is_clean(err);
}
