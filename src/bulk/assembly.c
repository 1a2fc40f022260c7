// SPDX-License-Identifier: GPL-2.0-or-later
// M, C and K of the semi-discrete block, M u'' + C u' + K u = f, summed element by element (Hughes,
// The Finite Element Method, ch. 2). K and C share one pattern of 2x2 blocks, one for each pair of
// nodes with a common element; both triangles are stored. M is lumped: a vector.
//
//     unknown 2 i: u_x of node i;  2 i + 1: u_z;  row-compressed, columns ascending
//
// Entries are found by bisection in a row: little beside computing an element's matrices.
#include "bulk/assembly.h"

#include "base/memory.h"
#include "bulk/element.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The nodes that share an element with each node, ascending, itself included.
typedef struct NodeGraph {
    int32_t *start;   // [nodes + 1]
    int32_t *neighbour;   // [start[nodes]]
} NodeGraph;

// For qsort: ascending, without the overflow of a difference.
static int compare_indices(const void *a, const void *b)
{
    int32_t left = *(const int32_t *)a, right = *(const int32_t *)b;
    return (left > right) - (left < right);
}

// Lists every pair of every element, then sorts each node's list and drops repetitions.
static bool build_graph(const Mesh *mesh, NodeGraph *graph, Error *err)
{
    int32_t nodes = mesh->node_count;
    int32_t *filled = NEW_ARRAY(int32_t, nodes, err);
    graph->start = NEW_ARRAY(int32_t, (int64_t)nodes + 1, err);
    TRY(filled && graph->start);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        int32_t first = mesh->first_node[e], count = mesh->first_node[e + 1] - first;
        for (int32_t a = 0; a < count; a++)
            graph->start[mesh->element_nodes[first + a] + 1] += count;
    }
    for (int32_t i = 0; i < nodes; i++) graph->start[i + 1] += graph->start[i];
    graph->neighbour = NEW_ARRAY(int32_t, graph->start[nodes], err);
    TRY(graph->neighbour);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        const int32_t *element = mesh->element_nodes + mesh->first_node[e];
        int32_t count = mesh->first_node[e + 1] - mesh->first_node[e];
        for (int32_t a = 0; a < count; a++) {
            int32_t *list = graph->neighbour + graph->start[element[a]] + filled[element[a]];
            memcpy(list, element, (size_t)count * sizeof *list);
            filled[element[a]] += count;
        }
    }
    int32_t kept = 0;
    for (int32_t i = 0; i < nodes; i++) {
        int32_t *list = graph->neighbour + graph->start[i];
        qsort(list, (size_t)filled[i], sizeof *list, compare_indices);
        graph->start[i] = kept;
        for (int32_t k = 0; k < filled[i]; k++) {
            if (k == 0 || list[k] != list[k - 1]) graph->neighbour[kept++] = list[k];
        }
    }
    graph->start[nodes] = kept;
cleanup:
    memory_free(filled);
    return error_is_clean(err);
}

// From nodes to unknowns: each neighbour gives two columns, both rows of a node are alike: 4
// entries for a pair of nodes. *pattern is the caller's to free also on failure.
static bool build_pattern(const Mesh *mesh, SparsePattern *pattern, Error *err)
{
    NodeGraph graph = {0};
    TRY(build_graph(mesh, &graph, err));
    int32_t nodes = mesh->node_count;
    pattern->size = 2 * nodes;
    pattern->start = NEW_ARRAY(int32_t, 2 * (int64_t)nodes + 1, err);
    pattern->index = NEW_ARRAY(int32_t, 4 * (int64_t)graph.start[nodes], err);
    if (!pattern->start || !pattern->index) goto cleanup;
    int32_t filled = 0;
    for (int32_t dof = 0; dof < 2 * nodes; dof++) {
        int32_t node = dof / 2;
        for (int32_t k = graph.start[node]; k < graph.start[node + 1]; k++) {
            pattern->index[filled++] = 2 * graph.neighbour[k];
            pattern->index[filled++] = 2 * graph.neighbour[k] + 1;
        }
        pattern->start[dof + 1] = filled;
    }
cleanup:
    memory_free(graph.start);
    memory_free(graph.neighbour);
    return error_is_clean(err);
}

// Unknowns 2 b and 2 b + 1 of a node stand side by side in every row, so one look-up serves both.
static void add_element(const Mesh *mesh, int32_t e, const ElementMatrices *matrices, Bulk *bulk)
{
    const int32_t *element = mesh->element_nodes + mesh->first_node[e];
    int32_t nodes = matrices->dof_count / 2;
    for (int32_t a = 0; a < nodes; a++) {
        for (int32_t d = 0; d < 2; d++) {
            int32_t row = 2 * element[a] + d;
            bulk->mass[row] += matrices->mass[a];
            for (int32_t b = 0; b < nodes; b++) {
                int32_t entry = sparse_entry(&bulk->pattern, row, 2 * element[b]);
                for (int32_t f = 0; f < 2; f++) {
                    bulk->stiffness[entry + f] += matrices->stiffness[2 * a + d][2 * b + f];
                    bulk->damping[entry + f] += matrices->damping[2 * a + d][2 * b + f];
                }
            }
        }
    }
    bulk->area += matrices->area;
}

// Of a checked mesh (bulk/mesh_build) every determinant is positive: no element can fail here.
bool bulk_assemble(const Mesh *mesh, const Material *materials, Bulk *bulk, Error *err)
{
    *bulk = (Bulk){.dof_count = 2 * mesh->node_count};
    TRY(build_pattern(mesh, &bulk->pattern, err));
    int64_t entries = bulk->pattern.start[bulk->dof_count];
    bulk->stiffness = NEW_ARRAY(double, entries, err);
    bulk->damping = NEW_ARRAY(double, entries, err);
    bulk->mass = NEW_ARRAY(double, bulk->dof_count, err);
    bulk->load = NEW_ARRAY(double, bulk->dof_count, err);
    bulk->held = NEW_ARRAY(uint8_t, bulk->dof_count, err);
    if (!bulk->stiffness || !bulk->damping || !bulk->mass || !bulk->load || !bulk->held)
        goto cleanup;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        double position[ELEMENT_NODES_MAX][2];
        int32_t first = mesh->first_node[e], count = mesh->first_node[e + 1] - first;
        for (int32_t a = 0; a < count; a++)
            memcpy(position[a], mesh->position + 2 * mesh->element_nodes[first + a],
                   sizeof position[a]);
        ElementMatrices matrices;
        element_matrices(mesh->kind[e], (const double(*)[2])position,
                         &materials[mesh_region(mesh, e)], &matrices);
        add_element(mesh, e, &matrices, bulk);
    }
cleanup:
    return error_is_clean(err);
}

void bulk_destroy(Bulk *bulk)
{
    sparse_pattern_destroy(&bulk->pattern);
    memory_free(bulk->stiffness);
    memory_free(bulk->damping);
    memory_free(bulk->mass);
    memory_free(bulk->load);
    memory_free(bulk->held);
    *bulk = (Bulk){0};
}

// Row and column are emptied but for the diagonal, so that the matrices stay symmetric and
// positive.
void bulk_hold(int32_t dof, Bulk *bulk)
{
    const SparsePattern *pattern = &bulk->pattern;
    for (int32_t k = pattern->start[dof]; k < pattern->start[dof + 1]; k++) {
        int32_t other = pattern->index[k];
        if (other == dof) continue;
        int32_t mirror = sparse_entry(pattern, other, dof);
        bulk->stiffness[k] = bulk->stiffness[mirror] = 0;
        bulk->damping[k] = bulk->damping[mirror] = 0;
    }
    bulk->load[dof] = 0;
    bulk->held[dof] = 1;
}

// int N_a ds on a straight edge: halves, or Simpson's 1/6, 1/6, 4/6 (end, end, middle).
static void share_edge(double length, int32_t nodes, double weight[3])
{
    weight[0] = weight[1] = nodes == 2 ? length / 2 : length / 6;
    weight[2] = length * 4 / 6;
}

static void edge_weights(const Mesh *mesh, const MeshCurve *curve, int32_t edge, double weight[3])
{
    const int32_t *nodes = curve->edge_nodes + (int64_t)edge * curve->nodes_per_edge;
    const double *a = mesh->position + 2 * nodes[0], *b = mesh->position + 2 * nodes[1];
    share_edge(hypot(b[0] - a[0], b[1] - a[1]), curve->nodes_per_edge, weight);
}

// w_i = int N_i dx of the curve, at its mesh nodes: what turns a nodal reaction into a stress.
void curve_add_weights(const Mesh *mesh, const MeshCurve *curve, double *weight)
{
    for (int32_t edge = 0; edge < curve->edge_count; edge++) {
        const int32_t *nodes = curve->edge_nodes + (int64_t)edge * curve->nodes_per_edge;
        double share[3] = {0};
        share_edge(fabs(mesh->position[2 * nodes[1]] - mesh->position[2 * nodes[0]]),
                   curve->nodes_per_edge, share);
        for (int32_t a = 0; a < curve->nodes_per_edge; a++)
            weight[curve->edge_nodes[edge * curve->nodes_per_edge + a]] += share[a];
    }
}

// Exact on straight edges of either order. traction: (x, z), stress, on the block.
void bulk_add_traction(const Mesh *mesh, const MeshCurve *curve, const double traction[2],
                       Bulk *bulk)
{
    for (int32_t edge = 0; edge < curve->edge_count; edge++) {
        double share[3] = {0};
        edge_weights(mesh, curve, edge, share);
        for (int32_t a = 0; a < curve->nodes_per_edge; a++) {
            int32_t node = curve->edge_nodes[edge * curve->nodes_per_edge + a];
            bulk->load[2 * node] += share[a] * traction[0];
            bulk->load[2 * node + 1] += share[a] * traction[1];
        }
    }
}
