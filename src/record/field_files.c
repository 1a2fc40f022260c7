// SPDX-License-Identifier: GPL-2.0-or-later
// Stresses of the bulk are found and written as .vtu, the interface as .vtp. What does
// not change in a run (points, cells) is laid out once, in the 64-bit integers and three
// coordinates that VTK wants; z of the model is VTK's y. VTK itself stays in its module:
// io/fields/field_file.
#include "record/field_files.h"

#include "base/memory.h"

#include <string.h>

// Of a point: points that follow the nodes stand where materials meet (fem/recovery).
static int32_t node_of(const FieldFiles *files, int64_t point)
{
    int32_t nodes = files->mesh->node_count;
    return point < nodes ? (int32_t)point : files->stress.extra_node[point - nodes];
}

// VTK's cells: offsets [cells + 1] into connectivity, and a type each. Third coordinates stay 0.
static bool fill_bulk_grid(FieldFiles *files, Error *err)
{
    const Mesh *mesh = files->mesh;
    int64_t cells = mesh->element_count;
    int64_t corners = mesh->first_node[cells], points = files->stress.point_count;
    files->points = NEW_ARRAY(double, 3 * points, err);
    files->vectors = NEW_ARRAY(double, 6 * points, err);
    files->offsets = NEW_ARRAY(int64_t, cells + 1, err);
    files->connectivity = NEW_ARRAY(int64_t, corners, err);
    files->cell_types = NEW_ARRAY(uint8_t, cells, err);
    if (!error_is_clean(err)) return false;
    for (int64_t i = 0; i < points; i++) {
        int32_t node = node_of(files, i);
        memcpy(files->points + 3 * i, mesh_place(mesh, node), (size_t)mesh->dim * sizeof(double));
    }
    const int32_t *all = nodal_stress_points(&files->stress, mesh, 0);
    for (int64_t e = 0; e <= cells; e++) files->offsets[e] = mesh->first_node[e];
    for (int64_t e = 0; e < cells; e++) {
        ElementKind kind = (ElementKind)mesh->kind[e];
        int32_t first = mesh->first_node[e];
        for (int32_t k = 0; k < element_node_count(kind); k++)
            files->connectivity[first + k] = all[first + element_vtk_node(kind, k)];
        files->cell_types[e] = element_info(kind)->vtk_type;
    }
    return true;
}

// One segment between neighbours of the same pad: gaps between pads stay gaps.
static bool fill_line_grid(FieldFiles *files, const Interface *interface, Error *err)
{
    int64_t count = interface->contact_count;
    files->line_points = NEW_ARRAY(double, 3 * count, err);
    files->line_offsets = NEW_ARRAY(int64_t, count + 1, err);
    files->line_connectivity = NEW_ARRAY(int64_t, 2 * count, err);
    files->line_types = NEW_ARRAY(uint8_t, count, err);
    if (!error_is_clean(err)) return false;
    for (int32_t i = 0; i < count; i++) {
        files->line_points[3 * i] = interface->x[i];
        if (i == 0 || interface->pad[i] != interface->pad[i - 1]) continue;
        int32_t line = files->line_count++;
        files->line_connectivity[2 * line] = i - 1;
        files->line_connectivity[2 * line + 1] = i;
        files->line_offsets[line + 1] = 2 * (line + 1);
        files->line_types[line] = 3;   // VTK_LINE
    }
    return true;
}

bool field_files_create(const Mesh *mesh, const Interface *interface, FieldFiles *files, Error *err)
{
    *files = (FieldFiles){.mesh = mesh, .line_point_count = interface->contact_count};
    return nodal_stress_create(mesh, &files->stress, err) && fill_bulk_grid(files, err) &&
           fill_line_grid(files, interface, err);
}

void field_files_destroy(FieldFiles *files)
{
    nodal_stress_destroy(&files->stress);
    memory_free(files->points);
    memory_free(files->vectors);
    memory_free(files->offsets);
    memory_free(files->connectivity);
    memory_free(files->cell_types);
    memory_free(files->line_points);
    memory_free(files->line_offsets);
    memory_free(files->line_connectivity);
    memory_free(files->line_types);
    *files = (FieldFiles){0};
}

// state: [dim * nodes] displacement and velocity of the mesh. Three components, the last 0 in the
// plane, as VTK has no vectors of two.
bool field_files_write_bulk(FieldFiles *files, const FieldState *state, const char *path,
                            Error *err)
{
    const Mesh *mesh = files->mesh;
    int64_t points = files->stress.point_count;
    int32_t strains = strain_count(mesh->dim);
    double *displacement = files->vectors, *velocity = files->vectors + 3 * points;
    for (int64_t i = 0; i < points; i++) {
        int32_t first = node_dof(mesh->dim, node_of(files, i), 0);
        for (int32_t d = 0; d < mesh->dim; d++) {
            displacement[3 * i + d] = state->displacement[first + d];
            velocity[3 * i + d] = state->velocity[first + d];
        }
    }
    nodal_stress_recover(files->materials, state->displacement, state->velocity, &files->stress);
    FieldArray arrays[] = {
        {.name = "displacement", .components = 3, .values = displacement},
        {.name = "velocity", .components = 3, .values = velocity},
        {.name = "stress_elastic", .components = strains, .values = files->stress.elastic},
        {.name = "stress", .components = strains, .values = files->stress.total},
        {.name = "von_mises", .components = 1, .values = files->stress.von_mises}};
    FieldGrid grid = {.point_count = points,
                      .points = files->points,
                      .cell_count = mesh->element_count,
                      .offsets = files->offsets,
                      .connectivity = files->connectivity,
                      .cell_types = files->cell_types,
                      .time = state->time,
                      .point_array_count = (int32_t)(sizeof arrays / sizeof arrays[0]),
                      .point_arrays = arrays};
    return field_file_write_vtu(path, &grid, err);
}

// line: [FIELD_LINE_ARRAYS][contact_count]; names and order are those of docs/results.md.
bool field_files_write_line(FieldFiles *files, const double *line, double time, const char *path,
                            Error *err)
{
    static const char *const names[FIELD_LINE_ARRAYS] = {
        "slip_rate", "displacement_x", "gap", "pressure", "shear", "contact_density"};
    FieldArray arrays[FIELD_LINE_ARRAYS];
    int64_t count = files->line_point_count;
    for (int k = 0; k < FIELD_LINE_ARRAYS; k++)
        arrays[k] = (FieldArray){.name = names[k], .components = 1, .values = line + k * count};
    FieldGrid grid = {.point_count = count,
                      .points = files->line_points,
                      .cell_count = files->line_count,
                      .offsets = files->line_offsets,
                      .connectivity = files->line_connectivity,
                      .cell_types = files->line_types,
                      .time = time,
                      .point_array_count = FIELD_LINE_ARRAYS,
                      .point_arrays = arrays};
    return field_file_write_vtp(path, &grid, err);
}
