// SPDX-License-Identifier: GPL-2.0-or-later
#include "fem/mesh_locate.h"

#include "base/memory.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdlib.h>

// Reference coordinates are exact to this where a point lies on the border of an element.
static const double REFERENCE_TOLERANCE = 1e-9;
// Box of an element with bent sides, over that of its nodes.
static const double BENT_BOX = 0.25;
// Rounding of places in a box, over its size.
static const double BOX_ROUNDING = 1e-9;

// Finds the box around element e, with room for bent sides: [mesh->dim] each, length.
static void element_box(const Mesh *mesh, int32_t e, MeshPlace low, MeshPlace high)
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

// True if `place` [mesh->dim] lies in element e or on its border; at: its reference coordinates.
static bool element_holds(const Mesh *mesh, int32_t e, const double *place, MeshPlace at)
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
        element_box(mesh, e, low, high);
        for (int32_t d = 0; d < mesh->dim; d++) {
            double slack = BOX_ROUNDING * (high[d] - low[d]);
            in_box = in_box && place[d] >= low[d] - slack && place[d] <= high[d] + slack;
        }
        if (!in_box || !element_holds(mesh, e, place, inside)) continue;
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

// --- faces inside the block ---------------------------------------------------------------------

// A point just outside of the middle of each face of the surface must lie in no element. Points
// stand in order of x, so that each element looks only at those within its box.

// Least distance that counts as outside, over the size of the face: more than rounding of
// coordinates, and a slit that is so wide open is no fault.
static const double OUTSIDE = 1e-5;

typedef struct ProbePoint {
    MeshPlace place;
    int32_t element;   // whose face it is before
    MeshPlace on_face;
} ProbePoint;

static int compare_points(const void *a, const void *b)
{
    const ProbePoint *first = a, *second = b;
    if (first->place[0] != second->place[0]) return first->place[0] < second->place[0] ? -1 : 1;
    return (first->element > second->element) - (first->element < second->element);
}

bool mesh_check_inside(const Mesh *mesh, const MeshFaces *faces, Error *err)
{
    int32_t count = 0, room = 0;
    char at[PLACE_TEXT_SIZE];
    ProbePoint *points = NULL;
    for (int32_t i = 0; i < mesh->node_count; i++)
        for (int32_t k = faces->first[i]; k < faces->last[i]; k++)
            room += faces->faces[k].elements == 1;
    if (!(points = NEW_ARRAY(ProbePoint, room, err))) return false;

    // A point just outside of the middle of each face that is on one element.
    for (int32_t i = 0; i < mesh->node_count; i++)
        for (int32_t k = faces->first[i]; k < faces->last[i]; k++) {
            static const double triangle[] = {1. / 3, 1. / 3}, square[] = {0, 0};
            const MeshFace *face = &faces->faces[k];
            int32_t nodes[FACE_NODES_MAX];
            MeshPlace position[FACE_NODES_MAX], normal;
            if (face->elements != 1) continue;
            FaceNodes seen = mesh_element_face(mesh, face->element, face->side, nodes);
            int32_t corners = element_corner_count(seen.kind);
            int32_t face_nodes = element_node_count(seen.kind);
            mesh_places(mesh, nodes, face_nodes, position);
            ShapeValues shape = shape_at(seen.kind, corners == 3 ? triangle : square);
            shape_normal(seen.kind, &shape, (const MeshPlace *)position, normal);
            double area = 0;
            for (int32_t d = 0; d < mesh->dim; d++) area = hypot(area, normal[d]);
            double size = mesh->dim == 2 ? area : sqrt(area);
            double outwards = mesh->dim == 2 ? -1 : 1;   // the normal of a line is to its left
            ProbePoint *point = &points[count++];
            point->element = face->element;
            for (int32_t d = 0; d < mesh->dim; d++) {
                for (int32_t a = 0; a < face_nodes; a++)
                    point->on_face[d] += shape.value[a] * position[a][d];
                point->place[d] = point->on_face[d] + outwards * OUTSIDE * size * normal[d] / area;
            }
        }
    qsort(points, (size_t)count, sizeof *points, compare_points);

    // No point may lie in another element of the same body.
    for (int32_t e = 0; e < mesh->element_count; e++) {
        const ProbePoint *found = NULL;
        MeshPlace low, high, inside;
        int32_t from = 0, to = count;   // becomes the first point with x >= low
        element_box(mesh, e, low, high);
        while (from < to) {
            int32_t middle = from + (to - from) / 2;
            if (points[middle].place[0] < low[0])
                from = middle + 1;
            else
                to = middle;
        }
        for (int32_t k = from; !found && k < count && !(points[k].place[0] > high[0]); k++) {
            const ProbePoint *point = &points[k];
            bool in_box = point->element != e && mesh_element_in_base(mesh, point->element) ==
                                                     mesh_element_in_base(mesh, e);
            for (int32_t d = 1; d < mesh->dim; d++)
                in_box = in_box && point->place[d] >= low[d] && point->place[d] <= high[d];
            if (in_box && element_holds(mesh, e, point->place, inside)) found = point;
        }
        if (!found) continue;
        FAIL(
            err, ERROR_INPUT,
            "%s: the %s at %s is on element %lld alone, but lies inside the block: element %lld is "
            "right behind it. Parts of the mesh are not glued together there: nodes are there "
            "twice (`Coherence Mesh;` in a .geo makes one of them; the sides of a crack must stand "
            "apart, as nothing keeps them from passing through each other), a node hangs in the "
            "middle of a larger cell's side, or elements overlap",
            mesh->path, mesh->dim == 2 ? "edge" : "face", place_text(mesh->dim, found->on_face, at),
            (long long)mesh->element_number[found->element], (long long)mesh->element_number[e]);
    }
cleanup:
    memory_free(points);
    return error_is_clean(err);
}
