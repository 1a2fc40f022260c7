// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh from the cache is checked like a file from elsewhere: indices are within their arrays,
// kinds exist, counts fit each other.
#include "io/mesh/mesh_cache.h"

#include "base/computation.h"
#include "io/cache/store.h"
#include "io/mesh/element_faces.h"
#include "io/mesh/mesh_source.h"

bool mesh_cache_key(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                    char key[HASH_TEXT_SIZE], Error *err)
{
    Hash hash = computation_hash();
    bool whole = false;
    key[0] = 0;
    if (!mesh_source_hash(path, parameters, parameter_count, &hash, &whole, err)) return false;
    if (whole) hash_write(&hash, key);
    return true;
}

static void archive_elements(MeshFile *mesh, Archive *archive)
{
    int32_t count = mesh->element_count;
    archive_new_counts(archive, &mesh->element_number, count);
    archive_new_octets(archive, &mesh->kind, count, ELEMENT_KIND_COUNT);
    archive_new_indices(archive, &mesh->first_node, (int64_t)count + 1, 0, INT32_MAX);
    if (archive->failed) return;
    const int32_t *first = mesh->first_node;
    archive_require(archive, first[0] == 0);
    for (int32_t k = 0; archive_fills(archive) && k < count; k++)
        archive_require(archive, element_dim((ElementKind)mesh->kind[k]) == mesh->dim &&
                                     first[k + 1] - first[k] ==
                                         element_node_count((ElementKind)mesh->kind[k]));
    archive_new_indices(archive, &mesh->element_nodes, first[count], 0, mesh->node_count);
}

// The kinds that a face may have; what it has less than room is filled up.
static void require_faces(const MeshGroup *group, const MeshFile *mesh, Archive *archive)
{
    for (int32_t k = 0; archive_fills(archive) && k < group->face_count; k++) {
        int32_t count = group->nodes_per_face;
        const int32_t *nodes = group->face_nodes + (int64_t)k * count;
        while (count > 0 && nodes[count - 1] < 0) count--;
        archive_require(archive, element_kind_of(mesh->dim - 1, count) >= 0);
        for (int32_t a = 0; a < count; a++) archive_require(archive, nodes[a] >= 0);
    }
}

static void archive_group(MeshGroup *group, const MeshFile *mesh, Archive *archive)
{
    archive_text(archive, group->name, sizeof group->name);
    archive_index(archive, &group->dimension, 0, mesh->dim + 1);
    archive_integer(archive, &group->number);
    archive_length(archive, &group->face_count);
    archive_index(archive, &group->nodes_per_face, 0, FACE_NODES_MAX + 1);
    archive_length(archive, &group->node_count);
    archive_length(archive, &group->element_count);
    archive_new_indices(archive, &group->face_nodes,
                        (int64_t)group->face_count * group->nodes_per_face, mesh->dim == 2 ? 0 : -1,
                        mesh->node_count);
    require_faces(group, mesh, archive);
    archive_new_indices(archive, &group->nodes, group->node_count, 0, mesh->node_count);
    archive_new_indices(archive, &group->elements, group->element_count, 0, mesh->element_count);
}

void mesh_archive(void *self, Archive *archive)
{
    MeshFile *mesh = self;
    archive_length(archive, &mesh->dim);
    archive_length(archive, &mesh->node_count);
    archive_length(archive, &mesh->element_count);
    archive_require(archive, mesh->dim >= 2 && mesh->dim <= DIM_MAX);
    archive_new_numbers(archive, &mesh->position, (int64_t)mesh->dim * mesh->node_count);
    archive_new_counts(archive, &mesh->node_number, mesh->node_count);
    archive_elements(mesh, archive);
    archive_length(archive, &mesh->group_count);
    mesh->groups = archive_new(archive, mesh->groups, mesh->group_count, sizeof *mesh->groups);
    if (!mesh->groups) mesh->group_count = 0;
    for (int32_t k = 0; k < mesh->group_count; k++) archive_group(&mesh->groups[k], mesh, archive);
    archive_text(archive, mesh->warning, sizeof mesh->warning);
}

bool mesh_cache_load(const char *key, MeshFile *mesh, bool *found, Error *err)
{
    *mesh = (MeshFile){0};
    bool done =
        cache_load(&(CacheItem){CACHE_MESH, key, mesh_archive, mesh}, NULL, found, NULL, err);
    if (!*found) mesh_file_destroy(mesh);
    return done;
}

void mesh_cache_store(const char *key, const MeshFile *mesh)
{
    MeshFile same = *mesh;
    cache_store(&(CacheItem){CACHE_MESH, key, mesh_archive, &same}, NULL);
}
