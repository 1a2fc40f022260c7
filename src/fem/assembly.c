// SPDX-License-Identifier: GPL-2.0-or-later
// M, C and K of the semi-discrete block, M u'' + C u' + K u = f, summed element by element (Hughes,
// The Finite Element Method, ch. 2). K and C share one pattern of dim x dim blocks, one for each
// pair of nodes with a common element; both triangles are stored. M is lumped: a vector.
//
//     unknowns by node, from u_x to u_z;  row-compressed, columns ascending
//
// Entries are found by bisection in a row.
#include "fem/assembly.h"

#include "base/hash.h"
#include "base/memory.h"
#include "fem/element_group.h"
#include "fem/mesh_faces.h"

#include <math.h>
#include <string.h>

// The nodes that share an element with each node, ascending, itself included.
typedef struct NodeGraph {
    int32_t *start;   // [nodes + 1]
    int32_t *neighbour;   // [start[nodes]]
} NodeGraph;

// Puts a node into an ascending list of `count` that has room for it; returns how many there are
// then. Lists are short.
static int32_t insert_node(int32_t node, int32_t *list, int32_t count)
{
    int32_t place = count;
    while (place > 0 && list[place - 1] > node) place--;
    if (place > 0 && list[place - 1] == node) return count;
    memmove(list + place + 1, list + place, (size_t)(count - place) * sizeof *list);
    list[place] = node;
    return count + 1;
}

// Room for every pair of every element, then close together.
static bool build_graph(const Mesh *mesh, NodeGraph *graph, Error *err)
{
    int32_t nodes = mesh->node_count;
    ElementGroup group;
    int32_t *filled = NEW_ARRAY(int32_t, nodes, err);
    graph->start = NEW_ARRAY(int32_t, (int64_t)nodes + 1, err);
    TRY(filled && graph->start);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        if (!element_group_at(mesh, e, &group)) continue;
        for (int32_t a = 0; a < group.node_count; a++)
            graph->start[group.node[a] + 1] += group.node_count;
    }
    for (int32_t i = 0; i < nodes; i++) graph->start[i + 1] += graph->start[i];
    graph->neighbour = NEW_ARRAY(int32_t, graph->start[nodes], err);
    TRY(graph->neighbour);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        if (!element_group_at(mesh, e, &group)) continue;
        for (int32_t a = 0; a < group.node_count; a++) {
            int32_t node = group.node[a], *list = graph->neighbour + graph->start[node];
            for (int32_t b = 0; b < group.node_count; b++)
                filled[node] = insert_node(group.node[b], list, filled[node]);
        }
    }
    int32_t kept = 0;
    for (int32_t i = 0; i < nodes; i++) {
        memmove(graph->neighbour + kept, graph->neighbour + graph->start[i],
                (size_t)filled[i] * sizeof *graph->neighbour);
        graph->start[i] = kept;
        kept += filled[i];
    }
    graph->start[nodes] = kept;
cleanup:
    memory_free(filled);
    return error_is_clean(err);
}

// From nodes to unknowns: each neighbour gives `dim` columns, the rows of a node are alike: dim^2
// entries for a pair of nodes. *pattern is the caller's to free also on failure.
static bool build_pattern(const Mesh *mesh, SparsePattern *pattern, Error *err)
{
    NodeGraph graph = {0};
    TRY(build_graph(mesh, &graph, err));
    int32_t nodes = mesh->node_count, dim = mesh->dim;
    pattern->size = dim * nodes;
    pattern->start = NEW_ARRAY(int32_t, (int64_t)dim * nodes + 1, err);
    pattern->index = NEW_ARRAY(int32_t, (int64_t)dim * dim * graph.start[nodes], err);
    if (!pattern->start || !pattern->index) goto cleanup;
    int32_t filled = 0;
    for (int32_t dof = 0; dof < pattern->size; dof++) {
        int32_t node = dof_node(dim, dof);
        for (int32_t k = graph.start[node]; k < graph.start[node + 1]; k++)
            for (int32_t d = 0; d < dim; d++)
                pattern->index[filled++] = node_dof(dim, graph.neighbour[k], d);
        pattern->start[dof + 1] = filled;
    }
cleanup:
    memory_free_all(graph.start, graph.neighbour);
    return error_is_clean(err);
}

// The unknowns of a node stand side by side in every row, and the rows of a node are alike, so one
// look-up serves a whole block.
static void add_group(const ElementGroup *group, const ElementMatrices *matrices, Bulk *bulk)
{
    const int32_t *element = group->node, *start = bulk->pattern.start;
    int32_t nodes = group->node_count, dim = bulk->dim;
    for (int32_t a = 0; a < nodes; a++) {
        int32_t row = node_dof(dim, element[a], 0), length = start[row + 1] - start[row];
        for (int32_t d = 0; d < dim; d++) bulk->mass[row + d] += matrices->mass[a];
        for (int32_t b = 0; b < nodes; b++) {
            int32_t entry = sparse_entry(&bulk->pattern, row, node_dof(dim, element[b], 0));
            int32_t i = node_dof(dim, a, 0), j = node_dof(dim, b, 0);
            for (int32_t d = 0; d < dim; d++, entry += length) {
                for (int32_t f = 0; f < dim; f++) {
                    bulk->stiffness[entry + f] += matrices->stiffness[i + d][j + f];
                    bulk->damping[entry + f] += matrices->damping[i + d][j + f];
                }
            }
        }
    }
    bulk->area += matrices->area;
}

// Elements of one shape and material have the same matrices: what some of the last ones had.
enum { SHAPES_KEPT = 16 };
typedef struct KnownShape {
    int32_t nodes;   // 0: none yet
    ElementKind kind;
    int32_t region;
    MeshPlace offset[ELEMENT_NODES_MAX];   // from the first node
    ElementMatrices matrices;
} KnownShape;

// Matrices follow from offsets alone, so whether they were kept does not show.
static const ElementMatrices *matrices_of(const Mesh *mesh, const ElementGroup *group,
                                          const Material *materials, KnownShape known[SHAPES_KEPT])
{
    MeshPlace offset[ELEMENT_NODES_MAX] = {0};
    size_t size = (size_t)group->node_count * sizeof *offset;
    mesh_offsets(mesh, group->node, group->node_count, offset);
    Hash hash = hash_start();
    hash_bytes(&hash, offset, size);
    KnownShape *shape = &known[hash.low % SHAPES_KEPT];
    ElementKind kind = mesh->kind[group->element[0]];
    int32_t region = mesh_region(mesh, group->element[0]);
    if (group->count == 1 && shape->nodes == group->node_count && shape->kind == kind &&
        shape->region == region && memcmp(shape->offset, offset, size) == 0)
        return &shape->matrices;
    shape->nodes = group->count == 1 ? group->node_count : 0;
    shape->kind = kind;
    shape->region = region;
    memcpy(shape->offset, offset, size);
    element_group_matrices(mesh, materials, group, &shape->matrices);
    return &shape->matrices;
}

// On a pattern that is there. Of a checked mesh (fem/mesh_build) every determinant is positive: no
// element can fail here.
static bool fill(const Mesh *mesh, const Material *materials, Bulk *bulk, Error *err)
{
    int64_t entries = bulk->pattern.start[bulk->dof_count];
    ElementGroup group;
    KnownShape *known = NEW_ARRAY(KnownShape, SHAPES_KEPT, err);
    bulk->stiffness = NEW_ARRAY(double, entries, err);
    bulk->damping = NEW_ARRAY(double, entries, err);
    bulk->mass = NEW_ARRAY(double, bulk->dof_count, err);
    bulk->load = NEW_ARRAY(double, bulk->dof_count, err);
    bulk->held = NEW_ARRAY(uint8_t, bulk->dof_count, err);
    for (int32_t e = 0; error_is_clean(err) && e < mesh->element_count; e++)
        if (element_group_at(mesh, e, &group))
            add_group(&group, matrices_of(mesh, &group, materials, known), bulk);
    memory_free(known);
    return error_is_clean(err);
}

bool bulk_assemble(const Mesh *mesh, const Material *materials, Bulk *bulk, Error *err)
{
    *bulk = (Bulk){.dim = mesh->dim, .dof_count = mesh->dim * mesh->node_count};
    return build_pattern(mesh, &bulk->pattern, err) && fill(mesh, materials, bulk, err);
}

bool bulk_assemble_like(const Bulk *like, const Mesh *mesh, const Material *materials, Bulk *bulk,
                        Error *err)
{
    const SparsePattern *from = &like->pattern;
    int64_t rows = from->size + 1, entries = from->start[from->size];
    *bulk = (Bulk){.dim = like->dim, .dof_count = from->size, .pattern.size = from->size};
    bulk->pattern.start = NEW_ARRAY(int32_t, rows, err);
    bulk->pattern.index = NEW_ARRAY(int32_t, entries, err);
    if (!error_is_clean(err)) return false;
    memcpy(bulk->pattern.start, from->start, (size_t)rows * sizeof *from->start);
    memcpy(bulk->pattern.index, from->index, (size_t)entries * sizeof *from->index);
    return fill(mesh, materials, bulk, err);
}

void bulk_destroy(Bulk *bulk)
{
    sparse_pattern_destroy(&bulk->pattern);
    memory_free_all(bulk->stiffness, bulk->damping, bulk->mass, bulk->load, bulk->held);
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

// share += int N_a dA of a face, or of its shadow on the floor, [its nodes].
static void share_face(const Mesh *mesh, FaceNodes face, bool shadow, double share[FACE_NODES_MAX])
{
    const int32_t *nodes = face.node;
    if (mesh->dim == 2) {
        double along = fabs(mesh_place(mesh, nodes[1])[0] - mesh_place(mesh, nodes[0])[0]);
        share_edge(shadow ? along : mesh_distance(mesh, nodes[0], nodes[1]),
                   element_node_count(face.kind), share);
        return;
    }
    MeshPlace position[FACE_NODES_MAX], normal;
    int32_t count = element_node_count(face.kind);
    Quadrature rule = shape_mass_quadrature(face.kind);
    mesh_places(mesh, nodes, count, position);
    for (int32_t q = 0; q < rule.count; q++) {
        ShapeValues shape = shape_at(face.kind, rule.point[q]);
        double size = 0;
        shape_normal(face.kind, &shape, (const MeshPlace *)position, normal);
        for (int32_t d = shadow ? mesh->dim - 1 : 0; d < mesh->dim; d++)
            size = hypot(size, normal[d]);
        for (int32_t a = 0; a < count; a++) share[a] += rule.weight[q] * size * shape.value[a];
    }
}

// int N_a dA of a T6's corners is 0 where it is flat and of either sign, as small as the square of
// its bend, where it is curved: half of each goes to the mid-sides beside it, so that corners of a
// curved contact touch nothing, either.
static void share_of_mid_sides(double share[FACE_NODES_MAX])
{
    static const double ROUNDING = 1e-12;   // over that of a mid-side
    for (int32_t a = 0; a < 3; a++) {
        double half = 0.5 * share[a];
        if (fabs(half) < ROUNDING * share[3 + a]) continue;
        share[3 + a] += half;
        share[3 + (a + 2) % 3] += half;
        share[a] = 0;
    }
}

// w_i = int N_i dA, at its mesh nodes: what turns a nodal reaction into a stress.
void boundary_add_weights(const Mesh *mesh, const MeshBoundary *boundary, bool shadow,
                          double *weight)
{
    for (int32_t k = 0; k < boundary->face_count; k++) {
        FaceNodes face = mesh_boundary_face(boundary, k);
        double share[FACE_NODES_MAX] = {0};
        share_face(mesh, face, shadow, share);
        if (mesh->dim > 2 && face.kind == ELEMENT_T6) share_of_mid_sides(share);
        for (int32_t a = 0; a < element_node_count(face.kind); a++)
            weight[face.node[a]] += share[a];
    }
}

// Exact on straight edges of either order, and on flat faces. traction: stress, on the block.
void bulk_add_traction(const Mesh *mesh, const MeshBoundary *boundary, const double *traction,
                       Bulk *bulk)
{
    for (int32_t k = 0; k < boundary->face_count; k++) {
        FaceNodes face = mesh_boundary_face(boundary, k);
        double share[FACE_NODES_MAX] = {0};
        share_face(mesh, face, false, share);
        for (int32_t a = 0; a < element_node_count(face.kind); a++)
            for (int32_t d = 0; d < bulk->dim; d++)
                bulk->load[node_dof(bulk->dim, face.node[a], d)] += share[a] * traction[d];
    }
}
