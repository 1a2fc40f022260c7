// SPDX-License-Identifier: GPL-2.0-or-later
// All numbers travel as doubles, exact up to 2^53. What is read is checked as a file from elsewhere
// is: indices within their arrays, kinds that exist, counts that fit each other.
#include "io/mesh/mesh_cache.h"

#include "base/computation.h"
#include "base/memory.h"
#include "io/cache/cache_file.h"
#include "io/mesh/mesh_source.h"

#include <stdio.h>
#include <string.h>

// COUNTS: nodes, elements, nodes of all elements, groups, nodes of all edges of groups, nodes of
// all groups, elements of all groups. HEADS: numbers of a group beside its name and lists.
enum { COUNTS = 7, HEADS = 7, ARRAYS = 11, NAME_NUMBERS = GROUP_NAME_SIZE / sizeof(double) };
static const double EXACT_LIMIT = 9007199254740992.0;   // 2^53

bool mesh_cache_key(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                    char key[HASH_TEXT_SIZE], Error *err)
{
    Hash hash = computation_hash();
    bool whole = false;
    key[0] = 0;
    TRY(mesh_source_hash(path, parameters, parameter_count, &hash, &whole, err));
    if (whole) hash_write(&hash, key);
cleanup:
    return error_is_clean(err);
}

// --- out of the cache ---------------------------------------------------------------------------

// All of these: false without an error where an array is missing, has another length, or holds what
// cannot be.

static bool read_tags(const CacheFile *file, const char *name, int32_t count, int64_t **out,
                      Error *err)
{
    const double *values = cache_file_array(file, name, count);
    if (!values || !(*out = NEW_ARRAY(int64_t, count, err))) return false;
    for (int32_t k = 0; k < count; k++) {
        if (!(values[k] >= 0 && values[k] <= EXACT_LIMIT)) return false;
        (*out)[k] = (int64_t)values[k];
    }
    return true;
}

// count: of their nodes, as the file says.
static bool read_elements(const CacheFile *file, MeshFile *mesh, int32_t count, Error *err)
{
    int32_t elements = mesh->element_count;
    const double *kind = cache_file_array(file, "kind", elements);
    if (!kind || !(mesh->kind = NEW_ARRAY(uint8_t, elements, err))) return false;
    if (!(mesh->first_node = NEW_ARRAY(int32_t, (int64_t)elements + 1, err))) return false;
    mesh->first_node[0] = 0;
    for (int32_t k = 0; k < elements; k++) {
        if (!(kind[k] >= 0 && kind[k] < ELEMENT_KIND_COUNT)) return false;
        mesh->kind[k] = (uint8_t)kind[k];
        mesh->first_node[k + 1] = mesh->first_node[k] +
                                  element_node_count((ElementKind)mesh->kind[k]);
        if (mesh->first_node[k + 1] > count) return false;
    }
    if (mesh->first_node[elements] != count) return false;
    mesh->element_nodes = NEW_ARRAY(int32_t, count, err);
    return mesh->element_nodes &&
           cache_file_whole(file, "element_nodes", count, mesh->node_count, mesh->element_nodes);
}

// As many numbers a node as the elements have dimensions.
static bool read_positions(const CacheFile *file, MeshFile *mesh, Error *err)
{
    if (mesh->element_count == 0) return false;
    mesh->dim = element_dim((ElementKind)mesh->kind[0]);
    int64_t numbers = (int64_t)mesh->dim * mesh->node_count;
    const double *position = cache_file_array(file, "position", numbers);
    if (!position || !(mesh->position = NEW_ARRAY(double, numbers, err))) return false;
    memcpy(mesh->position, position, (size_t)numbers * sizeof(double));
    return true;
}

// Copies `count` indices below `limit` from `values`.
static bool take_indices(const double *values, int32_t count, int32_t limit, int32_t **out,
                         Error *err)
{
    if (!(*out = NEW_ARRAY(int32_t, count, err))) return false;
    for (int32_t k = 0; k < count; k++) {
        if (!(values[k] >= 0 && values[k] < limit)) return false;
        (*out)[k] = (int32_t)values[k];
    }
    return true;
}

static bool take_head(const double *head, MeshGroup *group)
{
    int32_t blurred = 0;
    int32_t *fields[HEADS] = {&group->dimension,
                              &group->number,
                              &group->edge_count,
                              &group->nodes_per_edge,
                              &group->node_count,
                              &group->element_count,
                              &blurred};
    for (int32_t k = 0; k < HEADS; k++) {
        if (!(head[k] >= 0 && head[k] < CACHE_COUNT_LIMIT)) return false;
        *fields[k] = (int32_t)head[k];
    }
    group->blurred = blurred;
    return group->dimension <= 2 && group->nodes_per_edge <= EDGE_NODES_MAX;
}

// left: [3] ends of edges, nodes and elements of all groups together.
static bool read_groups(const CacheFile *file, MeshFile *mesh, const int32_t *left, Error *err)
{
    int64_t edge_count = left[1], node_count = left[2], element_count = left[3];
    int32_t count = left[0];
    const double *names = cache_file_array(file, "group_names", (int64_t)count * NAME_NUMBERS);
    const double *heads = cache_file_array(file, "group_heads", (int64_t)count * HEADS);
    const double *edges = cache_file_array(file, "group_edges", edge_count);
    const double *nodes = cache_file_array(file, "group_nodes", node_count);
    const double *elements = cache_file_array(file, "group_elements", element_count);
    if (!names || !heads || !edges || !nodes || !elements) return false;
    if (!(mesh->groups = NEW_ARRAY(MeshGroup, count, err))) return false;
    mesh->group_count = count;
    for (int32_t k = 0; k < count; k++) {
        MeshGroup *group = &mesh->groups[k];
        memcpy(group->name, names + (int64_t)k * NAME_NUMBERS, GROUP_NAME_SIZE);
        group->name[GROUP_NAME_SIZE - 1] = 0;
        if (!take_head(heads + (int64_t)k * HEADS, group)) return false;
        int64_t ends = (int64_t)group->edge_count * group->nodes_per_edge;
        if (ends > edge_count || group->node_count > node_count ||
            group->element_count > element_count)
            return false;
        if (!take_indices(edges, (int32_t)ends, mesh->node_count, &group->edge_nodes, err) ||
            !take_indices(nodes, group->node_count, mesh->node_count, &group->nodes, err) ||
            !take_indices(elements, group->element_count, mesh->element_count, &group->elements,
                          err))
            return false;
        edges += ends;
        nodes += group->node_count;
        elements += group->element_count;
        element_count -= group->element_count;
        edge_count -= ends;
        node_count -= group->node_count;
    }
    return edge_count == 0 && node_count == 0 && element_count == 0;
}

static bool read_mesh(const CacheFile *file, MeshFile *mesh, Error *err)
{
    int32_t counts[COUNTS];
    if (!cache_file_whole(file, "counts", COUNTS, CACHE_COUNT_LIMIT, counts)) return false;
    mesh->node_count = counts[0];
    mesh->element_count = counts[1];
    return read_elements(file, mesh, counts[2], err) && read_positions(file, mesh, err) &&
           read_groups(file, mesh, counts + 3, err) &&
           read_tags(file, "node_number", counts[0], &mesh->node_number, err) &&
           read_tags(file, "element_number", counts[1], &mesh->element_number, err);
}

bool mesh_cache_load(const char *key, MeshFile *mesh, bool *found, Error *err)
{
    char path[CACHE_PATH_SIZE], reason[CACHE_REASON_SIZE];
    CacheFile file = {0};
    *mesh = (MeshFile){0};
    *found = false;
    if (!key[0] || !cache_file_path(key, "mesh", path)) goto cleanup;
    TRY(cache_file_read(path, key, &file, found, reason, err));
    *found = *found && read_mesh(&file, mesh, err);
cleanup:
    cache_file_destroy(&file);
    if (!*found) mesh_file_destroy(mesh);
    return error_is_clean(err);
}

// --- into the cache -----------------------------------------------------------------------------

// Arrays of doubles one behind the other in `room`.
typedef struct Copies {
    CacheArray arrays[ARRAYS];
    int32_t count;
    double *room;
    int64_t used;
} Copies;

static void begin(Copies *copies, const char *name)
{
    CacheArray *array = &copies->arrays[copies->count++];
    snprintf(array->name, sizeof array->name, "%s", name);
    array->values = copies->room + copies->used;
}

// Appends `number` values of any whole type to the array that was begun last.
#define APPEND(copies, list, number)                                                               \
    for (int64_t at = 0; at < (number); at++, (copies)->arrays[(copies)->count - 1].count++)       \
    (copies)->room[(copies)->used++] = (double)(list)[at]

static void copy_groups(const MeshFile *mesh, Copies *copies)
{
    int32_t count = mesh->group_count;
    begin(copies, "group_names");
    for (int32_t k = 0; k < count; k++) {
        double name[NAME_NUMBERS];
        memcpy(name, mesh->groups[k].name, GROUP_NAME_SIZE);
        memcpy(copies->room + copies->used, name, GROUP_NAME_SIZE);
        copies->used += NAME_NUMBERS;
        copies->arrays[copies->count - 1].count += NAME_NUMBERS;
    }
    begin(copies, "group_heads");
    for (int32_t k = 0; k < count; k++) {
        const MeshGroup *group = &mesh->groups[k];
        const int32_t head[HEADS] = {group->dimension,      group->number,     group->edge_count,
                                     group->nodes_per_edge, group->node_count, group->element_count,
                                     group->blurred};
        APPEND(copies, head, HEADS);
    }
    begin(copies, "group_edges");
    for (int32_t k = 0; k < count; k++)
        APPEND(copies, mesh->groups[k].edge_nodes,
               (int64_t)mesh->groups[k].edge_count * mesh->groups[k].nodes_per_edge);
    begin(copies, "group_nodes");
    for (int32_t k = 0; k < count; k++)
        APPEND(copies, mesh->groups[k].nodes, mesh->groups[k].node_count);
    begin(copies, "group_elements");
    for (int32_t k = 0; k < count; k++)
        APPEND(copies, mesh->groups[k].elements, mesh->groups[k].element_count);
}

static void copy_mesh(const MeshFile *mesh, const int64_t counts[COUNTS], Copies *copies)
{
    begin(copies, "counts");
    APPEND(copies, counts, COUNTS);
    begin(copies, "position");
    APPEND(copies, mesh->position, (int64_t)mesh->dim * mesh->node_count);
    begin(copies, "node_number");
    APPEND(copies, mesh->node_number, mesh->node_count);
    begin(copies, "element_number");
    APPEND(copies, mesh->element_number, mesh->element_count);
    begin(copies, "kind");
    APPEND(copies, mesh->kind, mesh->element_count);
    begin(copies, "element_nodes");
    APPEND(copies, mesh->element_nodes, counts[2]);
    copy_groups(mesh, copies);
}

void mesh_cache_store(const char *key, const MeshFile *mesh)
{
    char path[CACHE_PATH_SIZE];
    Error err = {0};
    Copies copies = {0};
    int64_t edges = 0, nodes = 0, elements = 0, ends = mesh->first_node[mesh->element_count];
    if (!key[0] || !cache_file_path(key, "mesh", path)) return;
    for (int32_t k = 0; k < mesh->group_count; k++) {
        edges += (int64_t)mesh->groups[k].edge_count * mesh->groups[k].nodes_per_edge;
        nodes += mesh->groups[k].node_count;
        elements += mesh->groups[k].element_count;
    }
    int64_t group_numbers = (int64_t)mesh->group_count * (HEADS + NAME_NUMBERS);
    const int64_t counts[COUNTS] = {
        mesh->node_count, mesh->element_count, ends, mesh->group_count, edges, nodes, elements};
    copies.room = NEW_ARRAY(double,
                            COUNTS + (mesh->dim + 1) * (int64_t)mesh->node_count +
                                2 * (int64_t)mesh->element_count + ends + edges + nodes + elements +
                                group_numbers,
                            &err);
    if (!copies.room) return;
    copy_mesh(mesh, counts, &copies);
    cache_file_write(path, key, copies.arrays, copies.count, &err);
    memory_free(copies.room);
}
