// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/mesh/mesh_file.h"

#include "base/memory.h"
#include "base/text.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { LIST_SIZE = 1200 };   // of the list of groups in a message; what is longer is cut

const ElementInfo ELEMENTS[] = {
#define X(symbol, dim, nodes, corners, gmsh, vtk, name) {dim, nodes, corners, gmsh, vtk, name},
    ELEMENT_KINDS(X)
#undef X
};

int32_t element_vtk_node(ElementKind kind, int32_t k)
{
    static const uint8_t mid_sides[] = {8,  11, 13, 9,  16, 18, 19, 17, 10, 12,
                                        14, 15, 22, 23, 21, 24, 20, 25, 26};
    static const uint8_t outwards[] = {0, 2, 1, 3, 5, 4};   // VTK's wedge begins seen from outside
    if (kind == ELEMENT_TET10 && k >= 8) return 17 - k;
    if (kind == ELEMENT_WEDGE6) return outwards[k];
    return kind == ELEMENT_HEX27 && k >= 8 ? mid_sides[k - 8] : k;
}

void mesh_file_destroy(MeshFile *mesh)
{
    for (int32_t k = 0; k < mesh->group_count; k++) {
        memory_free_all(mesh->groups[k].face_nodes, mesh->groups[k].nodes,
                        mesh->groups[k].elements);
    }
    memory_free_all(mesh->position, mesh->node_number, mesh->element_number, mesh->kind,
                    mesh->first_node, mesh->element_nodes, mesh->groups);
    *mesh = (MeshFile){0};
}

// --- which files are meshes ---------------------------------------------------------------------

static bool is_one_of(const char *ending, const char *const *endings)
{
    while (*endings && strcasecmp(ending, *endings) != 0) endings++;
    return *endings != NULL;
}

static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return dot ? dot : "";
}

MeshFormat mesh_file_format(const char *path)
{
    static const char *const meshes[] = {".msh", ".msh2", ".msh4", NULL};
    static const char *const scripts[] = {".geo", ".geo_unrolled", NULL};
    const char *ending = ending_of(path);
    return is_one_of(ending, meshes)    ? MESH_MSH
           : is_one_of(ending, scripts) ? MESH_SCRIPT
                                        : MESH_NO_FORMAT;
}

const char *mesh_format_advice(const char *path)
{
    static const char *const parts[] = {".step", ".stp", NULL};
    static const char *const meshes[] = {".vtk",  ".vtu", ".med", ".inp", ".unv",  ".bdf", ".nas",
                                         ".mesh", ".exo", ".e",   ".xml", ".xdmf", ".stl", NULL};
    return is_one_of(ending_of(path), parts)
               ? "; a STEP file is meshed by meshes/step3d.geo: mesh: {file: meshes/step3d.geo, "
                 "set: {file: /absolute/path/of/it}}"
           : is_one_of(ending_of(path), meshes)
               ? "; gmsh and meshio make a .msh of most other formats (gmsh FILE -save -format "
                 "msh22 -o FILE.msh; meshio convert FILE FILE.msh)"
               : "";
}

// --- groups -------------------------------------------------------------------------------------

// The group of this name and dimension (-1: of any); NULL: none. gmsh counts groups by dimension,
// so those of different dimension may have the same name.
static const MeshGroup *find_group(const MeshFile *mesh, const char *name, int32_t dimension)
{
    for (int32_t k = 0; k < mesh->group_count; k++)
        if ((dimension < 0 || mesh->groups[k].dimension == dimension) &&
            strcmp(mesh->groups[k].name, name) == 0)
            return &mesh->groups[k];
    return NULL;
}

// dimension: 0 point, 1 curve, 2 surface.
const MeshGroup *mesh_file_group(const MeshFile *mesh, const char *path, const char *name,
                                 int32_t dimension, Error *err)
{
    static const char *const words[] = {"point", "curve", "surface", "volume"};
    const MeshGroup *group = find_group(mesh, name, dimension);
    const char **names = NULL;
    char list[LIST_SIZE] = "none", hint[GROUP_NAME_SIZE + 32] = "";
    size_t length = 0;
    if (group) return group;

    // "'body' (surface), 'contact' (curve)".
    for (int32_t k = 0; k < mesh->group_count && length < LIST_SIZE; k++)
        length += (size_t)snprintf(list + length, LIST_SIZE - length, "%s'%s' (%s)", k ? ", " : "",
                                   mesh->groups[k].name, words[mesh->groups[k].dimension & 3]);
    if ((group = find_group(mesh, name, -1)))
        FAIL(err, ERROR_INPUT, "%s: group '%s' is a %s, wanted is a %s; the groups are: %s", path,
             name, words[group->dimension & 3], words[dimension & 3], list);
    if (!(names = NEW_ARRAY(const char *, mesh->group_count, err))) goto cleanup;
    for (int32_t k = 0; k < mesh->group_count; k++) names[k] = mesh->groups[k].name;
    int32_t nearest = text_nearest(name, names, mesh->group_count);
    if (nearest >= 0) snprintf(hint, sizeof hint, "; did you mean '%s'?", names[nearest]);
    FAIL(err, ERROR_INPUT, "%s: has no group '%s'; the groups are: %s%s", path, name, list, hint);
cleanup:
    memory_free(names);
    return NULL;
}
