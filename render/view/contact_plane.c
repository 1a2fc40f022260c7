// SPDX-License-Identifier: GPL-2.0-or-later
// A face is cut in its reference coordinates half way between its nodes; a face of T6, whose
// corners touch nothing, from its middle to its corners.
#include "render/view/contact_plane.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/mesh/element_faces.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FACE_PATCHES_MAX = FACE_NODES_MAX };

// Arrays of the history that the faces are made of.
typedef struct Faces {
    double *corner, *point;   // as history.h5 has them
    int32_t corners, count, width;
} Faces;

typedef struct Face {
    ElementKind kind;
    int32_t point[FACE_NODES_MAX];
    MeshPlace place[FACE_NODES_MAX];
} Face;

typedef struct KnownSide {
    int32_t low, high;   // points at its ends
    ContactSide side;
} KnownSide;

static bool take_face(const ContactPlane *plane, const Faces *faces, int32_t f, Face *face,
                      Error *err)
{
    const double *stored = faces->point + (int64_t)f * faces->width;
    int32_t count = 0;
    while (count < faces->width && stored[count] >= 0) ++count;
    int32_t kind = element_kind_of(2, count);
    if (kind < 0) return FAULT(err, ERROR_FILE, "a face of the contact has %d points", count);
    face->kind = (ElementKind)kind;

    // Points are contact nodes, then corners that touch nothing.
    for (int32_t a = 0; a < count; ++a) {
        if (!(stored[a] < plane->nodes + faces->corners))
            return FAULT(err, ERROR_FILE, "a face of the contact has a point that is none");
        int32_t point = (int32_t)stored[a], k = point - plane->nodes;
        face->point[a] = point;
        face->place[a][0] = k < 0 ? plane->x[point] : faces->corner[2 * k];
        face->place[a][1] = k < 0 ? plane->y[point] : faces->corner[2 * k + 1];
    }
    return true;
}

static void middle_of(const double a[2], const double b[2], double middle[2])
{
    for (int32_t d = 0; d < 2; ++d) middle[d] = (a[d] + b[d]) / 2;
}

// The part of a face that is nearest to each of its nodes.
static void add_patches(const Face *face, ContactPlane *plane)
{
    static const int32_t turn[PATCH_CORNERS][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const double centre[2] = {1.0 / 3, 1.0 / 3};
    bool triangle = element_corner_count(face->kind) == 3;
    int32_t own = triangle ? 3 : element_node_count(face->kind);
    for (int32_t k = 0; k < own; ++k) {
        double at[PATCH_CORNERS][2];
        ContactPatch *patch = &plane->patches[plane->patch_count];
        patch->node = face->point[face->kind == ELEMENT_T6 ? 3 + k : k];
        if (patch->node >= plane->nodes) continue;
        if (triangle) {
            // Patch of corner k of a triangle; in a T6, of the node on side k.
            const double *here = shape_node(face->kind, k),
                         *next = shape_node(face->kind, (k + 1) % 3);
            const double *last = shape_node(face->kind, (k + 2) % 3);
            memcpy(at[0], here, sizeof at[0]);
            middle_of(here, next, at[1]);
            memcpy(at[2], centre, sizeof centre);
            if (face->kind == ELEMENT_T6)   // the mid-side's: from corner over itself to corner
                memcpy(at[2], next, sizeof at[2]), memcpy(at[3], centre, sizeof centre);
            else
                middle_of(last, here, at[3]);
        } else {
            // Half way to the nodes beside it, or to the end of the face.
            double half = face->kind == ELEMENT_Q9 ? 0.5 : 1;
            const double *node = shape_node(face->kind, k);
            for (int32_t c = 0; c < PATCH_CORNERS; ++c)
                for (int32_t d = 0; d < 2; ++d)
                    at[c][d] = turn[c][d] ? fmin(1, node[d] + half) : fmax(-1, node[d] - half);
        }
        for (int32_t c = 0; c < PATCH_CORNERS; ++c) {
            ShapeValues shape = shape_at(face->kind, at[c]);
            double *place = patch->corner[c];
            place[0] = place[1] = 0;
            for (int32_t a = 0; a < element_node_count(face->kind); ++a)
                for (int32_t d = 0; d < 2; ++d) place[d] += shape.value[a] * face->place[a][d];
        }
        ++plane->patch_count;
    }
}

// --- reading -------------------------------------------------------------------------------------

bool contact_plane_read(ArrayFile *file, int32_t nodes, ContactPlane *plane, Error *err)
{
    Faces faces = {0};
    Face face;
    KnownSide *sides = NULL;   // of all faces: a side between two faces is there twice; owned
    int32_t side_count = 0;
    *plane = (ContactPlane){.nodes = nodes};
    double **const arrays[] = {&plane->x, &plane->y, &plane->weight};
    const ResultNodes names[] = {NODES_X, NODES_Y, NODES_WEIGHT};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        int32_t count = 0;
        TRY(result_file_read_nodes(file, names[k], arrays[k], &count, err));
        if (count != nodes)
            FAIL(err, ERROR_FILE, "%d of %d contact nodes have a place", count, nodes);
    }

    // The faces of the contact, by their points.
    int32_t two = 0;
    TRY(result_file_read_faces(file, FACES_NODES, &faces.point, &faces.count, &faces.width, err));
    TRY(result_file_read_faces(file, FACES_CORNERS, &faces.corner, &faces.corners, &two, err));
    if (faces.count == 0)
        FAIL(err, ERROR_INPUT,
             "the history does not have the faces of the contact: it was written before they were "
             "stored, or by a run that did not read its mesh");
    if (faces.corners > 0 && two != 2) FAIL(err, ERROR_FILE, "corners have %d numbers", two);
    if (faces.width > FACE_NODES_MAX)
        FAIL(err, ERROR_FILE, "faces have up to %d points", faces.width);

    // Each face adds its patches to the plane, and its sides to those of all faces.
    TRY(plane->patches = NEW_ARRAY(ContactPatch, (int64_t)FACE_PATCHES_MAX * faces.count, err));
    TRY(plane->sides = NEW_ARRAY(ContactSide, (int64_t)FACE_CORNERS_MAX * faces.count, err));
    TRY(sides = NEW_ARRAY(KnownSide, (int64_t)FACE_CORNERS_MAX * faces.count, err));
    for (int32_t f = 0; f < faces.count; ++f) {
        TRY(take_face(plane, &faces, f, &face, err));
        add_patches(&face, plane);
        int32_t corners = element_corner_count(face.kind);
        bool between = element_node_count(face.kind) > corners;
        for (int32_t k = 0; k < corners; ++k) {
            int32_t next = (k + 1) % corners, a = face.point[k], b = face.point[next];
            KnownSide *side = &sides[side_count++];
            side->low = a < b ? a : b;
            side->high = a < b ? b : a;
            memcpy(side->side.point[0], face.place[k], sizeof side->side.point[0]);
            memcpy(side->side.point[2], face.place[next], sizeof side->side.point[2]);
            middle_of(face.place[k], face.place[next], side->side.point[1]);
            if (between) memcpy(side->side.point[1], face.place[corners + k], 2 * sizeof(double));
        }
    }

    // Sides that are on one face alone make the outline of the contact.
    qsort(sides, (size_t)side_count, sizeof *sides, order_int32_pairs);
    for (int32_t k = 0; k < side_count; ++k) {
        bool before = k > 0 && order_int32_pairs(&sides[k - 1], &sides[k]) == 0;
        bool after = k + 1 < side_count && order_int32_pairs(&sides[k], &sides[k + 1]) == 0;
        if (!before && !after) plane->sides[plane->side_count++] = sides[k].side;
    }

    for (int32_t d = 0; d < 2; ++d) {
        plane->low[d] = INFINITY;
        plane->high[d] = -INFINITY;
        for (int32_t k = 0; k < plane->patch_count; ++k)
            for (int32_t c = 0; c < PATCH_CORNERS; ++c) {
                plane->low[d] = fmin(plane->low[d], plane->patches[k].corner[c][d]);
                plane->high[d] = fmax(plane->high[d], plane->patches[k].corner[c][d]);
            }
    }
cleanup:
    memory_free_all(sides, faces.corner, faces.point);
    if (!error_is_clean(err)) contact_plane_destroy(plane);
    return error_is_clean(err);
}

void contact_plane_destroy(ContactPlane *plane)
{
    memory_free_all(plane->x, plane->y, plane->weight, plane->patches, plane->sides);
    *plane = (ContactPlane){0};
}
