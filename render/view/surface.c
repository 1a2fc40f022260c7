// SPDX-License-Identifier: GPL-2.0-or-later
// A face on the outside, or an element in the plane, is cut into a lattice on which places and
// values are those of the shape functions; the error of linear parts is below 1 / (8 n^2) of the
// second difference over the face, for n parts along its side. What is left of a block that is cut
// by several planes is the part behind the first, the part before the first and behind the second,
// and so on. The section goes through elements in small tetrahedra, in which places and values are
// linear: each element is a cube of parts, in the reference coordinates that make of a cube a wedge
// or a tetrahedron.
#include "render/view/surface.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/mesh/shape_functions.h"
#include "render/view/outer_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS_FLAT = 3, PARTS_CURVED = 6, LATTICE = SURFACE_PARTS_MAX + 1 };   // of a face
enum { PARTS_MAX = 4, CORNERS_MAX = PARTS_MAX + 1 };   // of an element
enum { POLYGON_MAX = 12, TETRAHEDRA = 6 };

static const double BEND = 0.87;   // cosine of the angle from which on two faces have an edge

bool space_cut_read(const char *words, SpaceCut *cut, Error *err)
{
    *cut = (SpaceCut){0};
    for (const char *at = words ? words : ""; *at; at += *at == ',') {
        static const char axes[] = "xyz";
        const char *axis = strchr(axes, *at);
        char *end = NULL;
        if (axis && at[1] == '=' && cut->count < 3) {
            cut->axis[cut->count] = (int32_t)(axis - axes);
            cut->value[cut->count++] = strtod(at + 2, &end);
        }
        if (!end || end == at + 2 || (*end && *end != ','))
            return REFUSE(
                err,
                "a cut is x, y or z = a place, as y=0.25, or up to three of them with commas "
                "between, not \"%.40s\"",
                words);
        at = end;
    }
    return true;
}

// Interpolates by the shape functions [count] of an element, or of a face, whose nodes these are.
static SurfacePoint point_at(const Block *block, const int32_t *nodes, const double *shape,
                             int32_t count)
{
    SurfacePoint point = {.value = 0};
    for (int32_t a = 0; a < count; ++a) {
        const double *was = block->frame.position + 3 * (int64_t)nodes[a];
        const double *at = block->moved ? block->moved[nodes[a]] : block->place[nodes[a]];
        point.value += shape[a] * block->value[nodes[a]];
        for (int32_t d = 0; d < block->frame.dim; ++d) {
            point.was[d] += shape[a] * was[d];
            point.at[d] += shape[a] * at[d];
        }
    }
    return point;
}

static bool add(SurfaceParts *parts, const SurfacePoint *points, int32_t each, Error *err)
{
    if (!memory_grow(&parts->points, parts->count, &parts->room, (size_t)each * sizeof *points,
                     err))
        return false;
    memcpy(parts->points + (int64_t)each * parts->count++, points, (size_t)each * sizeof *points);
    return true;
}

// --- half spaces ---------------------------------------------------------------------------------

// Distance of a point on the side that plane k takes away: the camera is at low x, low y, high z.
static double taken_by(const SpaceCut *cut, int32_t k, const SurfacePoint *point)
{
    double ahead = point->was[cut->axis[k]] - cut->value[k];
    return cut->axis[k] == 2 ? ahead : -ahead;
}

static SurfacePoint between(const SurfacePoint *a, const SurfacePoint *b, double part)
{
    SurfacePoint point = {.value = a->value + part * (b->value - a->value)};
    for (int32_t d = 0; d < 3; ++d) {
        point.was[d] = a->was[d] + part * (b->was[d] - a->was[d]);
        point.at[d] = a->at[d] + part * (b->at[d] - a->at[d]);
    }
    return point;
}

// The part of a polygon, or of a line of two points, that plane k takes away (sign 1) or leaves
// (-1), in place; returns how many points it has.
static int32_t clip(const SpaceCut *cut, int32_t k, double sign, SurfacePoint *points,
                    int32_t count)
{
    SurfacePoint kept[POLYGON_MAX];
    int32_t found = 0;
    for (int32_t i = 0; i < count; ++i) {
        const SurfacePoint *a = &points[i], *b = &points[(i + 1) % count];
        double here = sign * taken_by(cut, k, a), there = sign * taken_by(cut, k, b);
        if (here >= 0 && found < POLYGON_MAX) kept[found++] = *a;
        bool last = count == 2 && i == 1;   // a line does not go round
        if (!last && (here >= 0) != (there >= 0) && found < POLYGON_MAX)
            kept[found++] = between(a, b, here / (here - there));
    }
    memcpy(points, kept, (size_t)found * sizeof *points);
    return found;
}

static bool add_polygon(const SurfacePoint *points, int32_t count, Surface *surface, Error *err)
{
    for (int32_t k = 1; k + 1 < count; ++k) {
        const SurfacePoint corner[3] = {points[0], points[k], points[k + 1]};
        if (!add(&surface->triangles, corner, 3, err)) return false;
    }
    return true;
}

// Adds the line in which plane k cuts a triangle, as far as it is an edge of the part that is left.
static bool add_cut_line(const SurfacePoint corner[3], const SpaceCut *cut, int32_t k,
                         int32_t other, Surface *surface, Error *err)
{
    SurfacePoint line[POLYGON_MAX];
    int32_t found = 0;
    for (int32_t i = 0; i < 3; ++i) {
        double here = taken_by(cut, k, &corner[i]), there = taken_by(cut, k, &corner[(i + 1) % 3]);
        if ((here >= 0) != (there >= 0))
            line[found++] = between(&corner[i], &corner[(i + 1) % 3], here / (here - there));
    }
    for (int32_t j = 0; j < cut->count && found == 2; ++j)
        if (j != k && j != other) found = clip(cut, j, 1, line, found);
    return found != 2 || add(&surface->outline, line, 2, err);
}

// Adds the part of a boundary triangle that the cut leaves; where the cut goes through it, an
// outline.
static bool add_outside(const SurfacePoint corner[3], const SpaceCut *cut, Surface *surface,
                        Error *err)
{
    SurfacePoint points[POLYGON_MAX];
    if (cut->count == 0) return add(&surface->triangles, corner, 3, err);
    for (int32_t k = 0; k < cut->count; ++k) {
        memcpy(points, corner, 3 * sizeof *points);
        int32_t count = clip(cut, k, -1, points, 3);
        for (int32_t j = 0; j < k && count > 2; ++j) count = clip(cut, j, 1, points, count);
        if (!add_polygon(points, count, surface, err)) return false;
        if (!add_cut_line(corner, cut, k, -1, surface, err)) return false;
    }
    return true;
}

// --- the section ---------------------------------------------------------------------------------

// Maps the unit cube to the reference element.
static void reference_place(ElementKind kind, const double cube[3], double at[3])
{
    memcpy(at, cube, 3 * sizeof *at);
    switch (element_corner_count(kind)) {
    case 8:
        for (int32_t d = 0; d < 3; ++d) at[d] = 2 * cube[d] - 1;
        break;
    case 6:
        at[1] = cube[1] * (1 - cube[0]);
        at[2] = 2 * cube[2] - 1;
        break;
    default:
        at[1] = cube[1] * (1 - cube[0]);
        at[2] = cube[2] * (1 - at[0] - at[1]);
        break;
    }
}

// Three or four points in which the plane meets the sides of a tetrahedron, in turn.
static bool add_slice(const SurfacePoint *corner[4], const SpaceCut *cut, int32_t k,
                      Surface *surface, Error *err)
{
    SurfacePoint points[POLYGON_MAX];
    int32_t in[4], out[4], ins = 0, outs = 0, count = 0;
    for (int32_t c = 0; c < 4; ++c) {
        if (taken_by(cut, k, corner[c]) >= 0)
            in[ins++] = c;
        else
            out[outs++] = c;
    }
    for (int32_t i = 0; i < ins; ++i)
        for (int32_t o = 0; o < outs; ++o) {
            int32_t to = out[i & 1 ? outs - 1 - o : o];   // goes round where it is two by two
            const SurfacePoint *a = corner[in[i]], *b = corner[to];
            double here = taken_by(cut, k, a), there = taken_by(cut, k, b);
            points[count++] = between(a, b, here / (here - there));
        }
    for (int32_t j = 0; j < k && count > 2; ++j)   // edges with the planes before it
        for (int32_t i = 1; i + 1 < count; ++i) {
            const SurfacePoint triangle[3] = {points[0], points[i], points[i + 1]};
            if (!add_cut_line(triangle, cut, j, k, surface, err)) return false;
        }

    // Clips the points to the part that all planes but `own` take away.
    for (int32_t j = 0; j < cut->count && count > 1; ++j)
        if (j != k) count = clip(cut, j, 1, points, count);

    return add_polygon(points, count, surface, err);
}

// Plane k through all elements, as far as the other planes take away; and its edges with them.
static bool add_section(const Block *block, const SpaceCut *cut, int32_t k, Surface *surface,
                        Error *err)
{
    // Six tetrahedra around one diagonal of a small cube, whose corners are bits x, y, z.
    static const uint8_t ring[TETRAHEDRA + 1] = {1, 3, 2, 6, 4, 5, 1};
    const FieldFrame *frame = &block->frame;
    SurfacePoint lattice[CORNERS_MAX][CORNERS_MAX][CORNERS_MAX];
    for (int32_t e = 0; e < frame->element_count; ++e) {
        const int32_t *nodes = frame->element_nodes + frame->first_node[e];
        ElementKind kind = (ElementKind)frame->kind[e];
        int32_t count = element_node_count(kind), corners = element_corner_count(kind);
        double low = INFINITY, high = -INFINITY;
        for (int32_t a = 0; a < count; ++a) {
            double place = frame->position[3 * (int64_t)nodes[a] + cut->axis[k]];
            low = fmin(low, place);
            high = fmax(high, place);
        }
        if (!(low <= cut->value[k] && high >= cut->value[k])) continue;

        int32_t parts = count > corners ? PARTS_MAX : corners == 4 ? 1 : 2;
        for (int32_t i = 0; i <= parts; ++i)
            for (int32_t j = 0; j <= parts; ++j)
                for (int32_t l = 0; l <= parts; ++l) {
                    double cube[3] = {(double)i / parts, (double)j / parts, (double)l / parts};
                    double at[3];
                    reference_place(kind, cube, at);
                    ShapeValues shape = shape_at(kind, at);
                    lattice[i][j][l] = point_at(block, nodes, shape.value, count);
                }
        for (int32_t c = 0; c < parts * parts * parts; ++c) {
            int32_t i = c % parts, j = c / parts % parts, l = c / parts / parts;
            const SurfacePoint *cell[8];
            for (int32_t b = 0; b < 8; ++b)
                cell[b] = &lattice[i + (b & 1)][j + (b >> 1 & 1)][l + (b >> 2)];
            for (int32_t t = 0; t < TETRAHEDRA; ++t) {
                const SurfacePoint *corner[4] = {cell[0], cell[ring[t]], cell[ring[t + 1]],
                                                 cell[7]};
                if (!add_slice(corner, cut, k, surface, err)) return false;
            }
        }
    }
    return true;
}

// --- the boundary --------------------------------------------------------------------------------

// Nodes of face f; in the plane, where there is no list of faces, of element f.
static int32_t face_nodes(const ElementList *elements, const OuterFace *faces, int32_t f,
                          ElementKind *kind, int32_t nodes[FACE_NODES_MAX])
{
    if (faces) return outer_face_nodes(elements, &faces[f], kind, nodes);
    *kind = (ElementKind)elements->kind[f];
    int32_t count = element_node_count(*kind);
    memcpy(nodes, elements->nodes + elements->first_node[f], (size_t)count * sizeof *nodes);
    return count;
}

// Shape functions where the parts of a face meet; kept for the next face of its kind.
typedef struct FaceLattice {
    bool filled;   // false: it holds no face's yet
    int32_t kind;   // an ElementKind
    double shape[LATTICE][LATTICE][FACE_NODES_MAX];
} FaceLattice;

static bool add_face(const Block *block, ElementKind kind, const int32_t *nodes, int32_t parts,
                     FaceLattice *faces, const SpaceCut *cut, Surface *surface, Error *err)
{
    SurfacePoint lattice[LATTICE][LATTICE];
    int32_t corners = element_corner_count(kind), count = element_node_count(kind);
    bool triangle = corners == 3, known = faces->filled && faces->kind == (int32_t)kind;
    if (triangle && count == corners)
        parts = 1;
    else if (parts == 0)
        parts = count > corners ? PARTS_CURVED : PARTS_FLAT;
    faces->kind = (int32_t)kind;
    faces->filled = true;
    for (int32_t j = 0; j <= parts; ++j)
        for (int32_t i = 0; i <= (triangle ? parts - j : parts); ++i) {
            double at[2] = {(double)i / parts, (double)j / parts};
            for (int32_t d = 0; d < 2 && !triangle; ++d) at[d] = 2 * at[d] - 1;
            if (!known)
                memcpy(faces->shape[j][i], shape_at(kind, at).value, sizeof faces->shape[j][i]);
            lattice[j][i] = point_at(block, nodes, faces->shape[j][i], count);
        }
    for (int32_t j = 0; j < parts; ++j)
        for (int32_t i = 0; i < (triangle ? parts - j : parts); ++i) {
            const SurfacePoint lower[3] = {lattice[j][i], lattice[j][i + 1], lattice[j + 1][i]};
            if (!add_outside(lower, cut, surface, err)) return false;
            if (triangle && i + j == parts - 1) continue;
            const SurfacePoint upper[3] = {lattice[j][i + 1], lattice[j + 1][i + 1],
                                           lattice[j + 1][i]};
            if (!add_outside(upper, cut, surface, err)) return false;
        }
    return true;
}

typedef struct FaceSide {
    int32_t low, high, through;   // its ends; the node between them, -1: none
    double normal[3];   // of the face as it was
} FaceSide;

static SurfacePoint node_point(const Block *block, int32_t node)
{
    SurfacePoint point = {.value = block->value[node]};
    memcpy(point.was, block->frame.position + 3 * (int64_t)node, sizeof point.was);
    if (block->moved)
        memcpy(point.at, block->moved[node], sizeof point.at);
    else
        memcpy(point.at, block->place[node], sizeof block->place[node]);
    return point;
}

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

static bool add_side(const Block *block, const FaceSide *side, const SpaceCut *cut,
                     SurfaceParts *lines, Error *err)
{
    SurfacePoint line[3] = {node_point(block, side->low)};
    int32_t count = 1;
    if (side->through >= 0) line[count++] = node_point(block, side->through);
    line[count++] = node_point(block, side->high);
    if (cut->count == 0) {
        for (int32_t i = 0; i + 1 < count; ++i)
            if (!add(lines, &line[i], 2, err)) return false;
        return true;
    }

    // The part of each line that the cut leaves.
    for (int32_t i = 0; i + 1 < count; ++i)
        for (int32_t k = 0; k < cut->count; ++k) {
            SurfacePoint points[POLYGON_MAX];
            memcpy(points, &line[i], 2 * sizeof *points);
            int32_t left = clip(cut, k, -1, points, 2);
            for (int32_t j = 0; j < k && left == 2; ++j) left = clip(cut, j, 1, points, left);
            if (left == 2 && !add(lines, points, 2, err)) return false;
        }
    return true;
}

bool surface_build(const Block *block, const SpaceCut *cut, bool edges, int32_t parts,
                   Surface *surface, Error *err)
{
    const FieldFrame *frame = &block->frame;
    const ElementList elements = {frame->element_count, frame->kind, frame->first_node,
                                  frame->element_nodes};
    OuterFace *faces = NULL;
    FaceSide *sides = NULL;
    FaceLattice lattice = {0};
    int32_t count = frame->element_count, side_count = 0;
    *surface = (Surface){.outline = {0}};
    if (frame->dim == 3) TRY(outer_faces(&elements, &faces, &count, err));

    // Sides of the boundary, the same ones of two faces side by side.
    TRY((sides = NEW_ARRAY(FaceSide, (int64_t)FACE_CORNERS_MAX * count, err)));
    for (int32_t f = 0; f < count; ++f) {
        int32_t nodes[FACE_NODES_MAX];
        ElementKind kind;
        int32_t all = face_nodes(&elements, faces, f, &kind, nodes);
        int32_t corners = element_corner_count(kind);
        TRY(add_face(block, kind, nodes, parts, &lattice, cut, surface, err));
        for (int32_t k = 0; k < corners; ++k) {
            int32_t a = nodes[k], b = nodes[(k + 1) % corners];
            FaceSide *side = &sides[side_count++];
            *side = (FaceSide){
                a < b ? a : b, a < b ? b : a, all > corners ? nodes[corners + k] : -1, {0}};
            if (frame->dim == 3) face_normal(frame, nodes, corners, side->normal);
        }
    }
    qsort(sides, (size_t)side_count, sizeof *sides, order_int32_pairs);

    // An outline where two faces meet at an angle, or where there is one only; edges: all of them,
    // too.
    for (int32_t k = 0; k < side_count; ++k) {
        bool pair = k + 1 < side_count && order_int32_pairs(&sides[k], &sides[k + 1]) == 0;
        double same = !pair ? -1 : frame->dim == 3 ? 0 : 1;   // all elements in the plane lie flat
        for (int32_t d = 0; d < 3 && pair; ++d) same += sides[k].normal[d] * sides[k + 1].normal[d];
        if (same < BEND) TRY(add_side(block, &sides[k], cut, &surface->outline, err));
        if (edges) TRY(add_side(block, &sides[k], cut, &surface->edges, err));
        k += pair;
    }
    for (int32_t k = 0; k < cut->count; ++k) TRY(add_section(block, cut, k, surface, err));
cleanup:
    memory_free_all(faces, sides);
    if (!error_is_clean(err)) surface_destroy(surface);
    return error_is_clean(err);
}

void surface_destroy(Surface *surface)
{
    memory_free_all(surface->triangles.points, surface->outline.points, surface->edges.points);
    *surface = (Surface){.outline = {0}};
}
