// SPDX-License-Identifier: GPL-2.0-or-later
// Where nodes are, as numbers and in words.
#include "fem/mesh.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
