// SPDX-License-Identifier: GPL-2.0-or-later
// Stresses of the bulk are found and written as .vtu, the interface as .vtp. What does
// not change in a run (points, cells) is laid out once, in the 64-bit integers and three
// coordinates that VTK wants; z of a model in the plane is VTK's y. VTK itself stays in its module:
// io/fields/field_file.
#include "record/field_files.h"

#include "base/memory.h"

#include <string.h>

// Node of a point: points that follow the nodes stand where materials meet (fem/recovery).
static int32_t node_of(const FieldFiles *files, int64_t point)
{
    int32_t nodes = files->mesh->node_count;
    return point < nodes ? (int32_t)point : files->stress.extra_node[point - nodes];
}

// corners: of all cells. Third coordinates stay 0.
static bool make_cells(int64_t points, int64_t cells, int64_t corners, FieldGrid *made, Error *err)
{
    *made = (FieldGrid){.point_count = points};
    made->points = NEW_ARRAY(double, 3 * points, err);
    made->offsets = NEW_ARRAY(int64_t, cells + 1, err);
    made->connectivity = NEW_ARRAY(int64_t, corners, err);
    made->cell_types = NEW_ARRAY(uint8_t, cells, err);
    return error_is_clean(err);
}

enum { VTK_LINE_CELL = 3, VTK_TRIANGLE_CELL = 5, VTK_QUAD_CELL = 9, FACE_CELLS_MAX = 4 };

// Adds a cell of points by their numbers among those of a face; whole: in their order.
static void add_cell(FieldGrid *line, const int32_t *points, const uint8_t *which, int32_t count)
{
    static const uint8_t types[] = {[2] = VTK_LINE_CELL, VTK_TRIANGLE_CELL, VTK_QUAD_CELL};
    int64_t cell = line->cell_count++, first = line->offsets[cell];
    for (int32_t k = 0; k < count; k++) line->connectivity[first + k] = points[which[k]];
    line->offsets[cell + 1] = first + count;
    line->cell_types[cell] = types[count];
}

bool field_files_create(const Mesh *mesh, const Interface *interface, FieldFiles *files, Error *err)
{
    const ContactFaces *faces = &interface->faces;
    *files = (FieldFiles){.mesh = mesh,
                          .contact_count = interface->contact_count,
                          .tangents = mesh->dim - 1,
                          .faces = faces};

    // The grid of the block.
    if (!nodal_stress_create(mesh, &files->stress, err)) return false;
    FieldGrid *bulk = &files->bulk;
    int32_t cells = mesh->element_count;
    int64_t points = files->stress.point_count;
    files->vectors = NEW_ARRAY(double, 6 * points, err);
    if (!make_cells(points, cells, mesh->first_node[cells], bulk, err)) return false;
    for (int64_t i = 0; i < points; i++) {
        int32_t node = node_of(files, i);
        memcpy(bulk->points + 3 * i, mesh_place(mesh, node), (size_t)mesh->dim * sizeof(double));
    }
    const int32_t *all = nodal_stress_points(&files->stress, mesh, 0);
    bulk->cell_count = cells;
    for (int32_t e = 0; e < cells; e++) {
        ElementKind kind = (ElementKind)mesh->kind[e];
        int32_t first = mesh->first_node[e];
        for (int32_t k = 0; k < element_node_count(kind); k++)
            bulk->connectivity[first + k] = all[first + element_vtk_node(kind, k)];
        bulk->offsets[e + 1] = mesh->first_node[e + 1];
        bulk->cell_types[e] = ELEMENTS[kind].vtk_type;
    }

    // The grid of the contact: in the plane one segment between neighbours of the same pad, so that
    // gaps between pads stay gaps.
    FieldGrid *line = &files->line;
    int32_t count = interface->contact_count;
    int64_t line_points = (int64_t)count + faces->corner_count;
    int64_t line_cells = interface->y ? (int64_t)FACE_CELLS_MAX * faces->count : count;
    files->line_values = NEW_ARRAY(double, 3 * FIELD_LINE_ARRAYS * line_points, err);
    if (!make_cells(line_points, line_cells, 4 * line_cells, line, err)) return false;
    for (int32_t i = 0; i < line_points; i++) {
        const double *corner = i < count ? NULL : &faces->corner[2 * (i - count)];
        line->points[3 * i] = corner ? corner[0] : interface->x[i];
        if (interface->y) line->points[3 * i + 1] = corner ? corner[1] : interface->y[i];
    }

    // VTK's polygons are flat and have corners only: faces with nodes between them are cut into
    // four.
    static const uint8_t whole[] = {0, 1, 2, 3};
    static const uint8_t six[][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    static const uint8_t nine[][4] = {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}};
    for (int32_t f = 0; f < faces->count && interface->y; f++) {
        const int32_t *face = faces->point + (int64_t)f * faces->width;
        int32_t corners = contact_face_points(faces, f);
        if (corners <= 4) add_cell(line, face, whole, corners);
        for (int32_t k = 0; k < FACE_CELLS_MAX && corners == 6; k++)
            add_cell(line, face, six[k], 3);
        for (int32_t k = 0; k < FACE_CELLS_MAX && corners == 9; k++)
            add_cell(line, face, nine[k], 4);
    }
    for (int32_t i = 1; i < count && !interface->y; i++)
        if (interface->pad[i] == interface->pad[i - 1])
            add_cell(line, (int32_t[]){i - 1, i}, (uint8_t[]){0, 1}, 2);
    return true;
}

static void cells_destroy(FieldGrid *cells)
{
    memory_free_all(cells->points, cells->offsets, cells->connectivity, cells->cell_types);
}

void field_files_destroy(FieldFiles *files)
{
    nodal_stress_destroy(&files->stress);
    cells_destroy(&files->bulk);
    cells_destroy(&files->line);
    memory_free_all(files->vectors, files->line_values);
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
    nodal_stress_recover(files->materials, state->displacement, state->velocity, files->spectrum,
                         state->relaxing, &files->stress);
    FieldArray arrays[] = {
        {.name = "displacement", .components = 3, .values = displacement},
        {.name = "velocity", .components = 3, .values = velocity},
        {.name = "stress_elastic", .components = strains, .values = files->stress.elastic},
        {.name = "stress", .components = strains, .values = files->stress.total},
        {.name = "von_mises", .components = 1, .values = files->stress.von_mises}};
    FieldGrid grid = files->bulk;
    grid.time = state->time;
    grid.point_arrays = arrays;
    grid.point_array_count = (int32_t)(sizeof arrays / sizeof arrays[0]);
    return field_file_write(path, &grid, err);
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
                                 {"contact_density", 1},
                                 {"contact_area", 1}};
    FieldArray arrays[FIELD_LINE_ARRAYS];
    int64_t count = files->line.point_count, nodes = files->contact_count;
    for (int k = 0; k < FIELD_LINE_ARRAYS; k++) {
        // Columns become an array of points; vectors have three components there.
        int32_t components = rows[k].columns > 1 ? 3 : 1;
        double *values = files->line_values + 3 * k * count;
        arrays[k] = (FieldArray){.name = rows[k].name, .components = components, .values = values};
        for (int64_t i = 0; i < nodes; i++)
            for (int32_t d = 0; d < components; d++)
                values[components * i + d] = d < rows[k].columns ? line[d * nodes + i] : 0;

        // Each corner that touches nothing has the mean of the two points beside it, on the last
        // face that has it.
        const ContactFaces *faces = files->faces;
        for (int32_t f = 0; f < faces->count; f++) {
            const int32_t *points = faces->point + (int64_t)f * faces->width;
            int32_t corners = contact_face_points(faces, f) / 2;   // of a face with mid-sides
            for (int32_t c = 0; c < corners; c++) {
                int64_t beside = points[corners + c],
                        before = points[corners + (c + corners - 1) % corners];
                if (points[c] < nodes) continue;
                for (int32_t d = 0; d < components; d++)
                    values[components * points[c] + d] =
                        (values[components * beside + d] + values[components * before + d]) / 2;
            }
        }
        line += rows[k].columns * nodes;
    }
    FieldGrid grid = files->line;
    grid.time = time;
    grid.point_arrays = arrays;
    grid.point_array_count = FIELD_LINE_ARRAYS;
    return field_file_write(path, &grid, err);
}
