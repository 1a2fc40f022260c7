// SPDX-License-Identifier: GPL-2.0-or-later
// Contact nodes come from the mesh's contact boundaries (fem/mesh_contact: one a pad), rod nodes
// from the strip of the face that is named. Weights are lumped: w_i is the integral of node i's
// shape function over its boundary, so that a pressure field p gives the nodal force p_i w_i
// (consistent integration gave a resultant 17 % wrong).
#include "contact/interface.h"

#include "base/memory.h"
#include "fem/assembly.h"
#include "fem/mesh_faces.h"

#include <math.h>
#include <stdio.h>

// Largest distance of a rod node from the strip, relative to the block's height: rounding only.
static const double STRIP_TOLERANCE = 1e-9;
static const double LINE_ROUNDING =
    1e-6;   // of places along the contact, over the length of a cell

// Below that a node has no weight: the integral is 0 but for rounding.
static double least_weight(const Mesh *mesh, const double *weight)
{
    static const double ROUNDING = 1e-9;   // over the largest
    double largest = 0;
    for (int32_t i = 0; i < mesh->node_count; i++) largest = fmax(largest, weight[i]);
    return ROUNDING * largest;
}

// The line is on a grid the row of nodes nearest to the middle; elsewhere the nodes of a strip
// around it, as wide as a mean cell is long.
bool interface_find_line(Interface *interface, Error *err)
{
    double area = 0;
    if (!interface->y) return true;
    interface->line = NEW_ARRAY(int32_t, interface->contact_count, err);
    if (!interface->line) return false;
    for (int32_t i = 0; i < interface->contact_count; i++) area += interface->weight[i];
    double cell = sqrt(area / interface->contact_count), rounding = LINE_ROUNDING * cell;

    // y of the node nearest to the middle, of several as near the first.
    double low = INFINITY, high = -INFINITY, place = INFINITY;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        low = fmin(low, interface->y[i]);
        high = fmax(high, interface->y[i]);
    }
    double middle = 0.5 * (low + high);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double nearer = fabs(place - middle) - fabs(interface->y[i] - middle);
        if (nearer > rounding) place = interface->y[i];
    }

    // Go along x, and take of nodes side by side the one that is nearer to it.
    interface->line_count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t *last = interface->line + interface->line_count - 1;
        double off = fabs(interface->y[i] - place);
        if (off > 0.5 * cell + rounding) continue;
        bool beside = interface->line_count > 0 &&
                      interface->x[i] - interface->x[*last] <= rounding;
        if (!beside)
            interface->line[interface->line_count++] = i;
        else if (off < fabs(interface->y[*last] - place))
            *last = i;
    }
    return true;
}

// Fills all that belongs to the contact: nodes by ascending x, places, weights, pads and their
// names. On failure what was made so far stays in *interface, for interface_destroy.
static bool build_contact(const Mesh *mesh, const InterfaceDef *def, Interface *interface,
                          Error *err)
{
    MeshContact contact = {0};
    double *weight = NEW_ARRAY(double, mesh->node_count, err);
    if (!weight) goto cleanup;
    TRY(mesh_contact(mesh, def->contact_names, def->contact_name_count, &contact, err));
    for (int32_t c = 0; c < contact.pad_count; c++)
        boundary_add_weights(mesh, &contact.pads[c], true, weight);

    // Nodes without weight leave the list.
    double least = least_weight(mesh, weight);
    int32_t count = 0;
    for (int32_t i = 0; i < contact.node_count; i++) {
        if (weight[contact.nodes[i]] < least) continue;
        contact.nodes[count] = contact.nodes[i];
        contact.pad_of[count++] = contact.pad_of[i];
    }
    contact.node_count = count;
    interface->contact_count = count;
    interface->pad_count = contact.pad_count;
    interface->node = NEW_ARRAY(int32_t, count, err);
    interface->x = NEW_ARRAY(double, count, err);
    interface->weight = NEW_ARRAY(double, count, err);
    if (mesh->dim > 2) interface->y = NEW_ARRAY(double, count, err);
    interface->pad = NEW_ARRAY(int32_t, count, err);
    interface->pad_name = memory_array(contact.pad_count, sizeof *interface->pad_name, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t c = 0; c < contact.pad_count; c++)
        snprintf(interface->pad_name[c], GROUP_NAME_SIZE, "%s", contact.pads[c].name);
    bool flat = true;
    for (int32_t i = 0; i < count; i++) {
        int32_t node = contact.nodes[i];
        flat = flat && mesh_gap(mesh, node) == 0;
        interface->node[i] = node;
        interface->x[i] = mesh_place(mesh, node)[0];
        if (interface->y) interface->y[i] = mesh_place(mesh, node)[1];
        interface->weight[i] = weight[node];
        interface->pad[i] = contact.pad_of[i];
    }
    TRY(interface_find_line(interface, err));
    TRY(contact_faces_build(mesh, &contact, &interface->faces, err));
    if (!flat && (interface->gap = NEW_ARRAY(double, count, err)))
        for (int32_t i = 0; i < count; i++) interface->gap[i] = mesh_gap(mesh, interface->node[i]);
cleanup:
    memory_free(weight);
    mesh_contact_destroy(&contact);
    return error_is_clean(err);
}

// The face that the rod touches, by ascending z of its nodes. Each has a tributary part that
// reaches half way to the nodes beside it on the face, along z and, where the strip has a breadth,
// along y.
typedef struct Face {
    int32_t count;
    int32_t *node;   // [count]; owned
    double *from[2], *to[2];   // [count] bounds of the tributary parts along z and y, length; owned
    double *area;   // [nodes of the mesh] integral of the shape function; owned
    double rounding;   // of a place, length
} Face;

// Widens the tributary part of each node along an axis by those beside it on its faces. place:
// [nodes of the mesh] in the face's list.
static void find_tributary_parts(const Mesh *mesh, const MeshBoundary *boundary, int32_t axis,
                                 const int32_t *place, Face *face)
{
    int32_t which = axis == mesh->dim - 1 ? 0 : 1;
    double *from = face->from[which], *to = face->to[which];
    for (int32_t k = 0; k < face->count; k++)
        from[k] = to[k] = mesh_place(mesh, face->node[k])[axis];
    for (int32_t f = 0; f < boundary->face_count; f++) {
        FaceNodes nodes = mesh_boundary_face(boundary, f);
        for (int32_t a = 0; a < element_node_count(nodes.kind); a++) {
            double here = mesh_place(mesh, nodes.node[a])[axis], below = -INFINITY,
                   above = INFINITY;
            for (int32_t b = 0; b < element_node_count(nodes.kind); b++) {
                double there = mesh_place(mesh, nodes.node[b])[axis];
                if (there < here - face->rounding) below = fmax(below, there);
                if (there > here + face->rounding) above = fmin(above, there);
            }
            int32_t k = place[nodes.node[a]];
            if (isfinite(below)) from[k] = fmin(from[k], 0.5 * (below + here));
            if (isfinite(above)) to[k] = fmax(to[k], 0.5 * (here + above));
        }
    }
}

static bool face_build(const Mesh *mesh, const MeshBoundary *boundary, Face *face, Error *err)
{
    int32_t *place = NEW_ARRAY(int32_t, mesh->node_count, err);
    *face = (Face){.count = boundary->node_count,
                   .rounding = STRIP_TOLERANCE * (mesh->z_max - mesh->z_min)};
    face->node = NEW_ARRAY(int32_t, face->count, err);
    face->area = NEW_ARRAY(double, mesh->node_count, err);
    for (int k = 0; k < 2; k++) {
        face->from[k] = NEW_ARRAY(double, face->count, err);
        face->to[k] = NEW_ARRAY(double, face->count, err);
    }
    if (!error_is_clean(err)) goto cleanup;

    // Insertion sort: a face of n nodes costs n^2/4 moves at the worst, nothing beside meshing.
    for (int32_t k = 0; k < boundary->node_count; k++) {
        double z = mesh_height(mesh, boundary->nodes[k]);
        int32_t j = k;
        for (; j > 0 && mesh_height(mesh, face->node[j - 1]) > z; j--)
            face->node[j] = face->node[j - 1];
        face->node[j] = boundary->nodes[k];
    }
    for (int32_t k = 0; k < face->count; k++) place[face->node[k]] = k;
    for (int32_t axis = 1; axis < mesh->dim; axis++)
        find_tributary_parts(mesh, boundary, axis, place, face);
    boundary_add_weights(mesh, boundary, false, face->area);
cleanup:
    memory_free(place);
    return error_is_clean(err);
}

// The rod's strip: its range along z and, in space, along y.
typedef struct Strip {
    double low[2], high[2];   // length
    bool in_part;
} Strip;

// Share of node k's tributary part of the face, along one of the axes, that lies in the strip, 0 to
// 1. Without in_part a node is in or out: 1 or 0.
static double strip_share(const Mesh *mesh, const Strip *strip, const Face *face, int32_t k,
                          int32_t which)
{
    double at = mesh_place(mesh, face->node[k])[which == 0 ? mesh->dim - 1 : 1];
    double low = strip->low[which], high = strip->high[which], rounding = face->rounding;
    double from = face->from[which][k], to = face->to[which][k];
    bool level = to - from <= rounding;   // a face along x
    if (level || !strip->in_part) return at >= low - rounding && at <= high + rounding;
    double covered = fmin(to, high) - fmax(from, low);
    if (covered <= rounding) return 0;
    return covered >= to - from - rounding ? 1 : covered / (to - from);
}

// Lists the nodes of the face that lie in the strip. A node of the contact is left out, as the
// plane holds it.
static bool build_rod(const Mesh *mesh, const InterfaceDef *def, Interface *interface, Error *err)
{
    if (!def->has_rod) return true;
    MeshBoundary boundary;
    Face face = {0};
    TRY(mesh_boundary(mesh, def->rod_name, &boundary, err));
    interface->rod_node = NEW_ARRAY(int32_t, boundary.node_count, err);
    interface->rod_z = NEW_ARRAY(double, boundary.node_count, err);
    interface->rod_share = NEW_ARRAY(double, boundary.node_count, err);
    if (mesh->dim > 2) {
        interface->rod_y = NEW_ARRAY(double, boundary.node_count, err);
        interface->rod_length = NEW_ARRAY(double, boundary.node_count, err);
    }
    if (!error_is_clean(err)) goto cleanup;
    TRY(face_build(mesh, &boundary, &face, err));
    interface->rod_face[0] = mesh_height(mesh, face.node[0]);
    interface->rod_face[1] = mesh_height(mesh, face.node[face.count - 1]);

    // The strip: all of the face along y, unless the scene says how much of it.
    Strip strip = {.low = {def->rod_height - 0.5 * def->rod_width, -INFINITY},
                   .high = {def->rod_height + 0.5 * def->rod_width, INFINITY},
                   .in_part = def->rod_in_part};
    if (def->rod_whole) strip.low[0] = -INFINITY, strip.high[0] = INFINITY;
    if (def->rod_breadth > 0 && mesh->dim > 2) {
        double low = INFINITY, high = -INFINITY;
        for (int32_t k = 0; k < face.count; k++) {
            low = fmin(low, mesh_place(mesh, face.node[k])[1]);
            high = fmax(high, mesh_place(mesh, face.node[k])[1]);
        }
        strip.low[1] = 0.5 * (low + high - def->rod_breadth);
        strip.high[1] = 0.5 * (low + high + def->rod_breadth);
    }

    // Its nodes by ascending z. nearest: of those that may be led, the height next to the strip's.
    double least = least_weight(mesh, face.area), nearest = INFINITY;
    for (int32_t k = 0; k < face.count; k++) {
        int32_t node = face.node[k];
        double z = mesh_height(mesh, node);
        bool in_contact = false;
        for (int32_t i = 0; i < interface->contact_count; i++)
            in_contact = in_contact || interface->node[i] == node;
        if (in_contact || face.area[node] < least) continue;
        if (fabs(z - def->rod_height) < fabs(nearest - def->rod_height)) nearest = z;
        double up = strip_share(mesh, &strip, &face, k, 0);
        double across = mesh->dim > 2 ? strip_share(mesh, &strip, &face, k, 1) : 1;
        if (up * across == 0) continue;
        int32_t j = interface->rod_count++;
        interface->rod_node[j] = node;
        interface->rod_z[j] = z;
        interface->rod_share[j] = up * across;
        if (mesh->dim == 2) continue;
        // Extent along the end that it is at, the upper and lower ones unless it is at none.
        double height = face.to[0][k] - face.from[0][k];
        bool at_side = up == 1 && across < 1;
        interface->rod_y[j] = mesh_place(mesh, node)[1];
        interface->rod_length[j] = at_side ? height : face.area[node] / height;
    }

    if (interface->rod_count == 0 && isinf(nearest))
        FAIL(err, ERROR_INPUT,
             "%s: the rod has nothing to push: all nodes of group \"%s\" are nodes of the contact "
             "as "
             "well, which the floor holds; give the rod a face of its own (groups.rod)",
             mesh->path, def->rod_name);
    if (interface->rod_count == 0)
        FAIL(err, ERROR_INPUT,
             "%s: no node of group \"%s\" lies in the rod's strip %g <= z <= %g; the nearest is at "
             "z = %g: widen rod.width, move rod.height or refine the mesh",
             mesh->path, def->rod_name, def->rod_height - 0.5 * def->rod_width,
             def->rod_height + 0.5 * def->rod_width, nearest);
cleanup:
    memory_free_all(face.node, face.area);
    memory_free_all(face.from[0], face.to[0], face.from[1], face.to[1]);
    return error_is_clean(err);
}

// *interface is overwritten.
bool interface_build(const Mesh *mesh, const InterfaceDef *def, Interface *interface, Error *err)
{
    *interface = (Interface){.dim = mesh->dim};
    if (!build_contact(mesh, def, interface, err)) return false;
    if (!build_rod(mesh, def, interface, err)) return false;
    interface->count = interface_rod(interface, interface->rod_count);
    if (!(interface->dofs = NEW_ARRAY(int32_t, interface->count, err))) return false;
    for (int32_t i = 0; i < interface->contact_count; i++)
        for (int32_t d = 0; d < mesh->dim; d++)
            interface->dofs[interface_unknown(interface, i, d)] =
                node_dof(mesh->dim, interface->node[i], d);
    for (int32_t j = 0; j < interface->rod_count; j++)
        interface->dofs[interface_rod(interface, j)] =
            node_dof(mesh->dim, interface->rod_node[j], 0);
    return true;
}

// In space they are as many as cells with the area of its mean cell, if square, would stand along
// the contact.
double interface_nodes_along(const Interface *interface)
{
    double from[2] = {INFINITY, INFINITY}, to[2] = {-INFINITY, -INFINITY};
    if (interface->dim == 2) return interface->contact_count;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        const double place[] = {interface->x[i], interface->y[i]};
        for (int d = 0; d < 2; d++) {
            from[d] = fmin(from[d], place[d]);
            to[d] = fmax(to[d], place[d]);
        }
    }
    return sqrt(interface->contact_count * (to[0] - from[0]) / (to[1] - from[1]));
}

void interface_destroy(Interface *interface)
{
    memory_free_all(interface->node, interface->x, interface->weight, interface->gap,
                    interface->pad, interface->pad_name);
    contact_faces_destroy(&interface->faces);
    memory_free_all(interface->rod_node, interface->y, interface->line, interface->rod_z,
                    interface->rod_y, interface->rod_length, interface->rod_share, interface->dofs);
    *interface = (Interface){0};
}
