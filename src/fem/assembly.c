// SPDX-License-Identifier: GPL-2.0-or-later
// M, C and K of the semi-discrete block, M u'' + C u' + K u = f, summed element by element (Hughes,
// The Finite Element Method, ch. 2). K and C share one pattern of dim x dim blocks, one for each
// pair of nodes with a common element; both triangles are stored. M is lumped: a vector.
#include "fem/assembly.h"

#include "base/memory.h"
#include "fem/element_group.h"
#include "fem/mesh_faces.h"

#include <math.h>
#include <string.h>

// Nodes that move a common group of elements are neighbours. *pattern is the caller's to free also
// on failure.
static bool build_pattern(const Mesh *mesh, SparsePattern *pattern, Error *err)
{
    int32_t *start = NEW_ARRAY(int32_t, (int64_t)mesh->element_count + 1, err), count = 0;
    int32_t corners = mesh->first_node[mesh->element_count], room = corners, *nodes = NULL;
    const Floor *floor = &mesh->floor;
    ElementGroup group;
    if (!start) goto cleanup;
    for (int32_t a = 0; a < corners; a++)
        room += floor_end(floor, mesh->element_nodes[a]) -
                floor_start(floor, mesh->element_nodes[a]);
    TRY((nodes = NEW_ARRAY(int32_t, room, err)));
    for (int32_t e = 0; e < mesh->element_count; e++) {
        if (!element_group_at(mesh, e, &group)) continue;

        // The nodes whose unknowns move the group, each once: its own, and those of the floor that
        // its contact nodes move with.
        int32_t own = group.node_count, movers = own, *list = nodes + start[count];
        memcpy(list, group.node, (size_t)own * sizeof *list);
        for (int32_t a = 0; a < own; a++)
            for (int32_t k = floor_start(floor, list[a]); k < floor_end(floor, list[a]); k++) {
                int32_t known = own;
                while (known < movers && list[known] != floor->node[k]) known++;
                list[known] = floor->node[k];
                if (known == movers) movers++;
            }
        start[count + 1] = start[count] + movers;
        count++;
    }
    PointGroups groups = {mesh->node_count, count, start, nodes};
    TRY(sparse_pattern_of_groups(&groups, mesh->dim, pattern, err));
cleanup:
    memory_free_all(start, nodes);
    return error_is_clean(err);
}

// One of the nodes that move node a of an element: itself, or one of the floor's with its share.
typedef struct Mover {
    int32_t node;
    double share;
} Mover;

// Number k of them; false: there are no more.
static bool mover_at(const Floor *floor, int32_t node, int32_t k, Mover *mover)
{
    int32_t at = floor_start(floor, node) + k - 1;
    if (k > 0 && at >= floor_end(floor, node)) return false;
    *mover = k == 0 ? (Mover){node, 1} : (Mover){floor->node[at], floor->share[at]};
    return true;
}

// Adds T' (K, C) T of a block of two nodes, T the shares, to values on the bulk's pattern
// (stiffness NULL: to none). The unknowns of a node stand side by side in every row, and the rows
// of a node are alike, so one look-up serves a whole block.
static void add_block(const ElementMatrices *matrices, int32_t a, int32_t b, Mover row,
                      Mover column, const Bulk *bulk, double *stiffness, double *damping)
{
    int32_t dim = bulk->dim, first = node_dof(dim, row.node, 0);
    int32_t length = bulk->pattern.start[first + 1] - bulk->pattern.start[first];
    int32_t entry = sparse_entry(&bulk->pattern, first, node_dof(dim, column.node, 0));
    int32_t i = node_dof(dim, a, 0), j = node_dof(dim, b, 0);
    double share = row.share * column.share;
    for (int32_t d = 0; d < dim; d++, entry += length) {
        for (int32_t f = 0; f < dim; f++) {
            if (stiffness) stiffness[entry + f] += share * matrices->stiffness[i + d][j + f];
            damping[entry + f] += share * matrices->damping[i + d][j + f];
        }
    }
}

static void add_group(const Mesh *mesh, const ElementGroup *group, const ElementMatrices *matrices,
                      const Bulk *bulk, double *stiffness, double *damping)
{
    const Floor *floor = &mesh->floor;
    const int32_t *node = group->node;
    Mover row, column;
    for (int32_t a = 0; a < group->node_count; a++)
        for (int32_t k = 0; mover_at(floor, node[a], k, &row); k++)
            for (int32_t b = 0; b < group->node_count; b++)
                for (int32_t l = 0; mover_at(floor, node[b], l, &column); l++)
                    add_block(matrices, a, b, row, column, bulk, stiffness, damping);
}

// Adds the masses of a group's nodes: T' M T, and its area.
static void add_mass(const Mesh *mesh, const ElementGroup *group, const ElementMatrices *matrices,
                     Bulk *bulk)
{
    Mover row, column;
    for (int32_t a = 0; a < group->node_count; a++)
        for (int32_t k = 0; mover_at(&mesh->floor, group->node[a], k, &row); k++)
            for (int32_t l = 0; mover_at(&mesh->floor, group->node[a], l, &column); l++) {
                double value = row.share * column.share * matrices->mass[a];
                for (int32_t d = 0; d < bulk->dim; d++) {
                    int32_t i = node_dof(bulk->dim, row.node, d);
                    int32_t j = node_dof(bulk->dim, column.node, d);
                    if (i == j)
                        bulk->mass[i] += value;
                    else
                        bulk->mass_beside[sparse_entry(&bulk->pattern, i, j)] += value;
                }
            }
    if (!mesh_in_base(mesh, group->node[0])) bulk->area += matrices->area;
}

bool bulk_create(const Mesh *mesh, Bulk *bulk, Error *err)
{
    *bulk = (Bulk){.dim = mesh->dim, .dof_count = mesh->dim * mesh->node_count};
    bulk->load = NEW_ARRAY(double, bulk->dof_count, err);
    bulk->held = NEW_ARRAY(uint8_t, bulk->dof_count, err);

    // In space places order the sparse factor; in the plane minimum degree leaves less.
    if (mesh->dim == 3) bulk->place = NEW_ARRAY(double, 3 * (int64_t)bulk->dof_count, err);
    for (int32_t dof = 0; bulk->place && dof < bulk->dof_count; dof++)
        memcpy(bulk->place + 3 * (int64_t)dof, mesh_place(mesh, dof_node(3, dof)),
               3 * sizeof(double));
    if (mesh->is_base && (bulk->in_base = NEW_ARRAY(uint8_t, bulk->dof_count, err)))
        for (int32_t dof = 0; dof < bulk->dof_count; dof++)
            bulk->in_base[dof] = mesh->is_base[dof_node(mesh->dim, dof)];
    return error_is_clean(err);
}

void bulk_apply_mass(const Bulk *bulk, const double *x, double *y)
{
    if (bulk->mass_beside) sparse_apply(&bulk->pattern, bulk->mass_beside, x, y);
    for (int32_t k = 0; k < bulk->dof_count; k++)
        y[k] = (bulk->mass_beside ? y[k] : 0) + bulk->mass[k] * x[k];
}

// Row and column but for the diagonal, so that the matrices stay symmetric and positive.
static void empty_row(int32_t dof, Bulk *bulk)
{
    const SparsePattern *pattern = &bulk->pattern;
    for (int32_t k = pattern->start[dof]; k < pattern->start[dof + 1]; k++) {
        int32_t other = pattern->index[k];
        if (other == dof) continue;
        int32_t mirror = sparse_entry(pattern, other, dof);
        bulk->stiffness[k] = bulk->stiffness[mirror] = 0;
        bulk->damping[k] = bulk->damping[mirror] = 0;
        if (bulk->mass_beside) bulk->mass_beside[k] = bulk->mass_beside[mirror] = 0;
        for (int32_t j = 0; j < bulk->spectrum.matrix_count; j++)
            bulk->shape[j][k] = bulk->shape[j][mirror] = 0;
    }
}

// In a checked mesh (fem/mesh_build) every determinant is positive: no element can fail here.
bool bulk_assemble(const Mesh *mesh, const Material *materials, Bulk *bulk, Error *err)
{
    ElementGroup group;
    ElementMatrices matrices;
    if (!build_pattern(mesh, &bulk->pattern, err)) return false;
    int64_t entries = bulk->pattern.start[bulk->dof_count];
    bulk->stiffness = NEW_ARRAY(double, entries, err);
    bulk->damping = NEW_ARRAY(double, entries, err);
    bulk->mass = NEW_ARRAY(double, bulk->dof_count, err);
    if (mesh->floor.start) bulk->mass_beside = NEW_ARRAY(double, entries, err);
    for (int32_t e = 0; error_is_clean(err) && e < mesh->element_count; e++) {
        if (!element_group_at(mesh, e, &group)) continue;
        element_group_matrices(mesh, materials, &group, &matrices);
        add_group(mesh, &group, &matrices, bulk, bulk->stiffness, bulk->damping);
        add_mass(mesh, &group, &matrices, bulk);
    }
    for (int32_t j = 0; j < bulk->spectrum.matrix_count; j++) {
        bulk->shape[j] = NEW_ARRAY(double, entries, err);

        // S_j is the damping of a material with those viscosities.
        const SpectrumShape *shape = &bulk->spectrum.shape[j];
        Material like[MATERIALS_MAX] = {0};
        like[shape->region] =
            (Material){.young = 1, .eta1 = shape->moduli.deviator, .eta2 = shape->moduli.trace};
        for (int32_t e = 0; error_is_clean(err) && e < mesh->element_count; e++) {
            if (mesh_region(mesh, e) != shape->region || !element_group_at(mesh, e, &group))
                continue;
            element_group_matrices(mesh, like, &group, &matrices);
            add_group(mesh, &group, &matrices, bulk, NULL, bulk->shape[j]);
        }
    }
    for (int32_t dof = 0; error_is_clean(err) && dof < bulk->dof_count; dof++)
        if (bulk->held[dof]) empty_row(dof, bulk);
    return error_is_clean(err);
}

void bulk_destroy(Bulk *bulk)
{
    sparse_pattern_destroy(&bulk->pattern);
    memory_free_all(bulk->stiffness, bulk->damping, bulk->mass, bulk->load, bulk->held);
    memory_free_all(bulk->place, bulk->mass_beside, bulk->in_base);
    for (int32_t j = 0; j < SPECTRUM_SHAPES_MAX; j++) memory_free(bulk->shape[j]);
    *bulk = (Bulk){0};
}

void bulk_hold(int32_t dof, Bulk *bulk)
{
    if (bulk->stiffness) empty_row(dof, bulk);
    bulk->load[dof] = 0;
    bulk->held[dof] = 1;
}

// share += int N_a dA of a face, or of its shadow on the floor, [its nodes].
static void share_face(const Mesh *mesh, FaceNodes face, bool shadow, double share[FACE_NODES_MAX])
{
    const int32_t *nodes = face.node;
    if (mesh->dim == 2) {
        double along = fabs(mesh_place(mesh, nodes[1])[0] - mesh_place(mesh, nodes[0])[0]);

        // int N_a ds on a straight edge: halves, or Simpson's 1/6, 1/6, 4/6 (end, end, middle).
        double length = shadow ? along : mesh_distance(mesh, nodes[0], nodes[1]);
        share[0] = share[1] = element_node_count(face.kind) == 2 ? length / 2 : length / 6;
        share[2] = length * 4 / 6;

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

// w_i = int N_i dA, at its mesh nodes: what turns a nodal reaction into a stress.
void boundary_add_weights(const Mesh *mesh, const MeshBoundary *boundary, bool shadow,
                          double *weight)
{
    for (int32_t k = 0; k < boundary->face_count; k++) {
        FaceNodes face = mesh_boundary_face(boundary, k);
        double share[FACE_NODES_MAX] = {0};
        share_face(mesh, face, shadow, share);

        if (mesh->dim > 2 && face.kind == ELEMENT_T6) {
            // int N_a dA of a T6's corners is 0 where it is flat and of either sign, as small as
            // the square of its bend, where it is curved: half of each goes to the mid-sides beside
            // it, so that corners of a curved contact touch nothing, either.
            static const double ROUNDING = 1e-12;   // over that of a mid-side
            for (int32_t a = 0; a < 3; a++) {
                double half = 0.5 * share[a];
                if (fabs(half) < ROUNDING * share[3 + a]) continue;
                share[3 + a] += half;
                share[3 + (a + 2) % 3] += half;
                share[a] = 0;
            }
        }

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
