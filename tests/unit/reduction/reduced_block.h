// SPDX-License-Identifier: GPL-2.0-or-later
// A block reduced to its contact nodes and one rod node, with the full matrices beside it, dense.
#ifndef AMONTONS_TESTS_REDUCED_BLOCK_H
#define AMONTONS_TESTS_REDUCED_BLOCK_H

#include "algebra/dense.h"
#include "block_mesh.h"
#include "reduction/interface_operator.h"
#include "reduction/reduction.h"
#include "dense_by_hand.h"
#include "energy_differences.h"
#include "marked_layer.h"

typedef struct ReducedBlock {
    Mesh mesh;
    Bulk bulk;
    int32_t interface_count;
    int32_t *dofs;   // [interface_count], x and z of each contact node, then x of a rod node
    ReductionDef def;
    ReducedBulk reduced;
} ReducedBlock;

static inline BulkScales block_scales(const Mesh *mesh, const Material *material, double load)
{
    double length = mesh->x_max - mesh->x_min;
    return (BulkScales){.stiffness = material->young,
                        .damping = material->eta1 + material->eta2,
                        .mass = material->density * length * length,
                        .load = load};
}

// Assembles, loads the top with `load` per length along -z and a quarter of it along x; reduces
// unless tolerance is 0.
static inline void reduced_block_build_of(const BlockDef *shape, Materials materials, double layer,
                                          double load, double tolerance, ReducedBlock *block)
{
    Error err = {0};
    MeshBoundary contact, rod, top;
    double traction[2] = {load / 4, -load};
    dense_use_one_thread();
    memset(block, 0, sizeof *block);
    block_build(shape, &block->mesh);
    mark_layer(&block->mesh, layer, &materials);
    assert_true(bulk_create(&block->mesh, &block->bulk, &err) &&
                spectrum_find(&materials, 2, &block->bulk.spectrum, &err) &&
                bulk_assemble(&block->mesh, materials.list, &block->bulk, &err));
    assert_true(mesh_boundary(&block->mesh, "contact", &contact, &err));
    assert_true(mesh_boundary(&block->mesh, "rod", &rod, &err));
    assert_true(mesh_boundary(&block->mesh, "top", &top, &err));
    bulk_add_traction(&block->mesh, &top, traction, &block->bulk);
    block->interface_count = 2 * contact.node_count + 1;
    block->dofs = calloc((size_t)block->interface_count, sizeof *block->dofs);
    for (int32_t k = 0; k < 2 * contact.node_count; k++)
        block->dofs[k] = 2 * contact.nodes[k / 2] + k % 2;
    block->dofs[block->interface_count - 1] = 2 * rod.nodes[rod.node_count / 2];
    double largest = dense_max_abs(block->bulk.load, block->bulk.dof_count);
    block->def = (ReductionDef){.tolerance = tolerance,
                                .materials = materials,
                                .modes = true,
                                .position = block->mesh.position,
                                .scales = block_scales(&block->mesh, &materials.mean, largest)};
    if (tolerance > 0 && !reduction_build(&block->bulk, block->dofs, block->interface_count,
                                          &block->def, &block->reduced, &err))
        fail_msg("%s", err.message);
}

static inline void reduced_block_build(const BlockDef *shape, const Material *material, double load,
                                       double tolerance, ReducedBlock *block)
{
    reduced_block_build_of(shape, materials_of(material), 0, load, tolerance, block);
}

static inline void reduced_block_destroy(ReducedBlock *block)
{
    reduced_bulk_destroy(&block->reduced);
    free(block->dofs);
    bulk_destroy(&block->bulk);
    mesh_destroy(&block->mesh);
}

static inline double *dense_matrix(const Bulk *bulk, const double *values)
{
    int32_t n = bulk->dof_count;
    double *a = hand_matrix(n, n);
    for (int32_t j = 0; j < n; j++)
        for (int32_t k = bulk->pattern.start[j]; k < bulk->pattern.start[j + 1]; k++)
            a[j * n + bulk->pattern.index[k]] = values[k];
    return a;
}

static inline double *dense_mass(const Bulk *bulk)
{
    int32_t n = bulk->dof_count;
    double *a = hand_matrix(n, n);
    for (int32_t j = 0; j < n; j++) a[j * n + j] = bulk->mass[j];
    return a;
}

// full [full_dofs] of one state.
static inline void recover_state(const ReducedBulk *reduced, const double *state, double *full)
{
    Error err = {0};
    assert_true(reduced_bulk_recover(reduced, 1, &state, &full, &err));
}

// S of A = mass M + damping C + stiffness K and its branches: on the full mesh, or on a reduced
// bulk.
static inline double *full_schur(ReducedBlock *block, OperatorTerms terms)
{
    Error err = {0};
    BulkOperator system;
    int32_t m = block->interface_count;
    double *schur = hand_matrix(m, m);
    assert_true(
        bulk_operator_create(&block->bulk, block->mesh.position, block->dofs, m, &system, &err));
    InterfaceOperator *level = interface_operator_create(&system, terms, &err);
    if (!level) fail_msg("%s", err.message);
    memcpy(schur, interface_operator_schur(level), (size_t)(m * m) * sizeof *schur);
    interface_operator_destroy(level);
    bulk_operator_destroy(&system);
    return schur;
}

static inline double *reduced_schur(const ReducedBulk *reduced, OperatorTerms terms)
{
    Error err = {0};
    BulkOperator system;
    int32_t m = reduced->interface_count;
    double *schur = hand_matrix(m, m);
    assert_true(bulk_operator_reduce(reduced, 1, 1, &system, &err));
    InterfaceOperator *level = interface_operator_create(&system, terms, &err);
    if (!level) fail_msg("%s", err.message);
    memcpy(schur, interface_operator_schur(level), (size_t)(m * m) * sizeof *schur);
    interface_operator_destroy(level);
    bulk_operator_destroy(&system);
    return schur;
}

// [count^2] M of a part as one matrix.
static inline double *whole_mass(const ReducedPart *part)
{
    int32_t m = part->border_count, r = part->interior_count, count = part->count;
    double *mass = hand_matrix(count, count);
    for (int32_t k = 0; k < m * m; k++) mass[k / m * count + k % m] = part->mass[k];
    for (int32_t k = 0; k < r * m; k++)
        mass[k / r * count + m + k % r] = mass[(m + k % r) * count + k / r] = part->coupling[k];
    for (int32_t k = 0; k < r; k++) mass[(m + k) * (count + 1)] = part->masses[k];
    return mass;
}
#endif
