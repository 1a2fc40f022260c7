// SPDX-License-Identifier: GPL-2.0-or-later
// The assembled bulk: patch tests on distorted meshes of each element, a dense assembly beside the
// sparse one, tractions and weights.
#include "fem/assembly.h"

#include "plane.h"

#include "block_mesh.h"
#include "fem/element.h"
#include "dense_by_hand.h"
#include "paper_material.h"

static BlockDef distorted(int32_t kind)
{
    return (BlockDef){.kind = (ElementKind)kind,
                      .nx = 4,
                      .nz = 3,
                      .length = 1.3,
                      .height = 0.8,
                      .distortion = 0.25,
                      .seed = (uint64_t)kind + 1};
}

static void press_on(const Mesh *mesh, const char *name, double x, double z, Bulk *bulk)
{
    Error err = {0};
    MeshBoundary curve;
    assert_true(mesh_boundary(mesh, name, &curve, &err));
    bulk_add_traction(mesh, &curve, (double[2]){x, z}, bulk);
}

// A uniform strain needs no force but the tractions s n on the four sides: K u = f at every node.
// And likewise C v = f for a uniform rate.
TEST(test_patch)
{
    Error err = {0};
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        Material material = {.young = 2, .poisson = 0.3, .density = 1, .eta1 = 0.6, .eta2 = 0.9};
        BlockDef def = distorted(kind);
        Mesh mesh;
        Bulk bulk;
        block_build(&def, &mesh);
        for (int which = 0; which < 2; which++) {
            assert_true(bulk_create(&mesh, &bulk, &err) &&
                        bulk_assemble(&mesh, &material, &bulk, &err));
            double d[STRAINS_MAX][STRAINS_MAX], stress[3] = {0}, strain[3] = {0.4, -0.7, 0.5};
            moduli_matrix(which ? material_viscous(&material) : material_elastic(&material), 2, d);
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++) stress[r] += d[r][c] * strain[c];
            press_on(&mesh, "contact", -stress[2], -stress[1], &bulk);
            press_on(&mesh, "top", stress[2], stress[1], &bulk);
            press_on(&mesh, "rod", -stress[0], -stress[2], &bulk);
            press_on(&mesh, "leading", stress[0], stress[2], &bulk);
            double *u = hand_matrix(bulk.dof_count, 1), *force = hand_matrix(bulk.dof_count, 1);
            for (int32_t k = 0; k < mesh.node_count; k++) {
                double x = mesh.position[2 * k], z = mesh.position[2 * k + 1];
                u[2 * k] = 1 + strain[0] * x + 0.9 * z;
                u[2 * k + 1] = 2 + (strain[2] - 0.9) * x + strain[1] * z;
            }
            sparse_apply(&bulk.pattern, which ? bulk.damping : bulk.stiffness, u, force);
            assert_all_near(ELEMENTS[def.kind].name, force, bulk.load, bulk.dof_count, 1e-13);
            free(u);
            free(force);
            bulk_destroy(&bulk);
        }
        mesh_destroy(&mesh);
    }
}

// Entry by entry against a dense matrix filled element by element; the pattern in order. Elements
// of all shapes, then many of few shapes.
TEST(test_dense_assembly)
{
    Error err = {0};
    Material material = paper_material();
    material.density = 1.7;
    for (int32_t trial = 0; trial < 2 * PLANE_KINDS; trial++) {
        BlockDef def = distorted(trial / 2);
        if (trial % 2) def.distortion = 0;
        Mesh mesh;
        Bulk bulk;
        block_build(&def, &mesh);
        assert_true(bulk_create(&mesh, &bulk, &err) &&
                    bulk_assemble(&mesh, &material, &bulk, &err));
        int32_t n = 2 * mesh.node_count, stored = 0, needed = 0;
        assert_int_equal(bulk.dof_count, n);
        double *k_dense = hand_matrix(n, n), *c_dense = hand_matrix(n, n);
        double *mass = hand_matrix(n, 1);
        for (int32_t e = 0; e < mesh.element_count; e++) {
            const int32_t *nodes = mesh.element_nodes + mesh.first_node[e];
            MeshPlace position[ELEMENT_NODES_MAX];
            int32_t count = element_node_count(def.kind);
            for (int32_t a = 0; a < count; a++)
                memcpy(position[a], mesh_place(&mesh, nodes[a]), 2 * sizeof(double));
            ElementMatrices matrices;
            element_matrices(def.kind, (const MeshPlace *)position, &material, true, &matrices);
            for (int32_t i = 0; i < 2 * count; i++) {
                int32_t row = 2 * nodes[i / 2] + i % 2;
                mass[row] += matrices.mass[i / 2];
                for (int32_t j = 0; j < 2 * count; j++) {
                    int32_t entry = (2 * nodes[j / 2] + j % 2) * n + row;
                    k_dense[entry] += matrices.stiffness[i][j];
                    c_dense[entry] += matrices.damping[i][j];
                }
            }
        }
        for (int32_t column = 0; column < n; column++) {
            for (int32_t m = bulk.pattern.start[column]; m < bulk.pattern.start[column + 1]; m++) {
                int32_t row = bulk.pattern.index[m];
                assert_true(m == bulk.pattern.start[column] || row > bulk.pattern.index[m - 1]);
                assert_near("K", bulk.stiffness[m], k_dense[column * n + row], 1e-14);
                assert_near("C", bulk.damping[m], c_dense[column * n + row], 1e-14);
                if (k_dense[column * n + row] != 0) stored++;
            }
        }
        for (int32_t m = 0; m < n * n; m++) needed += k_dense[m] != 0;
        assert_int_equal(stored, needed);   // nothing is left out
        assert_all_near("M", bulk.mass, mass, n, 1e-14);
        assert_near("area", bulk.area, 1.3 * 0.8, 1e-14);
        double total = 0;
        for (int32_t m = 0; m < n; m += 2) total += bulk.mass[m];
        assert_near("mass", total, 1.7 * 1.3 * 0.8, 1e-13);
        free(k_dense);
        free(c_dense);
        free(mass);
        bulk_destroy(&bulk);
        mesh_destroy(&mesh);
    }
}

// A uniform pressure gives each node its share: halves in order 1, 1/6, 4/6, 1/6 in order 2; the
// resultant is traction times length, its moment that of the middle.
TEST(test_weights_and_tractions)
{
    Error err = {0};
    Material material = paper_material();
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        BlockDef def = distorted(kind);
        Mesh mesh;
        Bulk bulk;
        MeshBoundary top;
        block_build(&def, &mesh);
        assert_true(bulk_create(&mesh, &bulk, &err) &&
                    bulk_assemble(&mesh, &material, &bulk, &err));
        for (int32_t k = 0; k < bulk.dof_count; k++) assert_true(bulk.load[k] == 0);
        assert_true(mesh_boundary(&mesh, "top", &top, &err));
        double *weight = hand_matrix(mesh.node_count, 1);
        boundary_add_weights(&mesh, &top, true, weight);
        double cell = 1.3 / 4, sum = 0;
        for (int32_t k = 0; k < top.node_count; k++) {   // by ascending x
            bool end = k == 0 || k == top.node_count - 1;
            double wanted = top.nodes_per_face == 2 ? (end ? cell / 2 : cell)
                                                    : (end          ? cell / 6
                                                       : k % 2 == 1 ? cell * 4 / 6
                                                                    : cell / 3);
            assert_near("weight", weight[top.nodes[k]], wanted, 1e-15);
        }
        for (int32_t k = 0; k < mesh.node_count; k++) sum += weight[k];
        assert_near("length", sum, 1.3, 1e-14);
        press_on(&mesh, "top", 0.2, -3, &bulk);
        press_on(&mesh, "top", 0, -3, &bulk);   // tractions add
        double x = 0, z = 0, moment = 0;
        for (int32_t k = 0; k < mesh.node_count; k++) {
            x += bulk.load[2 * k];
            z += bulk.load[2 * k + 1];
            moment += mesh.position[2 * k] * bulk.load[2 * k + 1];
        }
        assert_near("F_x", x, 0.2 * 1.3, 1e-14);
        assert_near("F_z", z, -6 * 1.3, 1e-13);
        assert_near("moment", moment, -6 * 1.3 * 0.65, 1e-13);
        free(weight);
        bulk_destroy(&bulk);
        mesh_destroy(&mesh);
    }
}

// Unknowns that are held stay at 0: their rows and columns are cut, their load is gone, and the
// rest moves as if they were left out.
TEST(test_held)
{
    Error err = {0};
    Material material = paper_material();
    BlockDef def = distorted(ELEMENT_Q4);
    Mesh mesh;
    Bulk bulk;
    block_build(&def, &mesh);
    assert_true(bulk_create(&mesh, &bulk, &err) && bulk_assemble(&mesh, &material, &bulk, &err));
    press_on(&mesh, "top", 0.3, -1, &bulk);
    int32_t n = bulk.dof_count;
    double *a[2] = {hand_matrix(n, n), hand_matrix(n, n)}, *x[2];
    for (int round = 0; round < 2; round++) {   // K + C + M by hand cut, then by bulk_hold
        x[round] = hand_matrix(n, 1);
        if (round == 1)
            for (int32_t dof = 0; dof < n; dof += 7) bulk_hold(dof, &bulk);
        for (int32_t j = 0; j < n; j++) {
            for (int32_t m = bulk.pattern.start[j]; m < bulk.pattern.start[j + 1]; m++) {
                int32_t i = bulk.pattern.index[m];
                bool cut = round == 0 && i != j && (i % 7 == 0 || j % 7 == 0);
                a[round][j * n + i] =
                    cut ? 0 : bulk.stiffness[m] + bulk.damping[m] + (i == j ? bulk.mass[i] : 0);
            }
            x[round][j] = round == 0 && j % 7 == 0 ? 0 : bulk.load[j];
            assert_int_equal(bulk.held[j], round == 1 && j % 7 == 0);
        }
        assert_true(hand_solve(a[round], n, x[round], 1));
    }
    assert_all_near("x", x[1], x[0], n, 1e-13);
    for (int32_t dof = 0; dof < n; dof += 7) assert_true(x[1][dof] == 0);
    for (int round = 0; round < 2; round++) {
        free(a[round]);
        free(x[round]);
    }
    bulk_destroy(&bulk);
    mesh_destroy(&mesh);
}

TEST(test_memory_faults)
{
    Material material = paper_material();
    BlockDef def = distorted(ELEMENT_Q4);
    Mesh mesh;
    block_build(&def, &mesh);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        Bulk bulk;
        memory_fail_after(k);
        done = bulk_create(&mesh, &bulk, &err) && bulk_assemble(&mesh, &material, &bulk, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        bulk_destroy(&bulk);
        assert_int_equal(memory_counters().live, live);
    }
    mesh_destroy(&mesh);
}
