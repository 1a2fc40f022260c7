// SPDX-License-Identifier: GPL-2.0-or-later
// Contact nodes come from the mesh's contact curves (fem/mesh_contact: one a pad), rod nodes from
// the strip of the face that is named. Weights are lumped: w_i is the integral of node i's shape
// function along its curve, so that a pressure field p gives the nodal force p_i w_i (consistent
// integration gave a resultant 17 % wrong).
#include "contact/interface.h"

#include "base/memory.h"
#include "fem/assembly.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// How far outside the strip a rod node may lie, relative to the block's height: rounding only.
static const double STRIP_TOLERANCE = 1e-9;

static bool is_flat(const Mesh *mesh, const MeshContact *contact)
{
    bool flat = true;
    for (int32_t i = 0; i < contact->node_count; i++)
        flat = flat && mesh_gap(mesh, contact->nodes[i]) == 0;
    return flat;
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
    for (int32_t c = 0; c < contact.curve_count; c++)
        curve_add_weights(mesh, &contact.curves[c], weight);
    int32_t count = contact.node_count;
    interface->contact_count = count;
    interface->pad_count = contact.curve_count;
    interface->node = NEW_ARRAY(int32_t, count, err);
    interface->x = NEW_ARRAY(double, count, err);
    interface->weight = NEW_ARRAY(double, count, err);
    interface->pad = NEW_ARRAY(int32_t, count, err);
    interface->pad_name = memory_array(contact.curve_count, sizeof *interface->pad_name, err);
    if (!interface->node || !interface->x || !interface->weight || !interface->pad ||
        !interface->pad_name)
        goto cleanup;
    for (int32_t c = 0; c < contact.curve_count; c++)
        snprintf(interface->pad_name[c], GROUP_NAME_SIZE, "%s", contact.curves[c].name);
    for (int32_t i = 0; i < count; i++) {
        int32_t node = contact.nodes[i];
        interface->node[i] = node;
        interface->x[i] = mesh_place(mesh, node)[0];
        interface->weight[i] = weight[node];
        interface->pad[i] = contact.curve_of[i];
    }
    if (!is_flat(mesh, &contact) && (interface->gap = NEW_ARRAY(double, count, err)))
        for (int32_t i = 0; i < count; i++) interface->gap[i] = mesh_gap(mesh, interface->node[i]);
cleanup:
    memory_free(weight);
    mesh_contact_destroy(&contact);
    return error_is_clean(err);
}

// Looks through all: done once for each node of the rod's face, when the mesh is read.
static bool is_contact_node(const Interface *interface, int32_t node)
{
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (interface->node[i] == node) return true;
    }
    return false;
}

// All nodes of the rod's curve, by ascending z.
// Insertion sort into rod_z and rod_node, which have room for the whole face: a face of n cells
// costs n^2/4 moves at the worst, nothing beside meshing.
static void sort_face(const Mesh *mesh, const MeshCurve *curve, Interface *interface)
{
    for (int32_t k = 0; k < curve->node_count; k++) {
        double z = mesh_height(mesh, curve->nodes[k]);
        int32_t j = k;
        for (; j > 0 && interface->rod_z[j - 1] > z; j--) {
            interface->rod_z[j] = interface->rod_z[j - 1];
            interface->rod_node[j] = interface->rod_node[j - 1];
        }
        interface->rod_z[j] = z;
        interface->rod_node[j] = curve->nodes[k];
    }
}

// The heights of a face's nodes.
typedef struct Face {
    double *z;   // [count] ascending, length
    int32_t count;
    double rounding;   // of a height, length
} Face;

// How much of the stretch of node k lies in the strip, 0 to 1.
// The stretch of a node reaches half way to its neighbours, at the ends of the face to the node
// itself. Without rod_in_part a node is in or out: 1 or 0.
static double strip_share(const InterfaceDef *def, Face face, int32_t k)
{
    const double *z = face.z;
    double low = def->rod_height - 0.5 * def->rod_width, rounding = face.rounding;
    double high = def->rod_height + 0.5 * def->rod_width;
    double from = k > 0 ? 0.5 * (z[k - 1] + z[k]) : z[k];
    double to = k + 1 < face.count ? 0.5 * (z[k] + z[k + 1]) : z[k];
    bool level = to - from <= rounding;   // a face along x
    if (level || !def->rod_in_part) return z[k] >= low - rounding && z[k] <= high + rounding;
    double covered = fmin(to, high) - fmax(from, low);
    if (covered <= rounding) return 0;
    return covered >= to - from - rounding ? 1 : covered / (to - from);
}

// Keeps the face's nodes that lie in the strip, in place: first the whole face is listed, then what
// is outside is dropped. A node of the contact line is left out, as the plane holds it.
static bool build_rod(const Mesh *mesh, const InterfaceDef *def, Interface *interface, Error *err)
{
    if (!def->has_rod) return true;
    MeshCurve curve;
    Face face = {.rounding = STRIP_TOLERANCE * (mesh->z_max - mesh->z_min)};
    TRY(mesh_curve(mesh, def->rod_name, &curve, err));
    interface->rod_node = NEW_ARRAY(int32_t, curve.node_count, err);
    interface->rod_z = NEW_ARRAY(double, curve.node_count, err);
    interface->rod_share = NEW_ARRAY(double, curve.node_count, err);
    face.z = NEW_ARRAY(double, curve.node_count, err);
    if (!interface->rod_node || !interface->rod_z || !interface->rod_share || !face.z) goto cleanup;
    sort_face(mesh, &curve, interface);
    face.count = curve.node_count;
    memcpy(face.z, interface->rod_z, (size_t)face.count * sizeof(double));
    interface->rod_face[0] = face.z[0];
    interface->rod_face[1] = face.z[face.count - 1];
    double nearest = INFINITY;
    for (int32_t k = 0; k < face.count; k++) {
        int32_t node = interface->rod_node[k];
        if (is_contact_node(interface, node)) continue;
        if (fabs(face.z[k] - def->rod_height) < fabs(nearest - def->rod_height))
            nearest = face.z[k];
        double share = strip_share(def, face, k);
        if (share == 0) continue;
        int32_t j = interface->rod_count++;   // never beyond k: what is overwritten was looked at
        interface->rod_node[j] = node;
        interface->rod_z[j] = face.z[k];
        interface->rod_share[j] = share;
    }
    if (interface->rod_count == 0)
        FAIL(err, ERROR_INPUT,
             "%s: no node of group \"%s\" lies in the rod's strip %g <= z <= %g; the nearest is at "
             "z = %g: widen rod.width, move rod.height or refine the mesh",
             mesh->path, def->rod_name, def->rod_height - 0.5 * def->rod_width,
             def->rod_height + 0.5 * def->rod_width, nearest);
cleanup:
    memory_free(face.z);
    return error_is_clean(err);
}

// *interface is overwritten.
bool interface_build(const Mesh *mesh, const InterfaceDef *def, Interface *interface, Error *err)
{
    *interface = (Interface){.dim = mesh->dim};
    TRY(build_contact(mesh, def, interface, err));
    TRY(build_rod(mesh, def, interface, err));
    interface->count = interface_rod(interface, interface->rod_count);
    interface->dofs = NEW_ARRAY(int32_t, interface->count, err);
    if (!interface->dofs) goto cleanup;
    for (int32_t i = 0; i < interface->contact_count; i++)
        for (int32_t d = 0; d < mesh->dim; d++)
            interface->dofs[interface_unknown(interface, i, d)] =
                node_dof(mesh->dim, interface->node[i], d);
    for (int32_t j = 0; j < interface->rod_count; j++)
        interface->dofs[interface_rod(interface, j)] =
            node_dof(mesh->dim, interface->rod_node[j], 0);
cleanup:
    return error_is_clean(err);
}

double interface_nodes_along(const Interface *interface)
{
    return pow(interface->contact_count, 1.0 / (interface->dim - 1));
}

void interface_destroy(Interface *interface)
{
    memory_free(interface->node);
    memory_free(interface->x);
    memory_free(interface->weight);
    memory_free(interface->gap);
    memory_free(interface->pad);
    memory_free(interface->pad_name);
    memory_free(interface->rod_node);
    memory_free(interface->rod_z);
    memory_free(interface->rod_share);
    memory_free(interface->dofs);
    *interface = (Interface){0};
}
