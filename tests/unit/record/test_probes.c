// SPDX-License-Identifier: GPL-2.0-or-later
// Probes read motions whose displacement, strain and stress are known: linear ones exactly on any
// mesh, quadratic ones with elements of order 2. Runs of whole scenes are held against ParaView's
// fields end to end (test_probes.py).
#include "record/probes.h"

#include "fem/mesh_locate.h"

#include "plane.h"

#include "block_rig.h"

static double u_linear(int d, double x, double z)
{
    return d == 0 ? 0.1 + 0.3 * x - 0.4 * z : 0.7 * x + 0.2 * z;
}

static double u_quadratic(int d, double x, double z)
{
    return d == 0 ? x * x - 2 * x * z + 0.5 * z * z : 0.3 * x * x + x * z - z * z;
}

// Probes of the motion u, whose velocity is half of it, at two places; strain of the tensor.
static void expect_read(const BlockDef *block, double (*u)(int, double, double),
                        void (*strain)(double, double, double[3]))
{
    static const double places[][2] = {{0.31, 0.17}, {0.93, 0.42}};
    Error err = {0};
    RigDef def = rig_def();
    BlockRig rig;
    State state;
    ProbePlace at[2];
    Probes probes;
    def.block = *block;
    def.rod_width = 0;
    def.material.eta2 = 0.3;
    rig_build(&def, &rig);
    assert_true(state_create(&rig.system, &rig.interface, &state, &err));
    for (int32_t i = 0; i < rig.mesh.node_count; i++)
        for (int32_t d = 0; d < 2; d++) {
            const double *place = mesh_place(&rig.mesh, i);
            state.displacement[2 * i + d] = u(d, place[0], place[1]);
            state.velocity[2 * i + d] = 0.5 * state.displacement[2 * i + d];
        }
    for (int32_t k = 0; k < 2; k++)
        assert_true((at[k].element = mesh_locate(&rig.mesh, places[k], at[k].at)) >= 0);
    assert_true(probes_create(at, 2, &rig.mesh, &rig.system, &def.material, &rig.bulk.spectrum,
                              &probes, &err));
    probes_read(&probes, &state);
    const Material *m = &def.material;
    double lambda = m->young * m->poisson / (1 - m->poisson * m->poisson);   // plane stress
    for (int32_t k = 0; k < 2; k++) {
        double e[3], x = places[k][0], z = places[k][1];
        strain(x, z, e);
        double trace = e[0] + e[1];
        for (int32_t d = 0; d < 2; d++) {
            assert_near("u", probes.displacement[2 * k + d], u(d, x, z), 1e-13);
            assert_near("v", probes.velocity[2 * k + d], 0.5 * u(d, x, z), 1e-13);
        }
        for (int32_t r = 0; r < 3; r++) {
            double stress = (m->young / (1 + m->poisson) + 0.5 * m->eta1) * e[r];
            if (r < 2) stress += (lambda + 0.5 * m->eta2) * trace;
            assert_near("strain", probes.strain[3 * k + r], e[r], 1e-12);
            assert_near("stress", probes.stress[3 * k + r], stress, 1e-12);
        }
    }
    probes_destroy(&probes);
    state_destroy(&state);
    rig_destroy(&rig);
}

static void strain_linear(double x, double z, double e[3])
{
    (void)x;
    (void)z;
    e[0] = 0.3, e[1] = 0.2, e[2] = 0.15;
}

static void strain_quadratic(double x, double z, double e[3])
{
    e[0] = 2 * x - 2 * z;
    e[1] = x - 2 * z;
    e[2] = 0.5 * (-2 * x + z + 0.6 * x + z);
}

TEST(test_linear)
{
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        BlockDef def = {.kind = (ElementKind)kind, .nx = 4, .nz = 3, .length = 1, .height = 0.5};
        expect_read(&def, u_linear, strain_linear);
    }
}

TEST(test_quadratic)
{
    const ElementKind kinds[] = {ELEMENT_T6, ELEMENT_Q8, ELEMENT_Q9};
    for (int32_t k = 0; k < 3; k++) {
        BlockDef def = {.kind = kinds[k], .nx = 4, .nz = 3, .length = 1, .height = 0.5};
        expect_read(&def, u_quadratic, strain_quadratic);
    }
}

// A place in no element; corners and borders belong to the mesh.
TEST(test_locate)
{
    RigDef def = rig_def();
    BlockRig rig;
    MeshPlace at;
    double distance;
    rig_build(&def, &rig);
    assert_int_equal(mesh_locate(&rig.mesh, (double[]){0.5, 0.51}, at), -1);
    assert_int_equal(mesh_locate(&rig.mesh, (double[]){-0.01, 0.2}, at), -1);
    assert_true(mesh_locate(&rig.mesh, (double[]){0, 0}, at) >= 0);
    assert_true(mesh_locate(&rig.mesh, (double[]){1, 0.5}, at) >= 0);
    assert_true(mesh_locate(&rig.mesh, (double[]){0.5, 0}, at) >= 0);
    int32_t node = mesh_nearest_node(&rig.mesh, (double[]){1.3, 0.9}, &distance);
    assert_near("x", mesh_place(&rig.mesh, node)[0], 1, 0);
    assert_near("z", mesh_place(&rig.mesh, node)[1], 0.5, 0);
    assert_near("distance", distance, 0.5, 1e-12);
    rig_destroy(&rig);
}
