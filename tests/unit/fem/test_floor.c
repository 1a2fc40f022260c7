// SPDX-License-Identifier: GPL-2.0-or-later
// The floor of a base under a block: matching meshes are the identity, others pass linear fields
// and constant stresses, matrices are T' A T multiplied out, and mirror images keep the pressure.
#include "fem/floor.h"

#include "plane.h"

#include "base_mesh.h"
#include "block_mesh.h"
#include "dense_by_hand.h"
#include "fem/assembly.h"
#include "paper_material.h"
#include "space_mesh.h"

// Places are put on a grid of 1e-9 of the length before shares are found.
static const double GRID_ERROR = 5e-9;
// The same over a face of a seventh of the length.
static const double FACE_ERROR = 1e-7;

// Elements of the upper and the lower surface, and whether their nodes match.
typedef struct Pair {
    ElementKind upper, lower;
    bool matches;
} Pair;

static const Pair PAIRS[] = {
    {ELEMENT_Q4, ELEMENT_Q4, true},         {ELEMENT_T3, ELEMENT_T3, true},
    {ELEMENT_T6, ELEMENT_T6, true},         {ELEMENT_Q8, ELEMENT_Q8, true},
    {ELEMENT_Q9, ELEMENT_Q9, true},         {ELEMENT_Q4, ELEMENT_Q4, false},
    {ELEMENT_T3, ELEMENT_Q4, false},        {ELEMENT_Q9, ELEMENT_T6, false},
    {ELEMENT_Q4, ELEMENT_Q9, false},        {ELEMENT_T6, ELEMENT_T3, false},
    {ELEMENT_HEX8, ELEMENT_HEX8, true},     {ELEMENT_TET4, ELEMENT_TET4, true},
    {ELEMENT_TET10, ELEMENT_TET10, true},   {ELEMENT_HEX27, ELEMENT_HEX27, true},
    {ELEMENT_WEDGE6, ELEMENT_WEDGE6, true}, {ELEMENT_HEX8, ELEMENT_HEX8, false},
    {ELEMENT_TET4, ELEMENT_HEX8, false},    {ELEMENT_HEX27, ELEMENT_HEX8, false},
    {ELEMENT_HEX8, ELEMENT_TET10, false},   {ELEMENT_TET10, ELEMENT_WEDGE6, false}};
enum { PAIR_COUNT = sizeof PAIRS / sizeof PAIRS[0] };

static bool is_space(ElementKind kind)
{
    return element_dim(kind) == 3;
}

static MeshFile file_of(ElementKind kind, int32_t cells, double length, uint64_t seed)
{
    if (is_space(kind)) {
        SpaceDef def = {.kind = kind,
                        .cells = {cells, cells - 1, 2},
                        .size = {length, 0.8, 0.5},
                        .distortion = 0.2,
                        .seed = seed};
        return space_file(&def);
    }
    BlockDef def = {.kind = kind,
                    .nx = cells,
                    .nz = 3,
                    .length = length,
                    .height = 0.5,
                    .distortion = 0.2,
                    .seed = seed};
    return block_file(&def);
}

static void build(const Pair *pair, Mesh *mesh)
{
    Error err = {0};
    int32_t cells = is_space(pair->upper) ? 3 : 5;
    MeshFile upper = file_of(pair->upper, cells, 1, 3);
    MeshFile lower = file_of(pair->lower, pair->matches ? cells : cells + 2, 1, 7);
    if (!base_build(upper, lower, 0, mesh, &err)) fail_msg("%s", err.message);
}

static double stretched(double x)
{
    return 3 + 0.4 * x;
}

TEST(test_matching_meshes_are_the_identity)
{
    for (int32_t p = 0; p < PAIR_COUNT; p++) {
        Mesh mesh;
        if (!PAIRS[p].matches) continue;
        build(&PAIRS[p], &mesh);
        assert_true(mesh.floor.matches);
        assert_true(mesh.floor.start[mesh.node_count] > 0);
        for (int32_t i = 0; i < mesh.node_count; i++) {
            int32_t row = floor_start(&mesh.floor, i);
            if (row == floor_end(&mesh.floor, i)) continue;
            assert_false(mesh_in_base(&mesh, i));
            assert_true(mesh.floor.share[row] == 1);
            int32_t under = mesh.floor.node[row];
            assert_true(mesh_in_base(&mesh, under));
            for (int32_t d = 0; d < mesh.dim; d++)
                assert_near("place", mesh_place(&mesh, under)[d], mesh_place(&mesh, i)[d], 1e-12);
        }
        mesh_destroy(&mesh);
    }
}

// Rows add up to 1 and reproduce linear fields; the forces of a uniform pressure on the contact
// come down as those of a uniform pressure on the floor.
TEST(test_other_meshes_pass_what_is_constant)
{
    Error err = {0};
    for (int32_t p = 0; p < PAIR_COUNT; p++) {
        Mesh mesh;
        build(&PAIRS[p], &mesh);
        const Floor *floor = &mesh.floor;
        double *above = hand_matrix(mesh.node_count, 1), *below = hand_matrix(mesh.node_count, 1);
        double *passed = hand_matrix(mesh.node_count, 1);
        MeshBoundary contact, under;
        assert_true(mesh_boundary(&mesh, "contact", &contact, &err));
        assert_true(mesh_boundary(&mesh, "floor", &under, &err));
        boundary_add_weights(&mesh, &contact, true, above);
        boundary_add_weights(&mesh, &under, true, below);
        for (int32_t i = 0; i < mesh.node_count; i++) {
            double sum = 0, linear[2] = {0};
            if (floor_start(floor, i) == floor_end(floor, i)) continue;
            for (int32_t k = floor_start(floor, i); k < floor_end(floor, i); k++) {
                sum += floor->share[k];
                for (int32_t d = 0; d < mesh.dim - 1; d++)
                    linear[d] += floor->share[k] * stretched(mesh_place(&mesh, floor->node[k])[d]);
                passed[floor->node[k]] += floor->share[k] * above[i];
            }
            assert_near("sum of a row", sum, 1, FACE_ERROR);
            for (int32_t d = 0; d < mesh.dim - 1; d++)
                assert_near("linear", linear[d], stretched(mesh_place(&mesh, i)[d]), GRID_ERROR);
        }
        assert_all_near("pressure that passes", passed, below, mesh.node_count, FACE_ERROR);
        free(above);
        free(below);
        free(passed);
        mesh_destroy(&mesh);
    }
}

// u = T x written out.
static double *displacement_matrix(const Mesh *mesh)
{
    const Floor *floor = &mesh->floor;
    int32_t n = mesh->dim * mesh->node_count;
    double *by = hand_matrix(n, n);
    for (int32_t dof = 0; dof < n; dof++) {
        int32_t node = dof_node(mesh->dim, dof), d = dof_axis(mesh->dim, dof);
        by[(int64_t)dof * n + dof] = 1;
        for (int32_t k = floor_start(floor, node); k < floor_end(floor, node); k++)
            by[(int64_t)node_dof(mesh->dim, floor->node[k], d) * n + dof] = floor->share[k];
    }
    return by;
}

static double *dense_of(const Bulk *bulk, const double *values)
{
    int32_t n = bulk->dof_count;
    double *all = hand_matrix(n, n);
    for (int32_t j = 0; j < n; j++)
        for (int32_t k = bulk->pattern.start[j]; values && k < bulk->pattern.start[j + 1]; k++)
            all[(int64_t)j * n + bulk->pattern.index[k]] = values[k];
    return all;
}

// T' A T of a dense A.
static double *congruent(const double *a, const double *by, int32_t n)
{
    double *half = hand_matrix(n, n), *all = hand_matrix(n, n);
    for (int32_t j = 0; j < n; j++) hand_apply(a, n, n, by + (int64_t)j * n, half + (int64_t)j * n);
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < n; i++)
            for (int32_t k = 0; k < n; k++)
                all[(int64_t)j * n + i] += by[(int64_t)i * n + k] * half[(int64_t)j * n + k];
    free(half);
    return all;
}

TEST(test_matrices_are_those_of_the_jumps)
{
    Error err = {0};
    Material material = paper_material();
    for (int32_t p = 0; p < PAIR_COUNT; p++) {
        Mesh mesh;
        Bulk bulk, apart;
        if (is_space(PAIRS[p].upper)) continue;   // the same code; dense matrices are slow there
        build(&PAIRS[p], &mesh);
        Mesh separate = mesh;
        separate.floor = (Floor){0};
        assert_true(bulk_create(&mesh, &bulk, &err) &&
                    bulk_assemble(&mesh, &material, &bulk, &err));
        assert_true(bulk_create(&separate, &apart, &err) &&
                    bulk_assemble(&separate, &material, &apart, &err));
        int32_t n = bulk.dof_count;
        double *by = displacement_matrix(&mesh);
        const double *const values[][2] = {{apart.stiffness, bulk.stiffness},
                                           {apart.damping, bulk.damping},
                                           {NULL, bulk.mass_beside}};
        for (int which = 0; which < 3; which++) {
            double *plain = dense_of(&apart, values[which][0]);
            double *jumps = dense_of(&bulk, values[which][1]);
            for (int32_t k = 0; which == 2 && k < n; k++) {
                plain[(int64_t)k * n + k] += apart.mass[k];
                jumps[(int64_t)k * n + k] += bulk.mass[k];
            }
            double *wanted = congruent(plain, by, n);
            assert_all_near("T' A T", jumps, wanted, n * n, 1e-13);
            free(plain);
            free(jumps);
            free(wanted);
        }
        assert_near("area of the block", bulk.area, 0.5, 1e-12);
        free(by);
        bulk_destroy(&bulk);
        bulk_destroy(&apart);
        mesh_destroy(&mesh);
    }
}

// The work of forces is the same in both kinds of unknowns, and both changes can be undone.
TEST(test_forces_and_displacements_go_together)
{
    Mesh mesh;
    Random random = {.state = 5};
    build(&PAIRS[7], &mesh);
    int32_t n = mesh.dim * mesh.node_count;
    double *jump = hand_matrix(n, 1), *moved = hand_matrix(n, 1), *force = hand_matrix(n, 1);
    double *given = hand_matrix(n, 1), work[2] = {0};
    for (int32_t k = 0; k < n; k++) {
        jump[k] = moved[k] = random_between(&random, -1, 1);
        force[k] = given[k] = random_between(&random, -1, 1);
    }
    floor_displace(&mesh, moved);
    floor_gather(&mesh, force);
    for (int32_t k = 0; k < n; k++) {
        work[0] += given[k] * moved[k];
        work[1] += force[k] * jump[k];
    }
    assert_near("work", work[1], work[0], 1e-12);
    floor_find_jumps(&mesh, moved);
    floor_scatter(&mesh, force);
    assert_all_near("jumps", moved, jump, n, 1e-14);
    assert_all_near("forces", force, given, n, 1e-14);
    free(jump);
    free(moved);
    free(force);
    free(given);
    mesh_destroy(&mesh);
}

// Two bodies of one material under a uniform pressure on top and bottom, free to move sideways: the
// strain is uniform in both whatever their meshes are, and each contact node bears its weight.
TEST(test_uniform_stress_passes)
{
    Error err = {0};
    const double pressure = 0.3;
    Material material = {.young = 2, .poisson = 0.3, .density = 1, .plane_strain = true};
    double lame = 2 * 0.3 / (1.3 * 0.4), shear = 2 / 2.6;   // lambda, mu
    for (int32_t p = 0; p < PAIR_COUNT; p++) {
        Mesh mesh;
        Bulk bulk;
        MeshBoundary side;
        build(&PAIRS[p], &mesh);
        assert_true(bulk_create(&mesh, &bulk, &err) &&
                    bulk_assemble(&mesh, &material, &bulk, &err));
        // Uniaxial stress along z: in the plane with eps_yy = 0, in space free on all sides.
        double across = mesh.dim == 3 ? 0.3 / 2 : lame / (4 * shear * (lame + shear));
        double along = mesh.dim == 3 ? 1.0 / 2 : (lame + 2 * shear) / (4 * shear * (lame + shear));
        double down[3] = {0}, up[3] = {0};
        down[mesh.dim - 1] = -pressure;
        up[mesh.dim - 1] = pressure;
        assert_true(mesh_boundary(&mesh, "top", &side, &err));
        bulk_add_traction(&mesh, &side, down, &bulk);
        assert_true(mesh_boundary(&mesh, "bottom", &side, &err));
        bulk_add_traction(&mesh, &side, up, &bulk);
        double *u = hand_matrix(bulk.dof_count, 1), *force = hand_matrix(bulk.dof_count, 1);
        double *weight = hand_matrix(mesh.node_count, 1), *wanted = hand_matrix(bulk.dof_count, 1);
        for (int32_t dof = 0; dof < bulk.dof_count; dof++) {
            int32_t d = dof_axis(mesh.dim, dof);
            double place = mesh_place(&mesh, dof_node(mesh.dim, dof))[d];
            u[dof] = pressure * (d == mesh.dim - 1 ? -along : across) * place;
        }
        floor_find_jumps(&mesh, u);
        sparse_apply(&bulk.pattern, bulk.stiffness, u, force);
        for (int32_t dof = 0; dof < bulk.dof_count; dof++) force[dof] -= bulk.load[dof];
        assert_true(mesh_boundary(&mesh, "contact", &side, &err));
        boundary_add_weights(&mesh, &side, true, weight);
        for (int32_t i = 0; i < mesh.node_count; i++)
            wanted[node_dof(mesh.dim, i, mesh.dim - 1)] =
                floor_start(&mesh.floor, i) == floor_end(&mesh.floor, i) ? 0 : pressure * weight[i];
        assert_all_near("contact forces", force, wanted, bulk.dof_count, FACE_ERROR);
        free(u);
        free(force);
        free(weight);
        free(wanted);
        bulk_destroy(&bulk);
        mesh_destroy(&mesh);
    }
}

// Two bodies that are mirror images, sheared oppositely by their far sides, stuck to each other:
// the pressure between them does not change, for any Poisson's ratio (Dundurs' beta is 0).
// Inertia in the place of supports: it is a mirror image, too.
TEST(test_mirror_images_keep_their_pressure)
{
    Error err = {0};
    Material material = paper_material();
    BlockDef def = {.kind = ELEMENT_Q4, .nx = 6, .nz = 4, .length = 1, .height = 0.5};
    Mesh mesh;
    Bulk bulk;
    MeshBoundary side;
    if (!base_build(block_file(&def), block_file(&def), 0, &mesh, &err))
        fail_msg("%s", err.message);
    assert_true(bulk_create(&mesh, &bulk, &err) && bulk_assemble(&mesh, &material, &bulk, &err));
    assert_true(mesh_boundary(&mesh, "top", &side, &err));
    bulk_add_traction(&mesh, &side, (double[]){1, 0}, &bulk);
    assert_true(mesh_boundary(&mesh, "bottom", &side, &err));
    bulk_add_traction(&mesh, &side, (double[]){-1, 0}, &bulk);
    int32_t n = bulk.dof_count;
    double *a = dense_of(&bulk, bulk.stiffness), *beside = dense_of(&bulk, bulk.mass_beside);
    double *held = hand_matrix(n, n), *moved = hand_matrix(n, 1), *pull = hand_matrix(n, 1);
    for (int32_t k = 0; k < n * n; k++) a[k] += beside[k];
    for (int32_t k = 0; k < n; k++) a[k * n + k] += bulk.mass[k];
    assert_true(mesh_boundary(&mesh, "contact", &side, &err));
    // The response to the shear while all of the contact stays at rest, and its pull then.
    memcpy(held, a, (size_t)(n * n) * sizeof *held);
    memcpy(moved, bulk.load, (size_t)n * sizeof *moved);
    for (int32_t k = 0; k < side.node_count; k++)
        for (int32_t d = 0; d < 2; d++) {
            int32_t dof = node_dof(2, side.nodes[k], d);
            for (int32_t i = 0; i < n; i++) held[i * n + dof] = held[dof * n + i] = i == dof;
            moved[dof] = 0;
        }
    assert_true(hand_solve(held, n, moved, 1));
    hand_apply(a, n, n, moved, pull);
    double shear = 0;
    for (int32_t k = 0; k < side.node_count; k++)
        shear = fmax(shear, fabs(pull[node_dof(2, side.nodes[k], 0)]));
    assert_true(shear > 0.01);
    for (int32_t k = 0; k < side.node_count; k++)
        assert_near("pressure", pull[node_dof(2, side.nodes[k], 1)], 0, 1e-12 * shear);
    free(a);
    free(beside);
    free(held);
    free(moved);
    free(pull);
    bulk_destroy(&bulk);
    mesh_destroy(&mesh);
}

// Builds a block of length 1 over a base of another length that begins at `along`, lowered by
// `apart`; says why it is refused.
static void refuse(double length, double along, double apart, const char *why)
{
    Error err = {0};
    Mesh mesh;
    BlockDef upper = {.kind = ELEMENT_Q4, .nx = 4, .nz = 2, .length = 1, .height = 0.5};
    BlockDef lower = {.kind = ELEMENT_Q4, .nx = 4, .nz = 2, .length = length, .height = 0.5};
    MeshFile both = base_file(block_file(&upper), block_file(&lower), along);
    for (int32_t i = 0; i < both.node_count; i++)
        if (i >= 15) both.position[2 * i + 1] -= apart;
    bool done = mesh_build_on_base(&both, "a.msh", "floor", &mesh, &err) &&
                floor_find(NULL, 0, "floor", &mesh, &err);
    assert_false(done);
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, why)) fail_msg("%s", err.message);
    mesh_destroy(&mesh);
}

TEST(test_what_is_refused)
{
    refuse(1, 0.2, 0, "must reach over all of the contact");
    refuse(0.5, 0.25, 0, "must reach over all of the contact");
    refuse(1, 0, 0.1, "above");
    refuse(1, 0, -0.1, "below");
}

// A base counts as one only by the name of its upper side; and it is no part of the block's extent.
TEST(test_base_by_its_name)
{
    Error err = {0};
    Mesh mesh;
    BlockDef def = {.kind = ELEMENT_Q4, .nx = 4, .nz = 2, .length = 1, .height = 0.5};
    BlockDef longer = {.kind = ELEMENT_Q4, .nx = 4, .nz = 2, .length = 3, .height = 1};
    MeshFile both = base_file(block_file(&def), block_file(&longer), -1);
    assert_false(mesh_build_on_base(&both, "a.msh", "ground", &mesh, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    mesh_destroy(&mesh);
    error_clear(&err);
    both = base_file(block_file(&def), block_file(&longer), -1);
    assert_true(mesh_build_on_base(&both, "a.msh", "floor", &mesh, &err));
    assert_near("x_min", mesh.x_min, 0, 0);
    assert_near("x_max", mesh.x_max, 1, 0);
    assert_near("z_min", mesh.z_min, 0, 0);
    assert_near("z_max", mesh.z_max, 0.5, 0);
    mesh_destroy(&mesh);
}
