// SPDX-License-Identifier: GPL-2.0-or-later
// The section goes through elements in small tetrahedra, in which places and values are linear:
// each element is a cube of parts, in the reference coordinates that make of a cube a wedge or a
// tetrahedron.
#include "render/view/surface_cut.h"

#include "base/memory.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POLYGON_MAX = 12, PARTS_MAX = 4, CORNERS_MAX = PARTS_MAX + 1, TETRAHEDRA = 6 };

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

SurfacePoint surface_point_at(const Block *block, ElementKind kind, const int32_t *nodes,
                              const double *at)
{
    ShapeValues shape = shape_at(kind, at);
    SurfacePoint point = {.value = 0};
    for (int32_t a = 0; a < element_node_count(kind); ++a) {
        const double *was = block->frame.position + 3 * (int64_t)nodes[a];
        point.value += shape.value[a] * block->value[nodes[a]];
        for (int32_t d = 0; d < 3; ++d) {
            point.was[d] += shape.value[a] * was[d];
            point.at[d] += shape.value[a] * block->moved[nodes[a]][d];
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

// How far a point lies on the side that plane k takes away: the camera is at low x, low y, high z.
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

// Where plane k goes through a triangle, as far as it is an edge of what is left.
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

bool surface_add_outside(const SurfacePoint corner[3], const SpaceCut *cut, Surface *surface,
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

bool surface_add_line(const SurfacePoint *two, const SpaceCut *cut, SurfaceParts *lines, Error *err)
{
    SurfacePoint points[POLYGON_MAX];
    if (cut->count == 0) return add(lines, two, 2, err);
    for (int32_t k = 0; k < cut->count; ++k) {
        memcpy(points, two, 2 * sizeof *points);
        int32_t count = clip(cut, k, -1, points, 2);
        for (int32_t j = 0; j < k && count == 2; ++j) count = clip(cut, j, 1, points, count);
        if (count == 2 && !add(lines, points, 2, err)) return false;
    }
    return true;
}

// --- the section ---------------------------------------------------------------------------------

// From a unit cube to the reference element.
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

static bool straddles(const Block *block, int32_t e, const SpaceCut *cut, int32_t k)
{
    const FieldFrame *frame = &block->frame;
    double low = INFINITY, high = -INFINITY;
    for (int32_t i = frame->first_node[e]; i < frame->first_node[e + 1]; ++i) {
        double place = frame->position[3 * (int64_t)frame->element_nodes[i] + cut->axis[k]];
        low = fmin(low, place);
        high = fmax(high, place);
    }
    return low <= cut->value[k] && high >= cut->value[k];
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

static bool add_element(const Block *block, int32_t e, const SpaceCut *cut, int32_t k,
                        Surface *surface, Error *err)
{
    const FieldFrame *frame = &block->frame;
    ElementKind kind = (ElementKind)frame->kind[e];
    bool curved = element_node_count(kind) > element_corner_count(kind);
    int32_t parts = curved ? PARTS_MAX : element_corner_count(kind) == 4 ? 1 : 2;
    SurfacePoint lattice[CORNERS_MAX][CORNERS_MAX][CORNERS_MAX];
    for (int32_t i = 0; i <= parts; ++i)
        for (int32_t j = 0; j <= parts; ++j)
            for (int32_t l = 0; l <= parts; ++l) {
                double cube[3] = {(double)i / parts, (double)j / parts, (double)l / parts}, at[3];
                reference_place(kind, cube, at);
                lattice[i][j][l] =
                    surface_point_at(block, kind, frame->element_nodes + frame->first_node[e], at);
            }
    for (int32_t c = 0; c < parts * parts * parts; ++c) {
        int32_t i = c % parts, j = c / parts % parts, l = c / parts / parts;
        const SurfacePoint *cell[8];
        for (int32_t b = 0; b < 8; ++b)
            cell[b] = &lattice[i + (b & 1)][j + (b >> 1 & 1)][l + (b >> 2)];

        // Six tetrahedra around one diagonal of a small cube.
        static const uint8_t ring[TETRAHEDRA + 1] = {1, 3, 2, 6,
                                                     4, 5, 1};   // corners as bits x, y, z
        for (int32_t t = 0; t < TETRAHEDRA; ++t) {
            const SurfacePoint *corner[4] = {cell[0], cell[ring[t]], cell[ring[t + 1]], cell[7]};
            if (!add_slice(corner, cut, k, surface, err)) return false;
        }
    }
    return true;
}

bool surface_add_section(const Block *block, const SpaceCut *cut, int32_t k, Surface *surface,
                         Error *err)
{
    for (int32_t e = 0; e < block->frame.element_count; ++e)
        if (straddles(block, e, cut, k) && !add_element(block, e, cut, k, surface, err))
            return false;
    return true;
}
