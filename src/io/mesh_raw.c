// SPDX-License-Identifier: GPL-2.0-or-later
// From gmsh's tags to arrays indexed from 0. Order everywhere: ascending tags.
#include "io/mesh_raw.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A mesh counts as plane when |y3| stays below this times its extent: what round-off leaves of a
// coordinate of 0 after a rotation in a CAD program.
static const double PLANE_TOLERANCE = 1e-9;

enum { GMSH_POINT = 15, GMSH_LINE_2 = 1, GMSH_LINE_3 = 8, KIND_LIST_SIZE = 64 };

// One element: where it stands in the raw blocks.
typedef struct RawElement {
    int64_t number;
    const int64_t *nodes;   // its node tags, in the block
    int32_t count;   // of nodes
    int32_t kind;   // ElementKind; -1 for points and lines
    int32_t copies;   // how often the file gives it
    int32_t groups;   // in how many physical groups its entity is
} RawElement;

typedef struct RawElements {
    int32_t count;
    RawElement *items;   // [count]; owned
} RawElements;

// Raw nodes by ascending tag.
typedef struct NodeTable {
    int32_t count;
    int64_t *number;   // [count] ascending; owned
    int64_t *source;   // [count] index into the raw nodes; owned
    int32_t *index;   // [count] index in the MeshFile, -1: left out; owned
} NodeTable;

void mesh_raw_destroy(MeshRaw *raw)
{
    for (int32_t k = 0; k < raw->block_count; k++) {
        memory_free(raw->blocks[k].number);
        memory_free(raw->blocks[k].nodes);
    }
    for (int32_t k = 0; k < raw->group_count; k++) memory_free(raw->groups[k].entities);
    memory_free(raw->blocks);
    memory_free(raw->groups);
    memory_free(raw->node_number);
    memory_free(raw->node_dimension);
    memory_free(raw->node_position);
    *raw = (MeshRaw){0};
}

// --- elements -----------------------------------------------------------------------------------

static int32_t kind_of_type(int32_t gmsh_type)
{
#define X(kind, nodes, edge_nodes, type, name)                                                     \
    if (gmsh_type == (type)) return kind;
    ELEMENT_KINDS(X)
#undef X
    return -1;
}

static bool group_holds(const RawGroup *group, const RawBlock *block)
{
    if (group->dimension != block->dimension) return false;
    for (int32_t k = 0; k < group->entity_count; k++)
        if (abs(group->entities[k]) == block->entity) return true;
    return false;
}

// In how many physical groups of its dimension a block is.
static int32_t groups_of_block(const MeshRaw *raw, const RawBlock *block)
{
    int32_t count = 0;
    for (int32_t k = 0; k < raw->group_count; k++) count += group_holds(&raw->groups[k], block);
    return count;
}

static bool has_surface_group(const MeshRaw *raw)
{
    for (int32_t k = 0; k < raw->group_count; k++)
        if (raw->groups[k].dimension == 2) return true;
    return false;
}

static int compare_numbers(const void *a, const void *b)
{
    const RawElement *first = a, *second = b;
    return (first->number > second->number) - (first->number < second->number);
}

static int compare_nodes(const void *a, const void *b)
{
    const RawElement *first = a, *second = b;
    if (first->count != second->count) return first->count < second->count ? -1 : 1;
    for (int32_t k = 0; k < first->count; k++)
        if (first->nodes[k] != second->nodes[k]) return first->nodes[k] < second->nodes[k] ? -1 : 1;
    return compare_numbers(a, b);
}

// Format 2.2 writes an element once for each of its physical groups: keeps the first copy.
static void drop_copies(RawElements *elements)
{
    int32_t kept = 0;
    qsort(elements->items, (size_t)elements->count, sizeof *elements->items, compare_nodes);
    for (int32_t k = 0; k < elements->count; k++) {
        const RawElement *item = &elements->items[k];
        RawElement *last = kept > 0 ? &elements->items[kept - 1] : NULL;
        if (last && item->count == last->count &&
            memcmp(item->nodes, last->nodes, (size_t)item->count * sizeof *item->nodes) == 0)
            last->copies++;
        else
            elements->items[kept++] = *item;
    }
    elements->count = kept;
}

static bool append_block(RawElements *elements, const RawBlock *block, int32_t groups, Error *err)
{
    int64_t total = elements->count + block->count;
    if (total > INT32_MAX / ELEMENT_NODES_MAX)
        FAIL(err, ERROR_INPUT, "%lld elements are too many", (long long)total);
    RawElement *items = memory_resize(elements->items, elements->count, total, sizeof *items, err);
    if (!items) goto cleanup;
    elements->items = items;
    for (int64_t k = 0; k < block->count; k++)
        items[elements->count++] =
            (RawElement){.number = block->number[k],
                         .nodes = block->nodes + k * block->nodes_per_element,
                         .count = block->nodes_per_element,
                         .kind = kind_of_type(block->gmsh_type),
                         .copies = 1,
                         .groups = groups};
cleanup:
    return error_is_clean(err);
}

static void sort_elements(RawElements *elements, bool may_repeat)
{
    if (may_repeat) drop_copies(elements);
    for (int32_t k = 1; k < elements->count; k++)
        if (elements->items[k - 1].number > elements->items[k].number) {
            qsort(elements->items, (size_t)elements->count, sizeof *elements->items,
                  compare_numbers);
            break;
        }
}

static void list_kinds(char list[KIND_LIST_SIZE])
{
    int length = 0;
#define X(kind, nodes, edge_nodes, gmsh, name)                                                     \
    length += snprintf(list + length, KIND_LIST_SIZE - (size_t)length, "%s%s", length ? ", " : "", \
                       name);
    ELEMENT_KINDS(X)
#undef X
}

// The elements of the body: of the physical surfaces, or of every surface where there are none.
static bool pick_surface(const MeshRaw *raw, const char *path, RawElements *picked, Error *err)
{
    bool by_group = has_surface_group(raw), may_repeat = false;
    int64_t others = 0;
    char allowed[KIND_LIST_SIZE];
    list_kinds(allowed);
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        if (block->dimension == 3)
            FAIL(err, ERROR_INPUT,
                 "%s: holds %lld volume elements (%s); a plane mesh of %s is wanted", path,
                 (long long)block->count, block->type_name, allowed);
        int32_t groups = block->dimension == 2 ? groups_of_block(raw, block) : 0;
        if (block->dimension != 2 || (by_group && groups == 0)) {
            others += block->count;
            continue;
        }
        if (kind_of_type(block->gmsh_type) < 0)
            FAIL(err, ERROR_INPUT,
                 "%s: element %lld is of a kind that is not supported, %s; allowed are %s", path,
                 (long long)(block->count ? block->number[0] : 0), block->type_name, allowed);
        may_repeat = may_repeat || groups > 1;
        TRY(append_block(picked, block, groups, err));
    }
    if (picked->count == 0)
        FAIL(
            err, ERROR_INPUT,
            "%s: has no surface elements%s (%lld nodes, %lld other elements); was it meshed in 2D, "
            "and is the surface in a physical group?",
            path, by_group ? " in its physical surfaces" : "", (long long)raw->node_count,
            (long long)others);
    sort_elements(picked, may_repeat);
cleanup:
    return error_is_clean(err);
}

// --- nodes --------------------------------------------------------------------------------------

typedef struct TagAt {
    int64_t number, source;
} TagAt;

static int compare_tags(const void *a, const void *b)
{
    const TagAt *first = a, *second = b;
    return (first->number > second->number) - (first->number < second->number);
}

static bool table_build(const MeshRaw *raw, const char *path, NodeTable *table, Error *err)
{
    TagAt *tags = NEW_ARRAY(TagAt, raw->node_count, err);
    if (!tags) goto cleanup;
    if (raw->node_count > INT32_MAX / 3)
        FAIL(err, ERROR_INPUT, "%s: %lld nodes are too many", path, (long long)raw->node_count);
    table->count = (int32_t)raw->node_count;
    for (int32_t k = 0; k < table->count; k++) tags[k] = (TagAt){raw->node_number[k], k};
    qsort(tags, (size_t)table->count, sizeof *tags, compare_tags);
    if (!(table->number = NEW_ARRAY(int64_t, table->count, err))) goto cleanup;
    if (!(table->source = NEW_ARRAY(int64_t, table->count, err))) goto cleanup;
    if (!(table->index = NEW_ARRAY(int32_t, table->count, err))) goto cleanup;
    for (int32_t k = 0; k < table->count; k++) {
        table->number[k] = tags[k].number;
        table->source[k] = tags[k].source;
        table->index[k] = -1;
    }
cleanup:
    memory_free(tags);
    return error_is_clean(err);
}

static void table_destroy(NodeTable *table)
{
    memory_free(table->number);
    memory_free(table->source);
    memory_free(table->index);
}

// The place of a tag in the table, -1: none. Tags mostly count on without holes: guess that first.
static int32_t table_find(const NodeTable *table, int64_t number)
{
    int32_t low = 0, high = table->count - 1;
    if (table->count == 0) return -1;
    int64_t guess = number - table->number[0];
    if (guess >= 0 && guess <= high && table->number[guess] == number) return (int32_t)guess;
    while (low <= high) {
        int32_t middle = low + (high - low) / 2;
        if (table->number[middle] == number) return middle;
        if (table->number[middle] < number)
            low = middle + 1;
        else
            high = middle - 1;
    }
    return -1;
}

static bool mark_elements(const RawElements *elements, const char *path, NodeTable *table,
                          Error *err)
{
    for (int32_t e = 0; e < elements->count; e++)
        for (int32_t a = 0; a < elements->items[e].count; a++) {
            int32_t at = table_find(table, elements->items[e].nodes[a]);
            if (at < 0)
                FAIL(err, ERROR_INPUT, "%s: element %lld uses node %lld, which the file lacks",
                     path, (long long)elements->items[e].number,
                     (long long)elements->items[e].nodes[a]);
            table->index[at] = 0;
        }
cleanup:
    return error_is_clean(err);
}

// Marks what bulk/mesh shall complain about: nodes on a surface or curve that are on no element of
// any kind. Nodes of points, and of curves and surfaces outside the physical groups, help to draw
// the geometry (centres of arcs) and are left out.
static bool mark_orphans(const MeshRaw *raw, NodeTable *table, Error *err)
{
    bool *attached = NEW_ARRAY(bool, table->count, err);
    if (!attached) goto cleanup;
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        for (int64_t i = 0; i < block->count * block->nodes_per_element; i++) {
            int32_t at = table_find(table, block->nodes[i]);
            if (at >= 0) attached[at] = true;
        }
    }
    for (int32_t k = 0; k < table->count; k++)
        if (!attached[k] && raw->node_dimension[table->source[k]] > 0) table->index[k] = 0;
cleanup:
    memory_free(attached);
    return error_is_clean(err);
}

// Marks the nodes of the curve groups: on no surface element they are as wrong.
static void mark_curves(const MeshRaw *raw, NodeTable *table)
{
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        if (block->dimension != 1 || groups_of_block(raw, block) == 0) continue;
        for (int64_t i = 0; i < block->count * block->nodes_per_element; i++) {
            int32_t at = table_find(table, block->nodes[i]);
            if (at >= 0) table->index[at] = 0;
        }
    }
}

// Numbers the marked nodes and copies their positions.
static bool number_nodes(const MeshRaw *raw, const char *path, NodeTable *table, MeshFile *mesh,
                         Error *err)
{
    for (int32_t k = 0; k < table->count; k++)
        if (table->index[k] == 0) table->index[k] = mesh->node_count++;
    if (!(mesh->position = NEW_ARRAY(double, 2 * (int64_t)mesh->node_count, err))) goto cleanup;
    if (!(mesh->node_number = NEW_ARRAY(int64_t, mesh->node_count, err))) goto cleanup;
    double extent = 0, deepest = 0;
    int64_t worst = 0;
    for (int32_t k = 0; k < table->count; k++) {
        if (table->index[k] < 0) continue;
        const double *from = raw->node_position + 3 * table->source[k];
        double *to = mesh->position + 2 * table->index[k];
        if (!isfinite(from[0]) || !isfinite(from[1]) || !isfinite(from[2]))
            FAIL(err, ERROR_INPUT, "%s: node %lld has a coordinate that is not a number", path,
                 (long long)table->number[k]);
        to[0] = from[0];
        to[1] = from[1];
        mesh->node_number[table->index[k]] = table->number[k];
        extent = fmax(extent,
                      fmax(fabs(from[0] - mesh->position[0]), fabs(from[1] - mesh->position[1])));
        if (fabs(from[2]) > fabs(deepest)) {
            deepest = from[2];
            worst = table->number[k];
        }
    }
    if (fabs(deepest) > PLANE_TOLERANCE * extent)
        FAIL(
            err, ERROR_INPUT,
            "%s: is not in gmsh's plane z = 0: node %lld is at z = %g (draw the block with x along "
            "the drive and y upwards)",
            path, (long long)worst, deepest);
cleanup:
    return error_is_clean(err);
}

static bool store_elements(const RawElements *elements, const NodeTable *table, MeshFile *mesh,
                           Error *err)
{
    int64_t total = 0;
    for (int32_t e = 0; e < elements->count; e++) total += elements->items[e].count;
    mesh->element_number = NEW_ARRAY(int64_t, elements->count, err);
    if (!mesh->element_number) goto cleanup;
    if (!(mesh->kind = NEW_ARRAY(uint8_t, elements->count, err))) goto cleanup;
    mesh->first_node = NEW_ARRAY(int32_t, (int64_t)elements->count + 1, err);
    if (!mesh->first_node) goto cleanup;
    if (!(mesh->element_nodes = NEW_ARRAY(int32_t, total, err))) goto cleanup;
    mesh->element_count = elements->count;
    int32_t at = 0;
    for (int32_t e = 0; e < elements->count; e++) {
        const RawElement *element = &elements->items[e];
        mesh->element_number[e] = element->number;
        mesh->kind[e] = (uint8_t)element->kind;
        mesh->first_node[e] = at;
        for (int32_t a = 0; a < element->count; a++)
            mesh->element_nodes[at++] = table->index[table_find(table, element->nodes[a])];
    }
    mesh->first_node[elements->count] = at;
cleanup:
    return error_is_clean(err);
}

// --- groups -------------------------------------------------------------------------------------

static int compare_indices(const void *a, const void *b)
{
    int32_t first = *(const int32_t *)a, second = *(const int32_t *)b;
    return (first > second) - (first < second);
}

static int compare_groups(const void *a, const void *b)
{
    const MeshGroup *first = a, *second = b;
    if (first->dimension != second->dimension) return first->dimension < second->dimension ? -1 : 1;
    return (first->number > second->number) - (first->number < second->number);
}

// Fills group->nodes with the distinct nodes of its elements, as far as they are in the mesh.
static bool store_group_nodes(const RawElements *elements, const NodeTable *table, MeshGroup *group,
                              Error *err)
{
    int32_t count = 0;
    group->nodes = NEW_ARRAY(int32_t, (int64_t)elements->count * EDGE_NODES_MAX, err);
    if (!group->nodes) goto cleanup;
    for (int32_t k = 0; k < elements->count; k++)
        for (int32_t a = 0; a < elements->items[k].count; a++) {
            int32_t at = table_find(table, elements->items[k].nodes[a]);
            if (at >= 0 && table->index[at] >= 0) group->nodes[count++] = table->index[at];
        }
    qsort(group->nodes, (size_t)count, sizeof *group->nodes, compare_indices);
    for (int32_t k = 0; k < count; k++)
        if (k == 0 || group->nodes[k] != group->nodes[k - 1])
            group->nodes[group->node_count++] = group->nodes[k];
cleanup:
    return error_is_clean(err);
}

static bool store_group_edges(const char *path, const RawElements *edges, const NodeTable *table,
                              MeshGroup *group, Error *err)
{
    int32_t width = edges->count ? edges->items[0].count : 2;
    group->edge_nodes = NEW_ARRAY(int32_t, (int64_t)edges->count * width, err);
    if (!group->edge_nodes) goto cleanup;
    group->nodes_per_edge = width;
    for (int32_t k = 0; k < edges->count; k++) {
        if (edges->items[k].count != width)
            FAIL(err, ERROR_INPUT, "%s: group '%s' mixes edges of %d and %d nodes", path,
                 group->name, width, edges->items[k].count);
        for (int32_t a = 0; a < width; a++) {
            int32_t at = table_find(table, edges->items[k].nodes[a]);
            if (at < 0)
                FAIL(err, ERROR_INPUT, "%s: group '%s' uses node %lld, which the file lacks", path,
                     group->name, (long long)edges->items[k].nodes[a]);
            group->edge_nodes[k * width + a] = table->index[at];
        }
    }
    group->edge_count = edges->count;
cleanup:
    return error_is_clean(err);
}

// Format 2.2 says group and entity of each element; gmsh keeps the group by entity only. Where two
// groups share an entity number by accident, gmsh would give each the edges of both.
static bool check_copies(const char *path, const MeshGroup *group, const RawElements *elements,
                         Error *err)
{
    for (int32_t k = 0; k < elements->count; k++)
        if (elements->items[k].copies < elements->items[k].groups)
            FAIL(
                err, ERROR_INPUT,
                "%s: group '%s' (%d) shares an elementary number with another group, so gmsh "
                "cannot "
                "tell whose element %lld is; give each group its own (the second tag of an element "
                "in format 2.2), or save as format 4.1",
                path, group->name, group->number, (long long)elements->items[k].number);
cleanup:
    return error_is_clean(err);
}

// The points or edges of a group.
static bool pick_group(const MeshRaw *raw, const char *path, const RawGroup *from,
                       const MeshGroup *group, RawElements *picked, Error *err)
{
    for (int32_t k = 0; k < raw->block_count; k++) {
        const RawBlock *block = &raw->blocks[k];
        if (!group_holds(from, block)) continue;
        if (block->gmsh_type != GMSH_POINT && block->gmsh_type != GMSH_LINE_2 &&
            block->gmsh_type != GMSH_LINE_3)
            FAIL(err, ERROR_INPUT,
                 "%s: group '%s' has elements of a kind that is not supported, %s", path,
                 group->name, block->type_name);
        TRY(append_block(picked, block, groups_of_block(raw, block), err));
    }
    sort_elements(picked, true);
cleanup:
    return error_is_clean(err);
}

static bool convert_group(const MeshRaw *raw, const char *path, double version,
                          const NodeTable *table, const RawGroup *from, MeshGroup *group,
                          Error *err)
{
    RawElements elements = {0};
    *group = (MeshGroup){.dimension = from->dimension, .number = from->number};
    if (from->name[0])
        snprintf(group->name, sizeof group->name, "%s", from->name);
    else
        snprintf(group->name, sizeof group->name, "%d", from->number);
    if (from->dimension >= 2) goto cleanup;
    TRY(pick_group(raw, path, from, group, &elements, err));
    if (version > 0 && version < 4) TRY(check_copies(path, group, &elements, err));
    if (from->dimension == 1) TRY(store_group_edges(path, &elements, table, group, err));
    TRY(store_group_nodes(&elements, table, group, err));
cleanup:
    memory_free(elements.items);
    return error_is_clean(err);
}

static bool convert_groups(const MeshRaw *raw, const char *path, double version,
                           const NodeTable *table, MeshFile *mesh, Error *err)
{
    if (!(mesh->groups = NEW_ARRAY(MeshGroup, raw->group_count, err))) goto cleanup;
    for (int32_t k = 0; k < raw->group_count; k++) {
        MeshGroup *group = &mesh->groups[mesh->group_count++];
        TRY(convert_group(raw, path, version, table, &raw->groups[k], group, err));
        for (const MeshGroup *other = mesh->groups; other < group; other++)
            if (strcmp(other->name, group->name) == 0)
                FAIL(err, ERROR_INPUT,
                     "%s: the physical name '%s' is used twice: by group %d of dimension %d and by "
                     "group %d of dimension %d",
                     path, group->name, other->number, other->dimension, group->number,
                     group->dimension);
    }
    qsort(mesh->groups, (size_t)mesh->group_count, sizeof *mesh->groups, compare_groups);
cleanup:
    return error_is_clean(err);
}

bool mesh_raw_convert(const MeshRaw *raw, const char *path, double version, MeshFile *mesh,
                      Error *err)
{
    RawElements surface = {0};
    NodeTable table = {0};
    *mesh = (MeshFile){0};
    TRY(pick_surface(raw, path, &surface, err));
    TRY(table_build(raw, path, &table, err));
    TRY(mark_elements(&surface, path, &table, err));
    TRY(mark_orphans(raw, &table, err));
    mark_curves(raw, &table);
    TRY(number_nodes(raw, path, &table, mesh, err));
    TRY(store_elements(&surface, &table, mesh, err));
    TRY(convert_groups(raw, path, version, &table, mesh, err));
cleanup:
    table_destroy(&table);
    memory_free(surface.items);
    return error_is_clean(err);
}
