// SPDX-License-Identifier: GPL-2.0-or-later
#include "fem/element_group.h"

#include "base/memory.h"
#include "base/order.h"

#include <stdlib.h>

// --- which elements -----------------------------------------------------------------------------

// One side of an edge between corners.
typedef struct Side {
    int32_t low, high;   // nodes
    double length;   // squared, length^2
    int32_t element, other;   // other: beyond the edge, -1: none in the same region
} Side;

static int by_edge(const void *left, const void *right)
{
    const Side *a = left, *b = right;
    int nodes = order_int32_pairs(left, right);
    return nodes ? nodes : (a->element > b->element) - (a->element < b->element);
}

static int by_length(const void *left, const void *right)
{
    const Side *a = left, *b = right;
    if (a->length != b->length) return a->length > b->length ? -1 : 1;
    return by_edge(left, right);
}

// 0 of order 2, which does not lock.
static int32_t corners_of(const Mesh *mesh, int32_t e)
{
    int32_t corners = element_corner_count(mesh->kind[e]);
    return element_node_count(mesh->kind[e]) == corners ? corners : 0;
}

static bool is_alone(const Mesh *mesh, int32_t e)
{
    return mesh->kind[e] == ELEMENT_T3 && mesh->mean_next[e] == e;
}

static int32_t ring_size(const Mesh *mesh, int32_t e)
{
    int32_t size = 1;
    for (int32_t k = mesh->mean_next[e]; k != e; k = mesh->mean_next[k]) size++;
    return size;
}

// Two rings become one.
static void join(Mesh *mesh, int32_t one, int32_t other)
{
    int32_t next = mesh->mean_next[one];
    mesh->mean_next[one] = mesh->mean_next[other];
    mesh->mean_next[other] = next;
}

bool element_groups_find(const uint8_t *is_mean, Mesh *mesh, Error *err)
{
    int32_t elements = mesh->element_count, marked = 0, listed = 0, count = 0, *best = NULL;
    Side *sides = NULL;
    for (int32_t e = 0; e < elements; e++)
        marked += is_mean[mesh_region(mesh, e)] && corners_of(mesh, e) > 0;
    if (marked == 0) return true;
    mesh->mean_next = NEW_ARRAY(int32_t, elements, err);
    sides = memory_array(4 * (int64_t)elements, sizeof *sides, err);
    if (!mesh->mean_next || !sides) goto cleanup;
    for (int32_t e = 0; e < elements; e++)
        mesh->mean_next[e] = is_mean[mesh_region(mesh, e)] && corners_of(mesh, e) > 0 ? e : -1;

    // Both sides of the edges between two elements of one region that may be grouped.
    for (int32_t e = 0; e < elements; e++) {
        bool plane = element_dim((ElementKind)mesh->kind[e]) == 2;
        int32_t corners = plane && mesh->mean_next[e] >= 0 ? corners_of(mesh, e) : 0;
        const int32_t *node = mesh->element_nodes + mesh->first_node[e];
        for (int32_t a = 0; a < corners; a++) {
            int32_t one = node[a], two = node[(a + 1) % corners];
            double square = 0;
            for (int32_t d = 0; d < mesh->dim; d++) {
                double way = mesh_place(mesh, two)[d] - mesh_place(mesh, one)[d];
                square += way * way;
            }
            sides[listed++] = (Side){one < two ? one : two, one < two ? two : one, square, e, -1};
        }
    }
    qsort(sides, (size_t)listed, sizeof *sides, by_edge);
    for (int32_t k = 0; k + 1 < listed; k++) {
        Side *one = &sides[k], *two = &sides[k + 1];
        if (one->low != two->low || one->high != two->high ||
            mesh_region(mesh, one->element) != mesh_region(mesh, two->element))
            continue;
        one->other = two->element;
        two->other = one->element;
    }
    for (int32_t k = 0; k < listed; k++)
        if (sides[k].other >= 0) sides[count++] = sides[k];
    qsort(sides, (size_t)count, sizeof *sides, by_length);

    // Triangles are joined in pairs, over the longest edges first.
    for (int32_t k = 0; k < count; k++)
        if (is_alone(mesh, sides[k].element) && is_alone(mesh, sides[k].other))
            join(mesh, sides[k].element, sides[k].other);

    // Elements that were left over join the smallest group beside them. No two of them are
    // neighbours, or they would be a pair: so a group grows by its own edges only.
    TRY((best = NEW_ARRAY(int32_t, elements, err)));
    for (int32_t e = 0; e < elements; e++) best[e] = is_alone(mesh, e) ? e : -1;
    for (int32_t k = 0; k < count; k++) {
        int32_t e = sides[k].element, other = sides[k].other;
        if (best[e] < 0) continue;
        if (best[e] == e || ring_size(mesh, other) < ring_size(mesh, best[e])) best[e] = other;
    }
    for (int32_t e = 0; e < elements; e++)
        if (best[e] >= 0 && best[e] != e) join(mesh, e, best[e]);
cleanup:
    memory_free_all(sides, best);
    return error_is_clean(err);
}

// --- what they are ------------------------------------------------------------------------------

// Index of `node` among the group's nodes; a new one is added at the end.
static int32_t place_of(ElementGroup *group, int32_t node)
{
    for (int32_t a = 0; a < group->node_count; a++)
        if (group->node[a] == node) return a;
    group->node[group->node_count] = node;
    return group->node_count++;
}

bool element_group_at(const Mesh *mesh, int32_t e, ElementGroup *group)
{
    int32_t next = mesh->mean_next ? mesh->mean_next[e] : -1;
    group->count = 1;
    group->element[0] = e;
    group->is_mean = next >= 0;
    group->node_count = 0;
    for (int32_t k = next; k >= 0 && k != e; k = mesh->mean_next[k]) {
        if (k < e) return false;
        group->element[group->count++] = k;
    }
    for (int32_t m = 0; m < group->count; m++) {
        int32_t first = mesh->first_node[group->element[m]];
        int32_t end = mesh->first_node[group->element[m] + 1];
        for (int32_t a = first; a < end; a++) {
            if (group->count > 1)
                place_of(group, mesh->element_nodes[a]);
            else
                group->node[group->node_count++] = mesh->element_nodes[a];
        }
    }
    return true;
}

void element_group_of(const Mesh *mesh, int32_t e, ElementGroup *group)
{
    int32_t first = e;
    if (mesh->mean_next && mesh->mean_next[e] >= 0)
        for (int32_t k = mesh->mean_next[e]; k != e; k = mesh->mean_next[k])
            if (k < first) first = k;
    element_group_at(mesh, first, group);
}

// Offsets of the nodes of one element from its first node, so that equal shapes have equal
// matrices.
static void find_offsets(const Mesh *mesh, int32_t e, MeshPlace offset[ELEMENT_NODES_MAX])
{
    int32_t first = mesh->first_node[e];
    mesh_offsets(mesh, mesh->element_nodes + first, mesh->first_node[e + 1] - first, offset);
}

void element_group_matrices(const Mesh *mesh, const Material *materials, const ElementGroup *group,
                            ElementMatrices *out)
{
    const Material *material = &materials[mesh_region(mesh, group->element[0])];
    MeshPlace offset[ELEMENT_NODES_MAX];
    if (!group->is_mean) {
        find_offsets(mesh, group->element[0], offset);
        element_matrices((ElementKind)mesh->kind[group->element[0]], (const MeshPlace *)offset,
                         material, true, out);
        return;
    }
    ElementGroup known = *group;
    int32_t dim = mesh->dim;
    element_matrices_clear(dim * group->node_count, out);
    for (int32_t m = 0; m < group->count; m++) {
        int32_t e = group->element[m], place[ELEMENT_NODES_MAX], first = mesh->first_node[e];
        ElementMatrices member;
        find_offsets(mesh, e, offset);
        element_matrices((ElementKind)mesh->kind[e], (const MeshPlace *)offset, material, false,
                         &member);
        for (int32_t a = 0; dim * a < member.dof_count; a++)
            place[a] = place_of(&known, mesh->element_nodes[first + a]);

        // Its matrices are added where its nodes stand in the group.
        for (int32_t i = 0; i < member.dof_count; i++) {
            int32_t row = node_dof(dim, place[dof_node(dim, i)], dof_axis(dim, i));
            out->areal[row] += member.areal[i];
            for (int32_t j = 0; j < member.dof_count; j++) {
                int32_t column = node_dof(dim, place[dof_node(dim, j)], dof_axis(dim, j));
                out->stiffness[row][column] += member.stiffness[i][j];
                out->damping[row][column] += member.damping[i][j];
            }
        }
        for (int32_t a = 0; dim * a < member.dof_count; a++) out->mass[place[a]] += member.mass[a];
        out->area += member.area;
    }

    // k of the header.
    double elastic = moduli_bulk(material_elastic(material), dim);
    double viscous = moduli_bulk(material_viscous(material), dim);
    for (int32_t i = 0; i < out->dof_count; i++) {
        for (int32_t j = 0; j < out->dof_count; j++) {
            double square = out->areal[i] * out->areal[j] / out->area;
            out->stiffness[i][j] += elastic * square;
            out->damping[i][j] += viscous * square;
        }
    }
}

void element_group_areal(const Mesh *mesh, const ElementGroup *group, double *g)
{
    const Material unit = {.young = 1, .density = 1};
    ElementMatrices matrices;
    Mesh one = *mesh;   // borrows all but the regions
    one.region = NULL;
    element_group_matrices(&one, &unit, group, &matrices);
    for (int32_t i = 0; i < matrices.dof_count; i++) g[i] = matrices.areal[i] / matrices.area;
}
