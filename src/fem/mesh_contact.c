// SPDX-License-Identifier: GPL-2.0-or-later
// Contact is unilateral against the rigid plane z = 0, node by node, each straight above its place.
// So nodes must stand on it or over it, over distinct places, in the plane in one order along the
// curve, in space on faces that look down, on the block's boundary, with nothing of the block
// below.
#include "fem/mesh.h"

#include "base/memory.h"
#include "fem/mesh_faces.h"
#include "fem/mesh_parts.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A contact node counts as on z = 0, and two nodes as over one place, within this times the block's
// extent: coordinates computed by gmsh are exact to about 1e-12 of it.
static const double PLACE_TOLERANCE = 1e-9;

// The largest side of the block.
static double extent(const Mesh *mesh)
{
    return fmax(fmax(mesh->x_max - mesh->x_min, mesh->y_max - mesh->y_min),
                mesh->z_max - mesh->z_min);
}

double mesh_gap(const Mesh *mesh, int32_t node)
{
    double gap = mesh_height(mesh, node) - mesh_floor_height(mesh, node);
    return gap > PLACE_TOLERANCE * extent(mesh) ? gap : 0;
}

// Compares x first and z last. `context` comes third, as qsort_r passes it, without any state
// outside of it.
static int compare_places(const void *a, const void *b, void *context)
{
    const Mesh *mesh = context;
    const double *first = mesh_place(mesh, *(const int32_t *)a);
    const double *second = mesh_place(mesh, *(const int32_t *)b);
    for (int32_t d = 0; d < mesh->dim; d++)
        if (first[d] != second[d]) return first[d] < second[d] ? -1 : 1;
    return 0;
}

// Sorts by place, so that gmsh's numbers do not decide the order of contact nodes.
void mesh_sort_nodes(const Mesh *mesh, int32_t *nodes, int32_t count)
{
    Mesh order = *mesh;   // qsort_r takes no const
    if (count > 1) qsort_r(nodes, (size_t)count, sizeof *nodes, compare_places, &order);
}

// The error lists the groups that there are.
bool mesh_boundary(const Mesh *mesh, const char *name, MeshBoundary *boundary, Error *err)
{
    MeshFile view = {.group_count = mesh->group_count, .groups = mesh->groups};
    *boundary = (MeshBoundary){0};
    const MeshGroup *group = mesh_file_group(&view, mesh->path, name, mesh->dim - 1, err);
    if (!group) return false;
    if (group->face_count == 0)
        return REFUSE(err, "%s: group '%s' is empty: its %s in the mesh", mesh->path, name,
                      mesh->dim == 2 ? "curve has no edges" : "surface has no faces");
    *boundary = (MeshBoundary){.name = group->name,
                               .dim = mesh->dim,
                               .face_count = group->face_count,
                               .nodes_per_face = group->nodes_per_face,
                               .face_nodes = group->face_nodes,
                               .node_count = group->node_count,
                               .nodes = group->nodes};
    return error_is_clean(err);
}

// --- connected pieces of a boundary -------------------------------------------------------------

typedef struct MeshPieces {
    int32_t count;
    MeshBoundary
        *piece;   // [count] by their first nodes; of several "NAME/1", "NAME/2", ...; owned,
    // and what they borrow:
    char (*name)[GROUP_NAME_SIZE];   // [count]
    int32_t *nodes, *face_nodes;
} MeshPieces;

// Finds the connected pieces of a named boundary: faces that share a node are of one piece.
static bool find_pieces(const Mesh *mesh, const MeshBoundary *whole, MeshPieces *pieces, Error *err)
{
    int32_t width = whole->nodes_per_face;
    *pieces = (MeshPieces){0};

    // Number of the piece that each node of the mesh is on, -1: not on the boundary.
    int32_t *number = NULL, *parent = NEW_ARRAY(int32_t, mesh->node_count, err);
    if (!parent || !(number = NEW_ARRAY(int32_t, mesh->node_count, err))) goto cleanup;
    for (int32_t i = 0; i < mesh->node_count; i++) parent[i] = i, number[i] = -1;
    for (int32_t f = 0; f < whole->face_count; f++) {
        FaceNodes face = mesh_boundary_face(whole, f);
        for (int32_t a = 1; a < element_node_count(face.kind); a++)
            parent[mesh_part_root(parent, face.node[a])] = mesh_part_root(parent, face.node[0]);
    }
    for (int32_t k = 0; k < whole->node_count; k++) {
        int32_t node = whole->nodes[k], root = mesh_part_root(parent, node);
        if (number[root] < 0) number[root] = pieces->count++;
        number[node] = number[root];
    }

    // Nodes and faces of each piece.
    pieces->piece = memory_array(pieces->count, sizeof *pieces->piece, err);
    pieces->name = memory_array(pieces->count, sizeof *pieces->name, err);
    int32_t *nodes = pieces->nodes = NEW_ARRAY(int32_t, whole->node_count, err);
    int32_t *faces = pieces->face_nodes =
        NEW_ARRAY(int32_t, (int64_t)whole->face_count * width, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t p = 0; p < pieces->count; p++) {
        MeshBoundary *piece = &pieces->piece[p];
        *piece = (MeshBoundary){.name = pieces->name[p],
                                .dim = whole->dim,
                                .nodes_per_face = width,
                                .face_nodes = faces,
                                .nodes = nodes};
        if (pieces->count == 1)
            snprintf(pieces->name[p], GROUP_NAME_SIZE, "%s", whole->name);
        else
            snprintf(pieces->name[p], GROUP_NAME_SIZE, "%.51s/%d", whole->name, p + 1);
        for (int32_t k = 0; k < whole->node_count; k++)
            if (number[whole->nodes[k]] == p) nodes[piece->node_count++] = whole->nodes[k];
        for (int32_t f = 0; f < whole->face_count; f++) {
            const int32_t *face = whole->face_nodes + (int64_t)f * width;
            if (number[face[0]] != p) continue;
            memcpy(faces + (int64_t)width * piece->face_count++, face,
                   (size_t)width * sizeof *face);
        }
        nodes += piece->node_count;
        faces += (int64_t)width * piece->face_count;
    }
cleanup:
    memory_free_all(number, parent);
    return error_is_clean(err);
}

static void pieces_destroy(MeshPieces *pieces)
{
    memory_free_all(pieces->piece, pieces->name, pieces->nodes, pieces->face_nodes);
    *pieces = (MeshPieces){0};
}

bool mesh_piece_is_of(const char *name, const char *group)
{
    size_t length = strlen(group);
    if (strcmp(name, group) == 0) return true;
    if (strncmp(name, group, length) != 0 || name[length] != '/') return false;
    const char *number = name + length + 1;
    return *number && strspn(number, "0123456789") == strlen(number);
}

// --- contact ------------------------------------------------------------------------------------

void mesh_contact_destroy(MeshContact *contact)
{
    for (int32_t g = 0; g < contact->group_count; g++) pieces_destroy(&contact->groups[g]);
    memory_free_all(contact->groups, contact->pads, contact->nodes, contact->pad_of);
    *contact = (MeshContact){0};
}

bool mesh_is_contact_name(const char *name)
{
    return strcmp(name, "contact") == 0 || strncmp(name, "contact_", strlen("contact_")) == 0;
}

// Compares their first nodes, which are their leftmost.
static int compare_starts(const void *a, const void *b, void *context)
{
    const MeshBoundary *first = a, *second = b;
    return compare_places(&first->nodes[0], &second->nodes[0], context);
}

// Appends the connected pieces of the boundary called `name`.
static bool add_group(const Mesh *mesh, const char *name, MeshContact *contact, Error *err)
{
    MeshBoundary whole;
    return mesh_boundary(mesh, name, &whole, err) &&
           find_pieces(mesh, &whole, &contact->groups[contact->group_count++], err);
}

// Fills contact->pads from the names, or from every boundary that is called a contact.
static bool pick_pads(const Mesh *mesh, const char (*names)[GROUP_NAME_SIZE], int32_t count,
                      MeshContact *contact, Error *err)
{
    int32_t most = count > 0 ? count : mesh->group_count + 1;
    if (!(contact->groups = memory_array(most, sizeof *contact->groups, err))) return false;
    for (int32_t k = 0; k < count; k++)
        if (!add_group(mesh, names[k], contact, err)) return false;
    for (int32_t g = 0; g < mesh->group_count && count == 0; g++)
        if (mesh->groups[g].dimension == mesh->dim - 1 &&
            mesh_is_contact_name(mesh->groups[g].name) &&
            !add_group(mesh, mesh->groups[g].name, contact, err))
            return false;
    if (contact->group_count == 0 && !add_group(mesh, "contact", contact, err)) return false;
    for (int32_t g = 0; g < contact->group_count; g++)
        contact->pad_count += contact->groups[g].count;
    if (!(contact->pads = NEW_ARRAY(MeshBoundary, contact->pad_count, err))) return false;
    MeshBoundary *pad = contact->pads;
    for (int32_t g = 0; g < contact->group_count; g++)
        for (int32_t p = 0; p < contact->groups[g].count; p++) *pad++ = contact->groups[g].piece[p];
    Mesh order = *mesh;   // qsort_r takes no const
    if (count == 0)
        qsort_r(contact->pads, (size_t)contact->pad_count, sizeof *contact->pads, compare_starts,
                &order);
    return error_is_clean(err);
}

// An element's face: its nodes run counter-clockwise as seen from outside.
static bool looks_down(const Mesh *mesh, const MeshFace *face)
{
    static const double UPRIGHT = 1e-3;   // its shadow over its size
    MeshPlace position[FACE_NODES_MAX], normal;
    int32_t nodes[FACE_NODES_MAX], count;
    FaceNodes outside = mesh_element_face(mesh, face->element, face->side, nodes);
    count = element_node_count(outside.kind);
    mesh_places(mesh, nodes, count, position);
    for (int32_t a = 0; a < count; a++) {
        ShapeValues shape = shape_at(outside.kind, shape_node(outside.kind, a));
        shape_normal(outside.kind, &shape, (const MeshPlace *)position, normal);
        double size = 0;
        for (int32_t d = 0; d < mesh->dim; d++) size = hypot(size, normal[d]);
        if (!(normal[mesh->dim - 1] < -UPRIGHT * size)) return false;
    }
    return true;
}

// Each face of the contact is on one element only, as else it lies inside the block, and on one
// contact only.
static bool check_boundary(const Mesh *mesh, const MeshContact *contact, Error *err)
{
    MeshFaces table = {0};
    char at[PLACE_TEXT_SIZE];
    int32_t *claimed = NULL;   // by face of the table: 1 + the pad that has it
    TRY(mesh_faces_build(mesh, &table, err));
    if (!(claimed = NEW_ARRAY(int32_t, table.first[mesh->node_count], err))) goto cleanup;
    for (int32_t c = 0; c < contact->pad_count; c++) {
        const MeshBoundary *pad = &contact->pads[c];
        for (int32_t k = 0; k < pad->face_count; k++) {
            FaceNodes nodes = mesh_boundary_face(pad, k);
            const MeshFace *face = mesh_faces_find(&table, nodes);
            double x = mesh_place(mesh, nodes.node[0])[0];
            if (mesh_in_base(mesh, nodes.node[0]))
                FAIL(err, ERROR_INPUT,
                     "%s: contact group '%s' is on the base at x = %g: the contact is the block's "
                     "lower side, the base's upper side is groups.floor",
                     mesh->path, pad->name, x);
            if (face->elements != 1)
                FAIL(err, ERROR_INPUT,
                     "%s: contact group '%s' runs inside the block at x = %g, not on its %s",
                     mesh->path, pad->name, x, mesh->dim == 2 ? "edge" : "surface");
            if (mesh->dim > 2 && !looks_down(mesh, face))
                FAIL(err, ERROR_INPUT,
                     "%s: contact group '%s' has a face at %s that does not look down", mesh->path,
                     pad->name, mesh_place_text(mesh, nodes.node[0], at));
            int32_t *claim = &claimed[face - table.faces];
            if (*claim)
                FAIL(err, ERROR_INPUT,
                     "%s: contact groups '%s' and '%s' both have the %s at x = %g", mesh->path,
                     contact->pads[*claim - 1].name, pad->name, mesh->dim == 2 ? "edge" : "face",
                     x);
            *claim = c + 1;
        }
    }
cleanup:
    memory_free(claimed);
    mesh_faces_destroy(&table);
    return error_is_clean(err);
}

// The block does not reach below the substrate, and comes down to it. No two contact nodes are over
// one place: the sides of a crack, parts of a mesh that were not joined, or a boundary that goes
// straight up.
static bool check_places(const Mesh *mesh, const MeshContact *contact, Error *err)
{
    double tolerance = PLACE_TOLERANCE * extent(mesh);
    if (mesh->z_min < -tolerance)
        return REFUSE(err,
                      "%s: the block reaches down to z = %g, below the substrate at z = 0 that "
                      "group '%s' touches%s",
                      mesh->path, mesh->z_min, contact->pads[0].name,
                      mesh->move.onto_floor || mesh->move.shift[mesh->dim - 1] == 0
                          ? " (its lowest node is taken to be there): is all of the lower side in "
                            "the group, and z up?"
                          : " (without mesh.shift the lowest contact node is moved there)");
    for (int32_t k = 1; k < contact->node_count; k++) {
        // A node before it over the same place, a. Nodes are in order of x: only those with the
        // same x are looked at, in the plane the one before.
        int32_t b = contact->nodes[k], a = -1;
        const char *name = contact->pads[contact->pad_of[k]].name;
        const double *at_b = mesh_place(mesh, b);
        for (int32_t j = k - 1; j >= 0 && a < 0; j--) {
            const double *other = mesh_place(mesh, contact->nodes[j]);
            if (at_b[0] - other[0] > tolerance) break;
            bool same = true;
            for (int32_t d = 1; d < mesh->dim - 1; d++)
                same = same && fabs(at_b[d] - other[d]) <= tolerance;
            if (same) a = contact->nodes[j];
        }
        if (a < 0) continue;
        if (fabs(mesh_height(mesh, b) - mesh_height(mesh, a)) > tolerance)
            return REFUSE(err,
                          "%s: contact group '%s' goes straight up at x = %g, from z = %g to %g: a "
                          "face is no contact",
                          mesh->path, name, at_b[0], mesh_height(mesh, a), mesh_height(mesh, b));
        return REFUSE(err,
                      "%s: nodes %lld and %lld of contact group '%s' are both at x = %g: the mesh "
                      "is not glued together there",
                      mesh->path, (long long)mesh->node_number[a], (long long)mesh->node_number[b],
                      name, at_b[0]);
    }

    // A block that mesh.shift put at another height.
    int32_t lowest = contact->nodes[0];
    for (int32_t k = 1; k < contact->node_count; k++)
        if (mesh_height(mesh, contact->nodes[k]) < mesh_height(mesh, lowest))
            lowest = contact->nodes[k];
    if (mesh_gap(mesh, lowest) > 0)
        return REFUSE(err,
                      "%s: no contact node lies on z = 0: the lowest, node %lld at x = %g, has z = "
                      "%g (without mesh.shift it is moved there)",
                      mesh->path, (long long)mesh->node_number[lowest], mesh_place(mesh, lowest)[0],
                      mesh_height(mesh, lowest));
    return true;
}

bool mesh_stand_on_floor(const char (*names)[GROUP_NAME_SIZE], int32_t name_count, Mesh *mesh,
                         Error *err)
{
    MeshContact contact = {0};
    double lowest = INFINITY;
    int32_t up = mesh->dim - 1;
    TRY(pick_pads(mesh, names, name_count, &contact, err));
    for (int32_t c = 0; c < contact.pad_count; c++)
        for (int32_t k = 0; k < contact.pads[c].node_count; k++)
            lowest = fmin(lowest, mesh_height(mesh, contact.pads[c].nodes[k]));
    if (fabs(lowest) <= PLACE_TOLERANCE * extent(mesh)) goto cleanup;
    for (int32_t i = 0; i < mesh->node_count; i++)
        mesh->position[node_dof(mesh->dim, i, up)] -= lowest;
    mesh->move.shift[up] -= lowest;
    mesh->move.onto_floor = true;
    mesh_find_extent(mesh);
cleanup:
    mesh_contact_destroy(&contact);
    return error_is_clean(err);
}

bool mesh_contact(const Mesh *mesh, const char (*names)[GROUP_NAME_SIZE], int32_t name_count,
                  MeshContact *contact, Error *err)
{
    int32_t *owner = NULL;   // [nodes] 1 + the pad that has the node, 0: none; owned
    int32_t *place = NULL;   // [nodes] index in contact->nodes; owned
    int32_t total = 0;
    *contact = (MeshContact){0};
    TRY(pick_pads(mesh, names, name_count, contact, err));
    TRY(check_boundary(mesh, contact, err));

    // The nodes of all pads; a shared one keeps the first.
    for (int32_t c = 0; c < contact->pad_count; c++) total += contact->pads[c].node_count;
    TRY(owner = NEW_ARRAY(int32_t, mesh->node_count, err));
    TRY(contact->nodes = NEW_ARRAY(int32_t, total, err));
    TRY(contact->pad_of = NEW_ARRAY(int32_t, total, err));
    for (int32_t c = 0; c < contact->pad_count; c++)
        for (int32_t k = 0; k < contact->pads[c].node_count; k++) {
            int32_t i = contact->pads[c].nodes[k];
            if (owner[i]) continue;
            owner[i] = c + 1;
            contact->nodes[contact->node_count++] = i;
        }
    mesh_sort_nodes(mesh, contact->nodes, contact->node_count);
    for (int32_t k = 0; k < contact->node_count; k++)
        contact->pad_of[k] = owner[contact->nodes[k]] - 1;

    // Places are checked first: the search for curves that turn back relies on them.
    TRY(check_places(mesh, contact, err));
    if (mesh->dim > 2) goto cleanup;

    // In the plane: a curve that turns back has nodes of another stretch between those of an edge.
    TRY(place = NEW_ARRAY(int32_t, mesh->node_count, err));
    for (int32_t k = 0; k < contact->node_count; k++) place[contact->nodes[k]] = k;
    for (int32_t c = 0; c < contact->pad_count; c++) {
        const MeshBoundary *curve = &contact->pads[c];
        for (int32_t k = 0; k < curve->face_count; k++) {
            const int32_t *nodes = curve->face_nodes + k * curve->nodes_per_face;
            if (abs(place[nodes[1]] - place[nodes[0]]) == curve->nodes_per_face - 1) continue;
            FAIL(err, ERROR_INPUT,
                 "%s: contact group '%s' turns back over itself near x = %g, z = %g", mesh->path,
                 curve->name, mesh_place(mesh, nodes[0])[0], mesh_height(mesh, nodes[0]));
        }
    }
cleanup:
    memory_free_all(owner, place);
    return error_is_clean(err);
}
