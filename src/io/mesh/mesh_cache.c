// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh from the cache is checked like a file from elsewhere: indices are within their arrays,
// kinds exist, counts fit each other.
#include "io/mesh/mesh_cache.h"

#include "base/computation.h"
#include "base/memory.h"
#include "io/cache/store.h"
#include "io/files/text_file.h"
#include "io/mesh/element_faces.h"
#include "io/mesh/geo_parameters.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { OPTIONS_PATH_SIZE = 4096 };

bool mesh_source_hash(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                      Hash *hash, bool *whole, Error *err)
{
    // Words of gmsh 4's language that reach beyond the file and the parameters. They are looked for
    // in comments and strings too: a word too many costs a meshing, one too few an answer.
    static const char *const outside[] = {
        "Include",   "Merge",     "ShapeFromFile", "FileName",     "FileExists", "GetEnv",
        "GetString", "GetNumber", "GetValue",      "Onelab",       "SystemCall", "Today",
        "Cpu",       "Memory",    "CurrentDir",    "AbsolutePath", "Rand",       "Plugin"};
    bool is_geo = mesh_file_format(path) == MESH_SCRIPT;
    char *bytes = NULL, options[OPTIONS_PATH_SIZE];
    int32_t size = 0;
    TRY(text_file_bytes(path, GEO_BYTES_MAX, &bytes, &size, err));

    // gmsh reads FILE.opt whenever it opens FILE.
    int length = snprintf(options, sizeof options, "%s.opt", path);
    *whole = length < (int)sizeof options && access(options, F_OK) != 0;
    for (size_t k = 0; is_geo && k < sizeof outside / sizeof outside[0]; k++)
        *whole = *whole && !strstr(bytes, outside[k]);

    hash_text(hash, is_geo ? "geo" : "msh");
    hash_bytes(hash, bytes, (size_t)size);
    for (int32_t k = 0; k < parameter_count; k++) {
        hash_text(hash, parameters[k].name);
        hash_text(hash, parameters[k].text);
        hash_number(hash, parameters[k].value);
    }
cleanup:
    memory_free(bytes);
    return error_is_clean(err);
}

void mesh_file_hash(const MeshFile *mesh, Hash *hash)
{
    size_t nodes = (size_t)mesh->node_count, elements = (size_t)mesh->element_count;
    hash_bytes(hash, mesh->position, (size_t)mesh->dim * nodes * sizeof(double));
    hash_bytes(hash, mesh->kind, elements);
    hash_bytes(hash, mesh->element_nodes, (size_t)mesh->first_node[elements] * sizeof(int32_t));
    for (int32_t k = 0; k < mesh->group_count; k++) {
        const MeshGroup *group = &mesh->groups[k];
        size_t ends = (size_t)group->face_count * (size_t)group->nodes_per_face;
        hash_text(hash, group->name);
        hash_number(hash, group->dimension);
        hash_bytes(hash, group->face_nodes, ends * sizeof(int32_t));
        hash_bytes(hash, group->nodes, (size_t)group->node_count * sizeof(int32_t));
    }
}

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

void mesh_archive(void *self, Archive *archive)
{
    MeshFile *mesh = self;
    archive_length(archive, &mesh->dim);
    archive_length(archive, &mesh->node_count);
    archive_length(archive, &mesh->element_count);
    archive_require(archive, mesh->dim >= 2 && mesh->dim <= DIM_MAX);
    archive_new_numbers(archive, &mesh->position, (int64_t)mesh->dim * mesh->node_count);
    archive_new_counts(archive, &mesh->node_number, mesh->node_count);

    // Elements.
    int32_t count = mesh->element_count;
    archive_new_counts(archive, &mesh->element_number, count);
    archive_new_octets(archive, &mesh->kind, count, ELEMENT_KIND_COUNT);
    archive_new_indices(archive, &mesh->first_node, (int64_t)count + 1, 0, INT32_MAX);
    if (!archive->failed) {
        const int32_t *first = mesh->first_node;
        archive_require(archive, first[0] == 0);
        for (int32_t k = 0; archive_fills(archive) && k < count; k++)
            archive_require(archive, element_dim((ElementKind)mesh->kind[k]) == mesh->dim &&
                                         first[k + 1] - first[k] ==
                                             element_node_count((ElementKind)mesh->kind[k]));
        archive_new_indices(archive, &mesh->element_nodes, first[count], 0, mesh->node_count);
    }

    // Groups.
    archive_length(archive, &mesh->group_count);
    mesh->groups = archive_new(archive, mesh->groups, mesh->group_count, sizeof *mesh->groups);
    if (!mesh->groups) mesh->group_count = 0;
    for (int32_t g = 0; g < mesh->group_count; g++) {
        MeshGroup *group = &mesh->groups[g];
        archive_text(archive, group->name, sizeof group->name);
        archive_index(archive, &group->dimension, 0, mesh->dim + 1);
        archive_integer(archive, &group->number);
        archive_length(archive, &group->face_count);
        archive_index(archive, &group->nodes_per_face, 0, FACE_NODES_MAX + 1);
        archive_length(archive, &group->node_count);
        archive_length(archive, &group->element_count);
        archive_new_indices(archive, &group->face_nodes,
                            (int64_t)group->face_count * group->nodes_per_face,
                            mesh->dim == 2 ? 0 : -1, mesh->node_count);

        // The kinds that a face may have; what it has less than room is filled up.
        for (int32_t k = 0; archive_fills(archive) && k < group->face_count; k++) {
            int32_t ends = group->nodes_per_face;
            const int32_t *nodes = group->face_nodes + (int64_t)k * ends;
            while (ends > 0 && nodes[ends - 1] < 0) ends--;
            archive_require(archive, element_kind_of(mesh->dim - 1, ends) >= 0);
            for (int32_t a = 0; a < ends; a++) archive_require(archive, nodes[a] >= 0);
        }
        archive_new_indices(archive, &group->nodes, group->node_count, 0, mesh->node_count);
        archive_new_indices(archive, &group->elements, group->element_count, 0,
                            mesh->element_count);
    }
    archive_text(archive, mesh->warning, sizeof mesh->warning);
}

bool mesh_cache_load(const char *key, MeshFile *mesh, bool *found, Error *err)
{
    *mesh = (MeshFile){0};
    bool done = cache_load(&(CacheItem){CACHE_MESH, key, mesh_archive, mesh}, found, NULL, err);
    if (!*found) mesh_file_destroy(mesh);
    return done;
}

void mesh_cache_store(const char *key, const MeshFile *mesh)
{
    MeshFile same = *mesh;
    cache_store(&(CacheItem){CACHE_MESH, key, mesh_archive, &same}, NULL);
}
