// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/upper_block.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Positions are over L and on a grid (reduction/reduction_block): edges of a line add up to 1 but
// for rounding.
static const double LINE_LENGTH = 1 - 1e-9;

enum { BELOW = -1, UNKNOWN = -2 };

// An element between two heights, or with all that share its areal strain (fem/element_group).
typedef struct Span {
    double low, high;
    int32_t element;
} Span;

// The whole, and where it is cut.
typedef struct Cut {
    const Mesh *mesh;
    const double *position;   // [nodes * dim] over L
    Span *spans;   // [elements] by height; owned
    int32_t first;   // of those above the line
    int32_t *place;   // [nodes] where each stands in the upper block; BELOW; owned
} Cut;

void upper_block_destroy(UpperBlock *upper)
{
    reduction_block_destroy(&upper->block);
    mesh_destroy(&upper->mesh);
    memory_free(upper->dofs);
    memory_free(upper->interface_dofs);
    *upper = (UpperBlock){0};
}

static int by_height(const void *left, const void *right)
{
    const Span *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    return (a->element > b->element) - (a->element < b->element);
}

static const double *place_of(const Cut *cut, int32_t node)
{
    return cut->position + node_dof(cut->mesh->dim, node, 0);
}

static void list_spans(const Cut *cut)
{
    const Mesh *mesh = cut->mesh;
    Span *spans = cut->spans;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        int32_t member = e;
        spans[e] = (Span){INFINITY, -INFINITY, e};
        do {
            for (int32_t k = mesh->first_node[member]; k < mesh->first_node[member + 1]; k++) {
                double z = place_of(cut, mesh->element_nodes[k])[mesh->dim - 1];
                spans[e].low = fmin(spans[e].low, z);
                spans[e].high = fmax(spans[e].high, z);
            }
            member = mesh->mean_next && mesh->mean_next[e] >= 0 ? mesh->mean_next[member] : e;
        } while (member != e);
    }
    qsort(spans, (size_t)mesh->element_count, sizeof *spans, by_height);
}

// How long the edges at the foot of an element are.
static double foot_length(const Cut *cut, const Span *span)
{
    const Mesh *mesh = cut->mesh;
    const int32_t *nodes = mesh->element_nodes + mesh->first_node[span->element];
    ElementKind kind = (ElementKind)mesh->kind[span->element];
    int32_t corners = element_corner_count(kind), up = mesh->dim - 1;
    double length = 0;
    for (int32_t k = 0; k < corners; k++) {
        const double *one = place_of(cut, nodes[k]);
        const double *other = place_of(cut, nodes[(k + 1) % corners]);
        if (one[up] == span->low && other[up] == span->low) length += fabs(other[0] - one[0]);
    }
    return length;
}

// The first of `spans`, by height, above the line; their number: there is none. Where no element
// that begins below ends above, and feet make a line from side to side.
static int32_t find_line(const Cut *cut)
{
    const Span *spans = cut->spans;
    int32_t count = cut->mesh->element_count;
    double reached = -INFINITY;
    for (int32_t from = 0, end; from < count; from = end) {
        double length = 0, high = reached;
        for (end = from; end < count && spans[end].low == spans[from].low; end++) {
            length += foot_length(cut, &spans[end]);
            high = fmax(high, spans[end].high);
        }
        if (reached <= spans[from].low && length > LINE_LENGTH) return from;
        reached = high;
    }
    return count;
}

// Nodes of the elements above the line, by place.
static bool list_nodes(const Cut *cut, UpperBlock *upper, Error *err)
{
    Mesh by_place = *cut->mesh;   // borrows all but the positions
    const Mesh *mesh = cut->mesh;
    int32_t count = 0, *place = cut->place, *nodes = NEW_ARRAY(int32_t, mesh->node_count, err);
    if (!nodes) goto cleanup;
    by_place.position = (double *)(uintptr_t)cut->position;   // nobody writes to it
    for (int32_t i = 0; i < mesh->node_count; i++) place[i] = BELOW;
    for (int32_t k = cut->first; k < mesh->element_count; k++) {
        int32_t e = cut->spans[k].element;
        for (int32_t at = mesh->first_node[e]; at < mesh->first_node[e + 1]; at++)
            place[mesh->element_nodes[at]] = UNKNOWN;
    }
    for (int32_t i = 0; i < mesh->node_count; i++)
        if (place[i] == UNKNOWN) nodes[count++] = i;
    mesh_sort_nodes(&by_place, nodes, count);
    upper->dofs = NEW_ARRAY(int32_t, (int64_t)mesh->dim * count, err);
    upper->mesh.dim = mesh->dim;
    upper->mesh.node_count = count;
    if (!upper->dofs) goto cleanup;
    for (int32_t i = 0; i < count; i++) {
        place[nodes[i]] = i;
        for (int32_t d = 0; d < mesh->dim; d++)
            upper->dofs[node_dof(mesh->dim, i, d)] = node_dof(mesh->dim, nodes[i], d);
    }
cleanup:
    memory_free(nodes);
    return error_is_clean(err);
}

// An element by its nodes in their new order, which puts it in its place.
typedef struct Moved {
    int32_t nodes[ELEMENT_NODES_MAX], count, element;
} Moved;

static int by_nodes(const void *left, const void *right)
{
    const Moved *a = left, *b = right;
    for (int32_t k = 0; k < ELEMENT_NODES_MAX; k++)
        if (a->nodes[k] != b->nodes[k]) return a->nodes[k] < b->nodes[k] ? -1 : 1;
    return 0;
}

// No ring of elements reaches over the line.
static bool list_rings(const Cut *cut, const Moved *moved, Mesh *mesh, Error *err)
{
    const int32_t *next = cut->mesh->mean_next;
    int32_t *number = NEW_ARRAY(int32_t, cut->mesh->element_count, err);
    mesh->mean_next = NEW_ARRAY(int32_t, mesh->element_count, err);
    if (!number || !mesh->mean_next) goto cleanup;
    for (int32_t k = 0; k < mesh->element_count; k++) number[moved[k].element] = k;
    for (int32_t k = 0; k < mesh->element_count; k++) {
        int32_t after = next[moved[k].element];
        mesh->mean_next[k] = after < 0 ? -1 : number[after];
    }
cleanup:
    memory_free(number);
    return error_is_clean(err);
}

static bool list_elements(const Cut *cut, Mesh *mesh, Error *err)
{
    const Mesh *from = cut->mesh;
    int32_t count = from->element_count - cut->first, filled = 0;
    Moved *moved = memory_array(count, sizeof *moved, err);
    mesh->element_count = count;
    mesh->kind = NEW_ARRAY(uint8_t, count, err);
    mesh->region = from->region ? NEW_ARRAY(uint8_t, count, err) : NULL;
    mesh->first_node = NEW_ARRAY(int32_t, (int64_t)count + 1, err);
    mesh->element_nodes = NEW_ARRAY(int32_t, (int64_t)count * ELEMENT_NODES_MAX, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t k = 0; k < count; k++) {
        int32_t e = moved[k].element = cut->spans[cut->first + k].element;
        moved[k].count = from->first_node[e + 1] - from->first_node[e];
        for (int32_t a = 0; a < moved[k].count; a++)
            moved[k].nodes[a] = cut->place[from->element_nodes[from->first_node[e] + a]];
    }
    qsort(moved, (size_t)count, sizeof *moved, by_nodes);
    for (int32_t k = 0; k < count; k++) {
        mesh->kind[k] = from->kind[moved[k].element];
        if (mesh->region) mesh->region[k] = from->region[moved[k].element];
        memcpy(mesh->element_nodes + filled, moved[k].nodes,
               (size_t)moved[k].count * sizeof(int32_t));
        mesh->first_node[k + 1] = filled += moved[k].count;
    }
    if (from->mean_next) TRY(list_rings(cut, moved, mesh, err));
cleanup:
    memory_free(moved);
    return error_is_clean(err);
}

// Of the line all unknowns, above it those of `dofs`.
static bool list_interface(const int32_t *place, const int32_t *dofs, int32_t dof_count,
                           UpperBlock *upper, Error *err)
{
    const double *position = upper->block.position;
    int32_t count = 0, dim = upper->mesh.dim, unknowns = dim * upper->mesh.node_count;
    uint8_t *inside = NEW_ARRAY(uint8_t, unknowns, err);
    upper->interface_dofs = NEW_ARRAY(int32_t, unknowns, err);
    if (!inside || !upper->interface_dofs) goto cleanup;
    for (int32_t k = 0; k < unknowns; k++)
        inside[k] = position[node_dof(dim, dof_node(dim, k), dim - 1)] == 0;
    for (int32_t j = 0; j < dof_count; j++)
        if (place[dof_node(dim, dofs[j])] >= 0)
            inside[node_dof(dim, place[dof_node(dim, dofs[j])], dof_axis(dim, dofs[j]))] = 1;
    for (int32_t k = 0; k < unknowns; k++)
        if (inside[k]) upper->interface_dofs[count++] = k;
    upper->interface_count = count;
cleanup:
    memory_free(inside);
    return error_is_clean(err);
}

// Loads on the interface do no work on what responds to it: they are left to the whole.
static bool assemble(const ReductionBlock *whole, UpperBlock *upper, Error *err)
{
    Bulk *bulk = &upper->block.bulk;
    TRY(bulk_assemble(&upper->mesh, upper->block.materials.list, bulk, err));
    for (int32_t k = 0; k < bulk->dof_count; k++) {
        bulk->load[k] = whole->bulk.load[upper->dofs[k]];
        if (whole->bulk.held[upper->dofs[k]]) bulk_hold(k, bulk);
    }
    for (int32_t j = 0; j < upper->interface_count; j++) bulk->load[upper->interface_dofs[j]] = 0;
cleanup:
    return error_is_clean(err);
}

static bool take_above(const Cut *cut, UpperBlock *upper, Error *err)
{
    Mesh *mesh = &upper->mesh;
    TRY(list_nodes(cut, upper, err));
    TRY(list_elements(cut, mesh, err));
    int64_t numbers = (int64_t)mesh->dim * mesh->node_count;
    mesh->position = NEW_ARRAY(double, numbers, err);
    upper->block.position = NEW_ARRAY(double, numbers, err);
    if (!mesh->position || !upper->block.position) goto cleanup;
    for (int64_t k = 0; k < numbers; k++)
        mesh->position[k] = upper->block.position[k] =
            cut->position[upper->dofs[k]] -
            (k % mesh->dim == mesh->dim - 1 ? cut->spans[cut->first].low : 0);
cleanup:
    return error_is_clean(err);
}

bool upper_block_create(const Mesh *mesh, const ReductionBlock *whole, const int32_t *dofs,
                        int32_t dof_count, UpperBlock *upper, Error *err)
{
    Cut cut = {.mesh = mesh, .position = whole->position};
    cut.spans = memory_array(mesh->element_count, sizeof *cut.spans, err);
    cut.place = NEW_ARRAY(int32_t, mesh->node_count, err);
    *upper = (UpperBlock){0};
    if (!cut.spans || !cut.place) goto cleanup;
    list_spans(&cut);
    cut.first = find_line(&cut);
    if (cut.first == 0 || cut.first == mesh->element_count) goto cleanup;
    upper->block.materials = whole->materials;
    TRY(take_above(&cut, upper, err));
    TRY(list_interface(cut.place, dofs, dof_count, upper, err));
    TRY(assemble(whole, upper, err));
cleanup:
    memory_free(cut.spans);
    memory_free(cut.place);
    return error_is_clean(err);
}
