// SPDX-License-Identifier: GPL-2.0-or-later
// Elements in space, straight and distorted: shape functions by what defines them, quadrature
// against exact integrals, matrices against energies of known strains, rigid motions, spectra,
// masses; a patch of each under constant stress; contact weights and nodes.
#include "contact/interface.h"
#include "fem/assembly.h"
#include "fem/element_group.h"

#include "dense_by_hand.h"
#include "space_mesh.h"

static const ElementKind KINDS[] = {ELEMENT_TET4, ELEMENT_TET10, ELEMENT_WEDGE6, ELEMENT_HEX8,
                                    ELEMENT_HEX27};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };
static const Material MATERIAL = {
    .young = 2, .poisson = 0.3, .density = 1.5, .eta1 = 0.7, .eta2 = 0.2, .plane_strain = true};

static SpaceDef distorted(ElementKind kind)
{
    return (SpaceDef){
        .kind = kind, .cells = {3, 2, 3}, .size = {1.2, 0.5, 0.7}, .distortion = 0.15, .seed = 7};
}

TEST(test_shape_functions)
{
    const double h = 1e-5;
    for (int32_t k = 0; k < KIND_COUNT; k++) {
        int32_t nodes = element_node_count(KINDS[k]);
        for (int32_t b = 0; b < nodes; b++) {
            ShapeValues shape = shape_at(KINDS[k], shape_node(KINDS[k], b));
            for (int32_t a = 0; a < nodes; a++)
                assert_near("N", shape.value[a], a == b ? 1 : 0, 1e-15);
        }
        const double point[] = {0.21, 0.34, 0.15};
        double sum = 0, total[3] = {0};
        ShapeValues here = shape_at(KINDS[k], point);
        for (int d = 0; d < 3; d++) {
            double more[3] = {point[0], point[1], point[2]},
                   less[3] = {point[0], point[1], point[2]};
            more[d] += h, less[d] -= h;
            ShapeValues after = shape_at(KINDS[k], more), before = shape_at(KINDS[k], less);
            for (int32_t a = 0; a < nodes; a++) {
                total[d] += here.slope[a][d];
                assert_near("slope", here.slope[a][d], (after.value[a] - before.value[a]) / (2 * h),
                            1e-9);
            }
            assert_near("sum of slopes", total[d], 0, 1e-14);
        }
        for (int32_t a = 0; a < nodes; a++) sum += here.value[a];
        assert_near("sum", sum, 1, 1e-14);
    }
}

static double factorial(int32_t n)
{
    return n < 2 ? 1 : n * factorial(n - 1);
}

// Integral of x^i y^j z^k over the reference element.
static double exact_integral(ElementKind kind, int32_t i, int32_t j, int32_t k)
{
    double line = k % 2 ? 0 : 2. / (k + 1);
    if (kind == ELEMENT_TET4 || kind == ELEMENT_TET10)
        return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
    if (kind == ELEMENT_WEDGE6) return factorial(i) * factorial(j) / factorial(i + j + 2) * line;
    return i % 2 || j % 2 ? 0 : 4. / (i + 1) / (j + 1) * line;
}

// Degree in total on tetrahedra, along each line else; one more fails.
static void check_rule(ElementKind kind, const Quadrature *rule, int32_t degree)
{
    bool in_total = kind == ELEMENT_TET4 || kind == ELEMENT_TET10;
    int32_t flat = kind == ELEMENT_WEDGE6 ? 2 : degree;   // of the wedge's triangle
    double worst = 0, beyond = 0;
    for (int32_t i = 0; i <= degree; i++)
        for (int32_t j = 0; j <= degree; j++)
            for (int32_t k = 0; k <= degree + 1; k++) {
                double sum = 0;
                for (int32_t q = 0; q < rule->count; q++)
                    sum += rule->weight[q] * pow(rule->point[q][0], i) * pow(rule->point[q][1], j) *
                           pow(rule->point[q][2], k);
                double error = fabs(sum - exact_integral(kind, i, j, k));
                bool within = in_total                 ? i + j + k <= degree
                              : kind == ELEMENT_WEDGE6 ? i + j <= flat && k <= degree
                                                       : k <= degree;
                if (within) worst = fmax(worst, error);
                if (k == degree + 1 && i + j == 0) beyond = error;
            }
    assert_near(ELEMENTS[kind].name, worst, 0, 1e-15 * 8);
    assert_true(beyond > 1e-5);
}

TEST(test_quadrature)
{
    static const int32_t degrees[] = {1, 2, 3, 3, 5}, mass_degrees[] = {1, 5, 3, 3, 5};
    for (int32_t k = 0; k < KIND_COUNT; k++) {
        Quadrature rule = shape_quadrature(KINDS[k]), mass = shape_mass_quadrature(KINDS[k]);
        check_rule(KINDS[k], &rule, degrees[k]);
        check_rule(KINDS[k], &mass, mass_degrees[k]);
    }
}

// u = G x + c.
static void linear_motion(int32_t nodes, const MeshPlace *position, const double g[3][3], double *u)
{
    static const double c[] = {0.3, -0.8, 0.1};
    for (int32_t a = 0; a < nodes; a++)
        for (int d = 0; d < 3; d++) {
            u[3 * a + d] = c[d];
            for (int f = 0; f < 3; f++) u[3 * a + d] += g[d][f] * position[a][f];
        }
}

// Hooke's law written out: 2 G eps:eps + lambda tr^2, for two strains.
static double energy_density(double shear, double lambda, const double g[3][3],
                             const double h[3][3])
{
    double sum = 0, tr_g = 0, tr_h = 0;
    for (int i = 0; i < 3; i++) {
        tr_g += g[i][i], tr_h += h[i][i];
        for (int j = 0; j < 3; j++)
            sum += 2 * shear * (g[i][j] + g[j][i]) / 2 * (h[i][j] + h[j][i]) / 2;
    }
    return sum + lambda * tr_g * tr_h;
}

static double form(const double (*matrix)[ELEMENT_DOFS_MAX], const double *u, const double *v,
                   int32_t dofs)
{
    double sum = 0;
    for (int32_t i = 0; i < dofs; i++)
        for (int32_t j = 0; j < dofs; j++) sum += u[i] * matrix[i][j] * v[j];
    return sum;
}

static void check_element(ElementKind kind, const MeshPlace *position)
{
    static const double turn[3][3] = {{0, -1, 2}, {1, 0, -0.5}, {-2, 0.5, 0}};
    static const double g[3][3] = {{0.7, 0.2, 0.1}, {-0.5, 0.4, 0.9}, {0.3, -0.2, -0.6}};
    static const double h[3][3] = {{-0.1, 0.9, 0.4}, {0.3, 1.1, -0.7}, {0.2, 0.5, 0.8}};
    double u[ELEMENT_DOFS_MAX], v[ELEMENT_DOFS_MAX], nu = MATERIAL.poisson, young = MATERIAL.young;
    double shear = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    int32_t nodes = element_node_count(kind), dofs = 3 * nodes;
    ElementMatrices *matrices = malloc(sizeof *matrices);
    element_matrices(kind, position, &MATERIAL, true, matrices);
    assert_int_equal(matrices->dof_count, dofs);
    linear_motion(nodes, position, turn, u);
    for (int32_t i = 0; i < dofs; i++) {
        double held = 0, damped = 0;
        for (int32_t j = 0; j < dofs; j++) {
            held += matrices->stiffness[i][j] * u[j];
            damped += matrices->damping[i][j] * u[j];
            assert_near("symmetric", matrices->stiffness[i][j], matrices->stiffness[j][i], 1e-14);
        }
        assert_near("force of a rigid motion", held, 0, 1e-13);
        assert_near("viscous force of a rigid motion", damped, 0, 1e-13);
    }
    linear_motion(nodes, position, g, u);
    linear_motion(nodes, position, h, v);
    double volume = matrices->area, mass = 0;
    assert_near("u' K v", form(matrices->stiffness, u, v, dofs),
                volume * energy_density(shear, lambda, g, h), 1e-13);
    assert_near("u' C v", form(matrices->damping, u, v, dofs),
                volume * energy_density(MATERIAL.eta1 / 2, MATERIAL.eta2, g, h), 1e-13);
    for (int32_t a = 0; a < nodes; a++) {
        assert_true(matrices->mass[a] > 0);
        mass += matrices->mass[a];
    }
    assert_near("mass", mass, MATERIAL.density * volume, 1e-14);
    double *a = hand_matrix(dofs, dofs), *values = hand_matrix(dofs, 1);
    for (int32_t i = 0; i < dofs; i++)
        for (int32_t j = 0; j < dofs; j++) a[j * dofs + i] = matrices->stiffness[i][j];
    hand_eigenvalues(a, dofs, values);
    for (int32_t k = 0; k < 6; k++) assert_near("rigid", values[k], 0, 1e-13);
    if (!(values[6] > 1e-4 * values[dofs - 1]))
        fail_msg("%s: a seventh mode without energy (%g of %g)", ELEMENTS[kind].name, values[6],
                 values[dofs - 1]);
    free(a);
    free(values);
    free(matrices);
}

TEST(test_elements)
{
    for (int32_t k = 0; k < KIND_COUNT; k++) {
        SpaceDef def = distorted(KINDS[k]);
        Mesh mesh;
        double volume = 0;
        space_build(&def, &mesh);
        for (int32_t e = 0; e < mesh.element_count; e++) {
            MeshPlace position[ELEMENT_NODES_MAX];
            mesh_places(&mesh, mesh.element_nodes + mesh.first_node[e],
                        element_node_count(def.kind), position);
            if (e % 5 == 0) check_element(def.kind, (const MeshPlace *)position);
            volume += mesh_element_area(&mesh, e);
        }
        assert_near("volume", volume, 1.2 * 0.5 * 0.7, 1e-14);
        mesh_destroy(&mesh);
    }
}

// Constant stress, whatever the elements' shapes: K u of a linear field is the load of its
// tractions.
static void check_patch(bool mean)
{
    static const char *const sides[] = {"rod", "leading", "left", "right", "contact", "top"};
    static const double g[3][3] = {{0.7, 0.2, 0.1}, {-0.5, 0.4, 0.9}, {0.3, -0.2, -0.6}};
    double nu = MATERIAL.poisson, shear = MATERIAL.young / (2 * (1 + nu));
    double lambda = 2 * shear * nu / (1 - 2 * nu), stress[3][3];
    Error err = {0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            stress[i][j] = shear * (g[i][j] + g[j][i]) +
                           (i == j ? lambda * (g[0][0] + g[1][1] + g[2][2]) : 0);
    for (int32_t k = 0; k < KIND_COUNT; k++) {
        SpaceDef def = distorted(KINDS[k]);
        Mesh mesh;
        Bulk bulk;
        space_build(&def, &mesh);
        if (mean) assert_true(element_groups_find((uint8_t[]){1}, &mesh, &err));
        assert_true(bulk_create(&mesh, &bulk, &err) &&
                    bulk_assemble(&mesh, &MATERIAL, &bulk, &err));
        for (int side = 0; side < 6; side++) {
            MeshBoundary boundary;
            double traction[3];
            for (int d = 0; d < 3; d++) traction[d] = (side % 2 ? 1 : -1) * stress[d][side / 2];
            assert_true(mesh_boundary(&mesh, sides[side], &boundary, &err));
            bulk_add_traction(&mesh, &boundary, traction, &bulk);
        }
        double *u = hand_matrix(bulk.dof_count, 1), *force = hand_matrix(bulk.dof_count, 1);
        linear_motion(mesh.node_count, (const MeshPlace *)mesh.position, g, u);
        sparse_apply(&bulk.pattern, bulk.stiffness, u, force);
        assert_all_near(ELEMENTS[def.kind].name, force, bulk.load, bulk.dof_count, 1e-13);
        double mass = 0;
        for (int32_t i = 0; i < mesh.node_count; i++) mass += bulk.mass[3 * i];
        assert_near("mass", mass, MATERIAL.density * 1.2 * 0.5 * 0.7, 1e-13);
        assert_near("volume", bulk.area, 1.2 * 0.5 * 0.7, 1e-14);
        free(u);
        free(force);
        bulk_destroy(&bulk);
        mesh_destroy(&mesh);
    }
}

TEST(test_patch)
{
    check_patch(false);
    check_patch(true);
}

// In a HEX8 whose volume alone resists the mean technique leaves one condition: of its spectrum
// one value is large, not one for each quadrature point.
TEST(test_mean_volume)
{
    SpaceDef def = {ELEMENT_HEX8, {1, 1, 1}, {1, 1, 1}, 0, 1};
    Material soft = MATERIAL;
    soft.poisson = 0.49999;
    Error err = {0};
    Mesh mesh;
    ElementGroup group;
    ElementMatrices *matrices = malloc(sizeof *matrices);
    space_build(&def, &mesh);
    for (int mean = 0; mean < 2; mean++) {
        double *a = hand_matrix(24, 24), *values = hand_matrix(24, 1);
        int32_t large = 0;
        if (mean) assert_true(element_groups_find((uint8_t[]){1}, &mesh, &err));
        assert_true(element_group_at(&mesh, 0, &group));
        element_group_matrices(&mesh, &soft, &group, matrices);
        for (int32_t i = 0; i < 24; i++)
            for (int32_t j = 0; j < 24; j++) a[j * 24 + i] = matrices->stiffness[i][j];
        hand_eigenvalues(a, 24, values);
        for (int32_t k = 0; k < 24; k++) large += values[k] > 100 * soft.young;
        assert_int_equal(large, mean ? 1 : 7);
        free(a);
        free(values);
    }
    free(matrices);
    mesh_destroy(&mesh);
}

// Elements that are turned inside out are turned round, all of them or one among others; what two
// corners of another kind exchanged makes is crossed.
TEST(test_orientation)
{
    for (int32_t k = 0; k < KIND_COUNT; k++) {
        SpaceDef def = distorted(KINDS[k]);
        MeshFile file = space_file(&def);
        Error err = {0};
        Mesh mesh;
        for (int32_t i = 0; i < file.node_count; i++) file.position[3 * i + 1] *= -1;
        if (!mesh_build(&file, "turned.msh", &mesh, &err)) fail_msg("%s", err.message);
        for (int32_t e = 0; e < mesh.element_count; e++)
            assert_true(mesh_element_area(&mesh, e) > 0);
        assert_near("y_min", mesh.y_min, -0.5, 1e-15);
        mesh_destroy(&mesh);
        file = space_file(&def);
        int32_t swapped = file.element_nodes[1];
        file.element_nodes[1] = file.element_nodes[0];
        file.element_nodes[0] = swapped;
        bool turned = mesh_build(&file, "bad.msh", &mesh, &err);
        assert_true(turned == (KINDS[k] == ELEMENT_TET4));
        if (!turned) assert_non_null(strstr(err.message, "non-positive volume"));
        err = (Error){0};
        mesh_destroy(&mesh);
    }
}

// Weights sum to the area and its first moments; of TET10 only mid-sides touch.
TEST(test_contact)
{
    static const int32_t contacts[KIND_COUNT] = {4 * 3, 7 * 5 - 4 * 3, 4 * 3, 4 * 3, 7 * 5};
    for (int32_t k = 0; k < KIND_COUNT; k++) {
        SpaceDef def = distorted(KINDS[k]);
        InterfaceDef with = {.has_rod = true,
                             .rod_name = "rod",
                             .rod_height = 0.35,
                             .rod_width = 0.3,
                             .rod_in_part = true};
        Error err = {0};
        Mesh mesh;
        Interface interface;
        space_build(&def, &mesh);
        if (!interface_build(&mesh, &with, &interface, &err)) fail_msg("%s", err.message);
        assert_int_equal(interface.dim, 3);
        assert_int_equal(interface.contact_count, contacts[k]);
        double sum = 0, moment = 0;
        for (int32_t i = 0; i < interface.contact_count; i++) {
            const double *at = mesh_place(&mesh, interface.node[i]);
            assert_true(at[2] == 0 && at[0] == interface.x[i] && at[1] == interface.y[i]);
            assert_true(interface.weight[i] > 0);
            sum += interface.weight[i];
            moment += interface.weight[i] * (interface.x[i] + 10 * interface.y[i]);
            assert_int_equal(interface.dofs[interface_normal(&interface, i)],
                             3 * interface.node[i] + 2);
        }
        assert_near("area", sum, 1.2 * 0.5, 1e-14);
        assert_near("first moment", moment, 0.6 * (0.6 + 2.5), 1e-13);
        interface_destroy(&interface);
        mesh_destroy(&mesh);
    }
}

// Rows at z = 0.1, 0.2, ...: of the strip from 0.17 to 0.38 the shares are 0.8, 1, 0.3; with a
// breadth of 0.3 of 0.5, of rows at y = 0, 0.125, ...: 0.2 of the second, all of the third.
TEST(test_strip)
{
    SpaceDef def = {ELEMENT_HEX8, {3, 4, 7}, {1.2, 0.5, 0.7}, 0, 1};
    InterfaceDef with = {.has_rod = true,
                         .rod_name = "rod",
                         .rod_height = 0.275,
                         .rod_width = 0.21,
                         .rod_in_part = true};
    Error err = {0};
    Mesh mesh;
    Interface interface;
    space_build(&def, &mesh);
    assert_true(interface_build(&mesh, &with, &interface, &err));
    assert_int_equal(interface.rod_count, 3 * 5);
    static const double shares[] = {0.8, 1, 0.3};
    for (int32_t j = 0; j < 15; j++) {
        bool side = j % 5 == 0 || j % 5 == 4;
        assert_near("share", interface.rod_share[j], shares[j / 5], 1e-9);
        assert_near("y", interface.rod_y[j], 0.125 * (j % 5), 1e-15);
        assert_near("length", interface.rod_length[j], side ? 0.0625 : 0.125, 1e-12);
        assert_int_equal(interface.dofs[interface_rod(&interface, j)], 3 * interface.rod_node[j]);
    }
    interface_destroy(&interface);
    with.rod_breadth = 0.2;
    assert_true(interface_build(&mesh, &with, &interface, &err));
    assert_int_equal(interface.rod_count, 3 * 3);
    for (int32_t j = 0; j < 9; j++)
        assert_near("share", interface.rod_share[j], shares[j / 3] * (j % 3 == 1 ? 1 : 0.3), 1e-9);
    interface_destroy(&interface);
    with.rod_whole = true;
    with.rod_breadth = 0;
    assert_true(interface_build(&mesh, &with, &interface, &err));
    assert_int_equal(interface.rod_count, 7 * 5);   // the lowest row is contact
    for (int32_t j = 0; j < 35; j++) assert_near("share", interface.rod_share[j], 1, 0);
    interface_destroy(&interface);
    mesh_destroy(&mesh);
}

// A named side face is no contact.
TEST(test_upright_contact)
{
    static const char names[][GROUP_NAME_SIZE] = {"contact", "left"};
    SpaceDef def = distorted(ELEMENT_HEX8);
    Error err = {0};
    Mesh mesh;
    MeshContact contact;
    space_build(&def, &mesh);
    assert_false(mesh_contact(&mesh, names, 2, &contact, &err));
    assert_non_null(strstr(err.message, "does not look down"));
    mesh_contact_destroy(&contact);
    mesh_destroy(&mesh);
}
