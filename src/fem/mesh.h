// SPDX-License-Identifier: GPL-2.0-or-later
// The mesh the solver works on: that of io/mesh/mesh_file, checked, with its named pieces of
// boundary: curves in the plane, surfaces in space. Used by fem/assembly (elements, tractions on
// boundaries) and contact/interface (the contact).
#ifndef AMONTONS_FEM_MESH_H
#define AMONTONS_FEM_MESH_H

#include "base/error.h"
#include "io/mesh/mesh_file.h"

#include <stdint.h>

enum { MESH_PATH_SIZE = 1024 };

// Coordinates of the mesh are those of the file times `scale`, plus `shift`.
typedef struct MeshMove {
    double scale;
    MeshPlace shift;   // length
    bool onto_floor;   // along z so that the lowest contact node is at z = 0
} MeshMove;

// Where a second body, the base, is the floor (fem/floor): the mean displacement of the floor under
// each contact node is a row of P. Of a rigid floor `start` is NULL.
typedef struct Floor {
    int32_t *start;   // [node_count of the mesh + 1] where a node's row begins; owned
    int32_t *node;   // [start[node_count]] nodes of the floor, ascending in a row; owned
    double *share;   // [start[node_count]] of P; each row adds up to 1; owned
    bool matches;   // each row is one node
} Floor;

// A node's row of P: empty unless it is a contact node over a base.
static inline int32_t floor_start(const Floor *floor, int32_t node)
{
    return floor->start ? floor->start[node] : 0;
}
static inline int32_t floor_end(const Floor *floor, int32_t node)
{
    return floor->start ? floor->start[node + 1] : 0;
}

// A checked mesh: every element counter-clockwise, with a positive Jacobian determinant at its
// nodes and quadrature points; every node on an element; no node twice in one element; no face on
// more than two elements, on one only where nothing lies behind it; every face of a boundary group
// is a face of an element, listed once; all elements in one part, or in
// that of the block and those of the base.
typedef struct Mesh {
    char path[MESH_PATH_SIZE];   // of the file, for messages
    char warning[MESH_WARNING_SIZE];   // MeshFile.warning
    int32_t dim;   // numbers of a place, and displacements of a node
    int32_t node_count;
    double *position;   // [node_count * dim] from x to z, length; owned
    int64_t *node_number;   // [node_count] gmsh's node tags, for messages; owned
    int32_t element_count;
    int64_t *element_number;   // [element_count] gmsh's element tags, for messages; owned
    uint8_t *kind;   // [element_count] ElementKind; owned
    int32_t *first_node;   // [element_count + 1] offsets into element_nodes; owned
    int32_t *element_nodes;   // [first_node[element_count]] corners, mid-sides, centre; owned
    uint8_t
        *region;   // [element_count] which of the materials it is made of (model/assemble); NULL:
    // there is one; owned
    int32_t *mean_next;   // [element_count] elements that share one areal strain, as rings: the
        // next of them, itself where it is alone; -1: it has its own at each point; NULL: all have
        // (fem/element_group); owned
    int32_t group_count;
    MeshGroup *groups;   // [group_count]; nodes by ascending x, ..., z; owned
    double x_min, x_max, y_min, y_max, z_min, z_max;   // extent of the block, without the base,
        // length; y: 0 in the plane
    uint8_t *is_base;   // [node_count] 1: of the base; NULL: there is none; owned
    Floor floor;   // its surface under the contact; owned
    MeshMove move;
} Mesh;

// Place of number d of a node, 0 along x, dim - 1 along z, in an array with `dim` numbers a node;
// and from there back to the node, and to d.
static inline int32_t node_dof(int32_t dim, int32_t node, int32_t d)
{
    return dim * node + d;
}
static inline int32_t dof_node(int32_t dim, int32_t dof)
{
    return dof / dim;
}
static inline int32_t dof_axis(int32_t dim, int32_t dof)
{
    return dof % dim;
}

// Coordinates of a node: [mesh->dim].
static inline const double *mesh_place(const Mesh *mesh, int32_t node)
{
    return mesh->position + (int64_t)mesh->dim * node;
}
static inline double mesh_height(const Mesh *mesh, int32_t node)
{
    return mesh_place(mesh, node)[mesh->dim - 1];
}

// Coordinates of nodes [count]: place [count]. Offsets are those from the first of them.
void mesh_places(const Mesh *mesh, const int32_t *nodes, int32_t count, MeshPlace *place);
void mesh_offsets(const Mesh *mesh, const int32_t *nodes, int32_t count, MeshPlace *offset);

// A number of order 1 on a grid of 2^-30, so that shapes drawn in other units have the same bits.
double put_on_grid(double value);
// A coordinate on it: over the block's length, along x from its trailing end.
double mesh_grid_place(const Mesh *mesh, int32_t node, int32_t axis);

// Sets the block's extent, without the base. A node on no element would change it, but is an error.
void mesh_find_extent(Mesh *mesh);

// "(0.5, 0)": a place in a message.
enum { PLACE_TEXT_SIZE = 64 };
const char *place_text(int32_t dim, const double *at, char text[PLACE_TEXT_SIZE]);
const char *mesh_place_text(const Mesh *mesh, int32_t node, char text[PLACE_TEXT_SIZE]);

// Distance of two nodes, length.
double mesh_distance(const Mesh *mesh, int32_t one, int32_t two);

// True if a node, or an element, is part of the base.
static inline bool mesh_in_base(const Mesh *mesh, int32_t node)
{
    return mesh->is_base && mesh->is_base[node];
}
static inline bool mesh_element_in_base(const Mesh *mesh, int32_t e)
{
    return mesh_in_base(mesh, mesh->element_nodes[mesh->first_node[e]]);
}

// Index of element e's material in a list of materials.
static inline int32_t mesh_region(const Mesh *mesh, int32_t e)
{
    return mesh->region ? mesh->region[e] : 0;
}

// Puts nodes [count] in order of ascending x, then y in space, then z.
void mesh_sort_nodes(const Mesh *mesh, int32_t *nodes, int32_t count);

// A named piece of boundary: a curve in the plane, a surface in space. Borrows from the mesh, owns
// nothing.
typedef struct MeshBoundary {
    const char *name;
    int32_t dim;   // of the mesh
    int32_t face_count;
    int32_t nodes_per_face;   // as in MeshGroup
    const int32_t *face_nodes;   // [face_count * nodes_per_face]
    int32_t node_count;
    const int32_t *nodes;   // [node_count] each once, by ascending x, ..., z
} MeshBoundary;

// Several pieces of contact as one list of nodes. A node of two of them is listed once and belongs
// to that named first.
typedef struct MeshContact {
    int32_t group_count;
    struct MeshPieces *groups;   // [group_count] their connected pieces (fem/mesh_contact); owned
    int32_t pad_count;
    MeshBoundary *pads;   // [pad_count] these, in the order of the names; owned
    int32_t node_count;
    int32_t *nodes;   // [node_count] by ascending x, then y in space; owned
    int32_t *pad_of;   // [node_count] index into pads; owned
} MeshContact;

// Takes the arrays of `file` over (it is empty afterwards, also on failure), checks and completes
// them. Elements that run clockwise (a surface was reversed in gmsh) are turned round. Errors
// (ERROR_INPUT) name `path` and where: an element whose Jacobian determinant is 0 or changes its
// sign, one that repeats a node, a node on no element, a face of three elements, elements on one
// side of their common face or of different order, a boundary group that does not follow the
// elements or lists a face twice, parts that share no node, a face of one element inside the block.
bool mesh_build(MeshFile *file, const char *path, Mesh *mesh, Error *err);
// The same, but parts that share no node with the block are no error where each has nodes of the
// boundary called `floor`: they are the base.
bool mesh_build_on_base(MeshFile *file, const char *path, const char *floor, Mesh *mesh,
                        Error *err);
void mesh_destroy(Mesh *mesh);

// The piece of boundary called `name`; a missing one or a group of another dimension is
// ERROR_INPUT.
bool mesh_boundary(const Mesh *mesh, const char *name, MeshBoundary *boundary, Error *err);

// The contact from boundaries called `names` [name_count]; no names: every one called "contact"
// or "contact_...", in the order of their first nodes. One of several connected pieces is as many
// pads, "contact/1", "contact/2", ... Each must lie over z = 0 and one
// node on it, no node straight over another, on the block's boundary and in space looking down, no
// two on the same face, and the block not below z = 0: ERROR_INPUT names group and node.
bool mesh_contact(const Mesh *mesh, const char (*names)[GROUP_NAME_SIZE], int32_t name_count,
                  MeshContact *contact, Error *err);
// A name that is taken for the contact's where a scene gives none.
bool mesh_is_contact_name(const char *name);
// True if `name` is `group` or a piece of it: of several "NAME/1", "NAME/2", ...
bool mesh_piece_is_of(const char *name, const char *group);

// Puts a mesh that stands as its file has it where it is wanted.
void mesh_move(double scale, const MeshPlace shift, Mesh *mesh);

// Moves the mesh along z so that the lowest node of its contact is at z = 0; one that stands there
// up to rounding is not moved. names: as of mesh_contact. ERROR_INPUT: there is no contact of such
// a name.
bool mesh_stand_on_floor(const char (*names)[GROUP_NAME_SIZE], int32_t name_count, Mesh *mesh,
                         Error *err);

// Words for how it was moved; empty: not at all.
enum { MOVE_TEXT_SIZE = 160 };
const char *mesh_move_text(const Mesh *mesh, char text[MOVE_TEXT_SIZE]);

// z of the floor under a contact node, length; 0 where it is rigid, or not found yet (fem/floor).
double mesh_floor_height(const Mesh *mesh, int32_t node);

// Height of a contact node over the floor, length; exactly 0 where only rounding is left.
double mesh_gap(const Mesh *mesh, int32_t node);
void mesh_contact_destroy(MeshContact *contact);

// The numbers that `amontons info` prints of a mesh.
typedef struct MeshSummary {
    int32_t element_counts[ELEMENT_KIND_COUNT];   // by ElementKind
    double area;   // length^2; in space the volume, length^3
    double edge_min, edge_max;   // straight distances between corners, length
    double aspect_max;   // longest over shortest edge of one element
    int32_t aspect_worst;   // the element that has it
} MeshSummary;
MeshSummary mesh_summarise(const Mesh *mesh);
double mesh_element_area(const Mesh *mesh, int32_t e);   // length^2; in space its volume

#endif
