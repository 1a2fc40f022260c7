// SPDX-License-Identifier: GPL-2.0-or-later
// Where nodes are, as numbers and in words.
#include "fem/mesh.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Numbers of order 1 are rounded to this grid: far finer than an element, far coarser than
// rounding. Its steps are powers of 2, so that no length that one draws is half a step, which
// rounding could push either way.
static const double GRID = 0x1p30;

// Scenes whose numbers differ by rounding get the same. Should this fail for a node (within 1e-16
// of a half step) a basis is built twice, and both are right.
double put_on_grid(double value)
{
    return round(value * GRID) / GRID + 0.0;   // never -0
}

double mesh_grid_place(const Mesh *mesh, int32_t node, int32_t axis)
{
    double start = axis == 0 ? mesh->x_min : 0;
    return put_on_grid((mesh_place(mesh, node)[axis] - start) / (mesh->x_max - mesh->x_min));
}

void mesh_places(const Mesh *mesh, const int32_t *nodes, int32_t count, MeshPlace *place)
{
    for (int32_t a = 0; a < count; a++)
        memcpy(place[a], mesh_place(mesh, nodes[a]), (size_t)mesh->dim * sizeof(double));
}

void mesh_offsets(const Mesh *mesh, const int32_t *nodes, int32_t count, MeshPlace *offset)
{
    const double *origin = mesh_place(mesh, nodes[0]);
    mesh_places(mesh, nodes, count, offset);
    for (int32_t a = 0; a < count; a++)
        for (int32_t d = 0; d < mesh->dim; d++) offset[a][d] -= origin[d];
}

double mesh_distance(const Mesh *mesh, int32_t one, int32_t two)
{
    double length = 0;
    for (int32_t d = 0; d < mesh->dim; d++)
        length = hypot(length, mesh_place(mesh, two)[d] - mesh_place(mesh, one)[d]);
    return length;
}

const char *place_text(int32_t dim, const double *at, char text[PLACE_TEXT_SIZE])
{
    int length = snprintf(text, PLACE_TEXT_SIZE, "(");
    for (int32_t d = 0; d < dim; d++)
        length += snprintf(text + length, PLACE_TEXT_SIZE - (size_t)length, "%s%g",
                           d > 0 ? ", " : "", at[d]);
    snprintf(text + length, PLACE_TEXT_SIZE - (size_t)length, ")");
    return text;
}

const char *mesh_place_text(const Mesh *mesh, int32_t node, char text[PLACE_TEXT_SIZE])
{
    return place_text(mesh->dim, mesh_place(mesh, node), text);
}

void mesh_find_extent(Mesh *mesh)
{
    double *low[DIM_MAX] = {&mesh->x_min, &mesh->y_min},
           *high[DIM_MAX] = {&mesh->x_max, &mesh->y_max};
    low[mesh->dim - 1] = &mesh->z_min;
    high[mesh->dim - 1] = &mesh->z_max;
    for (int32_t d = 0; d < mesh->dim; d++) {
        *low[d] = INFINITY;
        *high[d] = -INFINITY;
        for (int32_t i = 0; i < mesh->node_count; i++) {
            if (mesh_in_base(mesh, i)) continue;
            *low[d] = fmin(*low[d], mesh_place(mesh, i)[d]);
            *high[d] = fmax(*high[d], mesh_place(mesh, i)[d]);
        }
    }
}

void mesh_move(double scale, const MeshPlace shift, Mesh *mesh)
{
    bool moved = scale != 1;
    mesh->move.scale = scale;
    for (int32_t d = 0; d < mesh->dim; d++) {
        mesh->move.shift[d] = shift[d];
        moved = moved || shift[d] != 0;
    }
    if (!moved) return;
    for (int32_t i = 0; i < mesh->node_count; i++)
        for (int32_t d = 0; d < mesh->dim; d++) {
            double *place = &mesh->position[node_dof(mesh->dim, i, d)];
            *place = scale * *place + shift[d];
        }
    mesh_find_extent(mesh);
}

const char *mesh_move_text(const Mesh *mesh, char text[MOVE_TEXT_SIZE])
{
    const MeshMove *move = &mesh->move;
    bool shifted = false;
    int length = 0;
    char by[PLACE_TEXT_SIZE];
    for (int32_t d = 0; d < mesh->dim; d++) shifted = shifted || move->shift[d] != 0;
    text[0] = 0;
    if (move->scale != 1)
        length = snprintf(text, MOVE_TEXT_SIZE, "coordinates times %g%s", move->scale,
                          shifted ? ", then " : "");
    if (move->onto_floor)
        snprintf(text + length, MOVE_TEXT_SIZE - (size_t)length,
                 "moved by %g along z, so that its lowest contact node stands on the floor z = 0",
                 move->shift[mesh->dim - 1]);
    else if (shifted)
        snprintf(text + length, MOVE_TEXT_SIZE - (size_t)length, "moved by %s",
                 place_text(mesh->dim, move->shift, by));
    return text;
}

double mesh_floor_height(const Mesh *mesh, int32_t node)
{
    const Floor *floor = &mesh->floor;
    double height = 0;
    for (int32_t k = floor_start(floor, node); k < floor_end(floor, node); k++)
        height += floor->share[k] * mesh_height(mesh, floor->node[k]);
    return height;
}
