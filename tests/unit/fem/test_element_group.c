// SPDX-License-Identifier: GPL-2.0-or-later
// Elements that share an areal strain: which are grouped; that a uniform strain and rigid motion
// are what they were; the pure bending of a nearly incompressible beam, whose displacement is
// known, elastic and viscous; stresses at nodes.
#include "fem/element_group.h"

#include "plane.h"

#include "block_mesh.h"
#include "fem/assembly.h"
#include "fem/recovery.h"
#include "dense_by_hand.h"

static const uint8_t ALL[] = {1}, FIRST_ALONE[] = {1, 0};

// trace over deviator: 2500 in K and in C
static Material rubber(void)
{
    return (Material){.young = 3,
                      .poisson = 0.4999,
                      .density = 1,
                      .eta1 = 0.7,
                      .eta2 = 0.7 * 0.4999 / 0.0002,
                      .plane_strain = true};
}

static BlockDef block_of(ElementKind kind, int32_t nx, int32_t nz)
{
    return (BlockDef){
        .kind = kind, .nx = nx, .nz = nz, .length = 2, .height = 1, .distortion = 0.2, .seed = 5};
}

// A cell's two triangles share its diagonal, the longest edge they have, even where nodes moved.
TEST(test_pairs)
{
    Error err = {0};
    BlockDef def = block_of(ELEMENT_T3, 5, 3);
    Mesh mesh;
    ElementGroup group;
    def.distortion = 0;
    block_build(&def, &mesh);
    assert_true(element_group_at(&mesh, 4, &group) && !group.is_mean && group.count == 1);
    assert_true(element_groups_find(ALL, &mesh, &err));
    for (int32_t e = 0; e < mesh.element_count; e++) {
        assert_int_equal(mesh.mean_next[e], e ^ 1);
        assert_int_equal(element_group_at(&mesh, e, &group), e % 2 == 0);
        element_group_of(&mesh, e, &group);
        assert_true(group.is_mean && group.count == 2 && group.element[0] == e / 2 * 2);
        assert_int_equal(group.node_count, 4);
    }
    mesh_destroy(&mesh);
}

// In regions that are marked and not across them; a T3 that is left over joins a group; Q8 stay.
TEST(test_regions)
{
    Error err = {0};
    BlockDef def = block_of(ELEMENT_T3, 5, 1);
    Mesh mesh;
    ElementGroup group;
    block_build(&def, &mesh);
    mesh.region = NEW_ARRAY(uint8_t, mesh.element_count, &err);
    for (int32_t e = 0; e < mesh.element_count; e++) mesh.region[e] = e > 1 && e != 3;
    assert_true(element_groups_find(FIRST_ALONE, &mesh, &err));
    element_group_of(&mesh, 3, &group);
    assert_int_equal(group.count, 3);
    assert_int_equal(group.node_count, 5);
    for (int32_t e = 0; e < mesh.element_count; e++)
        assert_int_equal(mesh.mean_next[e]<0, e> 1 && e != 3);
    mesh_destroy(&mesh);
    def = block_of(ELEMENT_Q8, 2, 2);
    block_build(&def, &mesh);
    assert_true(element_groups_find(ALL, &mesh, &err));
    assert_null(mesh.mean_next);
    mesh_destroy(&mesh);
}

typedef struct Motion {
    double u[2];
} Motion;

static Motion uniform(double x, double z)
{
    return (Motion){{1 + 0.4 * x + 0.9 * z, 2 - 0.4 * x - 0.7 * z}};
}

// A beam in plane strain that is bent to the curvature 1: eps_xx = -z, sigma_zz = sigma_xz = 0.
static Motion bent(double x, double z)
{
    double nu = rubber().poisson / (1 - rubber().poisson);
    return (Motion){{-x * z, 0.5 * (x * x + nu * z * z)}};
}

// The energy u K u/2, or v C v/2, of the block whose edge moves as `motion` says; what moves least
// inside. grouped false: as elements of their own.
static double least_energy(BlockDef def, Motion (*motion)(double x, double z), bool grouped,
                           bool viscous)
{
    Error err = {0};
    Material material = rubber();
    Mesh mesh;
    Bulk bulk;
    block_build(&def, &mesh);
    if (grouped) assert_true(element_groups_find(ALL, &mesh, &err));
    assert_true(bulk_create(&mesh, &bulk, &err) && bulk_assemble(&mesh, &material, &bulk, &err));
    int32_t n = bulk.dof_count, inner = 0, *inside = calloc((size_t)n, sizeof *inside);
    double *u = hand_matrix(n, 1), *force = hand_matrix(n, 1), energy = 0;
    const double *entries = viscous ? bulk.damping : bulk.stiffness;
    for (int32_t i = 0; i < mesh.node_count; i++) {
        double x = mesh.position[2 * i], z = mesh.position[2 * i + 1];
        bool edge = x <= 0 || x >= mesh.x_max || z <= 0 || z >= mesh.z_max;
        Motion at = motion(x, z - 0.5);
        for (int d = 0; d < 2; d++) {
            u[2 * i + d] = edge ? at.u[d] : 0;
            if (!edge) inside[inner++] = 2 * i + d;
        }
    }
    sparse_apply(&bulk.pattern, entries, u, force);
    double *matrix = hand_matrix(inner, inner), *x = hand_matrix(inner, 1);
    for (int32_t a = 0; a < inner; a++) {
        x[a] = -force[inside[a]];
        for (int32_t b = 0; b < inner; b++) {
            int32_t row = inside[a], k = bulk.pattern.start[row];
            while (k < bulk.pattern.start[row + 1] && bulk.pattern.index[k] != inside[b]) k++;
            if (k < bulk.pattern.start[row + 1]) matrix[b * inner + a] = entries[k];
        }
    }
    assert_true(hand_solve(matrix, inner, x, 1));
    for (int32_t a = 0; a < inner; a++) u[inside[a]] = x[a];
    sparse_apply(&bulk.pattern, entries, u, force);
    for (int32_t k = 0; k < n; k++) energy += 0.5 * u[k] * force[k];
    free(inside);
    free(u);
    free(force);
    free(matrix);
    free(x);
    bulk_destroy(&bulk);
    mesh_destroy(&mesh);
    return energy;
}

// Averaging does not change strains that are the same everywhere.
TEST(test_uniform)
{
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        if (kind != ELEMENT_T3 && kind != ELEMENT_Q4) continue;
        BlockDef def = block_of((ElementKind)kind, 4, 3);
        for (int viscous = 0; viscous < 2; viscous++)
            assert_near("energy", least_energy(def, uniform, true, viscous),
                        least_energy(def, uniform, false, viscous), 1e-6);
    }
}

// The exact energy is E/(1 - nu^2) L/24 of height 1: C is as much of it as eta1 of E/(1 + nu).
// Elements of their own lock, on grouped ones the error falls with the square of the cells.
TEST(test_bending)
{
    Material material = rubber();
    double nu = material.poisson, exact[2] = {material.young / (1 - nu * nu) * 2 / 24, 0};
    exact[1] = exact[0] * material.eta1 * (1 + nu) / material.young;
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        if (kind != ELEMENT_T3 && kind != ELEMENT_Q4) continue;
        for (int viscous = 0; viscous < 2; viscous++) {
            BlockDef coarse = block_of((ElementKind)kind, 8, 4);
            BlockDef fine = block_of((ElementKind)kind, 16, 8);
            double locked = least_energy(fine, bent, false, viscous) / exact[viscous] - 1;
            double first = least_energy(coarse, bent, true, viscous) / exact[viscous] - 1;
            double second = least_energy(fine, bent, true, viscous) / exact[viscous] - 1;
            assert_true(locked > 1);
            assert_true(fabs(first) < 0.1);
            assert_true(fabs(second) < 0.4 * fabs(first));
        }
    }
}

// At nodes of the bent beam, those of its sides too: stresses of the mean areal strain, where those
// of the slopes themselves are off by a hundred times the largest.
TEST(test_stress)
{
    Error err = {0};
    BlockDef def = block_of(ELEMENT_Q4, 24, 12);
    Material material = rubber();
    double nu = material.poisson, largest = 0.5 * material.young / (1 - nu * nu);
    for (int grouped = 0; grouped < 2; grouped++) {
        NodalStress stress;
        Mesh mesh;
        def.distortion = 0;
        block_build(&def, &mesh);
        if (grouped) assert_true(element_groups_find(ALL, &mesh, &err));
        assert_true(nodal_stress_create(&mesh, &stress, &err));
        double *u = hand_matrix(2 * mesh.node_count, 1), worst = 0;
        double *rest = hand_matrix(2 * mesh.node_count, 1);
        for (int32_t i = 0; i < mesh.node_count; i++) {
            Motion at = bent(mesh.position[2 * i], mesh.position[2 * i + 1] - 0.5);
            u[2 * i] = at.u[0];
            u[2 * i + 1] = at.u[1];
        }
        nodal_stress_recover(&material, u, rest, NULL, NULL, &stress);
        for (int32_t i = 0; i < mesh.node_count; i++) {
            double z = mesh.position[2 * i + 1];
            double exact = -2 * largest * (z - 0.5);
            worst = fmax(worst, fabs(stress.elastic[3 * i] - exact) / largest);
            worst = fmax(worst, fabs(stress.elastic[3 * i + 1]) / largest);
        }
        assert_true(grouped ? worst < 0.1 : worst > 100);
        free(u);
        free(rest);
        nodal_stress_destroy(&stress);
        mesh_destroy(&mesh);
    }
}
