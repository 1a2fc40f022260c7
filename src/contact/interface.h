// SPDX-License-Identifier: GPL-2.0-or-later
// Where the block meets the world: contact nodes over the rigid plane z = 0, on it or with a gap,
// each straight above its place (right where slopes are small), and rod nodes on the
// trailing face. Nodes of no weight, the corners of T6 faces, touch nothing: a pressure has no
// nodal force there, and the mid-sides are the points of a rule that integrates to second order.
// Lumped (nodal): one weight and one vector of reaction a contact node. Consistent integration of
// the contact gave a 17 % wrong resultant in a static test.
//
// Interface unknowns, in this order: u_x to u_z of contact node 0, of node 1, ...; u_x of the rod
// nodes. Used by contact/contact_problem, stepping/ and run/.
#ifndef AMONTONS_CONTACT_INTERFACE_H
#define AMONTONS_CONTACT_INTERFACE_H

#include "contact/contact_faces.h"
#include "fem/mesh.h"

typedef struct Interface {
    int32_t dim;   // unknowns of a contact node: its tangents, then its normal
    int32_t contact_count;
    int32_t *node;   // [contact_count] mesh node, ascending x, then y; owned
    double *x;   // [contact_count] position along the drive, length; owned
    double *y;   // [contact_count] across it, length; NULL in the plane; owned
    double *weight;   // [contact_count] integral of the shape function, length, in space length^2;
        // owned
    double *gap;   // [contact_count] over the substrate before anything moves, length; NULL: 0
        // everywhere; owned
    int32_t *pad;   // [contact_count] which connected piece of the contact, from 0; owned
    int32_t pad_count;
    char (*pad_name)[GROUP_NAME_SIZE];   // [pad_count] of its boundary (fem/mesh_contact); owned
    int32_t line_count;
    int32_t *line;   // [line_count] contact nodes one behind the other along the drive, in space
        // along the middle: fronts and how far slip reaches are read off it; NULL: all of them;
        // owned
    ContactFaces faces;   // what the contact is drawn by, in space; owned
    int32_t rod_count;
    int32_t *rod_node;   // [rod_count] mesh node, ascending z, then y; owned
    double *rod_z;   // [rod_count] height, length; owned
    double *rod_y;   // [rod_count] across the drive, length; NULL in the plane; owned
    double *rod_share;   // [rod_count] in (0, 1]: share of the node's tributary part of the face,
        // half way to its neighbours, that lies in the strip; owned
    double
        *rod_length;   // [rod_count] how long the strip's end is at the node, length; NULL in the
    // plane, where it is the unit width; owned
    double rod_face[2];   // from which z to which the whole face reaches, length
    int32_t count;   // dim * contact_count + rod_count
    int32_t *dofs;   // [count] unknowns of the bulk; owned
} Interface;

typedef struct InterfaceDef {
    int32_t contact_name_count;   // 0: every boundary called contact or contact_...
    const char (*contact_names)[GROUP_NAME_SIZE];
    bool has_rod;
    const char *rod_name;
    bool rod_whole;   // the strip is all of the boundary
    double rod_height, rod_width;   // centre of the strip and its extent along z, length
    double rod_breadth;   // its extent along y around the face's middle, length; 0: all of it
    bool rod_in_part;   // nodes whose tributary part lies in the strip in part belong to it, with a
        // share; else those inside it, wholly
} InterfaceDef;

// The unknowns of contact node i, and of rod node j, within the interface. component: 0 along the
// drive, dim - 1 normal.
static inline int32_t interface_unknown(const Interface *interface, int32_t i, int32_t component)
{
    return interface->dim * i + component;
}
static inline int32_t interface_tangent(const Interface *interface, int32_t i)
{
    return interface_unknown(interface, i, 0);
}
static inline int32_t interface_normal(const Interface *interface, int32_t i)
{
    return interface_unknown(interface, i, interface->dim - 1);
}
static inline int32_t interface_rod(const Interface *interface, int32_t j)
{
    return interface->dim * interface->contact_count + j;
}

// The nodes of its line along the drive: how many, the contact node that is number k, and its x.
static inline int32_t interface_line_count(const Interface *interface)
{
    return interface->line ? interface->line_count : interface->contact_count;
}
static inline int32_t interface_line_node(const Interface *interface, int32_t k)
{
    return interface->line ? interface->line[k] : k;
}
static inline double interface_line_x(const Interface *interface, int32_t k)
{
    return interface->x[interface_line_node(interface, k)];
}

// Number of contact nodes along its length: all of them in the plane; in space as many as if cells
// were as long along the drive as across it.
double interface_nodes_along(const Interface *interface);

static inline double interface_gap(const Interface *interface, int32_t i)
{
    return interface->gap ? interface->gap[i] : 0;
}

// ERROR_INPUT: no such boundary, contact not on z = 0, no rod node inside the strip (says where the
// nearest are), or the strip misses the face. A rod node that is a contact node is left out: the
// plane holds it already.
bool interface_build(const Mesh *mesh, const InterfaceDef *def, Interface *interface, Error *err);
// Fills `line`, in space; places and weights of the nodes are there. Called by interface_build.
bool interface_find_line(Interface *interface, Error *err);
void interface_destroy(Interface *interface);

#endif
