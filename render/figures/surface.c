// SPDX-License-Identifier: GPL-2.0-or-later
// A face of one element alone is boundary. It is cut into a lattice on which places and values are
// those of the shape functions. What is left of a block that is cut by several planes is the part
// behind the first, the part before the first and behind the second, and so on.
#include "render/figures/surface.h"

#include "base/memory.h"
#include "io/mesh/element_faces.h"
#include "io/mesh/shape_functions.h"
#include "render/figures/surface_cut.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS_FLAT = 3, PARTS_CURVED = 6, LATTICE = PARTS_CURVED + 1 };

static const double BEND = 0.87;   // cosine of the angle from which on two faces have an edge

typedef struct BoundaryFace {
    int32_t key[FACE_CORNERS_MAX];   // its corners, ascending; -1: no more
    int32_t element, side;
} BoundaryFace;

typedef struct FaceSide {
    int32_t low, high, through;   // its ends; the node between them, -1: none
    double normal[3];   // of the face as it was
} FaceSide;

static int compare_indices(const void *left, const void *right)
{
    int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
    return a < b ? -1 : a > b;
}

static int compare_faces(const void *left, const void *right)
{
    return memcmp(left, right, sizeof(int32_t[FACE_CORNERS_MAX]));
}

// Nodes of the face in the frame, in its kind's order; returns how many.
static int32_t face_nodes(const FieldFrame *frame, const BoundaryFace *face, ElementKind *kind,
                          int32_t nodes[FACE_NODES_MAX])
{
    ElementFace own = element_face((ElementKind)frame->kind[face->element], face->side);
    int32_t count = element_node_count(own.kind);
    for (int32_t a = 0; a < count; ++a)
        nodes[a] = frame->element_nodes[frame->first_node[face->element] + own.node[a]];
    *kind = own.kind;
    return count;
}

// All faces, sorted; those of two elements stand side by side.
static bool list_faces(const FieldFrame *frame, BoundaryFace **faces, int32_t *count, Error *err)
{
    int64_t all = 0;
    for (int32_t e = 0; e < frame->element_count; ++e)
        all += element_face_count((ElementKind)frame->kind[e]);
    *count = 0;
    TRY(*faces = NEW_ARRAY(BoundaryFace, all, err));
    for (int32_t e = 0; e < frame->element_count; ++e)
        for (int32_t side = 0; side < element_face_count((ElementKind)frame->kind[e]); ++side) {
            BoundaryFace *face = &(*faces)[(*count)++];
            int32_t nodes[FACE_NODES_MAX];
            ElementKind kind;
            *face = (BoundaryFace){{-1, -1, -1, -1}, e, side};
            face_nodes(frame, face, &kind, nodes);
            memcpy(face->key, nodes, (size_t)element_corner_count(kind) * sizeof *nodes);
            qsort(face->key, (size_t)element_corner_count(kind), sizeof *nodes, compare_indices);
        }
    qsort(*faces, (size_t)*count, sizeof **faces, compare_faces);
cleanup:
    return error_is_clean(err);
}

// Only those of one element stay.
static int32_t keep_boundary(BoundaryFace *faces, int32_t count)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < count; ++k) {
        bool before = k > 0 && compare_faces(&faces[k - 1], &faces[k]) == 0;
        bool after = k + 1 < count && compare_faces(&faces[k], &faces[k + 1]) == 0;
        if (k > 0 && before) continue;   // its twin was looked at
        if (!after) faces[kept++] = faces[k];
    }
    return kept;
}

// --- triangles -----------------------------------------------------------------------------------

static SurfacePoint node_point(const Block *block, int32_t node)
{
    SurfacePoint point = {.value = block->value[node]};
    memcpy(point.was, block->frame.position + 3 * (int64_t)node, sizeof point.was);
    memcpy(point.at, block->moved[node], sizeof point.at);
    return point;
}

static bool add_face(const Block *block, const BoundaryFace *face, const SpaceCut *cut,
                     Surface *surface, Error *err)
{
    int32_t nodes[FACE_NODES_MAX];
    ElementKind kind;
    SurfacePoint lattice[LATTICE][LATTICE];
    int32_t count = face_nodes(&block->frame, face, &kind, nodes);
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
            TRY(surface_add_outside(lower, cut, surface, err));
            if (triangle && i + j == parts - 1) continue;
            const SurfacePoint upper[3] = {lattice[j][i + 1], lattice[j + 1][i + 1],
                                           lattice[j + 1][i]};
            TRY(surface_add_outside(upper, cut, surface, err));
        }
cleanup:
    return error_is_clean(err);
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

static int32_t add_face_sides(const FieldFrame *frame, const BoundaryFace *face, FaceSide *sides)
{
    int32_t nodes[FACE_NODES_MAX];
    ElementKind kind;
    int32_t count = face_nodes(frame, face, &kind, nodes), corners = element_corner_count(kind);
    for (int32_t k = 0; k < corners; ++k) {
        int32_t a = nodes[k], b = nodes[(k + 1) % corners];
        sides[k] = (FaceSide){
            a < b ? a : b, a < b ? b : a, count > corners ? nodes[corners + k] : -1, {0}};
        face_normal(frame, nodes, corners, sides[k].normal);
    }
    return corners;
}

static int compare_sides(const void *left, const void *right)
{
    const FaceSide *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    return a->high < b->high ? -1 : a->high > b->high;
}

static bool add_side(const Block *block, const FaceSide *side, const SpaceCut *cut,
                     SurfaceParts *lines, Error *err)
{
    SurfacePoint line[3] = {node_point(block, side->low)};
    int32_t count = 1;
    if (side->through >= 0) line[count++] = node_point(block, side->through);
    line[count++] = node_point(block, side->high);
    for (int32_t k = 0; k + 1 < count; ++k) TRY(surface_add_line(&line[k], cut, lines, err));
cleanup:
    return error_is_clean(err);
}

// Sides of the boundary, those of one face side by side: [*count].
static bool list_sides(const FieldFrame *frame, const BoundaryFace *faces, int32_t face_count,
                       FaceSide **sides, int32_t *count, Error *err)
{
    *count = 0;
    TRY(*sides = NEW_ARRAY(FaceSide, (int64_t)FACE_CORNERS_MAX * face_count, err));
    for (int32_t f = 0; f < face_count; ++f)
        *count += add_face_sides(frame, &faces[f], *sides + *count);
    qsort(*sides, (size_t)*count, sizeof **sides, compare_sides);
cleanup:
    return error_is_clean(err);
}

// An outline where two faces meet at an angle, or where there is one only; edges: all of them, too.
static bool add_lines(const Block *block, const FaceSide *sides, int32_t count, const SpaceCut *cut,
                      Surface *surface, Error *err)
{
    for (int32_t k = 0; k < count; ++k) {
        double same = -1;
        bool pair = k + 1 < count && compare_sides(&sides[k], &sides[k + 1]) == 0;
        if (pair) same = 0;
        for (int32_t d = 0; d < 3 && pair; ++d) same += sides[k].normal[d] * sides[k + 1].normal[d];
        if (same < BEND) TRY(add_side(block, &sides[k], cut, &surface->outline, err));
        if (surface->with_edges) TRY(add_side(block, &sides[k], cut, &surface->edges, err));
        k += pair;
    }
cleanup:
    return error_is_clean(err);
}

bool surface_build(const Block *block, const SpaceCut *cut, bool edges, Surface *surface,
                   Error *err)
{
    BoundaryFace *faces = NULL;
    FaceSide *sides = NULL;
    int32_t count = 0, side_count = 0;
    *surface = (Surface){.with_edges = edges};
    TRY(list_faces(&block->frame, &faces, &count, err));
    count = keep_boundary(faces, count);
    for (int32_t f = 0; f < count; ++f) TRY(add_face(block, &faces[f], cut, surface, err));
    TRY(list_sides(&block->frame, faces, count, &sides, &side_count, err));
    TRY(add_lines(block, sides, side_count, cut, surface, err));
    for (int32_t k = 0; k < cut->count; ++k) TRY(surface_add_section(block, cut, k, surface, err));
cleanup:
    memory_free(faces);
    memory_free(sides);
    if (!error_is_clean(err)) surface_destroy(surface);
    return error_is_clean(err);
}

void surface_destroy(Surface *surface)
{
    memory_free(surface->triangles.points);
    memory_free(surface->outline.points);
    memory_free(surface->edges.points);
    *surface = (Surface){.with_edges = false};
}
