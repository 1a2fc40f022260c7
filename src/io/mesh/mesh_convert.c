// SPDX-License-Identifier: GPL-2.0-or-later
// From gmsh's tags to arrays indexed from 0. Order everywhere: ascending tags.
//
//   1  pick the elements of the body
//   2  sort the nodes by tag, so that a tag is found fast (NodeTable)
//   3  mark the nodes to keep: those of the elements, those of named boundaries, lone ones
//   4  number them in the order of their tags, copy positions, check the plane where it is one
//   5  write elements and groups with the new numbers
#include "io/mesh/mesh_raw.h"

#include "base/memory.h"
#include "base/order.h"
#include "base/text.h"
#include "io/mesh/element_faces.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A mesh counts as plane when gmsh's |z| stays below this times its extent: rounding, after a
// rotation in a CAD program.
static const double PLANE_TOLERANCE = 1e-9;

// Largest number of a node or an element: what base/archive takes as a count.
static const int64_t NUMBER_MAX = INT64_C(1) << 53;

// gmsh's numbers of what is not in ELEMENT_KINDS.
enum { GMSH_POINT = 15, GMSH_HEX_20 = 17, GMSH_WEDGE_15 = 18, KIND_LIST_SIZE = 64 };

// One element: where it stands in the raw blocks.
typedef struct RawElement {
    int64_t number;
    const int64_t *nodes;   // its node tags, in the block
    int32_t count;   // of nodes
    int32_t kind;   // ElementKind; -1 for points
} RawElement;

typedef struct RawElements {
    int32_t count;
    RawElement *items;   // [count]; owned
} RawElements;

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

// --- elements -----------------------------------------------------------------------------------

// The ElementKind of a block's gmsh type, -1: none of ours.
static int32_t kind_of(const RawBlock *block)
{
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++) {
        const ElementInfo *info = &ELEMENTS[(ElementKind)kind];
        if (info->gmsh_type == block->gmsh_type && info->dim == block->dimension) return kind;
    }
    return -1;
}

// The block's entity is in the group. Tags of entities are signed in some files: the sign is the
// orientation.
static bool group_holds(const RawGroup *group, const RawBlock *block)
{
    if (group->dimension != block->dimension) return false;
    for (int32_t k = 0; k < group->entity_count; k++)
        if (abs(group->entities[k]) == block->entity) return true;
    return false;
}

// Number of groups of its dimension in which a block's entity is.
static int32_t count_groups(const MeshRaw *raw, const RawBlock *block)
{
    int32_t count = 0;
    for (int32_t k = 0; k < raw->group_count; k++) count += group_holds(&raw->groups[k], block);
    return count;
}

// Appends the elements of one block; they go on pointing into it. INT32_MAX / ELEMENT_NODES_MAX
// elements keep every index into element_nodes within int32_t.
static bool append_block(RawElements *elements, const RawBlock *block, Error *err)
{
    int64_t total = elements->count + block->count;
    if (total > INT32_MAX / ELEMENT_NODES_MAX)
        return REFUSE(err, "%lld elements are too many", (long long)total);
    if (!memory_resize(&elements->items, elements->count, total, sizeof *elements->items, err))
        return false;
    for (int64_t k = 0; k < block->count; k++)
        elements->items[elements->count++] =
            (RawElement){.number = block->number[k],
                         .nodes = block->nodes + k * block->nodes_per_element,
                         .count = block->nodes_per_element,
                         .kind = kind_of(block)};
    return error_is_clean(err);
}

// Compares node tags, so that copies of one element come together; among copies the lowest tag
// first.
static int compare_nodes(const void *a, const void *b)
{
    const RawElement *first = a, *second = b;
    if (first->count != second->count) return first->count < second->count ? -1 : 1;
    for (int32_t k = 0; k < first->count; k++)
        if (first->nodes[k] != second->nodes[k]) return first->nodes[k] < second->nodes[k] ? -1 : 1;
    return order_int64(a, b);
}

// Sorts by tag, as gmsh mostly delivers them.
static void sort_elements(RawElements *elements, bool may_repeat)
{
    int32_t kept = 0;
    if (elements->count == 0) return;   // no array to sort

    // Format 2.2 writes an element once for each of its physical groups: the first copy is kept.
    if (may_repeat)
        qsort(elements->items, (size_t)elements->count, sizeof *elements->items, compare_nodes);
    for (int32_t k = 0; may_repeat && k < elements->count; k++) {
        const RawElement *item = &elements->items[k];
        const RawElement *last = kept > 0 ? &elements->items[kept - 1] : NULL;
        if (last && item->count == last->count &&
            memcmp(item->nodes, last->nodes, (size_t)item->count * sizeof *item->nodes) == 0)
            continue;
        elements->items[kept++] = *item;
    }
    if (may_repeat) elements->count = kept;

    for (int32_t k = 1; k < elements->count; k++)
        if (elements->items[k - 1].number > elements->items[k].number) {
            qsort(elements->items, (size_t)elements->count, sizeof *elements->items, order_int64);
            break;
        }
}

// The elements of the body by ascending number, which point into `raw`: of the physical groups of
// its dimension, or all of it where there are none. Points, edges, elements of no group and copies
// are left out; elements of a kind that we do not have are refused by name.
static bool pick_body(const MeshRaw *raw, int32_t dim, const char *path, RawElements *picked,
                      Error *err)
{
    bool by_group = false, may_repeat = false;
    const char *what = dim == 2 ? "surface" : "volume";
    int64_t others = 0;
    for (int32_t k = 0; !raw->all_elements && k < raw->group_count; k++)
        by_group = by_group || raw->groups[k].dimension == dim;
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        int32_t groups = block->dimension == dim ? count_groups(raw, block) : 0;
        if (block->dimension != dim || (by_group && groups == 0)) {
            others += block->count;
            continue;
        }
        if (kind_of(block) < 0) {
            bool serendipity = block->gmsh_type == GMSH_HEX_20 || block->gmsh_type == GMSH_WEDGE_15;
            const char *why =
                serendipity ? ": its faces have corners of negative weight, which can carry no "
                              "contact (Mesh.SecondOrderIncomplete = 0 makes HEX27)"
                            : "";
            char allowed[KIND_LIST_SIZE];   // "T3, T6, Q4, Q8, Q9"
            int length = 0;
            for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++)
                if (element_dim((ElementKind)kind) == dim)
                    length += snprintf(allowed + length, KIND_LIST_SIZE - (size_t)length, "%s%s",
                                       length ? ", " : "", ELEMENTS[(ElementKind)kind].name);
            return REFUSE(
                err, "%s: element %lld is of a kind that is not supported, %s%s; allowed are %s",
                path, (long long)(block->count ? block->number[0] : 0), block->type_name, why,
                allowed);
        }
        may_repeat = may_repeat || groups > 1;
        if (!append_block(picked, block, err)) return false;
    }
    if (picked->count == 0)
        return REFUSE(err,
                      "%s: has no %s elements%s%s%s (%lld nodes, %lld other elements); was it "
                      "meshed in %dD, and is the %s in a physical group?",
                      path, what, by_group ? " in its physical " : "", by_group ? what : "",
                      by_group ? "s" : "", (long long)raw->node_count, (long long)others, dim,
                      what);
    sort_elements(picked, may_repeat);
    return true;
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

    // Take the nodes of the body's elements. A tag that no node has is an error: gmsh lets some of
    // those files pass.
    for (int32_t e = 0; e < body->count; e++)
        for (int32_t a = 0; a < body->items[e].count; a++) {
            Node *node = table_find(table, body->items[e].nodes[a]);
            if (!node)
                return REFUSE(err, "%s: element %lld uses node %lld, which the file lacks", path,
                              (long long)body->items[e].number, (long long)body->items[e].nodes[a]);
            node->index = 0;
        }

    // Take the nodes on a surface or curve that are on no element of any kind, which fem/mesh_build
    // refuses, and those of the boundary groups: where they are on no element of the body they are
    // refused likewise. Nodes of points, and of curves and surfaces outside the physical groups,
    // only help to draw the geometry (centres of arcs) and are left out.
    TRY(attached = NEW_ARRAY(bool, table->count, err));
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        bool boundary = block->dimension == dim - 1 && count_groups(raw, block) > 0;
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
    // The extent is measured from the first node: it only scales the plane's tolerance.
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

// --- groups -------------------------------------------------------------------------------------

// Compares dimensions, then numbers: the order promised in io/mesh/mesh_file.h.
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

// Copies the faces of a boundary, whose nodes mark_nodes has put into the mesh. Faces of
// different order in one group are an error; triangles beside quadrilaterals are not.
static bool store_faces(const char *path, const RawElements *faces, const NodeTable *table,
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

// One group: its name (or its number in decimal), and of a region its elements, else its nodes, and
// of a boundary its faces.
static bool convert_group(const MeshRaw *raw, const char *path, const NodeTable *table,
                          const RawGroup *from, const MeshFile *mesh, MeshGroup *group, Error *err)
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

    // The elements of a region, by the entities that it is made of: copies of an element are on the
    // same entity as the one that was kept.
    if (from->dimension == mesh->dim) {
        int32_t most = 0;
        for (int32_t k = 0; k < raw->block_count; k++)
            if (group_holds(from, &raw->blocks[k])) most += (int32_t)raw->blocks[k].count;
        TRY(group->elements = NEW_ARRAY(int32_t, most, err));
        for (int32_t k = 0; k < raw->block_count; k++) {
            const RawBlock *block = &raw->blocks[k];
            if (!group_holds(from, block)) continue;
            for (int64_t i = 0; i < block->count; i++) {
                // gmsh's numbers ascend; a copy that was dropped is not found.
                const int64_t *found = bsearch(&block->number[i], mesh->element_number,
                                               (size_t)mesh->element_count, sizeof *block->number,
                                               order_int64);
                if (found)
                    group->elements[group->element_count++] =
                        (int32_t)(found - mesh->element_number);
            }
        }
        qsort(group->elements, (size_t)group->element_count, sizeof(int32_t), order_int32);
    }
    if (from->dimension >= mesh->dim) goto cleanup;

    // Points, edges or faces, by ascending number. Faces of order 3 on are refused here, before the
    // elements, as a message about the group says more.
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        if (!group_holds(from, block)) continue;
        if (block->gmsh_type != GMSH_POINT && kind_of(block) < 0)
            FAIL(err, ERROR_INPUT,
                 "%s: group '%s' has elements of a kind that is not supported, %s", path,
                 group->name, block->type_name);
        TRY(append_block(&elements, block, err));
    }
    sort_elements(&elements, true);
    if (from->dimension == mesh->dim - 1) TRY(store_faces(path, &elements, table, group, err));

    // Their distinct nodes, as far as they are in the mesh.
    int32_t count = 0;
    TRY(group->nodes = NEW_ARRAY(int32_t, (int64_t)elements.count * FACE_NODES_MAX, err));
    for (int32_t k = 0; k < elements.count; k++)
        for (int32_t a = 0; a < elements.items[k].count; a++) {
            const Node *node = table_find(table, elements.items[k].nodes[a]);
            if (node && node->index >= 0) group->nodes[count++] = node->index;
        }
    qsort(group->nodes, (size_t)count, sizeof *group->nodes, order_int32);
    for (int32_t k = 0; k < count; k++)
        if (k == 0 || group->nodes[k] != group->nodes[k - 1])
            group->nodes[group->node_count++] = group->nodes[k];
cleanup:
    memory_free(elements.items);
    return error_is_clean(err);
}

bool mesh_raw_convert(const MeshRaw *raw, const char *path, MeshFile *mesh, Error *err)
{
    static const char *const how =
        "numbers are from 1 to 2147483647 in format 2.2 (gmsh and meshio renumber a mesh that they "
        "save again)";
    RawElements body = {0};
    NodeTable table = {0};
    *mesh = (MeshFile){.dim = 2};   // 3 where there are volume elements
    for (int32_t k = 0; k < raw->block_count; k++)
        if (raw->blocks[k].dimension == 3 && raw->blocks[k].count > 0) mesh->dim = 3;

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
    TRY(pick_body(raw, mesh->dim, path, &body, err));

    // All nodes by their tags, none marked yet.
    if (raw->node_count > INT32_MAX / 3)
        FAIL(err, ERROR_INPUT, "%s: %lld nodes are too many", path, (long long)raw->node_count);
    TRY(table.node = NEW_ARRAY(Node, raw->node_count, err));
    table.count = (int32_t)raw->node_count;
    for (int32_t k = 0; k < table.count; k++) table.node[k] = (Node){raw->node_number[k], k, -1};
    qsort(table.node, (size_t)table.count, sizeof *table.node, order_int64);

    TRY(mark_nodes(raw, &body, path, mesh->dim, &table, err));
    TRY(number_nodes(raw, path, &table, mesh, err));

    // Elements with indices in place of tags; by offsets, since kinds may be mixed.
    int64_t total = 0;
    int32_t at = 0;
    for (int32_t e = 0; e < body.count; e++) total += body.items[e].count;
    TRY(mesh->element_number = NEW_ARRAY(int64_t, body.count, err));
    TRY(mesh->kind = NEW_ARRAY(uint8_t, body.count, err));
    TRY(mesh->first_node = NEW_ARRAY(int32_t, (int64_t)body.count + 1, err));
    TRY(mesh->element_nodes = NEW_ARRAY(int32_t, total, err));
    mesh->element_count = body.count;
    for (int32_t e = 0; e < body.count; e++) {
        const RawElement *element = &body.items[e];
        mesh->element_number[e] = element->number;
        mesh->kind[e] = (uint8_t)element->kind;
        mesh->first_node[e] = at;
        for (int32_t a = 0; a < element->count; a++)
            mesh->element_nodes[at++] = table_find(&table, element->nodes[a])->index;
    }
    mesh->first_node[body.count] = at;

    // Groups. Among those of one dimension each name is there once.
    TRY(mesh->groups = NEW_ARRAY(MeshGroup, raw->group_count, err));
    for (int32_t k = 0; k < raw->group_count; k++) {
        MeshGroup *group = &mesh->groups[mesh->group_count++];
        TRY(convert_group(raw, path, &table, &raw->groups[k], mesh, group, err));
        for (const MeshGroup *other = mesh->groups; other < group; other++)
            if (other->dimension == group->dimension && strcmp(other->name, group->name) == 0)
                FAIL(err, ERROR_INPUT,
                     "%s: the physical name '%s' is used twice: by groups %d and %d of dimension "
                     "%d",
                     path, group->name, other->number, group->number, group->dimension);
    }
    qsort(mesh->groups, (size_t)mesh->group_count, sizeof *mesh->groups, compare_groups);
cleanup:
    memory_free_all(table.node, body.items);
    return error_is_clean(err);
}
