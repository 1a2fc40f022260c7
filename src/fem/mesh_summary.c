// SPDX-License-Identifier: GPL-2.0-or-later
// Counts and sizes of a mesh.
#include "fem/mesh.h"

#include "fem/mesh_faces.h"
#include "io/mesh/shape_functions.h"

#include <math.h>

// The element's own quadrature is exact where sides are straight.
double mesh_element_area(const Mesh *mesh, int32_t e)
{
    MeshPlace position[ELEMENT_NODES_MAX];
    double area = 0;
    ElementKind kind = mesh->kind[e];
    mesh_places(mesh, mesh->element_nodes + mesh->first_node[e], element_node_count(kind),
                position);
    Quadrature rule = shape_quadrature(kind);
    for (int32_t q = 0; q < rule.count; q++) {
        ShapeValues shape = shape_at(kind, rule.point[q]);
        area += rule.weight[q] * shape_jacobian(kind, &shape, (const MeshPlace *)position);
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
        double shortest = INFINITY, longest = 0;
        for (int32_t side = 0; side < element_face_count(kind); side++) {
            int32_t nodes[FACE_NODES_MAX];
            int32_t corners = element_corner_count(mesh_element_face(mesh, e, side, nodes).kind);
            for (int32_t k = 0; k < corners; k++) {
                double length = mesh_distance(mesh, nodes[k], nodes[(k + 1) % corners]);
                shortest = fmin(shortest, length);
                longest = fmax(longest, length);
            }
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
