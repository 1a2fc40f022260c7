// SPDX-License-Identifier: GPL-2.0-or-later
// In buckets by the lowest corner, each of the few faces of one node.
#include "fem/mesh_faces.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

// Ascending, in place; a handful.
static void sort_nodes(int32_t *nodes, int32_t count)
{
    for (int32_t k = 1; k < count; k++) {
        int32_t node = nodes[k], place = k;
        for (; place > 0 && nodes[place - 1] > node; place--) nodes[place] = nodes[place - 1];
        nodes[place] = node;
    }
}

static FaceKey key_of(FaceNodes face)
{
    FaceKey key;
    int32_t corners = element_corner_count(face.kind), nodes = element_node_count(face.kind);
    memset(&key, -1, sizeof key);
    memcpy(key.corner, face.node, (size_t)corners * sizeof *face.node);
    memcpy(key.inner, face.node + corners, (size_t)(nodes - corners) * sizeof *face.node);
    sort_nodes(key.corner, corners);
    sort_nodes(key.inner, nodes - corners);
    return key;
}

FaceNodes mesh_element_face(const Mesh *mesh, int32_t e, int32_t side, int32_t *nodes)
{
    ElementFace face = element_face((ElementKind)mesh->kind[e], side);
    for (int32_t a = 0; a < element_node_count(face.kind); a++)
        nodes[a] = mesh->element_nodes[mesh->first_node[e] + face.node[a]];
    return (FaceNodes){face.kind, nodes};
}

FaceNodes mesh_boundary_face(const MeshBoundary *boundary, int32_t face)
{
    int32_t width = boundary->nodes_per_face;
    const int32_t *nodes = boundary->face_nodes + (int64_t)face * width;
    while (width > 0 && nodes[width - 1] < 0) width--;
    return (FaceNodes){(ElementKind)element_kind_of(boundary->dim - 1, width), nodes};
}

// Searches the bucket of the lowest corner; NULL: not there (yet).
static MeshFace *find_face(const MeshFaces *table, const FaceKey *key)
{
    int32_t low = key->corner[0];
    for (int32_t k = table->first[low]; k < table->last[low]; k++)
        if (memcmp(table->faces[k].key.corner, key->corner, sizeof key->corner) == 0)
            return &table->faces[k];
    return NULL;
}

// "edge at (1, 0)", the middle of its corners.
static const char *describe(const Mesh *mesh, const FaceKey *key, char text[PLACE_TEXT_SIZE + 8])
{
    MeshPlace middle = {0};
    char at[PLACE_TEXT_SIZE];
    int32_t corners = 0;
    while (corners < FACE_CORNERS_MAX && key->corner[corners] >= 0) corners++;
    for (int32_t d = 0; d < mesh->dim; d++) {
        for (int32_t k = 0; k < corners; k++) middle[d] += mesh_place(mesh, key->corner[k])[d];
        middle[d] /= corners;
    }
    snprintf(text, PLACE_TEXT_SIZE + 8, "%s at %s", mesh->dim == 2 ? "edge" : "face",
             place_text(mesh->dim, middle, at));
    return text;
}

// Puts a face (elements = 1) into its bucket, or counts one more element on it. ERROR_INPUT: the
// mesh does not fit together there.
static bool add_face(const Mesh *mesh, const MeshFace *face, MeshFaces *table, Error *err)
{
    MeshFace *known = find_face(table, &face->key);
    char what[PLACE_TEXT_SIZE + 8];
    if (!known) {
        table->faces[table->last[face->key.corner[0]]++] = *face;
        return true;
    }
    if (memcmp(known->key.inner, face->key.inner, sizeof known->key.inner) != 0)
        return REFUSE(err,
                      "%s: elements %lld and %lld share the %s but not its mid-side node: elements "
                      "of different order do not fit together",
                      mesh->path, (long long)mesh->element_number[known->element],
                      (long long)mesh->element_number[face->element],
                      describe(mesh, &face->key, what));
    known->elements++;
    if (known->elements > 2)
        return REFUSE(err,
                      "%s: the %s is on more than two elements (%lld among them): elements overlap",
                      mesh->path, describe(mesh, &face->key, what),
                      (long long)mesh->element_number[face->element]);

    // Two elements on either side of a face have its corners in opposite order, as each sees them
    // from its outside. In the same order both lie on one side of it.
    int32_t first_nodes[FACE_NODES_MAX], second_nodes[FACE_NODES_MAX], begin = 0;
    FaceNodes first = mesh_element_face(mesh, known->element, known->side, first_nodes);
    FaceNodes second = mesh_element_face(mesh, face->element, face->side, second_nodes);
    int32_t corners = element_corner_count(first.kind);
    bool opposite = true, same = true;
    while (second.node[begin] != first.node[0]) begin++;   // it has the same corners
    for (int32_t k = 0; k < corners; k++) {
        opposite = opposite && second.node[(begin + corners - k) % corners] == first.node[k];
        same = same && second.node[(begin + k) % corners] == first.node[k];
    }
    if (mesh->dim == 2) opposite = second.node[0] == first.node[1];
    if (opposite) return true;
    return REFUSE(err, "%s: elements %lld and %lld %s the %s: %s", mesh->path,
                  (long long)mesh->element_number[known->element],
                  (long long)mesh->element_number[face->element],
                  same || mesh->dim == 2 ? "lie on one side of" : "do not fit together on",
                  describe(mesh, &known->key, what),
                  same || mesh->dim == 2 ? "the mesh is folded over there"
                                         : "they have its corners in different order, so one of "
                                           "them is twisted");
}

// A first pass counts a face once for each element on it: at most twice the room that is needed.
bool mesh_faces_build(const Mesh *mesh, MeshFaces *table, Error *err)
{
    int32_t nodes[FACE_NODES_MAX];
    *table = (MeshFaces){0};
    if (!(table->first = NEW_ARRAY(int32_t, (int64_t)mesh->node_count + 1, err))) return false;
    if (!(table->last = NEW_ARRAY(int32_t, mesh->node_count, err))) return false;
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t side = 0; side < element_face_count((ElementKind)mesh->kind[e]); side++)
            table->first[key_of(mesh_element_face(mesh, e, side, nodes)).corner[0] + 1]++;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        table->first[i + 1] += table->first[i];
        table->last[i] = table->first[i];
    }
    if (!(table->faces = NEW_ARRAY(MeshFace, table->first[mesh->node_count], err))) return false;
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t side = 0; side < element_face_count((ElementKind)mesh->kind[e]); side++) {
            MeshFace face = {.key = key_of(mesh_element_face(mesh, e, side, nodes)),
                             .elements = 1,
                             .element = e,
                             .side = side};
            if (!add_face(mesh, &face, table, err)) return false;
        }
    return true;
}

void mesh_faces_destroy(MeshFaces *table)
{
    memory_free_all(table->first, table->last, table->faces);
    *table = (MeshFaces){0};
}

const MeshFace *mesh_faces_find(const MeshFaces *table, FaceNodes face)
{
    FaceKey key = key_of(face);
    return find_face(table, &key);
}

bool mesh_face_is(const MeshFace *known, FaceNodes face)
{
    FaceKey key = key_of(face);
    return memcmp(&known->key, &key, sizeof key) == 0;
}
