// SPDX-License-Identifier: GPL-2.0-or-later
#include "fem/mesh_locate.h"

#include "io/mesh/shape_functions.h"

#include <math.h>

// Reference coordinates are exact to this where a point lies on the border of an element.
static const double REFERENCE_TOLERANCE = 1e-9;
// Box of an element with bent sides, over that of its nodes.
static const double BENT_BOX = 0.25;
// Rounding of places in a box, over its size.
static const double BOX_ROUNDING = 1e-9;

void mesh_element_box(const Mesh *mesh, int32_t e, MeshPlace low, MeshPlace high)
{
    ElementKind kind = (ElementKind)mesh->kind[e];
    int32_t nodes = element_node_count(kind);
    for (int32_t d = 0; d < mesh->dim; d++) {
        low[d] = INFINITY, high[d] = -INFINITY;
        for (int32_t a = 0; a < nodes; a++) {
            double place = mesh_place(mesh, mesh->element_nodes[mesh->first_node[e] + a])[d];
            low[d] = fmin(low[d], place);
            high[d] = fmax(high[d], place);
        }
        double bend = nodes > element_corner_count(kind) ? BENT_BOX * (high[d] - low[d]) : 0;
        low[d] -= bend;
        high[d] += bend;
    }
}

bool mesh_element_holds(const Mesh *mesh, int32_t e, const double *place, MeshPlace at)
{
    ElementKind kind = (ElementKind)mesh->kind[e];
    MeshPlace position[ELEMENT_NODES_MAX];
    mesh_places(mesh, mesh->element_nodes + mesh->first_node[e], element_node_count(kind),
                position);
    if (!shape_locate(kind, (const MeshPlace *)position, place, at)) return false;

    // Within the reference element: xi, eta, zeta >= 0 and their sum <= 1, or each from -1 to 1.
    int32_t dim = element_dim(kind), corners = element_corner_count(kind);
    int32_t simplex = corners == dim + 1 ? dim : kind == ELEMENT_WEDGE6 ? 2 : 0;
    double left = 1;
    for (int32_t d = 0; d < simplex; d++) {
        if (at[d] < -REFERENCE_TOLERANCE) return false;
        left -= at[d];
    }
    if (left < -REFERENCE_TOLERANCE) return false;
    for (int32_t d = simplex; d < dim; d++)
        if (fabs(at[d]) > 1 + REFERENCE_TOLERANCE) return false;
    return true;
}

int32_t mesh_locate(const Mesh *mesh, const double *place, MeshPlace at)
{
    int32_t found = -1;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        MeshPlace low, high, inside;
        bool in_base = mesh_element_in_base(mesh, e), in_box = true;
        if (found >= 0 && in_base) continue;
        mesh_element_box(mesh, e, low, high);
        for (int32_t d = 0; d < mesh->dim; d++) {
            double slack = BOX_ROUNDING * (high[d] - low[d]);
            in_box = in_box && place[d] >= low[d] - slack && place[d] <= high[d] + slack;
        }
        if (!in_box || !mesh_element_holds(mesh, e, place, inside)) continue;
        for (int32_t d = 0; d < mesh->dim; d++) at[d] = inside[d];
        found = e;
        if (!in_base) break;
    }
    return found;
}

int32_t mesh_nearest_node(const Mesh *mesh, const double *place, double *distance)
{
    int32_t nearest = 0;
    *distance = INFINITY;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        double away = 0;
        for (int32_t d = 0; d < mesh->dim; d++)
            away = hypot(away, mesh_place(mesh, i)[d] - place[d]);
        if (away >= *distance) continue;
        *distance = away;
        nearest = i;
    }
    return nearest;
}
