// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh as gmsh's API delivers it, between the gmsh module (io/mesh/mesh_file_module) and
// io/mesh/mesh_read, which need not know gmsh's headers; and its conversion to a MeshFile.
#ifndef AMONTONS_IO_MESH_MESH_RAW_H
#define AMONTONS_IO_MESH_MESH_RAW_H

#include "base/error.h"
#include "io/mesh/mesh_file.h"

#include <stdint.h>

// The elements of one type on one geometrical entity (a point, curve, surface or volume).
typedef struct RawBlock {
    int32_t dimension, entity;   // of the entity; its tag
    int32_t gmsh_type;   // 3 quad4, ...
    int32_t nodes_per_element;
    char type_name[GROUP_NAME_SIZE];   // gmsh's: "Quadrilateral 4"
    int64_t count;
    int64_t *number;   // [count] element tags; owned
    int64_t *nodes;   // [count * nodes_per_element] node tags; owned
} RawBlock;

typedef struct RawGroup {
    int32_t dimension, number;   // physical tag
    char name[GROUP_NAME_SIZE];   // empty: none
    int32_t entity_count;
    int32_t *entities;   // [entity_count] tags of entities of that dimension; owned
} RawGroup;

typedef struct MeshRaw {
    int64_t node_count;
    int64_t *node_number;   // [node_count] tags; owned
    uint8_t *node_dimension;   // [node_count] of the entity the node is on; owned
    double *node_position;   // [node_count * 3]; owned
    int32_t block_count;
    RawBlock *blocks;   // [block_count]; owned
    int32_t group_count;
    RawGroup *groups;   // [group_count]; owned
    bool all_elements;   // Mesh.SaveAll of a .geo: those of no physical group belong to the mesh
    char warning[MESH_WARNING_SIZE];   // gmsh's first error, after which it made a whole mesh
} MeshRaw;

// Request to the module.
typedef struct MeshRawRequest {
    const char *path;   // of the file, for messages
    const char *opened_as;   // what gmsh opens in its place, by `descriptor`; NULL: nothing else
    int descriptor;   // -1: none
    const char *script;   // [script_size] the text of the .geo (io/mesh/geo_script); NULL: gmsh
        // reads the file
    int32_t script_size;
    bool trusted;   // the file may do what it wants: run commands, have options beside it
    bool generate;   // a .geo: mesh it, in 3D where it has a volume
    const MeshParameter *parameters;   // [parameter_count] all known to the .geo
    int32_t parameter_count;
    int32_t splits;   // so many times every edge is halved afterwards
    void (*opened)(void);   // called when the file is read and meshing begins; NULL: nobody
} MeshRawRequest;

// The module's entry: runs gmsh from start to finish, so that a second call finds it clean. Errors
// are gmsh's first message, with the file's name. *raw is destroyed by the caller.
typedef bool (*MeshRawReader)(const MeshRawRequest *request, MeshRaw *raw, Error *err);
bool amontons_gmsh_read(const MeshRawRequest *request, MeshRaw *raw, Error *err);

void mesh_raw_destroy(MeshRaw *raw);

// Picks the volume elements, where there are none the surface elements (where physical groups of
// that dimension exist: theirs, as gmsh does when it saves a mesh), the nodes and the groups. Nodes
// and elements are ordered by gmsh's tags, so that a .geo and the .msh made from it give the same
// arrays. Errors (ERROR_INPUT) name `path`.
bool mesh_raw_convert(const MeshRaw *raw, const char *path, MeshFile *mesh, Error *err);

#endif
