// SPDX-License-Identifier: GPL-2.0-or-later
// One element of each kind, straight and distorted: rigid motions, energies of known strains,
// eigenvalues, lumped masses against published fractions.
#include "fem/element.h"

#include "plane.h"

#include "block_mesh.h"
#include "dense_by_hand.h"
#include "paper_material.h"

// The elements of distorted blocks, three blocks a kind.
typedef void (*ElementCheck)(ElementKind kind, const MeshPlace *position,
                             const ElementMatrices *matrices, const Material *material);

static void for_all_elements(const Material *material, ElementCheck check)
{
    for (int32_t k = 0; k < 3 * PLANE_KINDS; k++) {
        BlockDef def = {.kind = (ElementKind)(k / 3),
                        .nx = 3,
                        .nz = 3,
                        .length = 1.2,
                        .height = 0.7,
                        .distortion = 0.12 * (k % 3),
                        .seed = (uint64_t)k};
        Mesh mesh;
        block_build(&def, &mesh);
        for (int32_t e = 0; e < mesh.element_count; e++) {
            MeshPlace position[ELEMENT_NODES_MAX];
            mesh_places(&mesh, mesh.element_nodes + mesh.first_node[e],
                        element_node_count(def.kind), position);
            ElementMatrices matrices;
            element_matrices(def.kind, (const MeshPlace *)position, material, true, &matrices);
            check(def.kind, (const MeshPlace *)position, &matrices, material);
        }
        mesh_destroy(&mesh);
    }
}

// The polygon's area by the shoelace formula, from its corners.
static double corner_area(ElementKind kind, const MeshPlace *position)
{
    int32_t corners = kind == ELEMENT_T3 || kind == ELEMENT_T6 ? 3 : 4;
    double sum = 0;
    for (int32_t a = 0; a < corners; a++) {
        const double *p = position[a], *q = position[(a + 1) % corners];
        sum += p[0] * q[1] - q[0] * p[1];
    }
    return sum / 2;
}

static double quadratic_form(const double (*matrix)[ELEMENT_DOFS_MAX], const double *u,
                             const double *v, int32_t dofs)
{
    double sum = 0;
    for (int32_t i = 0; i < dofs; i++)
        for (int32_t j = 0; j < dofs; j++) sum += u[i] * matrix[i][j] * v[j];
    return sum;
}

// u = G x + c, four numbers of G row by row.
static void linear_motion(int32_t nodes, const MeshPlace *position, const double g[4], double *u)
{
    for (int32_t a = 0; a < nodes; a++) {
        u[2 * a] = 0.3 + g[0] * position[a][0] + g[1] * position[a][1];
        u[2 * a + 1] = -0.8 + g[2] * position[a][0] + g[3] * position[a][1];
    }
}

static void check_linear(ElementKind kind, const MeshPlace *position,
                         const ElementMatrices *matrices, const Material *material)
{
    int32_t nodes = element_node_count(kind), dofs = 2 * nodes;
    assert_int_equal(matrices->dof_count, dofs);
    double area = corner_area(kind, position), u[ELEMENT_DOFS_MAX], v[ELEMENT_DOFS_MAX];
    assert_near("area", matrices->area, area, 1e-14);

    const double turn[] = {0, -1, 1, 0};   // and a translation: no force
    linear_motion(nodes, position, turn, u);
    for (int32_t i = 0; i < dofs; i++) {
        double held = 0, damped = 0;
        for (int32_t j = 0; j < dofs; j++) {
            held += matrices->stiffness[i][j] * u[j];
            damped += matrices->damping[i][j] * u[j];
        }
        assert_near("force of a rigid motion", held, 0, 1e-13);
        assert_near("viscous force of a rigid motion", damped, 0, 1e-13);
    }

    // Work between two constant strains: area * strain' D strain.
    const double g[] = {0.7, 0.2, -0.5, 0.4}, h[] = {-0.1, 0.9, 0.3, 1.1};
    const double strain_g[] = {g[0], g[3], g[1] + g[2]}, strain_h[] = {h[0], h[3], h[1] + h[2]};
    double elastic[STRAINS_MAX][STRAINS_MAX], viscous[STRAINS_MAX][STRAINS_MAX], held = 0,
                                                                                 damped = 0;
    moduli_matrix(material_elastic(material), 2, elastic);
    moduli_matrix(material_viscous(material), 2, viscous);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            held += area * strain_g[r] * elastic[r][c] * strain_h[c];
            damped += area * strain_g[r] * viscous[r][c] * strain_h[c];
        }
    }
    linear_motion(nodes, position, g, u);
    linear_motion(nodes, position, h, v);
    assert_near("u' K v", quadratic_form(matrices->stiffness, u, v, dofs), held, 1e-13);
    assert_near("u' C v", quadratic_form(matrices->damping, u, v, dofs), damped, 1e-13);
}

TEST(test_linear_motions)
{
    Material material = {.young = 2, .poisson = 0.3, .density = 1.5, .eta1 = 0.7, .eta2 = 0.2};
    for_all_elements(&material, check_linear);
    material.plane_strain = true;
    for_all_elements(&material, check_linear);
}

// Symmetric, with three zero eigenvalues and no negative one.
static void check_spectrum(ElementKind kind, const MeshPlace *position,
                           const ElementMatrices *matrices, const Material *material)
{
    (void)position;
    (void)material;
    int32_t dofs = 2 * element_node_count(kind);
    double a[ELEMENT_DOFS_MAX * ELEMENT_DOFS_MAX], values[ELEMENT_DOFS_MAX];
    for (int which = 0; which < 2; which++) {
        for (int32_t i = 0; i < dofs; i++) {
            for (int32_t j = 0; j < dofs; j++) {
                a[j * dofs + i] = which ? matrices->damping[i][j] : matrices->stiffness[i][j];
                double other = which ? matrices->damping[j][i] : matrices->stiffness[j][i];
                assert_near("symmetric", a[j * dofs + i], other, 1e-14);
            }
        }
        hand_eigenvalues(a, dofs, values);
        for (int32_t k = 0; k < 3; k++) assert_near("rigid", values[k], 0, 1e-13);
        if (!(values[3] > 1e-3 * values[dofs - 1]))
            fail_msg("%s: a fourth mode without energy (%g of %g)", ELEMENTS[kind].name, values[3],
                     values[dofs - 1]);
    }
}

TEST(test_spectra)
{
    Material material = paper_material();
    for_all_elements(&material, check_spectrum);
}

static void check_mass(ElementKind kind, const MeshPlace *position, const ElementMatrices *matrices,
                       const Material *material)
{
    double total = 0;
    for (int32_t a = 0; a < ELEMENT_NODES_MAX; a++) {
        assert_true(a < element_node_count(kind) ? matrices->mass[a] > 0 : matrices->mass[a] == 0);
        total += matrices->mass[a];
    }
    assert_near("mass", total, material->density * corner_area(kind, position), 1e-14);
}

// Fractions of the total on straight elements: Hinton, Rock and Zienkiewicz's for quadrilaterals;
// T6 with int N^2 by the three points its stiffness is integrated with.
TEST(test_masses)
{
    Material material = paper_material();
    material.density = 2.5;
    for_all_elements(&material, check_mass);
    const double fractions[PLANE_KINDS][3] = {[ELEMENT_T3] = {1. / 3},
                                              [ELEMENT_T6] = {3. / 57, 16. / 57},
                                              [ELEMENT_Q4] = {1. / 4},
                                              [ELEMENT_Q8] = {3. / 76, 16. / 76},
                                              [ELEMENT_Q9] = {1. / 36, 4. / 36, 16. / 36}};
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        int32_t nodes = element_node_count((ElementKind)kind);
        int32_t corners = kind == ELEMENT_T3 || kind == ELEMENT_T6 ? 3 : 4;
        MeshPlace position[ELEMENT_NODES_MAX];
        for (int32_t a = 0; a < nodes; a++) {
            const double *at = shape_node((ElementKind)kind, a);
            double xi = at[0], eta = at[1];
            position[a][0] = 3 * xi + eta;   // a parallelogram
            position[a][1] = 2 * eta;
        }
        ElementMatrices matrices;
        element_matrices((ElementKind)kind, (const MeshPlace *)position, &material, true,
                         &matrices);
        double total = 2.5 * matrices.area;
        for (int32_t a = 0; a < nodes; a++)
            assert_near("fraction", matrices.mass[a] / total,
                        fractions[kind][a < corners ? 0 : (a < 2 * corners ? 1 : 2)], 1e-14);
    }
}

// With eta1 and eta2 in the proportion of the elastic moduli, C is a time times K.
static void check_proportional(ElementKind kind, const MeshPlace *position,
                               const ElementMatrices *matrices, const Material *material)
{
    (void)position;
    double duration = material->eta1 * (1 + material->poisson) / material->young;
    for (int32_t i = 0; i < 2 * element_node_count(kind); i++)
        for (int32_t j = 0; j < 2 * element_node_count(kind); j++)
            assert_near("C", matrices->damping[i][j], duration * matrices->stiffness[i][j], 1e-14);
}

TEST(test_damping_is_the_viscous_stiffness)
{
    double nu = 0.3, duration = 0.4;
    Material material = {.young = 1,
                         .poisson = nu,
                         .density = 1,
                         .eta1 = duration / (1 + nu),
                         .eta2 = duration * nu / (1 - nu * nu)};
    for_all_elements(&material, check_proportional);
    material.plane_strain = true;
    material.eta2 = duration * nu / ((1 + nu) * (1 - 2 * nu));
    for_all_elements(&material, check_proportional);
}

// u_x = x^2 on elements of order 2, over a rectangle a times b: u' K u = D_11 4 a^3 b / 3.
TEST(test_quadratic_motions)
{
    Material material = paper_material();
    double axial = moduli_axial(material_elastic(&material));
    const ElementKind kinds[] = {ELEMENT_T6, ELEMENT_Q8, ELEMENT_Q9};
    for (int32_t k = 0; k < 3; k++) {
        BlockDef def = {.kind = kinds[k], .nx = 1, .nz = 1, .length = 1.5, .height = 0.6};
        Mesh mesh;
        block_build(&def, &mesh);
        double energy = 0;
        for (int32_t e = 0; e < mesh.element_count; e++) {
            MeshPlace position[ELEMENT_NODES_MAX];
            double u[ELEMENT_DOFS_MAX] = {0};
            int32_t nodes = element_node_count(def.kind);
            mesh_places(&mesh, mesh.element_nodes + mesh.first_node[e], nodes, position);
            for (int32_t a = 0; a < nodes; a++) u[2 * a] = position[a][0] * position[a][0];
            ElementMatrices matrices;
            element_matrices(def.kind, (const MeshPlace *)position, &material, true, &matrices);
            energy += quadratic_form(matrices.stiffness, u, u, 2 * nodes);
        }
        assert_near(ELEMENTS[def.kind].name, energy, axial * 4 * 1.5 * 1.5 * 1.5 * 0.6 / 3, 1e-13);
        mesh_destroy(&mesh);
    }
}
