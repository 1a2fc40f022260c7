// SPDX-License-Identifier: GPL-2.0-or-later
// Contact is unilateral against the rigid line z = 0, node by node, each straight above its place.
// So nodes must stand on the line or over it, over distinct places, in one order along the curve,
// on the block's edge, with nothing of the block below.
#include "fem/mesh.h"

#include "base/memory.h"
#include "fem/mesh_edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A contact node counts as on z = 0, and two nodes as over one place, within this times the block's
// extent: coordinates computed by gmsh are exact to about 1e-12 of it.
static const double PLACE_TOLERANCE = 1e-9;

// The larger side of the block.
static double extent(const Mesh *mesh)
{
    return fmax(mesh->x_max - mesh->x_min, mesh->z_max - mesh->z_min);
}

double mesh_gap(const Mesh *mesh, int32_t node)
{
    double z = mesh_height(mesh, node);
    return z > PLACE_TOLERANCE * extent(mesh) ? z : 0;
}

// By x first, by z last. `context` comes third, as qsort_r passes it: no state outside the call.
static int compare_places(const void *a, const void *b, void *context)
{
    const Mesh *mesh = context;
    const double *first = mesh_place(mesh, *(const int32_t *)a);
    const double *second = mesh_place(mesh, *(const int32_t *)b);
    for (int32_t d = 0; d < mesh->dim; d++)
        if (first[d] != second[d]) return first[d] < second[d] ? -1 : 1;
    return 0;
}

// By place, so that numbers given out by gmsh do not decide the order of contact nodes.
void mesh_sort_nodes(const Mesh *mesh, int32_t *nodes, int32_t count)
{
    Mesh order = *mesh;   // qsort_r takes no const
    if (count > 1) qsort_r(nodes, (size_t)count, sizeof *nodes, compare_places, &order);
}

// The error lists the curves that there are.
bool mesh_curve(const Mesh *mesh, const char *name, MeshCurve *curve, Error *err)
{
    MeshFile view = {.group_count = mesh->group_count, .groups = mesh->groups};
    *curve = (MeshCurve){0};
    const MeshGroup *group = mesh_file_group(&view, mesh->path, name, 1, err);
    if (!group) goto cleanup;
    if (group->edge_count == 0)
        FAIL(err, ERROR_INPUT, "%s: group '%s' is empty: its curve has no edges in the mesh",
             mesh->path, name);
    *curve = (MeshCurve){.name = group->name,
                         .edge_count = group->edge_count,
                         .nodes_per_edge = group->nodes_per_edge,
                         .edge_nodes = group->edge_nodes,
                         .node_count = group->node_count,
                         .nodes = group->nodes};
cleanup:
    return error_is_clean(err);
}

// --- contact ------------------------------------------------------------------------------------

void mesh_contact_destroy(MeshContact *contact)
{
    memory_free(contact->curves);
    memory_free(contact->nodes);
    memory_free(contact->curve_of);
    *contact = (MeshContact){0};
}

// The names taken where a scene gives none.
static bool is_contact_name(const char *name)
{
    return strcmp(name, "contact") == 0 || strncmp(name, "contact_", strlen("contact_")) == 0;
}

// Curves by their first node, which is their leftmost.
static int compare_starts(const void *a, const void *b, void *context)
{
    const MeshCurve *first = a, *second = b;
    return compare_places(&first->nodes[0], &second->nodes[0], context);
}

// Fills contact->curves from the names, or from every curve that is called a contact.
static bool pick_curves(const Mesh *mesh, const char (*names)[GROUP_NAME_SIZE], int32_t count,
                        MeshContact *contact, Error *err)
{
    int32_t most = count > mesh->group_count ? count : mesh->group_count;
    if (!(contact->curves = NEW_ARRAY(MeshCurve, most, err))) goto cleanup;
    for (int32_t k = 0; k < count; k++)
        TRY(mesh_curve(mesh, names[k], &contact->curves[contact->curve_count++], err));
    if (count > 0) goto cleanup;
    for (int32_t g = 0; g < mesh->group_count; g++)
        if (mesh->groups[g].dimension == 1 && is_contact_name(mesh->groups[g].name))
            TRY(mesh_curve(mesh, mesh->groups[g].name, &contact->curves[contact->curve_count++],
                           err));
    MeshCurve none;
    Mesh order = *mesh;   // qsort_r takes no const
    if (contact->curve_count == 0) TRY(mesh_curve(mesh, "contact", &none, err));
    qsort_r(contact->curves, (size_t)contact->curve_count, sizeof *contact->curves, compare_starts,
            &order);
cleanup:
    return error_is_clean(err);
}

// Each edge of the contact is on one element only, as else it lies inside the block, and on one
// contact curve only.
static bool check_boundary(const Mesh *mesh, const MeshContact *contact, Error *err)
{
    MeshEdges table = {0};
    int32_t *claimed = NULL;   // by edge of the table: 1 + the curve that has it
    TRY(mesh_edges_build(mesh, &table, err));
    if (!(claimed = NEW_ARRAY(int32_t, table.first[mesh->node_count], err))) goto cleanup;
    for (int32_t c = 0; c < contact->curve_count; c++) {
        const MeshCurve *curve = &contact->curves[c];
        for (int32_t k = 0; k < curve->edge_count; k++) {
            const int32_t *nodes = curve->edge_nodes + k * curve->nodes_per_edge;
            const MeshEdge *edge = mesh_edges_find(&table, nodes[0], nodes[1]);
            double x = mesh_place(mesh, nodes[0])[0];
            if (edge->elements != 1)
                FAIL(err, ERROR_INPUT,
                     "%s: contact group '%s' runs inside the block at x = %g, not on its edge",
                     mesh->path, curve->name, x);
            int32_t *claim = &claimed[edge - table.edges];
            if (*claim)
                FAIL(err, ERROR_INPUT,
                     "%s: contact groups '%s' and '%s' both have the edge at x = %g", mesh->path,
                     contact->curves[*claim - 1].name, curve->name, x);
            *claim = c + 1;
        }
    }
cleanup:
    memory_free(claimed);
    mesh_edges_destroy(&table);
    return error_is_clean(err);
}

// Merges the nodes of the curves; a shared one keeps the first curve.
static bool merge_nodes(const Mesh *mesh, MeshContact *contact, Error *err)
{
    int32_t *owner = NULL;   // by mesh node: 1 + curve
    int32_t total = 0;
    for (int32_t c = 0; c < contact->curve_count; c++) total += contact->curves[c].node_count;
    if (!(owner = NEW_ARRAY(int32_t, mesh->node_count, err))) goto cleanup;
    if (!(contact->nodes = NEW_ARRAY(int32_t, total, err))) goto cleanup;
    if (!(contact->curve_of = NEW_ARRAY(int32_t, total, err))) goto cleanup;
    for (int32_t c = 0; c < contact->curve_count; c++)
        for (int32_t k = 0; k < contact->curves[c].node_count; k++) {
            int32_t i = contact->curves[c].nodes[k];
            if (owner[i]) continue;
            owner[i] = c + 1;
            contact->nodes[contact->node_count++] = i;
        }
    mesh_sort_nodes(mesh, contact->nodes, contact->node_count);
    for (int32_t k = 0; k < contact->node_count; k++)
        contact->curve_of[k] = owner[contact->nodes[k]] - 1;
cleanup:
    memory_free(owner);
    return error_is_clean(err);
}

// Two nodes over one place: the sides of a crack, parts of a mesh that were not joined, or a curve
// that goes straight up. Nodes are in order of x, so that only neighbours are compared.
static bool check_places(const Mesh *mesh, const MeshContact *contact, Error *err)
{
    double tolerance = PLACE_TOLERANCE * extent(mesh);
    if (mesh->z_min < -tolerance)
        FAIL(err, ERROR_INPUT,
             "%s: the block reaches down to z = %g, below the substrate at z = 0 that group '%s' "
             "touches",
             mesh->path, mesh->z_min, contact->curves[0].name);
    for (int32_t k = 1; k < contact->node_count; k++) {
        int32_t a = contact->nodes[k - 1], b = contact->nodes[k];
        const char *name = contact->curves[contact->curve_of[k]].name;
        const double *at_a = mesh_place(mesh, a), *at_b = mesh_place(mesh, b);
        if (at_b[0] - at_a[0] > tolerance) continue;
        if (fabs(at_b[1] - at_a[1]) > tolerance)
            FAIL(err, ERROR_INPUT,
                 "%s: contact group '%s' goes straight up at x = %g, from z = %g to %g: a face is "
                 "no "
                 "contact",
                 mesh->path, name, at_b[0], at_a[1], at_b[1]);
        FAIL(err, ERROR_INPUT,
             "%s: nodes %lld and %lld of contact group '%s' are both at x = %g: the mesh is not "
             "glued together there",
             mesh->path, (long long)mesh->node_number[a], (long long)mesh->node_number[b], name,
             at_b[0]);
    }
cleanup:
    return error_is_clean(err);
}

// A block that was drawn at another height.
static bool check_height(const Mesh *mesh, const MeshContact *contact, Error *err)
{
    int32_t lowest = contact->nodes[0];
    for (int32_t k = 1; k < contact->node_count; k++)
        if (mesh_height(mesh, contact->nodes[k]) < mesh_height(mesh, lowest))
            lowest = contact->nodes[k];
    if (mesh_gap(mesh, lowest) > 0)
        FAIL(err, ERROR_INPUT,
             "%s: no contact node lies on z = 0: the lowest, node %lld at x = %g, has z = %g",
             mesh->path, (long long)mesh->node_number[lowest], mesh_place(mesh, lowest)[0],
             mesh_height(mesh, lowest));
cleanup:
    return error_is_clean(err);
}

// A curve that turns back has nodes of another stretch between those of an edge.
static bool check_order(const Mesh *mesh, const MeshContact *contact, Error *err)
{
    int32_t *place = NEW_ARRAY(int32_t, mesh->node_count, err);
    if (!place) goto cleanup;
    for (int32_t k = 0; k < contact->node_count; k++) place[contact->nodes[k]] = k;
    for (int32_t c = 0; c < contact->curve_count; c++) {
        const MeshCurve *curve = &contact->curves[c];
        for (int32_t k = 0; k < curve->edge_count; k++) {
            const int32_t *nodes = curve->edge_nodes + k * curve->nodes_per_edge;
            if (abs(place[nodes[1]] - place[nodes[0]]) == curve->nodes_per_edge - 1) continue;
            FAIL(err, ERROR_INPUT,
                 "%s: contact group '%s' turns back over itself near x = %g, z = %g", mesh->path,
                 curve->name, mesh_place(mesh, nodes[0])[0], mesh_height(mesh, nodes[0]));
        }
    }
cleanup:
    memory_free(place);
    return error_is_clean(err);
}

// Places first: the order relies on them.
bool mesh_contact(const Mesh *mesh, const char (*names)[GROUP_NAME_SIZE], int32_t name_count,
                  MeshContact *contact, Error *err)
{
    *contact = (MeshContact){0};
    TRY(pick_curves(mesh, names, name_count, contact, err));
    TRY(check_boundary(mesh, contact, err));
    TRY(merge_nodes(mesh, contact, err));
    TRY(check_places(mesh, contact, err));
    TRY(check_height(mesh, contact, err));
    TRY(check_order(mesh, contact, err));
cleanup:
    return error_is_clean(err);
}
