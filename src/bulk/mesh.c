// SPDX-License-Identifier: GPL-2.0-or-later
// Checks a mesh once, so that nobody after it has to: see bulk/mesh.h for what holds afterwards.
#include "bulk/mesh.h"

#include "base/memory.h"
#include "bulk/mesh_edges.h"
#include "bulk/shape.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A determinant counts as zero below this times the square of the element's longest edge. Round-off
// is 1e-16 of it; an element of aspect ratio 1e4 still has 2e-5 of it.
static const double AREA_TOLERANCE = 1e-12;

// A contact node counts as on z = 0, and two nodes as in one place, within this times the block's
// extent: coordinates computed by gmsh are exact to about 1e-12 of it.
static const double PLACE_TOLERANCE = 1e-9;

void mesh_destroy(Mesh *mesh)
{
    MeshFile file = {.position = mesh->position,
                     .node_number = mesh->node_number,
                     .element_number = mesh->element_number,
                     .kind = mesh->kind,
                     .first_node = mesh->first_node,
                     .element_nodes = mesh->element_nodes,
                     .group_count = mesh->group_count,
                     .groups = mesh->groups};
    mesh_file_destroy(&file);
    *mesh = (Mesh){0};
}

static void take_over(MeshFile *file, const char *path, Mesh *mesh)
{
    *mesh = (Mesh){.node_count = file->node_count,
                   .position = file->position,
                   .node_number = file->node_number,
                   .element_count = file->element_count,
                   .element_number = file->element_number,
                   .kind = file->kind,
                   .first_node = file->first_node,
                   .element_nodes = file->element_nodes,
                   .group_count = file->group_count,
                   .groups = file->groups};
    snprintf(mesh->path, sizeof mesh->path, "%s", path);
    *file = (MeshFile){0};
}

static double extent(const Mesh *mesh)
{
    return fmax(mesh->x_max - mesh->x_min, mesh->z_max - mesh->z_min);
}

static void find_extent(Mesh *mesh)
{
    mesh->x_min = mesh->z_min = INFINITY;
    mesh->x_max = mesh->z_max = -INFINITY;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        mesh->x_min = fmin(mesh->x_min, mesh->position[2 * i]);
        mesh->x_max = fmax(mesh->x_max, mesh->position[2 * i]);
        mesh->z_min = fmin(mesh->z_min, mesh->position[2 * i + 1]);
        mesh->z_max = fmax(mesh->z_max, mesh->position[2 * i + 1]);
    }
}

// --- checks -------------------------------------------------------------------------------------

// The name of a curve group that holds node i, NULL: none.
static const char *group_of_node(const Mesh *mesh, int32_t i)
{
    for (int32_t g = 0; g < mesh->group_count; g++)
        for (int32_t k = 0; k < mesh->groups[g].node_count; k++)
            if (mesh->groups[g].nodes[k] == i) return mesh->groups[g].name;
    return NULL;
}

static bool check_nodes(const Mesh *mesh, Error *err)
{
    bool *used = NEW_ARRAY(bool, mesh->node_count, err);
    if (!used) goto cleanup;
    for (int32_t k = 0; k < mesh->first_node[mesh->element_count]; k++)
        used[mesh->element_nodes[k]] = true;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        if (used[i]) continue;
        const char *group = group_of_node(mesh, i);
        FAIL(err, ERROR_INPUT, "%s: node %lld at (%g, %g) is on no surface element%s%s%s",
             mesh->path, (long long)mesh->node_number[i], mesh->position[2 * i],
             mesh->position[2 * i + 1], group ? "; it belongs to group '" : "", group ? group : "",
             group ? "'" : "");
    }
cleanup:
    memory_free(used);
    return error_is_clean(err);
}

static bool check_repeats(const Mesh *mesh, Error *err)
{
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
            for (int32_t b = mesh->first_node[e]; b < a; b++)
                if (mesh->element_nodes[a] == mesh->element_nodes[b])
                    FAIL(err, ERROR_INPUT, "%s: element %lld (%s) has node %lld twice", mesh->path,
                         (long long)mesh->element_number[e], element_name(mesh->kind[e]),
                         (long long)mesh->node_number[mesh->element_nodes[a]]);
cleanup:
    return error_is_clean(err);
}

// Positions of the nodes of element e, and their mean; returns the square of the longest distance
// from node 0, the scale of its Jacobian.
static double gather(const Mesh *mesh, int32_t e, double (*position)[2], double centre[2])
{
    int32_t count = mesh->first_node[e + 1] - mesh->first_node[e];
    double scale = 0;
    centre[0] = centre[1] = 0;
    for (int32_t a = 0; a < count; a++) {
        int32_t i = mesh->element_nodes[mesh->first_node[e] + a];
        for (int32_t d = 0; d < 2; d++) {
            position[a][d] = mesh->position[2 * i + d];
            centre[d] += position[a][d] / count;
        }
        double x = position[a][0] - position[0][0], z = position[a][1] - position[0][1];
        scale = fmax(scale, x * x + z * z);
    }
    return scale;
}

// Shape functions at the nodes and quadrature points of each kind, where Jacobians are looked at.
typedef struct ProbePoints {
    int32_t count[ELEMENT_KIND_COUNT];
    ShapeValues shape[ELEMENT_KIND_COUNT][ELEMENT_NODES_MAX + QUADRATURE_POINTS_MAX];
} ProbePoints;

static void set_probes(ProbePoints *probes)
{
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++) {
        Quadrature rule = shape_quadrature((ElementKind)kind);
        int32_t count = 0;
        for (int32_t a = 0; a < element_node_count((ElementKind)kind); a++) {
            double xi, eta;
            shape_node((ElementKind)kind, a, &xi, &eta);
            probes->shape[kind][count++] = shape_at((ElementKind)kind, xi, eta);
        }
        for (int32_t q = 0; q < rule.count; q++)
            probes->shape[kind][count++] =
                shape_at((ElementKind)kind, rule.point[q][0], rule.point[q][1]);
        probes->count[kind] = count;
    }
}

// Smallest and largest determinant of element e over its probes, over the scale; its centre.
static void determinant_range(const Mesh *mesh, const ProbePoints *probes, int32_t e,
                              double range[2], double centre[2])
{
    double position[ELEMENT_NODES_MAX][2];
    double scale = gather(mesh, e, position, centre);
    ElementKind kind = mesh->kind[e];
    range[0] = INFINITY, range[1] = -INFINITY;
    for (int32_t q = 0; q < probes->count[kind]; q++) {
        double determinant =
            shape_jacobian(kind, &probes->shape[kind][q], (const double(*)[2])position, NULL);
        range[0] = fmin(range[0], determinant);
        range[1] = fmax(range[1], determinant);
    }
    for (int32_t k = 0; k < 2; k++) range[k] = scale > 0 ? range[k] / scale : 0;
}

// Exchanges nodes so that the element runs the other way round, from the same first corner.
static void reverse_element(ElementKind kind, int32_t *nodes)
{
    static const uint8_t order[ELEMENT_KIND_COUNT][ELEMENT_NODES_MAX] = {
        [ELEMENT_T3] = {0, 2, 1},
        [ELEMENT_T6] = {0, 2, 1, 5, 4, 3},
        [ELEMENT_Q4] = {0, 3, 2, 1},
        [ELEMENT_Q8] = {0, 3, 2, 1, 7, 6, 5, 4},
        [ELEMENT_Q9] = {0, 3, 2, 1, 7, 6, 5, 4, 8}};
    int32_t old[ELEMENT_NODES_MAX], count = element_node_count(kind);
    memcpy(old, nodes, (size_t)count * sizeof *nodes);
    for (int32_t a = 0; a < count; a++) nodes[a] = old[order[kind][a]];
}

// A mesh that is clockwise throughout is a reversed surface and is turned round; a clockwise element
// among others is a mistake.
static bool check_orientation(Mesh *mesh, Error *err)
{
    int32_t clockwise = 0, first_bad = -1;
    double bad_range[2] = {0}, bad_centre[2] = {0};
    ProbePoints *probes = NEW_ARRAY(ProbePoints, 1, err);
    if (!probes) goto cleanup;
    set_probes(probes);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        double range[2], centre[2];
        determinant_range(mesh, probes, e, range, centre);
        bool reversed = range[1] < -AREA_TOLERANCE;
        clockwise += reversed;
        bool bad = !(range[0] > AREA_TOLERANCE) && !reversed;
        bool odd = reversed != (clockwise == e + 1);   // unlike every element before it
        if (!bad && !odd) continue;
        first_bad = e;
        memcpy(bad_range, range, sizeof range);
        memcpy(bad_centre, centre, sizeof centre);
        break;
    }
    if (first_bad >= 0)
        FAIL(err, ERROR_INPUT,
             "%s: element %lld (%s) at (%g, %g) has a non-positive area: its Jacobian determinant "
             "runs from %.3g to %.3g of its size squared%s",
             mesh->path, (long long)mesh->element_number[first_bad],
             element_name(mesh->kind[first_bad]), bad_centre[0], bad_centre[1], bad_range[0],
             bad_range[1],
             bad_range[0] > AREA_TOLERANCE || bad_range[1] < -AREA_TOLERANCE
                 ? " while others run the other way round (a surface of the .geo is reversed)"
                 : "");
    if (clockwise > 0)
        for (int32_t e = 0; e < mesh->element_count; e++)
            reverse_element(mesh->kind[e], mesh->element_nodes + mesh->first_node[e]);
cleanup:
    memory_free(probes);
    return error_is_clean(err);
}

// Every edge of a named curve must be an edge of an element, with the same mid-side node.
static bool check_curves(const Mesh *mesh, Error *err)
{
    MeshEdges table = {0};
    TRY(mesh_edges_build(mesh, &table, err));
    for (int32_t g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        for (int32_t k = 0; k < group->edge_count; k++) {
            const int32_t *nodes = group->edge_nodes + k * group->nodes_per_edge;
            int32_t middle = group->nodes_per_edge == 3 ? nodes[2] : -1;
            const MeshEdge *edge = mesh_edges_find(&table, nodes[0], nodes[1]);
            if (!edge || edge->middle != middle)
                FAIL(
                    err, ERROR_INPUT,
                    "%s: group '%s': its edge from node %lld to %lld at (%g, %g) is not an edge of "
                    "any element",
                    mesh->path, group->name, (long long)mesh->node_number[nodes[0]],
                    (long long)mesh->node_number[nodes[1]], mesh->position[2 * nodes[0]],
                    mesh->position[2 * nodes[0] + 1]);
        }
    }
cleanup:
    mesh_edges_destroy(&table);
    return error_is_clean(err);
}

// --- curves -------------------------------------------------------------------------------------

static int compare_places(const void *a, const void *b, void *position)
{
    const double *first = (const double *)position + 2 * *(const int32_t *)a;
    const double *second = (const double *)position + 2 * *(const int32_t *)b;
    if (first[0] != second[0]) return first[0] < second[0] ? -1 : 1;
    return (first[1] > second[1]) - (first[1] < second[1]);
}

static void sort_by_place(const Mesh *mesh, int32_t *nodes, int32_t count)
{
    qsort_r(nodes, (size_t)count, sizeof *nodes, compare_places, mesh->position);
}

bool mesh_build(MeshFile *file, const char *path, Mesh *mesh, Error *err)
{
    take_over(file, path, mesh);
    find_extent(mesh);
    TRY(check_nodes(mesh, err));
    TRY(check_repeats(mesh, err));
    TRY(check_orientation(mesh, err));
    TRY(check_curves(mesh, err));
    for (int32_t g = 0; g < mesh->group_count; g++)
        sort_by_place(mesh, mesh->groups[g].nodes, mesh->groups[g].node_count);
cleanup:
    return error_is_clean(err);
}

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

static bool is_contact_name(const char *name)
{
    return strcmp(name, "contact") == 0 || strncmp(name, "contact_", strlen("contact_")) == 0;
}

static int compare_starts(const void *a, const void *b, void *position)
{
    const MeshCurve *first = a, *second = b;
    return compare_places(&first->nodes[0], &second->nodes[0], position);
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
    if (contact->curve_count == 0) TRY(mesh_curve(mesh, "contact", &none, err));
    qsort_r(contact->curves, (size_t)contact->curve_count, sizeof *contact->curves, compare_starts,
            mesh->position);
cleanup:
    return error_is_clean(err);
}

static bool check_flat(const Mesh *mesh, const MeshCurve *curve, Error *err)
{
    int32_t worst = curve->nodes[0];
    for (int32_t k = 1; k < curve->node_count; k++)
        if (fabs(mesh->position[2 * curve->nodes[k] + 1]) > fabs(mesh->position[2 * worst + 1]))
            worst = curve->nodes[k];
    if (fabs(mesh->position[2 * worst + 1]) > PLACE_TOLERANCE * extent(mesh))
        FAIL(err, ERROR_INPUT,
             "%s: contact group '%s' is not flat at z = 0: node %lld at x = %g has z = %g",
             mesh->path, curve->name, (long long)mesh->node_number[worst],
             mesh->position[2 * worst], mesh->position[2 * worst + 1]);
cleanup:
    return error_is_clean(err);
}

// Each edge of the contact is on one element only and on one contact curve only.
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
            double x = mesh->position[2 * nodes[0]];
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
    sort_by_place(mesh, contact->nodes, contact->node_count);
    for (int32_t k = 0; k < contact->node_count; k++)
        contact->curve_of[k] = owner[contact->nodes[k]] - 1;
cleanup:
    memory_free(owner);
    return error_is_clean(err);
}

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
        if (mesh->position[2 * b] - mesh->position[2 * a] <= tolerance)
            FAIL(
                err, ERROR_INPUT,
                "%s: nodes %lld and %lld of contact group '%s' are both at x = %g: the mesh is not "
                "glued together there",
                mesh->path, (long long)mesh->node_number[a], (long long)mesh->node_number[b],
                contact->curves[contact->curve_of[k]].name, mesh->position[2 * b]);
    }
cleanup:
    return error_is_clean(err);
}

bool mesh_contact(const Mesh *mesh, const char (*names)[GROUP_NAME_SIZE], int32_t name_count,
                  MeshContact *contact, Error *err)
{
    *contact = (MeshContact){0};
    TRY(pick_curves(mesh, names, name_count, contact, err));
    for (int32_t c = 0; c < contact->curve_count; c++)
        TRY(check_flat(mesh, &contact->curves[c], err));
    TRY(check_boundary(mesh, contact, err));
    TRY(merge_nodes(mesh, contact, err));
    TRY(check_places(mesh, contact, err));
cleanup:
    return error_is_clean(err);
}

// --- summary ------------------------------------------------------------------------------------

static double element_area(const Mesh *mesh, int32_t e)
{
    double position[ELEMENT_NODES_MAX][2], centre[2], area = 0;
    ElementKind kind = mesh->kind[e];
    gather(mesh, e, position, centre);
    Quadrature rule = shape_quadrature(kind);
    for (int32_t q = 0; q < rule.count; q++) {
        ShapeValues shape = shape_at(kind, rule.point[q][0], rule.point[q][1]);
        area += rule.weight[q] * shape_jacobian(kind, &shape, (const double(*)[2])position, NULL);
    }
    return area;
}

MeshSummary mesh_summarise(const Mesh *mesh)
{
    MeshSummary summary = {.edge_min = INFINITY, .aspect_worst = -1};
    for (int32_t e = 0; e < mesh->element_count; e++) {
        ElementKind kind = mesh->kind[e];
        const int32_t *nodes = mesh->element_nodes + mesh->first_node[e];
        int32_t corners = kind == ELEMENT_T3 || kind == ELEMENT_T6 ? 3 : 4;
        double shortest = INFINITY, longest = 0;
        for (int32_t k = 0; k < corners; k++) {
            const double *from = mesh->position + 2 * nodes[k];
            const double *to = mesh->position + 2 * nodes[(k + 1) % corners];
            double length = hypot(to[0] - from[0], to[1] - from[1]);
            shortest = fmin(shortest, length);
            longest = fmax(longest, length);
        }
        summary.element_counts[kind]++;
        summary.area += element_area(mesh, e);
        summary.edge_min = fmin(summary.edge_min, shortest);
        summary.edge_max = fmax(summary.edge_max, longest);
        if (longest / shortest > summary.aspect_max) {
            summary.aspect_max = longest / shortest;
            summary.aspect_worst = e;
        }
    }
    return summary;
}
