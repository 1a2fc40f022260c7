// SPDX-License-Identifier: GPL-2.0-or-later
// From gmsh's tags to arrays indexed from 0. Order everywhere: ascending tags.
//
//   1  pick the elements of the body                      (raw_elements)
//   2  sort the nodes by tag, so that a tag is found fast (NodeTable)
//   3  mark the nodes to keep: those of the elements, those of named boundaries, lone ones
//   4  number them in the order of their tags, copy positions, check the plane where it is one
//   5  write elements and groups with the new numbers
#include "io/mesh/mesh_raw.h"

#include "base/memory.h"
#include "base/order.h"
#include "base/text.h"
#include "io/mesh/element_faces.h"
#include "io/mesh/raw_elements.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A mesh counts as plane when gmsh's |z| stays below this times its extent: rounding, after a
// rotation in a CAD program.
static const double PLANE_TOLERANCE = 1e-9;

// Largest number of a node or an element: what base/archive takes as a count.
static const int64_t NUMBER_MAX = INT64_C(1) << 53;

// A raw node.
typedef struct Node {
    int64_t number;   // its tag
    int32_t source;   // index into the raw nodes
    int32_t index;   // in the MeshFile; -1: left out
} Node;

typedef struct NodeTable {
    int32_t count;
    Node *node;   // [count] by ascending tag; owned
} NodeTable;

void mesh_raw_destroy(MeshRaw *raw)
{
    for (int32_t k = 0; k < raw->block_count; k++) {
        memory_free_all(raw->blocks[k].number, raw->blocks[k].nodes);
    }
    for (int32_t k = 0; k < raw->group_count; k++) memory_free(raw->groups[k].entities);
    memory_free_all(raw->blocks, raw->groups, raw->node_number, raw->node_dimension,
                    raw->node_position);
    *raw = (MeshRaw){0};
}

// --- nodes --------------------------------------------------------------------------------------

// The node of a tag; NULL: none. Tags mostly have no holes: that is tried first.
static Node *table_find(const NodeTable *table, int64_t number)
{
    if (table->count == 0) return NULL;
    int64_t guess = number - table->node[0].number;
    if (guess >= 0 && guess < table->count && table->node[guess].number == number)
        return &table->node[guess];
    return bsearch(&number, table->node, (size_t)table->count, sizeof *table->node, order_int64);
}

// Marks the nodes to keep, by an index of 0.
static bool mark_nodes(const MeshRaw *raw, const RawElements *body, const char *path, int32_t dim,
                       NodeTable *table, Error *err)
{
    bool *attached = NULL;

    // Those of the body's elements. A tag that no node has is an error: gmsh lets some of those
    // files pass.
    for (int32_t e = 0; e < body->count; e++)
        for (int32_t a = 0; a < body->items[e].count; a++) {
            Node *node = table_find(table, body->items[e].nodes[a]);
            if (!node)
                return REFUSE(err, "%s: element %lld uses node %lld, which the file lacks", path,
                              (long long)body->items[e].number, (long long)body->items[e].nodes[a]);
            node->index = 0;
        }

    // Those on a surface or curve that are on no element of any kind, which fem/mesh_build refuses;
    // and those of the boundary groups: on no element of the body they are refused likewise. Nodes
    // of points, and of curves and surfaces outside the physical groups, only help to draw the
    // geometry (centres of arcs) and are left out.
    TRY(attached = NEW_ARRAY(bool, table->count, err));
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        bool boundary = block->dimension == dim - 1 && raw_block_groups(raw, block) > 0;
        for (int64_t i = 0; i < block->count * block->nodes_per_element; i++) {
            Node *node = table_find(table, block->nodes[i]);
            if (node) attached[node - table->node] = true;
            if (node && boundary) node->index = 0;
        }
    }
    for (int32_t k = 0; k < table->count; k++)
        if (!attached[k] && raw->node_dimension[table->node[k].source] > 0)
            table->node[k].index = 0;
cleanup:
    memory_free(attached);
    return error_is_clean(err);
}

// Numbers the marked nodes and copies their positions, mesh->dim numbers each.
static bool number_nodes(const MeshRaw *raw, const char *path, NodeTable *table, MeshFile *mesh,
                         Error *err)
{
    for (int32_t k = 0; k < table->count; k++)
        if (table->node[k].index == 0) table->node[k].index = mesh->node_count++;
    if (!(mesh->position = NEW_ARRAY(double, (int64_t)mesh->dim * mesh->node_count, err)))
        return false;
    if (!(mesh->node_number = NEW_ARRAY(int64_t, mesh->node_count, err))) return false;
    // From the first node: it only scales the plane's tolerance.
    double extent = 0, deepest = 0;
    int64_t worst = 0;
    for (int32_t k = 0; k < table->count; k++) {
        const Node *node = &table->node[k];
        if (node->index < 0) continue;
        const double *from = raw->node_position + 3 * (int64_t)node->source;
        double *to = mesh->position + (int64_t)mesh->dim * node->index;
        if (!isfinite(from[0]) || !isfinite(from[1]) || !isfinite(from[2]))
            return REFUSE(err, "%s: node %lld has a coordinate that is not a number", path,
                          (long long)node->number);
        memcpy(to, from, (size_t)mesh->dim * sizeof(double));
        mesh->node_number[node->index] = node->number;
        extent = fmax(extent,
                      fmax(fabs(from[0] - mesh->position[0]), fabs(from[1] - mesh->position[1])));
        if (mesh->dim == 2 && fabs(from[2]) > fabs(deepest)) {
            deepest = from[2];
            worst = node->number;
        }
    }
    if (fabs(deepest) > PLANE_TOLERANCE * extent)
        return REFUSE(err,
                      "%s: is not in gmsh's plane z = 0: node %lld is at z = %g (draw the block "
                      "with x along the drive and y upwards)",
                      path, (long long)worst, deepest);
    return true;
}

// Elements with indices in place of tags; by offsets, since kinds may be mixed.
static bool store_elements(const RawElements *elements, const NodeTable *table, MeshFile *mesh,
                           Error *err)
{
    int64_t total = 0;
    for (int32_t e = 0; e < elements->count; e++) total += elements->items[e].count;
    if (!(mesh->element_number = NEW_ARRAY(int64_t, elements->count, err))) return false;
    if (!(mesh->kind = NEW_ARRAY(uint8_t, elements->count, err))) return false;
    if (!(mesh->first_node = NEW_ARRAY(int32_t, (int64_t)elements->count + 1, err))) return false;
    if (!(mesh->element_nodes = NEW_ARRAY(int32_t, total, err))) return false;
    mesh->element_count = elements->count;
    int32_t at = 0;
    for (int32_t e = 0; e < elements->count; e++) {
        const RawElement *element = &elements->items[e];
        mesh->element_number[e] = element->number;
        mesh->kind[e] = (uint8_t)element->kind;
        mesh->first_node[e] = at;
        for (int32_t a = 0; a < element->count; a++)
            mesh->element_nodes[at++] = table_find(table, element->nodes[a])->index;
    }
    mesh->first_node[elements->count] = at;
    return true;
}

// --- groups -------------------------------------------------------------------------------------

// By dimension, then by number: the order promised in io/mesh/mesh_file.h.
static int compare_groups(const void *a, const void *b)
{
    const MeshGroup *first = a, *second = b;
    if (first->dimension != second->dimension) return first->dimension < second->dimension ? -1 : 1;
    return (first->number > second->number) - (first->number < second->number);
}

static bool is_quadratic(const RawElement *element)
{
    return element->count > element_corner_count((ElementKind)element->kind);
}

// Fills group->nodes with the distinct nodes of its elements, as far as they are in the mesh.
static bool store_group_nodes(const RawElements *elements, const NodeTable *table, MeshGroup *group,
                              Error *err)
{
    int32_t count = 0;
    if (!(group->nodes = NEW_ARRAY(int32_t, (int64_t)elements->count * FACE_NODES_MAX, err)))
        return false;
    for (int32_t k = 0; k < elements->count; k++)
        for (int32_t a = 0; a < elements->items[k].count; a++) {
            const Node *node = table_find(table, elements->items[k].nodes[a]);
            if (node && node->index >= 0) group->nodes[count++] = node->index;
        }
    qsort(group->nodes, (size_t)count, sizeof *group->nodes, order_int32);
    for (int32_t k = 0; k < count; k++)
        if (k == 0 || group->nodes[k] != group->nodes[k - 1])
            group->nodes[group->node_count++] = group->nodes[k];
    return true;
}

// Copies the faces of a boundary, whose nodes mark_boundaries has put into the mesh. Faces of
// different order in one group are an error; triangles beside quadrilaterals are not.
static bool store_group_faces(const char *path, const RawElements *faces, const NodeTable *table,
                              MeshGroup *group, Error *err)
{
    int32_t width = group->dimension + 1;
    for (int32_t k = 0; k < faces->count; k++) width = (int32_t)fmax(width, faces->items[k].count);
    if (!(group->face_nodes = NEW_ARRAY(int32_t, (int64_t)faces->count * width, err))) return false;
    group->nodes_per_face = width;
    for (int32_t k = 0; k < faces->count; k++) {
        int32_t nodes = faces->items[k].count, first = faces->items[0].count;
        if (is_quadratic(&faces->items[k]) != is_quadratic(&faces->items[0]))
            return REFUSE(err, "%s: group '%s' mixes %s of %d and %d nodes", path, group->name,
                          group->dimension == 1 ? "edges" : "faces", first, nodes);
        for (int32_t a = 0; a < width; a++) {
            const Node *node = a < nodes ? table_find(table, faces->items[k].nodes[a]) : NULL;
            if (a < nodes && !node)
                return REFUSE(err, "%s: group '%s' uses node %lld, which the file lacks", path,
                              group->name, (long long)faces->items[k].nodes[a]);
            group->face_nodes[k * width + a] = node ? node->index : -1;
        }
    }
    group->face_count = faces->count;
    return true;
}

// The elements of a region, by the entities that it is made of: copies of an element are on the
// same entity as the one that was kept.
static bool store_group_elements(const MeshRaw *raw, const RawGroup *from, const MeshFile *mesh,
                                 MeshGroup *group, Error *err)
{
    int32_t most = 0;
    for (int32_t k = 0; k < raw->block_count; k++)
        if (raw_group_holds(from, &raw->blocks[k])) most += (int32_t)raw->blocks[k].count;
    if (!(group->elements = NEW_ARRAY(int32_t, most, err))) return false;
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        for (int64_t i = 0; raw_group_holds(from, block) && i < block->count; i++) {
            // By gmsh's numbers, which ascend; a copy that was dropped is not found.
            const int64_t *found = bsearch(&block->number[i], mesh->element_number,
                                           (size_t)mesh->element_count, sizeof *block->number,
                                           order_int64);
            if (found)
                group->elements[group->element_count++] = (int32_t)(found - mesh->element_number);
        }
    }
    qsort(group->elements, (size_t)group->element_count, sizeof(int32_t), order_int32);
    return true;
}

// One group: its name (or its number in decimal), and its faces and nodes.
static bool convert_group(const MeshRaw *raw, const char *path, const NodeTable *table,
                          const RawGroup *from, MeshGroup *group, Error *err)
{
    RawElements elements = {0};
    uint32_t code = 0;
    *group = (MeshGroup){.dimension = from->dimension, .number = from->number};
    if (from->name[0])
        snprintf(group->name, sizeof group->name, "%s", from->name);
    else
        snprintf(group->name, sizeof group->name, "%d", from->number);
    if (text_find_unshown(group->name, &code) >= 0)
        FAIL(err, ERROR_INPUT,
             "%s: the name of group %d of dimension %d has the character U+%04X, which no page or "
             "picture can show",
             path, from->number, from->dimension, code);
    if (from->dimension >= raw_dimension(raw)) goto cleanup;
    TRY(raw_pick_group(raw, path, from, group->name, &elements, err));
    if (from->dimension == raw_dimension(raw) - 1)
        TRY(store_group_faces(path, &elements, table, group, err));
    TRY(store_group_nodes(&elements, table, group, err));
cleanup:
    memory_free(elements.items);
    return error_is_clean(err);
}

// All groups. Among those of one dimension each name is there once.
static bool convert_groups(const MeshRaw *raw, const char *path, const NodeTable *table,
                           MeshFile *mesh, Error *err)
{
    if (!(mesh->groups = NEW_ARRAY(MeshGroup, raw->group_count, err))) return false;
    for (int32_t k = 0; k < raw->group_count; k++) {
        MeshGroup *group = &mesh->groups[mesh->group_count++];
        if (!convert_group(raw, path, table, &raw->groups[k], group, err)) return false;
        if (group->dimension == mesh->dim &&
            !store_group_elements(raw, &raw->groups[k], mesh, group, err))
            return false;
        for (const MeshGroup *other = mesh->groups; other < group; other++)
            if (other->dimension == group->dimension && strcmp(other->name, group->name) == 0)
                return REFUSE(err,
                              "%s: the physical name '%s' is used twice: by groups %d and %d of "
                              "dimension %d",
                              path, group->name, other->number, group->number, group->dimension);
    }
    qsort(mesh->groups, (size_t)mesh->group_count, sizeof *mesh->groups, compare_groups);
    return true;
}

bool mesh_raw_convert(const MeshRaw *raw, const char *path, MeshFile *mesh, Error *err)
{
    static const char *const how =
        "numbers are from 1 to 2147483647 in format 2.2 (gmsh and meshio renumber a mesh that they "
        "save again)";
    RawElements body = {0};
    NodeTable table = {0};
    *mesh = (MeshFile){.dim = raw_dimension(raw)};

    // gmsh reads numbers of format 2.2 into ints, where larger ones run over, and takes negative
    // ones as they are; messages name nodes and elements by them.
    for (int64_t i = 0; i < raw->node_count; i++)
        if (raw->node_number[i] < 1 || raw->node_number[i] > NUMBER_MAX)
            FAIL(err, ERROR_INPUT, "%s: a node has the number %lld as gmsh reads it; %s", path,
                 (long long)raw->node_number[i], how);
    for (int32_t k = 0; k < raw->block_count; k++)
        for (int64_t i = 0; i < raw->blocks[k].count; i++)
            if (raw->blocks[k].number[i] < 1 || raw->blocks[k].number[i] > NUMBER_MAX)
                FAIL(err, ERROR_INPUT, "%s: an element has the number %lld as gmsh reads it; %s",
                     path, (long long)raw->blocks[k].number[i], how);
    TRY(raw_pick_body(raw, mesh->dim, path, &body, err));

    // All nodes by their tags, none marked yet.
    if (raw->node_count > INT32_MAX / 3)
        FAIL(err, ERROR_INPUT, "%s: %lld nodes are too many", path, (long long)raw->node_count);
    TRY(table.node = NEW_ARRAY(Node, raw->node_count, err));
    table.count = (int32_t)raw->node_count;
    for (int32_t k = 0; k < table.count; k++) table.node[k] = (Node){raw->node_number[k], k, -1};
    qsort(table.node, (size_t)table.count, sizeof *table.node, order_int64);

    TRY(mark_nodes(raw, &body, path, mesh->dim, &table, err));
    TRY(number_nodes(raw, path, &table, mesh, err));
    TRY(store_elements(&body, &table, mesh, err));
    TRY(convert_groups(raw, path, &table, mesh, err));
cleanup:
    memory_free_all(table.node, body.items);
    return error_is_clean(err);
}
