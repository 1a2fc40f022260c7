// SPDX-License-Identifier: GPL-2.0-or-later
// The dual mortar of fem/floor.h. Of each face of the contact
//
//     M_ab = int N_a N_b dA,   D_a = int N_a dA,   B_af = int N_a N_f dA
//
// are added up at the same points of the same pieces, so that psi_a = D_a sum_b (M^-1)_ab N_b is
// dual to rounding and matching meshes give the identity. Places are those on a grid of 2^-30 of
// the block's length, so that P has the same bits in any unit.
#include "fem/floor.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "fem/mesh_faces.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Shares below this, and what misses from 1, are rounding.
static const double SHARE_ROUNDING = 1e-9;
// Part of a face of the contact that may lie over no face of the floor: rounding of coordinates.
static const double COVER_ROUNDING = 1e-6;
// A contact node so much above the floor stands on it, over the block's length.
static const double GAP_ROUNDING = 1e-9;
// A face whose shadow is smaller, over the square of its extent, stands upright.
static const double UPRIGHT = 1e-9;

enum {
    SHADOW_DIM = DIM_MAX - 1,
    POLYGON_MAX = 2 * FACE_CORNERS_MAX,   // corners of what two convex faces have in common
    GAUSS_POINTS = 5   // exact to degree 9 along a line
};

static const double GAUSS_PLACE[GAUSS_POINTS] = {-0.906179845938664, -0.5384693101056831, 0,
                                                 0.5384693101056831, 0.906179845938664};
static const double GAUSS_WEIGHT[GAUSS_POINTS] = {0.23692688505618908, 0.47862867049936647,
                                                  0.5688888888888889, 0.47862867049936647,
                                                  0.23692688505618908};

typedef double Shadow[SHADOW_DIM];

// A face seen from above.
typedef struct ShadowFace {
    FaceNodes face;
    MeshPlace place[FACE_NODES_MAX];   // of its nodes, the last number 0
    Shadow low, high;   // box of its corners
} ShadowFace;

// B of one face of the contact and one of the floor.
typedef struct FacePair {
    int32_t floor_face;
    double product[FACE_NODES_MAX][FACE_NODES_MAX];   // [node of the contact's][of the floor's]
} FacePair;

typedef struct FloorEntry {
    int32_t contact, node;   // of the contact, of the floor
    double value;
} FloorEntry;

typedef struct Mortar {
    const Mesh *mesh;
    int32_t dim;   // of a shadow
    ShadowFace *floor;   // [floor_count] by ascending low[0]; owned
    int32_t floor_count;
    double widest;   // along x of a face of the floor
    double *total;   // [nodes] int psi_i dA of contact nodes; owned
    FacePair *pairs;   // of the face at hand; owned
    int32_t pair_count, pair_room;
    FloorEntry *entries;   // owned
    int32_t entry_count, entry_room;
} Mortar;

void floor_destroy(Floor *floor)
{
    memory_free_all(floor->start, floor->node, floor->share);
    *floor = (Floor){0};
}

// --- places -------------------------------------------------------------------------------------

static ShadowFace shadow_of(const Mesh *mesh, FaceNodes face)
{
    ShadowFace shadow = {.face = face};
    for (int32_t d = 0; d < mesh->dim - 1; d++) {
        shadow.low[d] = INFINITY;
        shadow.high[d] = -INFINITY;
        for (int32_t a = 0; a < element_node_count(face.kind); a++)
            shadow.place[a][d] = mesh_grid_place(mesh, face.node[a], d);
        for (int32_t a = 0; a < element_corner_count(face.kind); a++) {
            shadow.low[d] = fmin(shadow.low[d], shadow.place[a][d]);
            shadow.high[d] = fmax(shadow.high[d], shadow.place[a][d]);
        }
    }
    return shadow;
}

// Twice the area, positive where corners run counter-clockwise.
static double double_area(const Shadow *corner, int32_t count)
{
    double sum = 0;
    for (int32_t a = 0; a < count; a++) {
        const double *one = corner[a], *next = corner[(a + 1) % count];
        sum += one[0] * next[1] - one[1] * next[0];
    }
    return sum;
}

// Corners of a face, counter-clockwise; in the plane its two ends, ascending. Returns how many.
static int32_t corners_of(const ShadowFace *shadow, int32_t dim, Shadow *corner)
{
    int32_t count = element_corner_count(shadow->face.kind);
    for (int32_t a = 0; a < count; a++) memcpy(corner[a], shadow->place[a], sizeof *corner);
    bool turned = dim == 1 ? corner[0][0] > corner[1][0] : double_area(corner, count) < 0;
    for (int32_t a = 0; turned && a < count / 2; a++)
        for (int32_t d = 0; d < SHADOW_DIM; d++) {
            double kept = corner[a][d];
            corner[a][d] = corner[count - 1 - a][d];
            corner[count - 1 - a][d] = kept;
        }
    return count;
}

// Length or area of a polygon.
static double size_of(const Shadow *corner, int32_t count, int32_t dim)
{
    return dim == 1 ? corner[1][0] - corner[0][0] : double_area(corner, count) / 2;
}

// Intersects two faces: an interval, or a convex polygon (Sutherland and Hodgman, Comm. ACM 17,
// 1974). Returns the number of corners, 0: nothing.
static int32_t overlap(const ShadowFace *one, const ShadowFace *other, int32_t dim, Shadow *corner)
{
    Shadow edge[FACE_CORNERS_MAX], before[POLYGON_MAX];
    int32_t count = corners_of(one, dim, corner), edges = corners_of(other, dim, edge);
    if (dim == 1) {
        corner[0][0] = fmax(corner[0][0], edge[0][0]);
        corner[1][0] = fmin(corner[1][0], edge[1][0]);
        return corner[0][0] < corner[1][0] ? 2 : 0;
    }
    for (int32_t k = 0; k < edges; k++) {
        const double *from = edge[k], *to = edge[(k + 1) % edges];
        int32_t left = 0;
        memcpy(before, corner, (size_t)count * sizeof *corner);
        for (int32_t a = 0; a < count; a++) {
            const double *at = before[a], *next = before[(a + 1) % count];
            double here = (to[0] - from[0]) * (at[1] - from[1]) -
                          (to[1] - from[1]) * (at[0] - from[0]);
            double there = (to[0] - from[0]) * (next[1] - from[1]) -
                           (to[1] - from[1]) * (next[0] - from[0]);
            if (here >= 0 && left < POLYGON_MAX) memcpy(corner[left++], at, sizeof(Shadow));
            if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
                double part = here / (here - there);
                if (left == POLYGON_MAX) continue;
                for (int32_t d = 0; d < SHADOW_DIM; d++)
                    corner[left][d] = at[d] + part * (next[d] - at[d]);
                left++;
            }
        }
        count = left;
        if (count < 3) return 0;
    }
    return count;
}

// Shape functions of a face where it lies over, or under, a place.
static ShapeValues shape_under(const ShadowFace *shadow, const double *at)
{
    MeshPlace point;
    shape_locate(shadow->face.kind, (const MeshPlace *)shadow->place, at, point);
    return shape_at(shadow->face.kind, point);
}

// --- integrals ----------------------------------------------------------------------------------

typedef struct PiecePoints {
    int32_t count;
    Shadow at[POLYGON_MAX * GAUSS_POINTS * GAUSS_POINTS];
    double weight[POLYGON_MAX * GAUSS_POINTS * GAUSS_POINTS];
} PiecePoints;

// Gauss's points of an interval; of a polygon those of the triangles around its first corner, each
// a square with one side pulled together (Duffy).
static void set_points(const Shadow *corner, int32_t count, int32_t dim, PiecePoints *points)
{
    points->count = 0;
    for (int32_t k = 0; dim == 1 && k < GAUSS_POINTS; k++) {
        double half = 0.5 * (corner[1][0] - corner[0][0]);
        points->at[k][0] = corner[0][0] + half * (1 + GAUSS_PLACE[k]);
        points->weight[points->count++] = half * GAUSS_WEIGHT[k];
    }
    for (int32_t t = 1; dim == 2 && t + 1 < count; t++) {
        const Shadow triangle[3] = {{corner[0][0], corner[0][1]},
                                    {corner[t][0], corner[t][1]},
                                    {corner[t + 1][0], corner[t + 1][1]}};
        double twice = double_area(triangle, 3);
        for (int32_t k = 0; k < GAUSS_POINTS; k++)
            for (int32_t l = 0; l < GAUSS_POINTS; l++) {
                double out = 0.5 * (1 + GAUSS_PLACE[k]), along = 0.5 * (1 + GAUSS_PLACE[l]);
                int32_t at = points->count++;
                for (int32_t d = 0; d < SHADOW_DIM; d++)
                    points->at[at][d] = (1 - out) * triangle[0][d] +
                                        out *
                                            ((1 - along) * triangle[1][d] + along * triangle[2][d]);
                points->weight[at] = 0.25 * GAUSS_WEIGHT[k] * GAUSS_WEIGHT[l] * out * twice;
            }
    }
}

// Adds the rows of one face of the contact.
static bool add_face(Mortar *mortar, const char *pad, FaceNodes face, const char *floor, Error *err)
{
    ShadowFace own = shadow_of(mortar->mesh, face);
    int32_t dim = mortar->dim, nodes = element_node_count(face.kind);
    double mass[FACE_NODES_MAX * FACE_NODES_MAX] = {0}, share[FACE_NODES_MAX] = {0}, covered = 0;
    Shadow corner[POLYGON_MAX];
    PiecePoints points;
    mortar->pair_count = 0;

    // Faces of the floor are sorted by where they begin: the first that may reach the own one.
    int32_t first = 0, behind = mortar->floor_count;
    while (first < behind) {
        int32_t middle = first + (behind - first) / 2;
        if (mortar->floor[middle].low[0] < own.low[0] - mortar->widest)
            first = middle + 1;
        else
            behind = middle;
    }

    // Integrals over what both have of the contact.
    for (int32_t k = first; k < mortar->floor_count && mortar->floor[k].low[0] < own.high[0]; k++) {
        const ShadowFace *under = &mortar->floor[k];
        if (dim == 2 && (under->high[1] <= own.low[1] || under->low[1] >= own.high[1])) continue;
        int32_t corners = overlap(&own, under, dim, corner);
        if (corners == 0) continue;
        if (!memory_grow(&mortar->pairs, mortar->pair_count, &mortar->pair_room,
                         sizeof *mortar->pairs, err))
            return false;
        FacePair *pair = &mortar->pairs[mortar->pair_count++];
        *pair = (FacePair){.floor_face = k};
        set_points(corner, corners, dim, &points);
        for (int32_t q = 0; q < points.count; q++) {
            ShapeValues upper = shape_under(&own, points.at[q]);
            ShapeValues lower = shape_under(under, points.at[q]);
            double weight = points.weight[q];
            covered += weight;
            for (int32_t a = 0; a < nodes; a++) {
                share[a] += weight * upper.value[a];
                for (int32_t b = 0; b < nodes; b++)
                    mass[b * nodes + a] += weight * upper.value[a] * upper.value[b];
                for (int32_t f = 0; f < element_node_count(under->face.kind); f++)
                    pair->product[a][f] += weight * upper.value[a] * lower.value[f];
            }
        }
    }

    // The faces of the floor must cover all of this one.
    int32_t corners = corners_of(&own, dim, corner);
    double size = size_of(corner, corners, dim);
    if (!(fabs(covered - size) <= COVER_ROUNDING * size)) {
        char at[PLACE_TEXT_SIZE];
        return REFUSE(
            err,
            "%s: contact group '%s' near %s lies over group '%s' of the base with %.3g of "
            "its %s: the floor must reach over all of the contact, once (draw the base longer, "
            "and name its upper side alone)",
            mortar->mesh->path, pad, mesh_place_text(mortar->mesh, face.node[0], at), floor,
            covered / size, mortar->mesh->dim == 2 ? "length" : "area");
    }

    // Inverts the mass matrix of the face's shape functions.
    if (!dense_cholesky(mass, nodes) || !dense_invert_factored(mass, nodes))
        return FAULT(err, ERROR_COMPUTE, "%s: a face of contact group '%s' has no area",
                     mortar->mesh->path, pad);

    if (dim == 2 && face.kind == ELEMENT_T6) {
        // The corners of a T6 have no weight: half of what they have goes to each mid-side beside
        // them, as for the weights of the contact (fem/assembly).
        for (int32_t a = 0; a < 3; a++) {
            share[3 + a] += 0.5 * share[a];
            share[3 + (a + 2) % 3] += 0.5 * share[a];
            share[a] = 0;
        }
    }

    // Adds the entries of each contact node and each node of the floor under the face.
    for (int32_t a = 0; a < nodes; a++) {
        mortar->total[face.node[a]] += share[a];
        for (int32_t p = 0; share[a] != 0 && p < mortar->pair_count; p++) {
            const FacePair *pair = &mortar->pairs[p];
            FaceNodes under = mortar->floor[pair->floor_face].face;
            for (int32_t f = 0; f < element_node_count(under.kind); f++) {
                double value = 0;
                for (int32_t b = 0; b < nodes; b++)
                    value += share[a] * mass[b * nodes + a] * pair->product[b][f];
                if (!memory_grow(&mortar->entries, mortar->entry_count, &mortar->entry_room,
                                 sizeof *mortar->entries, err))
                    return false;
                mortar->entries[mortar->entry_count++] =
                    (FloorEntry){face.node[a], under.node[f], value};
            }
        }
    }
    return true;
}

// --- P ------------------------------------------------------------------------------------------

static int compare_entries(const void *a, const void *b)
{
    const FloorEntry *one = a, *other = b;
    if (one->contact != other->contact) return one->contact < other->contact ? -1 : 1;
    if (one->node != other->node) return one->node < other->node ? -1 : 1;
    return (one->value > other->value) - (one->value < other->value);
}

static int compare_shadows(const void *a, const void *b)
{
    const ShadowFace *one = a, *other = b;
    if (one->low[0] != other->low[0]) return one->low[0] < other->low[0] ? -1 : 1;
    return (one->face.node[0] > other->face.node[0]) - (one->face.node[0] < other->face.node[0]);
}

bool floor_find(const char (*names)[GROUP_NAME_SIZE], int32_t name_count, const char *floor,
                Mesh *mesh, Error *err)
{
    MeshContact contact = {0};
    MeshBoundary boundary;
    Mortar mortar = {.mesh = mesh, .dim = mesh->dim - 1};
    if (!mesh->is_base) return true;
    TRY(mesh_contact(mesh, names, name_count, &contact, err));
    TRY(mesh_boundary(mesh, floor, &boundary, err));

    // Faces of the floor that do not stand upright.
    Shadow corner[FACE_CORNERS_MAX];
    TRY((mortar.floor = NEW_ARRAY(ShadowFace, boundary.face_count, err)));
    for (int32_t k = 0; k < boundary.face_count; k++) {
        ShadowFace shadow = shadow_of(mesh, mesh_boundary_face(&boundary, k));
        int32_t corners = corners_of(&shadow, mortar.dim, corner);
        double extent = shadow.high[0] - shadow.low[0];
        if (mortar.dim == 2) extent = pow(fmax(extent, shadow.high[1] - shadow.low[1]), 2);
        if (!(size_of(corner, corners, mortar.dim) > UPRIGHT * extent)) continue;
        mortar.widest = fmax(mortar.widest, shadow.high[0] - shadow.low[0]);
        mortar.floor[mortar.floor_count++] = shadow;
    }
    qsort(mortar.floor, (size_t)mortar.floor_count, sizeof *mortar.floor, compare_shadows);

    // The rows of P, from each face of the contact.
    TRY((mortar.total = NEW_ARRAY(double, mesh->node_count, err)));
    for (int32_t c = 0; c < contact.pad_count; c++)
        for (int32_t k = 0; k < contact.pads[c].face_count; k++)
            TRY(add_face(&mortar, contact.pads[c].name, mesh_boundary_face(&contact.pads[c], k),
                         floor, err));

    // Entries of one place are summed, over the total of their row; rows without weight and shares
    // of rounding are left out.
    Floor *rows = &mesh->floor;
    int32_t count = mortar.entry_count, filled = 0, at = 0;
    const FloorEntry *entry = mortar.entries;
    double largest = 0;
    TRY((rows->start = NEW_ARRAY(int32_t, (int64_t)mesh->node_count + 1, err)));
    TRY((rows->node = NEW_ARRAY(int32_t, count, err)));
    TRY((rows->share = NEW_ARRAY(double, count, err)));
    if (count > 0) qsort(mortar.entries, (size_t)count, sizeof *entry, compare_entries);
    for (int32_t i = 0; i < mesh->node_count; i++) largest = fmax(largest, mortar.total[i]);
    rows->matches = true;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        bool weightless = mortar.total[i] < SHARE_ROUNDING * largest;
        while (at < count && entry[at].contact == i) {
            int32_t node = entry[at].node;
            double share = 0;
            for (; at < count && entry[at].contact == i && entry[at].node == node; at++)
                share += entry[at].value / mortar.total[i];
            if (weightless || fabs(share) < SHARE_ROUNDING) continue;
            rows->node[filled] = node;
            rows->share[filled++] = fabs(share - 1) < SHARE_ROUNDING ? 1 : share;
        }
        rows->start[i + 1] = filled;
        rows->matches = rows->matches && filled <= rows->start[i] + 1;
    }

    // The block stands on the base, nowhere in it.
    int32_t lowest = -1;
    double least = INFINITY;
    for (int32_t k = 0; k < contact.node_count; k++) {
        int32_t node = contact.nodes[k];
        if (floor_start(&mesh->floor, node) == floor_end(&mesh->floor, node)) continue;
        double gap = mesh_height(mesh, node) - mesh_floor_height(mesh, node);
        if (gap < least) {
            least = gap;
            lowest = node;
        }
    }
    if (lowest >= 0 && !(fabs(least) <= GAP_ROUNDING * (mesh->x_max - mesh->x_min)))
        FAIL(err, ERROR_INPUT,
             "%s: contact node %lld at x = %g, the lowest, is %g %s the floor of the base: "
             "draw the block so that it stands on the base",
             mesh->path, (long long)mesh->node_number[lowest], mesh_place(mesh, lowest)[0],
             fabs(least), least < 0 ? "below" : "above");
cleanup:
    memory_free_all(mortar.floor, mortar.total, mortar.pairs, mortar.entries);
    mesh_contact_destroy(&contact);
    return error_is_clean(err);
}

// --- fields and forces --------------------------------------------------------------------------

// Adds sign * P times the floor's entries to the contact's, or of forces the contact's to the
// floor's. Contact nodes and those of the floor are different, so that the order does not matter.
static void add_rows(const Mesh *mesh, double sign, bool forces, double *field)
{
    const Floor *floor = &mesh->floor;
    for (int32_t i = 0; floor->start && i < mesh->node_count; i++)
        for (int32_t k = floor->start[i]; k < floor->start[i + 1]; k++)
            for (int32_t d = 0; d < mesh->dim; d++) {
                double *contact = &field[node_dof(mesh->dim, i, d)];
                double *under = &field[node_dof(mesh->dim, floor->node[k], d)];
                if (forces)
                    *under += sign * floor->share[k] * *contact;
                else
                    *contact += sign * floor->share[k] * *under;
            }
}

void floor_displace(const Mesh *mesh, double *field)
{
    add_rows(mesh, 1, false, field);
}

void floor_find_jumps(const Mesh *mesh, double *field)
{
    add_rows(mesh, -1, false, field);
}

void floor_gather(const Mesh *mesh, double *force)
{
    add_rows(mesh, 1, true, force);
}

void floor_scatter(const Mesh *mesh, double *force)
{
    add_rows(mesh, -1, true, force);
}
