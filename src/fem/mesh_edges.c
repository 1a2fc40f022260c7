// SPDX-License-Identifier: GPL-2.0-or-later
// In buckets by the lower end, each of the few edges of one node.
#include "fem/mesh_edges.h"

#include "base/memory.h"

// In the bucket of the lower end; NULL: not there (yet).
static MeshEdge *find_edge(const MeshEdges *table, int32_t low, int32_t high)
{
    for (int32_t k = table->first[low]; k < table->last[low]; k++)
        if (table->edges[k].high == high) return &table->edges[k];
    return NULL;
}

// Puts an edge (elements = 1) into the bucket of its lower end `low`, or counts one more element on
// it. ERROR_INPUT: the mesh does not fit together there.
static bool add_edge(const Mesh *mesh, int32_t element, const MeshEdge *edge, int32_t low,
                     MeshEdges *table, Error *err)
{
    MeshEdge *known = find_edge(table, low, edge->high);
    const double *from = mesh_place(mesh, low), *to = mesh_place(mesh, edge->high);
    double x = (from[0] + to[0]) / 2, z = (from[mesh->dim - 1] + to[mesh->dim - 1]) / 2;
    if (!known) {
        table->edges[table->last[low]++] = *edge;
        goto cleanup;
    }
    if (known->middle != edge->middle)
        FAIL(err, ERROR_INPUT,
             "%s: elements %lld and %lld share the edge at (%g, %g) but not its mid-side node: "
             "elements of different order do not fit together",
             mesh->path, (long long)mesh->element_number[known->element],
             (long long)mesh->element_number[element], x, z);
    if (++known->elements > 2)
        FAIL(err, ERROR_INPUT,
             "%s: the edge at (%g, %g) is on more than two elements (%lld among them): elements "
             "overlap",
             mesh->path, x, z, (long long)mesh->element_number[element]);
cleanup:
    return error_is_clean(err);
}

// Edge k of an element runs from corner k to the next; mid-side node k of a quadratic one, which
// follows its corners, is on it.
static bool fill_edges(const Mesh *mesh, MeshEdges *table, Error *err)
{
    for (int32_t e = 0; e < mesh->element_count; e++) {
        const int32_t *nodes = mesh->element_nodes + mesh->first_node[e];
        int32_t corners = element_corner_count(mesh->kind[e]);
        bool straight = element_node_count(mesh->kind[e]) == corners;
        for (int32_t k = 0; k < corners; k++) {
            int32_t a = nodes[k], b = nodes[(k + 1) % corners], low = a < b ? a : b;
            MeshEdge edge = {.high = a < b ? b : a,
                             .middle = straight ? -1 : nodes[corners + k],
                             .elements = 1,
                             .element = e};
            TRY(add_edge(mesh, e, &edge, low, table, err));
        }
    }
cleanup:
    return error_is_clean(err);
}

// A first pass counts an edge once for each element on it: at most twice the room that is needed.
bool mesh_edges_build(const Mesh *mesh, MeshEdges *table, Error *err)
{
    *table = (MeshEdges){0};
    table->first = NEW_ARRAY(int32_t, (int64_t)mesh->node_count + 1, err);
    if (!table->first) goto cleanup;
    if (!(table->last = NEW_ARRAY(int32_t, mesh->node_count, err))) goto cleanup;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        const int32_t *nodes = mesh->element_nodes + mesh->first_node[e];
        int32_t corners = element_corner_count(mesh->kind[e]);
        for (int32_t k = 0; k < corners; k++) {
            int32_t a = nodes[k], b = nodes[(k + 1) % corners];
            table->first[(a < b ? a : b) + 1]++;
        }
    }
    for (int32_t i = 0; i < mesh->node_count; i++) {
        table->first[i + 1] += table->first[i];
        table->last[i] = table->first[i];
    }
    table->edges = NEW_ARRAY(MeshEdge, table->first[mesh->node_count], err);
    if (!table->edges) goto cleanup;
    TRY(fill_edges(mesh, table, err));
cleanup:
    return error_is_clean(err);
}

void mesh_edges_destroy(MeshEdges *table)
{
    memory_free(table->first);
    memory_free(table->last);
    memory_free(table->edges);
    *table = (MeshEdges){0};
}

// one, other: its two end nodes in either order; NULL: no element has such an edge.
const MeshEdge *mesh_edges_find(const MeshEdges *table, int32_t one, int32_t other)
{
    return one < other ? find_edge(table, one, other) : find_edge(table, other, one);
}
