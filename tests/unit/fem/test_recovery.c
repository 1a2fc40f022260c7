// SPDX-License-Identifier: GPL-2.0-or-later
// Nodal stresses of motions whose stresses are known: exact for linear ones, exact for quadratic
// ones in order 2, converging for smooth ones.
#include "fem/recovery.h"

#include "plane.h"

#include "block_mesh.h"

enum { COMPONENTS = 3 };

// A displacement field and its strains (xx, zz, 2 xz).
typedef struct Field {
    double u[2], strain[COMPONENTS];
} Field;

static Field linear_field(double x, double z)
{
    return (Field){.u = {0.1 + 0.3 * x - 0.4 * z, 0.7 * x + 0.2 * z}, .strain = {0.3, 0.2, 0.3}};
}

static Field quadratic_field(double x, double z)
{
    return (Field){.u = {x * x - 2 * x * z + 0.5 * z * z, 0.3 * x * x + x * z - z * z},
                   .strain = {2 * x - 2 * z, x - 2 * z, -2 * x + z + 0.6 * x + z}};
}

static Field smooth_field(double x, double z)
{
    return (Field){.u = {sin(2 * x) * cos(z), 0},
                   .strain = {2 * cos(2 * x) * cos(z), 0, -sin(2 * x) * sin(z)}};
}

// Largest error of elastic and total stress and von Mises over the nodes (or the inner ones).
static double largest_error(const BlockDef *def, const Material *material, bool inner_only,
                            Field (*field)(double x, double z))
{
    Error err = {0};
    Mesh mesh;
    NodalStress stress;
    block_build(def, &mesh);
    assert_true(nodal_stress_create(&mesh, &stress, &err));
    double *u = calloc(2 * (size_t)mesh.node_count, sizeof *u);
    double *v = calloc(2 * (size_t)mesh.node_count, sizeof *v);
    for (int32_t k = 0; k < mesh.node_count; k++) {
        Field at = field(mesh.position[2 * k], mesh.position[2 * k + 1]);
        for (int d = 0; d < 2; d++) {
            u[2 * k + d] = at.u[d];
            v[2 * k + d] = -0.5 * at.u[d];
        }
    }
    for (int32_t round = 0; round < 2; round++)   // a second call starts from nothing
        nodal_stress_recover(material, u, v, NULL, NULL, &stress);
    double elastic[STRAINS_MAX][STRAINS_MAX], viscous[STRAINS_MAX][STRAINS_MAX],
        worst = 0, nu = material->poisson;
    moduli_matrix(material_elastic(material), 2, elastic);
    moduli_matrix(material_viscous(material), 2, viscous);
    for (int32_t k = 0; k < mesh.node_count; k++) {
        double x = mesh.position[2 * k], z = mesh.position[2 * k + 1];
        bool edge = x == mesh.x_min || x == mesh.x_max || z == mesh.z_min || z == mesh.z_max;
        if (inner_only && edge) continue;
        Field at = field(x, z);
        double held[3] = {0}, total[3];
        for (int r = 0; r < 3; r++) {
            for (int c = 0; c < 3; c++) held[r] += elastic[r][c] * at.strain[c];
            total[r] = held[r];
            for (int c = 0; c < 3; c++) total[r] -= 0.5 * viscous[r][c] * at.strain[c];
            worst = fmax(worst, fabs(stress.elastic[3 * k + r] - held[r]));
            worst = fmax(worst, fabs(stress.total[3 * k + r] - total[r]));
        }
        double yy = 0;
        if (material->plane_strain)
            yy = nu * (held[0] + held[1]) - 0.5 * material->eta2 * (at.strain[0] + at.strain[1]);
        double mean = (total[0] + total[1] + yy) /
                      3;   // von Mises^2 = 3/2 of the deviator's square
        double square = (total[0] - mean) * (total[0] - mean) +
                        (total[1] - mean) * (total[1] - mean) + (yy - mean) * (yy - mean) +
                        2 * total[2] * total[2];
        worst = fmax(worst, fabs(stress.von_mises[k] - sqrt(1.5 * square)));
    }
    free(u);
    free(v);
    nodal_stress_destroy(&stress);
    mesh_destroy(&mesh);
    return worst;
}

static Material test_material(bool plane_strain)
{
    return (Material){.young = 2,
                      .poisson = 0.3,
                      .density = 1,
                      .eta1 = 0.4,
                      .eta2 = 0.9,
                      .plane_strain = plane_strain};
}

TEST(test_linear)
{
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        BlockDef def = {.kind = (ElementKind)kind,
                        .nx = 4,
                        .nz = 3,
                        .length = 1,
                        .height = 0.7,
                        .distortion = 0.25,
                        .seed = 11};
        for (int wide = 0; wide < 2; wide++) {
            Material material = test_material(wide);
            double error = largest_error(&def, &material, false, linear_field);
            assert_near(ELEMENTS[def.kind].name, error, 0, 1e-13);
        }
    }
}

TEST(test_quadratic)
{
    const ElementKind kinds[] = {ELEMENT_T6, ELEMENT_Q9, ELEMENT_Q8};
    for (int32_t k = 0; k < 3; k++) {   // Q8 holds them on rectangles only
        BlockDef def = {.kind = kinds[k],
                        .nx = 4,
                        .nz = 3,
                        .length = 1,
                        .height = 0.7,
                        .distortion = kinds[k] == ELEMENT_Q8 ? 0 : 0.25,
                        .seed = 12};
        Material material = test_material(true);
        double error = largest_error(&def, &material, false, quadratic_field);
        assert_near(ELEMENTS[def.kind].name, error, 0, 1e-12);
    }
}

// Order 1 converges with h at the edge, and with h^2 inside regular quadrilaterals.
TEST(test_convergence)
{
    Material material = test_material(false);
    for (int inner = 0; inner < 2; inner++) {
        double error[2];
        for (int32_t k = 0; k < 2; k++) {
            BlockDef def = {
                .kind = ELEMENT_Q4, .nx = 16 << k, .nz = 16 << k, .length = 1, .height = 1};
            error[k] = largest_error(&def, &material, inner, smooth_field);
        }
        double order = log2(error[0] / error[1]);
        assert_near("order", order, inner ? 2 : 1, 0.15);
    }
}

// Columns of elements in turns of two materials, one twice the other: nodes between them are two
// points, each with the stress of its own material.
TEST(test_two_materials)
{
    Error err = {0};
    BlockDef def = {.kind = ELEMENT_Q4, .nx = 4, .nz = 3, .length = 1, .height = 0.7};
    Mesh mesh;
    NodalStress stress;
    Material material[2] = {test_material(true), test_material(true)};
    material[1].young *= 2;
    material[1].eta1 *= 2;
    material[1].eta2 *= 2;
    block_build(&def, &mesh);
    mesh.region = NEW_ARRAY(uint8_t, mesh.element_count, &err);
    for (int32_t e = 0; e < mesh.element_count; e++) {
        double x = mesh.position[2 * mesh.element_nodes[mesh.first_node[e]]];
        mesh.region[e] = lround(x * def.nx) % 2 == 0;
    }
    assert_true(nodal_stress_create(&mesh, &stress, &err));
    assert_int_equal(stress.point_count, mesh.node_count + 3 * (def.nz + 1));
    double *u = calloc(2 * (size_t)mesh.node_count, sizeof *u);
    for (int32_t k = 0; k < mesh.node_count; k++) {
        Field at = linear_field(mesh.position[2 * k], mesh.position[2 * k + 1]);
        memcpy(u + 2 * k, at.u, sizeof at.u);
    }
    nodal_stress_recover(material, u, u, NULL, NULL, &stress);
    for (int32_t e = 0; e < mesh.element_count; e++)
        for (int32_t a = 0; a < 4; a++) {
            int32_t point = nodal_stress_points(&stress, &mesh, e)[a];
            double times = 1 + mesh.region[e], nu = 0.3, shear = 2 / (2 * (1 + nu));
            double trace = 0.3 + 0.2, lame = 2 * nu / ((1 + nu) * (1 - 2 * nu));
            double held[] = {2 * shear * 0.3 + lame * trace, 2 * shear * 0.2 + lame * trace,
                             shear * 0.3};
            double damped[] = {0.4 * 0.3 + 0.9 * trace, 0.4 * 0.2 + 0.9 * trace, 0.4 * 0.3 / 2};
            for (int r = 0; r < 3; r++) {
                assert_near("elastic", stress.elastic[3 * point + r], times * held[r], 1e-13);
                assert_near("total", stress.total[3 * point + r], times * (held[r] + damped[r]),
                            1e-13);
            }
        }
    free(u);
    nodal_stress_destroy(&stress);
    mesh_destroy(&mesh);
}

TEST(test_memory_faults)
{
    BlockDef def = {.kind = ELEMENT_T3, .nx = 2, .nz = 2, .length = 1, .height = 1};
    Mesh mesh;
    block_build(&def, &mesh);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        NodalStress stress;
        memory_fail_after(k);
        done = nodal_stress_create(&mesh, &stress, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        nodal_stress_destroy(&stress);
        assert_int_equal(memory_counters().live, live);
    }
    mesh_destroy(&mesh);
}
