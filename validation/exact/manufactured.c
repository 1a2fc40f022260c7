// SPDX-License-Identifier: GPL-2.0-or-later
// The method of manufactured solutions for K: a smooth displacement is chosen,
//
//     u_x = sin(2 x + 0.5) cos(3 z),   u_z = cos(x + 2 z),
//
// the body force that it needs is put into f by quadrature, the boundary is held at it, and what is
// solved is compared with it. Prints the elements' size h and the errors of u in the L2 norm and of
// the strain energy's norm, both relative.
//
//   amontons_manufactured MESH.geo name=value ...
#include "base/dense.h"
#include "base/memory.h"
#include "fem/assembly.h"
#include "fem/element.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARAMETERS_MAX = 16 };

typedef struct Problem {
    Mesh mesh;
    Material material;
    Bulk bulk;
    double *u;   // [dof_count]
} Problem;

// Displacement, its gradient [component][direction], and second derivatives xx, xz, zz.
static void chosen(double x, double z, double u[2], double gradient[2][2], double second[2][3])
{
    double a = 2 * x + 0.5, b = 3 * z, c = x + 2 * z;
    u[0] = sin(a) * cos(b);
    u[1] = cos(c);
    gradient[0][0] = 2 * cos(a) * cos(b);
    gradient[0][1] = -3 * sin(a) * sin(b);
    gradient[1][0] = -sin(c);
    gradient[1][1] = -2 * sin(c);
    second[0][0] = -4 * sin(a) * cos(b);
    second[0][1] = -6 * cos(a) * sin(b);
    second[0][2] = -9 * sin(a) * cos(b);
    second[1][0] = -cos(c);
    second[1][1] = -2 * cos(c);
    second[1][2] = -4 * cos(c);
}

// -div sigma of plane stress, sigma = dev eps + lam tr(eps) I, with moduli that owe nothing to
// fem/material:  (dev + lam) u_x,xx + lam u_z,xz + dev/2 (u_x,zz + u_z,xz), and likewise along z.
static void body_force(const Material *material, double x, double z, double force[2])
{
    double u[2], gradient[2][2], s[2][3], nu = material->poisson;
    double dev = material->young / (1 + nu), lam = material->young * nu / (1 - nu * nu);
    chosen(x, z, u, gradient, s);
    force[0] = -((dev + lam) * s[0][0] + lam * s[1][1] + dev / 2 * (s[0][2] + s[1][1]));
    force[1] = -((dev + lam) * s[1][2] + lam * s[0][1] + dev / 2 * (s[0][1] + s[1][0]));
}

// 5 x 5 Gauss points on the square, collapsed onto the triangle: exact enough for any element here.
static int32_t fine_points(ElementKind kind, double point[25][2], double weight[25])
{
    static const double x[5] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                                0.906179845938664};
    static const double w[5] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                0.478628670499366, 0.236926885056189};
    bool triangle = kind == ELEMENT_T3 || kind == ELEMENT_T6;
    for (int32_t q = 0; q < 25; q++) {
        double a = x[q % 5], b = x[q / 5];
        weight[q] = w[q % 5] * w[q / 5];
        point[q][0] = triangle ? (1 + a) / 2 : a;
        point[q][1] = triangle ? (1 - a) * (1 + b) / 4 : b;
        if (triangle) weight[q] *= (1 - a) / 8;
    }
    return 25;
}

static int32_t element_positions(const Mesh *mesh, int32_t e, MeshPlace position[])
{
    int32_t first = mesh->first_node[e], count = mesh->first_node[e + 1] - first;
    mesh_places(mesh, mesh->element_nodes + first, count, position);
    return count;
}

// What stands at one point of an element.
typedef struct Place {
    ShapeValues shape;
    double b[STRAINS_MAX][ELEMENT_DOFS_MAX];
    double x, z, weight;   // weight: with the Jacobian determinant
} Place;

static Place place_at(ElementKind kind, const MeshPlace *position, const double point[2],
                      double weight)
{
    Place place = {.shape = shape_at(kind, point)};
    place.weight = weight * element_strain_matrix(kind, position, point, place.b);
    for (int32_t a = 0; a < element_node_count(kind); a++) {
        place.x += place.shape.value[a] * position[a][0];
        place.z += place.shape.value[a] * position[a][1];
    }
    return place;
}

static void add_body_forces(Problem *problem)
{
    const Mesh *mesh = &problem->mesh;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        MeshPlace position[ELEMENT_NODES_MAX];
        double point[25][2], weight[25];
        int32_t count = element_positions(mesh, e, position);
        int32_t points = fine_points(mesh->kind[e], point, weight);
        for (int32_t q = 0; q < points; q++) {
            double force[2];
            Place place = place_at(mesh->kind[e], (const MeshPlace *)position, point[q], weight[q]);
            body_force(&problem->material, place.x, place.z, force);
            for (int32_t a = 0; a < count; a++) {
                int32_t node = mesh->element_nodes[mesh->first_node[e] + a];
                for (int d = 0; d < 2; d++)
                    problem->bulk.load[2 * node + d] += place.weight * place.shape.value[a] *
                                                        force[d];
            }
        }
    }
}

// Puts the chosen displacement on the boundary: f -= K u there, then those unknowns are held.
static bool hold_boundary(Problem *problem, Error *err)
{
    const Mesh *mesh = &problem->mesh;
    Bulk *bulk = &problem->bulk;
    double gradient[2][2], second[2][3], tiny = 1e-9 * (mesh->x_max - mesh->x_min);
    double *force = NEW_ARRAY(double, bulk->dof_count, err);
    if (!force) return false;
    for (int32_t node = 0; node < mesh->node_count; node++) {
        double x = mesh->position[2 * node], z = mesh->position[2 * node + 1];
        bool inside = x > mesh->x_min + tiny && x < mesh->x_max - tiny && z > mesh->z_min + tiny &&
                      z < mesh->z_max - tiny;
        if (!inside) chosen(x, z, problem->u + 2 * node, gradient, second);
    }
    sparse_apply(&bulk->pattern, bulk->stiffness, problem->u, force);
    for (int32_t dof = 0; dof < bulk->dof_count; dof++) bulk->load[dof] -= force[dof];
    for (int32_t dof = 0; dof < bulk->dof_count; dof++)
        if (problem->u[dof] != 0) bulk_hold(dof, bulk);
    memory_free(force);
    return true;
}

static bool solve(Problem *problem, Error *err)
{
    Bulk *bulk = &problem->bulk;
    SparseAnalysis *analysis = NULL;
    SparseFactor *factor = NULL;
    int32_t border = 0;
    double g, schur, at_border;
    double *inside = NEW_ARRAY(double, bulk->dof_count, err);
    if (!inside) goto cleanup;
    analysis = sparse_analyse(&bulk->pattern, &border, 1, err);   // one unknown as the border
    if (!analysis) goto cleanup;
    factor = sparse_factorise(analysis, bulk->stiffness, err);
    if (!factor) goto cleanup;
    TRY(sparse_condense(factor, bulk->load, &g, err));
    sparse_schur(factor, &schur);
    at_border = g / schur;
    TRY(sparse_expand(factor, &at_border, inside, err));
    for (int32_t dof = 0; dof < bulk->dof_count; dof++) problem->u[dof] += inside[dof];
cleanup:
    sparse_factor_destroy(factor);
    sparse_analysis_destroy(analysis);
    memory_free(inside);
    return error_is_clean(err);
}

static void print_errors(const Problem *problem)
{
    const Mesh *mesh = &problem->mesh;
    double d[STRAINS_MAX][STRAINS_MAX], wrong = 0, size = 0, wrong_energy = 0, energy = 0;
    moduli_matrix(material_elastic(&problem->material), 2, d);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        MeshPlace position[ELEMENT_NODES_MAX];
        double point[25][2], weight[25];
        int32_t count = element_positions(mesh, e, position);
        int32_t points = fine_points(mesh->kind[e], point, weight);
        for (int32_t q = 0; q < points; q++) {
            double u[2], gradient[2][2], second[2][3], ours[2] = {0};
            Place place = place_at(mesh->kind[e], (const MeshPlace *)position, point[q], weight[q]);
            chosen(place.x, place.z, u, gradient, second);
            double exact[3] = {gradient[0][0], gradient[1][1], gradient[0][1] + gradient[1][0]};
            double off[3] = {-exact[0], -exact[1], -exact[2]};
            for (int32_t a = 0; a < count; a++) {
                const double *nodal = problem->u + 2 * mesh->element_nodes[mesh->first_node[e] + a];
                for (int c = 0; c < 2; c++) {
                    ours[c] += place.shape.value[a] * nodal[c];
                    for (int r = 0; r < 3; r++) off[r] += place.b[r][2 * a + c] * nodal[c];
                }
            }
            for (int c = 0; c < 2; c++) {
                wrong += place.weight * (ours[c] - u[c]) * (ours[c] - u[c]);
                size += place.weight * u[c] * u[c];
            }
            for (int r = 0; r < 3; r++) {
                for (int c = 0; c < 3; c++) {
                    wrong_energy += place.weight * off[r] * d[r][c] * off[c];
                    energy += place.weight * exact[r] * d[r][c] * exact[c];
                }
            }
        }
    }
    printf("%.17g %.17g %.17g\n", sqrt(problem->bulk.area / mesh->element_count),
           sqrt(wrong / size), sqrt(wrong_energy / energy));
}

static int32_t read_parameters(int argc, char **argv, MeshParameter *parameters)
{
    int32_t count = 0;
    for (int k = 2; k < argc && count < PARAMETERS_MAX; k++) {
        const char *equals = strchr(argv[k], '=');
        if (!equals || equals - argv[k] >= GROUP_NAME_SIZE) continue;
        MeshParameter *parameter = &parameters[count++];
        char *end = NULL;
        memcpy(parameter->name, argv[k], (size_t)(equals - argv[k]));
        parameter->value = strtod(equals + 1, &end);
        if (*end) snprintf(parameter->text, sizeof parameter->text, "%.60s", equals + 1);
    }
    return count;
}

int main(int argc, char **argv)
{
    Error err = {0};
    Problem problem = {
        .material = {.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1}};
    MeshParameter parameters[PARAMETERS_MAX] = {0};
    MeshFile file = {0};
    if (argc < 2) return 2;
    dense_use_one_thread();
    int32_t count = read_parameters(argc, argv, parameters);
    TRY(mesh_file_read(argv[1], parameters, count, &file, &err));
    TRY(mesh_build(&file, argv[1], &problem.mesh, &err));
    TRY(bulk_assemble(&problem.mesh, &problem.material, &problem.bulk, &err));
    problem.u = NEW_ARRAY(double, problem.bulk.dof_count, &err);
    if (!problem.u) goto cleanup;
    add_body_forces(&problem);
    TRY(hold_boundary(&problem, &err));
    TRY(solve(&problem, &err));
    print_errors(&problem);
cleanup:
    mesh_file_destroy(&file);
    mesh_destroy(&problem.mesh);
    bulk_destroy(&problem.bulk);
    memory_free(problem.u);
    if (error_is_clean(&err)) return 0;
    fprintf(stderr, "amontons_manufactured: error: %s\n", err.message);
    return amontons_error_exit_status(err.code);
}
