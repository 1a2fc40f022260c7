// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks of elements in space, reduced in their four parts, in two and as they are, against their
// full matrices, dense and by hand: S within what the reduction allows, products and solves to
// rounding, rigid motions that nothing resists.
#include "reduction/mirror.h"
#include "reduction/symmetric_part.h"
#include "space_mesh.h"
#include "unit/reduction/reduced_checks.h"

static const Material MATERIAL = {
    .young = 2.5, .poisson = 0.3, .density = 1.7, .eta1 = 0.4, .eta2 = 0.9, .plane_strain = true};
static const double TOLERANCE = 2e-2, TRACTION[] = {0.1, 0.05, -0.3};

// Four parts, two (one node off the middle of another's image across x), none (nodes inside moved
// at random), and mid-sides that carry the contact.
typedef struct SpaceCase {
    SpaceDef shape;
    int32_t parts;
} SpaceCase;
static const SpaceCase CASES[] = {
    {{.kind = ELEMENT_HEX8, .cells = {5, 4, 3}, .size = {1.2, 0.9, 0.6}}, 4},
    {{.kind = ELEMENT_HEX27, .cells = {2, 2, 2}, .size = {1.2, 0.9, 0.6}}, 4},
    {{.kind = ELEMENT_HEX8, .cells = {4, 4, 3}, .size = {1, 1, 0.7}, .distortion = 0.1, .seed = 3},
     1},
    {{.kind = ELEMENT_TET10, .cells = {2, 2, 1}, .size = {1, 0.8, 0.5}}, 1},
};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

// All contact nodes with weight, and x of a row of rod nodes.
static void list_interface(ReducedBlock *block)
{
    Error err = {0};
    MeshBoundary contact, rod;
    assert_true(mesh_boundary(&block->mesh, "contact", &contact, &err));
    assert_true(mesh_boundary(&block->mesh, "rod", &rod, &err));
    block->dofs = calloc(3 * (size_t)(contact.node_count + rod.node_count), sizeof *block->dofs);
    int32_t count = 0, last = rod.nodes[rod.node_count - 1];
    for (int32_t k = 0; k < 3 * contact.node_count; k++)
        block->dofs[count++] = 3 * contact.nodes[k / 3] + k % 3;
    double height = block->mesh.position[3 * last + 2];
    for (int32_t k = 0; k < rod.node_count; k++)
        if (fabs(block->mesh.position[3 * rod.nodes[k] + 2] - height) < 1e-9)
            block->dofs[count++] = 3 * rod.nodes[k];
    block->interface_count = count;
}

static void build(const SpaceCase *one, ReducedBlock *block)
{
    Error err = {0};
    MeshBoundary top;
    dense_use_one_thread();
    memset(block, 0, sizeof *block);
    space_build(&one->shape, &block->mesh);
    assert_true(bulk_create(&block->mesh, &block->bulk, &err) &&
                bulk_assemble(&block->mesh, &MATERIAL, &block->bulk, &err));
    assert_true(mesh_boundary(&block->mesh, "top", &top, &err));
    bulk_add_traction(&block->mesh, &top, TRACTION, &block->bulk);
    list_interface(block);
    int32_t *image[2];
    for (int32_t axis = 0; axis < 2; axis++) {
        double *position = hand_matrix(block->bulk.dof_count, 1);
        memcpy(position, block->mesh.position, (size_t)block->bulk.dof_count * sizeof *position);
        assert_true(
            mirror_nodes_find(3, axis, position, block->mesh.node_count, &image[axis], &err));
        free(position);
    }
    double length = one->shape.size[0];
    block->def =
        (ReductionDef){.tolerance = TOLERANCE,
                       .materials = materials_of(&MATERIAL),
                       .modes = true,
                       .no_patches = true,
                       .node_image = image,
                       .position = block->mesh.position,
                       .scales = {MATERIAL.young * length, (MATERIAL.eta1 + MATERIAL.eta2) * length,
                                  MATERIAL.density * length * length * length,
                                  dense_max_abs(block->bulk.load, block->bulk.dof_count)}};
    if (!reduction_build(&block->bulk, block->dofs, block->interface_count, &block->def,
                         &block->reduced, &err))
        fail_msg("%s", err.message);
    assert_int_equal(block->reduced.part_count, one->parts);
    for (int32_t axis = 0; axis < 2; axis++) memory_free(image[axis]);
}

TEST(test_response)
{
    static const OperatorTerms ASKED[] = {
        {.stiffness = 1, .mass = 1e-2}, {.stiffness = 1, .damping = 1, .mass = 1e-1},
        {.stiffness = 1, .mass = 3},    {.damping = 1, .mass = 50},
        {.stiffness = 1, .mass = 1000}, {.stiffness = 0.1, .damping = 2, .mass = 0.3}};
    for (int32_t s = 0; s < CASE_COUNT; s++) {
        ReducedBlock block;
        build(&CASES[s], &block);
        const BulkScales *scales = &block.def.scales;
        for (size_t k = 0; k < sizeof ASKED / sizeof *ASKED; k++) {
            double least, largest, *full = full_schur(&block, ASKED[k]);
            double *reduced = reduced_schur(&block.reduced, ASKED[k]);
            energy_differences(reduced, full, block.interface_count, &least, &largest);
            double inertia =
                ASKED[k].mass * scales->mass /
                (ASKED[k].stiffness * scales->stiffness + ASKED[k].damping * scales->damping);
            assert_true(least > -ROUNDING);   // a Galerkin projection is too stiff
            assert_true(largest < reduced_bulk_error(&block.reduced, inertia) + ROUNDING);
            free(full), free(reduced);
        }
        reduced_block_destroy(&block);
    }
}

TEST(test_operator)
{
    for (int32_t s = 0; s < CASE_COUNT; s++) {
        ReducedBlock block;
        build(&CASES[s], &block);
        check_operator(&block, 71 + (uint64_t)s);
        reduced_block_destroy(&block);
    }
}

// Translations move every node alike, rotations turn it: K u = 0, and u x is normal to its axis.
TEST(test_rigid_motions)
{
    for (int32_t s = 0; s < CASE_COUNT; s++) {
        ReducedBlock block;
        BulkOperator system;
        Error err = {0};
        build(&CASES[s], &block);
        assert_true(bulk_operator_reduce(&block.reduced, 1, 1, &system, &err));
        int32_t n = block.bulk.dof_count;
        double *full = hand_matrix(n, 1), *force = hand_matrix(n, 1);
        for (int32_t which = 0; which < 6; which++) {
            recover_state(&block.reduced, system.rigid + which * block.reduced.count, full);
            sparse_apply(&block.bulk.pattern, block.bulk.stiffness, full, force);
            assert_true(dense_max_abs(full, n) > 0.3);
            assert_true(dense_max_abs(force, n) < 1e-10);
            for (int32_t k = 0; which < 3 && k < n; k++)
                assert_near("u", full[k], k % 3 == which, 1e-10);
        }
        bulk_operator_destroy(&system);
        free(full), free(force);
        reduced_block_destroy(&block);
    }
}

// Node across y of each node, by its place: -1 where there is none.
static int32_t *nodes_across(const ReducedBlock *block, double breadth)
{
    const Mesh *mesh = &block->mesh;
    int32_t *across = calloc((size_t)mesh->node_count, sizeof *across);
    for (int32_t i = 0; i < mesh->node_count; i++) {
        const double *at = mesh->position + 3 * i;
        across[i] = -1;
        for (int32_t j = 0; j < mesh->node_count; j++) {
            const double *there = mesh->position + 3 * j;
            if (hypot(hypot(at[0] - there[0], at[2] - there[2]), at[1] + there[1] - breadth) < 1e-9)
                across[i] = j;
        }
    }
    return across;
}

// A v = x for held interface motions of `even`: g and v. [interface_count], [dof_count]
static void condense_and_expand(InterfaceOperator *condensed, const BulkOperator *system,
                                const double *x, const double *even, double *g, double *v)
{
    Error err = {0};
    double *border = hand_matrix(system->interface_count, 1);
    for (int32_t k = 0; k < system->interface_count; k++)
        border[k] = even[system->interface_dofs[k]];
    assert_true(interface_operator_condense(condensed, x, g, &err));
    assert_true(interface_operator_expand(condensed, border, v, &err));
    free(border);
}

// With the symmetric part alone what is asked of x is what is asked of `even`, its symmetric part,
// and all of it again where the others act again. On a mesh nothing changes.
static void check_alone(const SymmetricPart *part, BulkOperator *system, const double *x,
                        const double *even)
{
    Error err = {0};
    int32_t size = system->dof_count, m = system->interface_count;
    double *answers[3][5], lacks = symmetric_part_antisymmetric(part, x);
    OperatorTerms terms = {.stiffness = 0.7, .damping = 1, .mass = 2};
    InterfaceOperator *condensed = interface_operator_create(system, terms, &err);
    assert_non_null(condensed);
    assert_true(system->reduced ? lacks > 0.1 && lacks <= 1 : isnan(lacks));
    if (system->reduced) assert_true(symmetric_part_antisymmetric(part, even) < 1e-15);
    for (int32_t k = 0; k < 3; k++) {   // of x with the symmetric part alone, of even, of x
        const double *of = k == 1 ? even : x;
        for (int32_t a = 0; a < 5; a++) answers[k][a] = hand_matrix(size, 1);
        symmetric_part_alone(part, k == 0);
        for (BulkTerm term = BULK_STIFFNESS; term <= BULK_MASS; term++)
            bulk_operator_apply(system, term, of, answers[k][term]);
        condense_and_expand(condensed, system, of, even, answers[k][3], answers[k][4]);
    }
    for (int32_t a = 0; a < 5; a++) {
        double scale = dense_max_abs(answers[2][a], size), off = 0;
        for (int32_t i = 0; i < size; i++)
            off = fmax(off, fabs(answers[1][a][i] - answers[2][a][i]));
        assert_true(off > 1e-3 * scale);
        assert_all_near("alone", answers[0][a], answers[system->reduced ? 1 : 2][a],
                        a == 3 ? m : size, 1e-11 * scale);
    }
    for (int32_t k = 0; k < 3; k++)
        for (int32_t a = 0; a < 5; a++) free(answers[k][a]);
    interface_operator_destroy(condensed);
}

// Half of what a node and its image have, node by node of the mesh: on the mesh, and in parts,
// whose states are recovered. Nothing joins both parts. Blocks that are not their own images have
// none.
TEST(test_symmetric_part)
{
    for (int32_t s = 0; s < CASE_COUNT; s++) {
        Error err = {0};
        ReducedBlock block;
        BulkOperator system[2];
        SymmetricPart part[2];
        build(&CASES[s], &block);
        int32_t m = block.interface_count, n = block.bulk.dof_count, place = 0;
        int32_t *across = nodes_across(&block, CASES[s].shape.size[1]);
        int32_t *image = calloc((size_t)m, sizeof *image);
        double *sign = hand_matrix(m, 1);
        bool split = CASES[s].parts == 4;
        Random random = {.state = 17 + (uint64_t)s};
        for (int32_t k = 0; k < m; k++) {
            int32_t dof = 3 * across[block.dofs[k] / 3] + block.dofs[k] % 3;
            for (place = 0; place < m && block.dofs[place] != dof;) place++;
            image[k] = place < m ? place : k;
            sign[k] = dof % 3 == 1 ? -1 : 1;
        }
        assert_true(bulk_operator_create(&block.bulk, block.mesh.position, block.dofs, m,
                                         &system[0], &err));
        assert_true(bulk_operator_reduce(&block.reduced, 1, 1, &system[1], &err));
        for (int32_t k = 0; k < 2; k++) {
            assert_true(symmetric_part_find(&system[k], image, sign, &part[k], &err));
            assert_int_equal(part[k].exists, split);
            if (!split) continue;
            int32_t size = system[k].dof_count;
            double *x = hand_matrix(size, 1), *even = hand_matrix(size, 1);
            double *force = hand_matrix(size, 1), *full = hand_matrix(n, 1);
            double *full_even = hand_matrix(n, 1);
            for (int32_t i = 0; i < size; i++) x[i] = random_between(&random, -1, 1);
            symmetric_part_take(&part[k], x, even);
            bulk_operator_apply(&system[k], BULK_STIFFNESS, even, force);
            check_alone(&part[k], &system[k], x, even);
            double joined = 0, own = 0;
            for (int32_t i = 0; i < size; i++) joined += force[i] * (x[i] - even[i]);
            for (int32_t i = 0; i < size; i++) own += force[i] * even[i];
            assert_true(own > 0 && fabs(joined) < 1e-11 * own);
            assert_true(bulk_operator_recover(&system[k], 1, (const double *const[]){x},
                                              (double *[]){full}, &err));
            assert_true(bulk_operator_recover(&system[k], 1, (const double *const[]){even},
                                              (double *[]){full_even}, &err));
            for (int32_t i = 0; i < n; i++) {
                double there = (i % 3 == 1 ? -1 : 1) * full[3 * across[i / 3] + i % 3];
                assert_near("u", full_even[i], 0.5 * (full[i] + there), 1e-10);
            }
            free(x), free(even), free(force), free(full), free(full_even);
        }
        for (int32_t k = 0; k < 2; k++) {
            symmetric_part_destroy(&part[k]);
            bulk_operator_destroy(&system[k]);
        }
        free(across), free(image), free(sign);
        reduced_block_destroy(&block);
    }
}
