// SPDX-License-Identifier: GPL-2.0-or-later
// A face on the outside is cut into a lattice on which places and values are
// those of the shape functions. What is left of a block that is cut by several planes is the part
// behind the first, the part before the first and behind the second, and so on.
#include "render/view/surface.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/mesh/shape_functions.h"
#include "render/view/outer_faces.h"
#include "render/view/surface_cut.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS_FLAT = 3, PARTS_CURVED = 6, LATTICE = PARTS_CURVED + 1 };

static const double BEND = 0.87;   // cosine of the angle from which on two faces have an edge

typedef struct FaceSide {
    int32_t low, high, through;   // its ends; the node between them, -1: none
    double normal[3];   // of the face as it was
} FaceSide;

static ElementList elements_of(const FieldFrame *frame)
{
    return (ElementList){frame->element_count, frame->kind, frame->first_node,
                         frame->element_nodes};
}

// --- triangles -----------------------------------------------------------------------------------

static SurfacePoint node_point(const Block *block, int32_t node)
{
    SurfacePoint point = {.value = block->value[node]};
    memcpy(point.was, block->frame.position + 3 * (int64_t)node, sizeof point.was);
    memcpy(point.at, block->moved[node], sizeof point.at);
    return point;
}

static bool add_face(const Block *block, const OuterFace *face, const SpaceCut *cut,
                     Surface *surface, Error *err)
{
    int32_t nodes[FACE_NODES_MAX];
    ElementKind kind;
    SurfacePoint lattice[LATTICE][LATTICE];
    ElementList elements = elements_of(&block->frame);
    int32_t count = outer_face_nodes(&elements, face, &kind, nodes);
    bool triangle = element_corner_count(kind) == 3;
    int32_t parts = count > element_corner_count(kind) ? PARTS_CURVED : triangle ? 1 : PARTS_FLAT;
    for (int32_t j = 0; j <= parts; ++j)
        for (int32_t i = 0; i <= (triangle ? parts - j : parts); ++i) {
            double at[2] = {(double)i / parts, (double)j / parts};
            for (int32_t d = 0; d < 2 && !triangle; ++d) at[d] = 2 * at[d] - 1;
            lattice[j][i] = surface_point_at(block, kind, nodes, at);
        }
    for (int32_t j = 0; j < parts; ++j)
        for (int32_t i = 0; i < (triangle ? parts - j : parts); ++i) {
            const SurfacePoint lower[3] = {lattice[j][i], lattice[j][i + 1], lattice[j + 1][i]};
            if (!surface_add_outside(lower, cut, surface, err)) return false;
            if (triangle && i + j == parts - 1) continue;
            const SurfacePoint upper[3] = {lattice[j][i + 1], lattice[j + 1][i + 1],
                                           lattice[j + 1][i]};
            if (!surface_add_outside(upper, cut, surface, err)) return false;
        }
    return true;
}

// --- lines ---------------------------------------------------------------------------------------

static void face_normal(const FieldFrame *frame, const int32_t *nodes, int32_t corners,
                        double normal[3])
{
    const double *p[3];
    double a[3], b[3], size = 0;
    for (int32_t k = 0; k < 3; ++k) p[k] = frame->position + 3 * (int64_t)nodes[k];
    if (corners == 4) p[2] = frame->position + 3 * (int64_t)nodes[3];
    for (int32_t d = 0; d < 3; ++d) a[d] = p[1][d] - p[0][d], b[d] = p[2][d] - p[0][d];
    for (int32_t d = 0; d < 3; ++d) {
        normal[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
        size += normal[d] * normal[d];
    }
    for (int32_t d = 0; d < 3; ++d) normal[d] /= sqrt(size);
}

static int32_t add_face_sides(const FieldFrame *frame, const OuterFace *face, FaceSide *sides)
{
    int32_t nodes[FACE_NODES_MAX];
    ElementKind kind;
    ElementList elements = elements_of(frame);
    int32_t count = outer_face_nodes(&elements, face, &kind, nodes),
            corners = element_corner_count(kind);
    for (int32_t k = 0; k < corners; ++k) {
        int32_t a = nodes[k], b = nodes[(k + 1) % corners];
        sides[k] = (FaceSide){
            a < b ? a : b, a < b ? b : a, count > corners ? nodes[corners + k] : -1, {0}};
        face_normal(frame, nodes, corners, sides[k].normal);
    }
    return corners;
}

static bool add_side(const Block *block, const FaceSide *side, const SpaceCut *cut,
                     SurfaceParts *lines, Error *err)
{
    SurfacePoint line[3] = {node_point(block, side->low)};
    int32_t count = 1;
    if (side->through >= 0) line[count++] = node_point(block, side->through);
    line[count++] = node_point(block, side->high);
    for (int32_t k = 0; k + 1 < count; ++k)
        if (!surface_add_line(&line[k], cut, lines, err)) return false;
    return true;
}

// An outline where two faces meet at an angle, or where there is one only; edges: all of them, too.
static bool add_lines(const Block *block, const FaceSide *sides, int32_t count, const SpaceCut *cut,
                      Surface *surface, Error *err)
{
    for (int32_t k = 0; k < count; ++k) {
        double same = -1;
        bool pair = k + 1 < count && order_int32_pairs(&sides[k], &sides[k + 1]) == 0;
        if (pair) same = 0;
        for (int32_t d = 0; d < 3 && pair; ++d) same += sides[k].normal[d] * sides[k + 1].normal[d];
        if (same < BEND && !add_side(block, &sides[k], cut, &surface->outline, err)) return false;
        if (surface->with_edges && !add_side(block, &sides[k], cut, &surface->edges, err))
            return false;
        k += pair;
    }
    return true;
}

bool surface_build(const Block *block, const SpaceCut *cut, bool edges, Surface *surface,
                   Error *err)
{
    OuterFace *faces = NULL;
    FaceSide *sides = NULL;
    int32_t count = 0, side_count = 0;
    *surface = (Surface){.with_edges = edges};
    ElementList elements = elements_of(&block->frame);
    TRY(outer_faces(&elements, &faces, &count, err));
    for (int32_t f = 0; f < count; ++f) TRY(add_face(block, &faces[f], cut, surface, err));

    // Sides of the boundary, those of one face side by side.
    side_count = 0;
    TRY((sides = NEW_ARRAY(FaceSide, (int64_t)FACE_CORNERS_MAX * count, err)));
    for (int32_t f = 0; f < count; ++f)
        side_count += add_face_sides(&block->frame, &faces[f], sides + side_count);
    qsort(sides, (size_t)side_count, sizeof *sides, order_int32_pairs);

    TRY(add_lines(block, sides, side_count, cut, surface, err));
    for (int32_t k = 0; k < cut->count; ++k) TRY(surface_add_section(block, cut, k, surface, err));
cleanup:
    memory_free_all(faces, sides);
    if (!error_is_clean(err)) surface_destroy(surface);
    return error_is_clean(err);
}

void surface_destroy(Surface *surface)
{
    memory_free_all(surface->triangles.points, surface->outline.points, surface->edges.points);
    *surface = (Surface){.with_edges = false};
}
