// SPDX-License-Identifier: GPL-2.0-or-later
// Counts and sizes of a mesh.
#include "fem/mesh.h"

#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stddef.h>

// By the element's own quadrature: exact where sides are straight.
double mesh_element_area(const Mesh *mesh, int32_t e)
{
    double position[ELEMENT_NODES_MAX][2], area = 0;
    ElementKind kind = mesh->kind[e];
    for (int32_t a = 0; a < element_node_count(kind); a++) {
        int32_t i = mesh->element_nodes[mesh->first_node[e] + a];
        position[a][0] = mesh->position[2 * i];
        position[a][1] = mesh->position[2 * i + 1];
    }
    Quadrature rule = shape_quadrature(kind);
    for (int32_t q = 0; q < rule.count; q++) {
        ShapeValues shape = shape_at(kind, rule.point[q][0], rule.point[q][1]);
        area += rule.weight[q] * shape_jacobian(kind, &shape, (const double(*)[2])position, NULL);
    }
    return area;
}

// Edges are measured between corners, also where a mid-side node bends them. Longest over shortest
// edge shows a triangle that is a needle; one that is flat, with an obtuse corner, hardly.
MeshSummary mesh_summarise(const Mesh *mesh)
{
    MeshSummary summary = {.edge_min = INFINITY, .aspect_worst = -1};
    for (int32_t e = 0; e < mesh->element_count; e++) {
        ElementKind kind = mesh->kind[e];
        const int32_t *nodes = mesh->element_nodes + mesh->first_node[e];
        int32_t corners = kind == ELEMENT_T3 || kind == ELEMENT_T6 ? 3 : 4;
        double shortest = INFINITY, longest = 0;
        for (int32_t k = 0; k < corners; k++) {
            const double *from = mesh->position + 2 * nodes[k];
            const double *to = mesh->position + 2 * nodes[(k + 1) % corners];
            double length = hypot(to[0] - from[0], to[1] - from[1]);
            shortest = fmin(shortest, length);
            longest = fmax(longest, length);
        }
        summary.element_counts[kind]++;
        summary.area += mesh_element_area(mesh, e);
        summary.edge_min = fmin(summary.edge_min, shortest);
        summary.edge_max = fmax(summary.edge_max, longest);
        if (longest / shortest > summary.aspect_max) {
            summary.aspect_max = longest / shortest;
            summary.aspect_worst = e;
        }
    }
    return summary;
}
