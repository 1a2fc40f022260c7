// SPDX-License-Identifier: GPL-2.0-or-later
// Stresses of the bulk are found and written as .vtu, the interface as .vtp. What does
// not change in a run (points, cells) is laid out once, in the 64-bit integers and three
// coordinates that VTK wants; z of a model in the plane is VTK's y. VTK itself stays in its module:
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
        files->cell_types[e] = ELEMENTS[kind].vtk_type;
    }
    return true;
}

enum { VTK_LINE_CELL = 3, VTK_TRIANGLE_CELL = 5, VTK_QUAD_CELL = 9, FACE_CELLS_MAX = 4 };

// Room for the interface's cells.
static bool make_line_grid(FieldFiles *files, int64_t cells, int32_t points_each, Error *err)
{
    int64_t count = files->line_point_count;
    files->line_points = NEW_ARRAY(double, 3 * count, err);
    files->line_values = NEW_ARRAY(double, 3 * FIELD_LINE_ARRAYS * count, err);
    files->line_offsets = NEW_ARRAY(int64_t, cells + 1, err);
    files->line_connectivity = NEW_ARRAY(int64_t, points_each * cells, err);
    files->line_types = NEW_ARRAY(uint8_t, cells, err);
    return error_is_clean(err);
}

static void add_face_cell(FieldFiles *files, const int32_t *points, const uint8_t *which,
                          int32_t count)
{
    int32_t cell = files->line_count++;
    int64_t first = files->line_offsets[cell];
    for (int32_t k = 0; k < count; k++) files->line_connectivity[first + k] = points[which[k]];
    files->line_offsets[cell + 1] = first + count;
    files->line_types[cell] = count == 3 ? VTK_TRIANGLE_CELL : VTK_QUAD_CELL;
}

// VTK's polygons are flat and have corners only: faces with nodes between them are cut into four.
static bool fill_face_grid(FieldFiles *files, const Interface *interface, Error *err)
{
    static const uint8_t whole[] = {0, 1, 2, 3};
    static const uint8_t six[][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    static const uint8_t nine[][4] = {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}};
    const ContactFaces *faces = files->faces;
    if (!make_line_grid(files, (int64_t)FACE_CELLS_MAX * faces->count, 4, err)) return false;
    for (int32_t i = 0; i < files->line_point_count; i++) {
        int32_t k = i - interface->contact_count;
        files->line_points[3 * i] = k < 0 ? interface->x[i] : faces->corner[2 * k];
        files->line_points[3 * i + 1] = k < 0 ? interface->y[i] : faces->corner[2 * k + 1];
    }
    for (int32_t f = 0; f < faces->count; f++) {
        const int32_t *points = faces->point + (int64_t)f * faces->width;
        int32_t count = contact_face_points(faces, f);
        if (count <= 4) add_face_cell(files, points, whole, count);
        for (int32_t k = 0; k < FACE_CELLS_MAX && count == 6; k++)
            add_face_cell(files, points, six[k], 3);
        for (int32_t k = 0; k < FACE_CELLS_MAX && count == 9; k++)
            add_face_cell(files, points, nine[k], 4);
    }
    return true;
}

// In the plane one segment between neighbours of the same pad: gaps between pads stay gaps.
static bool fill_line_grid(FieldFiles *files, const Interface *interface, Error *err)
{
    int64_t count = interface->contact_count;
    if (interface->y) return fill_face_grid(files, interface, err);
    if (!make_line_grid(files, count, 2, err)) return false;
    for (int32_t i = 0; i < count; i++) {
        files->line_points[3 * i] = interface->x[i];
        if (i == 0 || interface->pad[i] != interface->pad[i - 1]) continue;
        int32_t line = files->line_count++;
        files->line_connectivity[2 * line] = i - 1;
        files->line_connectivity[2 * line + 1] = i;
        files->line_offsets[line + 1] = 2 * (line + 1);
        files->line_types[line] = VTK_LINE_CELL;
    }
    return true;
}

bool field_files_create(const Mesh *mesh, const Interface *interface, FieldFiles *files, Error *err)
{
    *files = (FieldFiles){
        .mesh = mesh, .contact_count = interface->contact_count, .tangents = mesh->dim - 1};
    files->faces = &interface->faces;
    files->line_point_count = interface->contact_count + files->faces->corner_count;
    return nodal_stress_create(mesh, &files->stress, err) && fill_bulk_grid(files, err) &&
           fill_line_grid(files, interface, err);
}

void field_files_destroy(FieldFiles *files)
{
    nodal_stress_destroy(&files->stress);
    memory_free_all(files->points, files->vectors, files->offsets, files->connectivity,
                    files->cell_types, files->line_points, files->line_values, files->line_offsets,
                    files->line_connectivity, files->line_types);
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
    return field_file_write(path, &grid, err);
}

// What belongs to a point: its own, and of a corner that touches nothing the mean of the points
// beside it on its faces. values: [line_point_count * components], known at the contact nodes.
static void fill_corners(const FieldFiles *files, int32_t components, double *values)
{
    const ContactFaces *faces = files->faces;
    for (int32_t f = 0; f < faces->count; f++) {
        const int32_t *points = faces->point + (int64_t)f * faces->width;
        int32_t corners = contact_face_points(faces, f) / 2;   // of a face with mid-sides
        for (int32_t k = 0; k < corners; k++) {
            int64_t beside = points[corners + k],
                    before = points[corners + (k + corners - 1) % corners];
            if (points[k] < files->contact_count) continue;
            for (int32_t d = 0; d < components; d++)
                values[components * points[k] + d] =
                    (values[components * beside + d] + values[components * before + d]) / 2;
        }
    }
}

// From columns to an array of points, vectors with three components.
static FieldArray line_array(const FieldFiles *files, const char *name, const double *columns,
                             int32_t count, double *values)
{
    int32_t components = count > 1 ? 3 : 1;
    for (int64_t i = 0; i < files->contact_count; i++)
        for (int32_t d = 0; d < components; d++)
            values[components * i + d] = d < count ? columns[d * (int64_t)files->contact_count + i]
                                                   : 0;
    fill_corners(files, components, values);
    return (FieldArray){.name = name, .components = components, .values = values};
}

// line: [field_line_columns][contact_count]; names and order are those of docs/results.md.
bool field_files_write_line(FieldFiles *files, const double *line, double time, const char *path,
                            Error *err)
{
    int32_t tangents = files->tangents;
    const struct {
        const char *name;
        int32_t columns;
    } rows[FIELD_LINE_ARRAYS] = {{"slip_rate", tangents},
                                 {tangents > 1 ? "displacement" : "displacement_x", tangents},
                                 {"gap", 1},
                                 {"pressure", 1},
                                 {"shear", tangents},
                                 {"contact_density", 1}};
    FieldArray arrays[FIELD_LINE_ARRAYS];
    int64_t count = files->line_point_count;
    for (int k = 0; k < FIELD_LINE_ARRAYS; k++) {
        arrays[k] = line_array(files, rows[k].name, line, rows[k].columns,
                               files->line_values + 3 * k * count);
        line += rows[k].columns * (int64_t)files->contact_count;
    }
    FieldGrid grid = {.point_count = count,
                      .points = files->line_points,
                      .cell_count = files->line_count,
                      .offsets = files->line_offsets,
                      .connectivity = files->line_connectivity,
                      .cell_types = files->line_types,
                      .time = time,
                      .point_array_count = FIELD_LINE_ARRAYS,
                      .point_arrays = arrays};
    return field_file_write(path, &grid, err);
}
