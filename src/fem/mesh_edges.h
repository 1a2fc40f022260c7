// SPDX-License-Identifier: GPL-2.0-or-later
// The edges of a mesh's elements, each once, with the number of elements it is on: 1 on the block's
// boundary, 2 inside. Used by fem/mesh to check elements, curves and contact lines.
#ifndef AMONTONS_FEM_MESH_EDGES_H
#define AMONTONS_FEM_MESH_EDGES_H

#include "fem/mesh.h"

#include <stdint.h>

typedef struct MeshEdge {
    int32_t high;   // the end with the larger index; the smaller one is the bucket
    int32_t middle;   // mid-side node, -1: none
    int32_t elements;   // on how many elements
    int32_t element;   // one of them
} MeshEdge;

// Edges in buckets by their lower end: those of node i are edges[first[i] .. last[i] - 1].
typedef struct MeshEdges {
    int32_t *first;   // [node_count + 1]; owned
    int32_t *last;   // [node_count]; owned
    MeshEdge *edges;   // [first[node_count]]; owned
} MeshEdges;

// ERROR_INPUT where an edge is on three elements or has two different mid-side nodes.
bool mesh_edges_build(const Mesh *mesh, MeshEdges *table, Error *err);
void mesh_edges_destroy(MeshEdges *table);

// The edge between two nodes, NULL: none.
const MeshEdge *mesh_edges_find(const MeshEdges *table, int32_t one, int32_t other);

#endif
