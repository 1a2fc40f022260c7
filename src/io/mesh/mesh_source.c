// SPDX-License-Identifier: GPL-2.0-or-later
// The words are those of gmsh 4's language that reach beyond the file and the parameters. They are
// looked for in comments and strings too: a word too many costs a meshing, one too few an answer.
#include "io/mesh/mesh_source.h"

#include "base/memory.h"
#include "io/files/text_file.h"
#include "io/mesh/geo_parameters.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { OPTIONS_PATH_SIZE = 4096 };

static const char *const OUTSIDE[] = {
    "Include",   "Merge",     "ShapeFromFile", "FileName",     "FileExists", "GetEnv",
    "GetString", "GetNumber", "GetValue",      "Onelab",       "SystemCall", "Today",
    "Cpu",       "Memory",    "CurrentDir",    "AbsolutePath", "Rand",       "Plugin"};

static bool reaches_outside(const char *text)
{
    for (size_t k = 0; k < sizeof OUTSIDE / sizeof OUTSIDE[0]; k++)
        if (strstr(text, OUTSIDE[k])) return true;
    return false;
}

// gmsh reads FILE.opt whenever it opens FILE.
static bool has_options(const char *path)
{
    char options[OPTIONS_PATH_SIZE];
    int length = snprintf(options, sizeof options, "%s.opt", path);
    return length >= (int)sizeof options || access(options, F_OK) == 0;
}

static bool is_geo(const char *path)
{
    return mesh_file_format(path) == MESH_SCRIPT;
}

bool mesh_source_hash(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                      Hash *hash, bool *whole, Error *err)
{
    char *bytes = NULL;
    int32_t size = 0;
    TRY(text_file_bytes(path, GEO_BYTES_MAX, &bytes, &size, err));
    *whole = !has_options(path) && (!is_geo(path) || !reaches_outside(bytes));
    hash_text(hash, is_geo(path) ? "geo" : "msh");
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
