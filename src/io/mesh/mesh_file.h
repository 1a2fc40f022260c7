// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh as it stands in a file: plain arrays, no physics. Read through the gmsh C API, which is a
// module opened on first use. Called by model/assemble and run/info/info; checked by
// fem/mesh_build.
#ifndef AMONTONS_IO_MESH_MESH_FILE_H
#define AMONTONS_IO_MESH_MESH_FILE_H

#include "base/child_process.h"
#include "base/error.h"

#include <stdint.h>

// kind, dimension, nodes, corners among them, gmsh's type, VTK's, name. Node order is gmsh's:
// corners, mid-sides, faces, centre. Those of one dimension are faces of a mesh in the plane.
#define ELEMENT_KINDS(X)                                                                           \
    X(ELEMENT_T3, 2, 3, 3, 2, 5, "T3")                                                             \
    X(ELEMENT_T6, 2, 6, 3, 9, 22, "T6")                                                            \
    X(ELEMENT_Q4, 2, 4, 4, 3, 9, "Q4")                                                             \
    X(ELEMENT_Q8, 2, 8, 4, 16, 23, "Q8")                                                           \
    X(ELEMENT_Q9, 2, 9, 4, 10, 28, "Q9")                                                           \
    X(ELEMENT_L2, 1, 2, 2, 1, 3, "L2")                                                             \
    X(ELEMENT_L3, 1, 3, 2, 8, 21, "L3")                                                            \
    X(ELEMENT_TET4, 3, 4, 4, 4, 10, "TET4")                                                        \
    X(ELEMENT_TET10, 3, 10, 4, 11, 24, "TET10")                                                    \
    X(ELEMENT_WEDGE6, 3, 6, 6, 6, 13, "WEDGE6")                                                    \
    X(ELEMENT_HEX8, 3, 8, 8, 5, 12, "HEX8")                                                        \
    X(ELEMENT_HEX27, 3, 27, 8, 12, 29, "HEX27")

typedef enum ElementKind {
#define X(kind, ...) kind,
    ELEMENT_KINDS(X) ELEMENT_KIND_COUNT
#undef X
} ElementKind;

enum { GROUP_NAME_SIZE = 64, ELEMENT_NODES_MAX = 27, DIM_MAX = 3, MESH_WARNING_SIZE = 300 };

// x to z in as many numbers as the mesh has dimensions: (x, z) in the plane, (x, y, z) in space.
typedef double MeshPlace[DIM_MAX];

// One physical group: of points (dimension 0), curves (1), surfaces (2) or volumes (3). Of the
// mesh's own dimension it is a region, of one less a piece of boundary, made of faces.
typedef struct MeshGroup {
    char name[GROUP_NAME_SIZE];   // where the mesh gives none: the physical number in decimal;
    // groups of different dimension may share name and number
    int32_t dimension;   // 0 to 3
    int32_t number;   // gmsh's physical tag
    int32_t face_count;   // 0 unless it is a piece of boundary
    int32_t nodes_per_face;   // room for each: where kinds are mixed the last of some are -1
    int32_t *face_nodes;   // [face_count * nodes_per_face] node indices; owned
    int32_t node_count;
    int32_t *nodes;   // [node_count] ascending, each once; empty for regions; owned
    int32_t element_count;   // 0 unless it is a region
    int32_t *elements;   // [element_count] of the mesh, ascending; owned
} MeshGroup;

// Made by gmsh now, or before (io/mesh/mesh_cache); or of files that it says itself, so that it is
// made anew each time.
typedef enum MeshOrigin { MESH_OF_GMSH, MESH_OF_CACHE, MESH_OF_OTHER_FILES } MeshOrigin;

typedef struct MeshFile {
    MeshOrigin origin;
    int32_t dim;   // numbers of a place
    int32_t node_count;
    double *position;   // [node_count * dim] (x, z), gmsh's x and y; in space gmsh's x, y and z;
        // length; owned
    int64_t *node_number;   // [node_count] gmsh's node tags, for messages; owned
    int32_t element_count;
    int64_t *element_number;   // [element_count] gmsh's element tags, for messages; owned
    uint8_t *kind;   // [element_count] ElementKind; owned
    int32_t *first_node;   // [element_count + 1] offsets into element_nodes; owned
    int32_t *element_nodes;   // [first_node[element_count]] node indices; owned
    int32_t group_count;
    MeshGroup *groups;   // [group_count] by dimension, then by number; owned
    char warning[MESH_WARNING_SIZE];   // an error of gmsh after which it made a mesh; empty: none
} MeshFile;

// Format by the ending of a file's name, in small or capital letters; gmsh's own endings are .msh2,
// .msh4 and .geo_unrolled.
typedef enum MeshFormat { MESH_NO_FORMAT, MESH_MSH, MESH_SCRIPT } MeshFormat;
MeshFormat mesh_file_format(const char *path);
// Advice how another program's file becomes a mesh: the end of a message, empty where there is
// none.
const char *mesh_format_advice(const char *path);

// A value for one name of a .geo: `DefineConstant[ nx = 80 ]` takes what is given here instead.
typedef struct MeshParameter {
    char name[GROUP_NAME_SIZE];
    double value;
    char text[GROUP_NAME_SIZE];   // non-empty: a string parameter, and `value` is not looked at
} MeshParameter;

// The parameter `refine` (cells so many times as small) is known to every mesh: where a .geo does
// not declare it itself, gmsh halves all edges, so that it must be a power of two.
//
// Reads `path`: .msh (4.1 or 2.2, ASCII or binary), or .geo meshed with `parameters`: where it has
// a volume in 3D, else in 2D. A .geo that has made such a mesh itself keeps it; Mesh.ScalingFactor
// and Mesh.SaveAll of a .geo count as where gmsh writes a mesh. trusted: a .geo may do what gmsh
// can (run commands, write files, open others); else what io/mesh/geo_script allows. Errors
// (ERROR_INPUT) name the file: missing, truncated, not a mesh, no elements, an element kind that is
// not in ELEMENT_KINDS, a parameter the .geo does not know, a name that two
// groups of one dimension have. A mesh without volumes that is not in the plane z = 0 of gmsh is
// refused. watch: may end gmsh where it works in a child process; NULL: nobody. *mesh is destroyed
// by the caller.
bool mesh_file_read(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                    bool trusted, const ChildWatch *watch, MeshFile *mesh, Error *err);
void mesh_file_destroy(MeshFile *mesh);

// The group called `name`. An error (ERROR_INPUT) names `path`, lists the groups that exist with
// their dimension, and suggests the nearest name. `dimension`: the one wanted.
const MeshGroup *mesh_file_group(const MeshFile *mesh, const char *path, const char *name,
                                 int32_t dimension, Error *err);

// A row of ELEMENT_KINDS.
typedef struct ElementInfo {
    int32_t dim, node_count, corner_count;
    int32_t gmsh_type;
    uint8_t vtk_type;
    const char *name;   // "Q4"; static storage
} ElementInfo;

extern const ElementInfo ELEMENTS[ELEMENT_KIND_COUNT];

static inline int32_t element_dim(ElementKind kind)
{
    return ELEMENTS[kind].dim;
}
static inline int32_t element_node_count(ElementKind kind)
{
    return ELEMENTS[kind].node_count;
}
static inline int32_t element_corner_count(ElementKind kind)
{
    return ELEMENTS[kind].corner_count;
}
// Number of the element's node that VTK has in place k.
int32_t element_vtk_node(ElementKind kind, int32_t k);

#endif
