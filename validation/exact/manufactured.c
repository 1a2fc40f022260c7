// SPDX-License-Identifier: GPL-2.0-or-later
// The method of manufactured solutions for K: a smooth displacement is chosen, in the plane
//
//     u_x = sin(2 x + 0.5) cos(3 z),   u_z = cos(x + 2 z),
//
// in space such waves along all three axes (WAVES), the body force that it needs is put into f by
// quadrature, the boundary is held at it, and what is solved is compared with it. Prints the
// elements' size h and the errors of u in the L2 norm and of the strain energy's norm, both
// relative.
//
//   amontons_manufactured MESH.geo name=value ...
#include "algebra/dense.h"
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

// amplitude sin(along . x + phase), two of them a component.
typedef struct Wave {
    double amplitude, along[3], phase;
} Wave;

static const Wave WAVES[2][3][2] = {
    {{{0.5, {2, 3}, 0.5}, {0.5, {2, -3}, 0.5}}, {{1, {1, 2}, 1.5707963267948966}}},
    {{{0.5, {2, 1, 3}, 0.5}, {0.5, {2, -2, -1}, 0.5}},
     {{0.7, {1, 3, -1}, 0.2}, {0.4, {-2, 1, 2}, 1}},
     {{1, {1, -1, 2}, 1.5}, {0.3, {2, 3, 1}, 0}}}};

// Displacement, its gradient [component][direction] and second derivatives.
typedef struct Chosen {
    double u[3], gradient[3][3], second[3][3][3];
} Chosen;

static Chosen chosen(int32_t dim, const double *x)
{
    Chosen at = {{0}, {{0}}, {{{0}}}};
    for (int32_t c = 0; c < dim; c++)
        for (int32_t w = 0; w < 2; w++) {
            const Wave *wave = &WAVES[dim - 2][c][w];
            double angle = wave->phase;
            for (int32_t d = 0; d < dim; d++) angle += wave->along[d] * x[d];
            at.u[c] += wave->amplitude * sin(angle);
            for (int32_t d = 0; d < dim; d++) {
                at.gradient[c][d] += wave->amplitude * wave->along[d] * cos(angle);
                for (int32_t e = 0; e < dim; e++)
                    at.second[c][d][e] -= wave->amplitude * wave->along[d] * wave->along[e] *
                                          sin(angle);
            }
        }
    return at;
}

// -div sigma, sigma = dev eps + lam tr(eps) I, of plane stress or in space, with moduli that owe
// nothing to fem/material:  -(dev/2 (u_i,jj + u_j,ij) + lam u_j,ij).
static void body_force(const Material *material, int32_t dim, const double *x, double force[3])
{
    Chosen at = chosen(dim, x);
    double nu = material->poisson, dev = material->young / (1 + nu);
    double lam = dev * nu / (dim == 2 ? 1 - nu : 1 - 2 * nu);
    for (int32_t i = 0; i < dim; i++) {
        force[i] = 0;
        for (int32_t j = 0; j < dim; j++)
            force[i] -= dev / 2 * (at.second[i][j][j] + at.second[j][i][j]) +
                        lam * at.second[j][i][j];
    }
}

enum { FINE = 5, FINE_MAX = FINE * FINE * FINE };

// From a square or cube [-1, 1] to the reference element, with the factor of the weight: triangles,
// wedges and tetrahedra are squares and cubes that collapsed.
static double collapse(ElementKind kind, double at[3])
{
    int32_t dim = element_dim(kind), corners = element_corner_count(kind);
    double t[3];
    if (corners == 1 << dim) return 1;
    for (int32_t d = 0; d < 3; d++) t[d] = (1 + at[d]) / 2;
    at[0] = t[0];
    at[1] = t[1] * (1 - t[0]);
    if (corners != 4) return (1 - t[0]) / 4;   // of a triangle; a wedge's third axis stays
    at[2] = t[2] * (1 - at[0] - at[1]);
    return (1 - t[0]) * (1 - at[0] - at[1]) / 8;
}

// 5 Gauss points along each axis: exact enough for any element here.
static int32_t fine_points(ElementKind kind, double point[FINE_MAX][3], double weight[FINE_MAX])
{
    static const double x[FINE] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                                   0.906179845938664};
    static const double w[FINE] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                   0.478628670499366, 0.236926885056189};
    int32_t dim = element_dim(kind), count = dim == 2 ? FINE * FINE : FINE_MAX;
    for (int32_t q = 0; q < count; q++) {
        const int32_t place[3] = {q % FINE, q / FINE % FINE, q / FINE / FINE};
        weight[q] = 1;
        point[q][2] = 0;
        for (int32_t d = 0; d < dim; d++) {
            point[q][d] = x[place[d]];
            weight[q] *= w[place[d]];
        }
        weight[q] *= collapse(kind, point[q]);
    }
    return count;
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
    double x[3], weight;   // weight: with the Jacobian determinant
} Place;

static Place place_at(ElementKind kind, const MeshPlace *position, const double *point,
                      double weight)
{
    Place place = {.shape = shape_at(kind, point)};
    place.weight = weight * element_strain_matrix(kind, position, point, place.b);
    for (int32_t a = 0; a < element_node_count(kind); a++) {
        for (int32_t d = 0; d < element_dim(kind); d++)
            place.x[d] += place.shape.value[a] * position[a][d];
    }
    return place;
}

static void add_body_forces(Problem *problem)
{
    const Mesh *mesh = &problem->mesh;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        MeshPlace position[ELEMENT_NODES_MAX];
        double point[FINE_MAX][3], weight[FINE_MAX];
        int32_t count = element_positions(mesh, e, position);
        int32_t points = fine_points(mesh->kind[e], point, weight);
        for (int32_t q = 0; q < points; q++) {
            double force[3];
            Place place = place_at(mesh->kind[e], (const MeshPlace *)position, point[q], weight[q]);
            body_force(&problem->material, mesh->dim, place.x, force);
            for (int32_t a = 0; a < count; a++) {
                int32_t node = mesh->element_nodes[mesh->first_node[e] + a];
                for (int d = 0; d < mesh->dim; d++)
                    problem->bulk.load[node_dof(mesh->dim, node, d)] +=
                        place.weight * place.shape.value[a] * force[d];
            }
        }
    }
}

// Puts the chosen displacement on the boundary: f -= K u there, then those unknowns are held.
static bool hold_boundary(Problem *problem, Error *err)
{
    const Mesh *mesh = &problem->mesh;
    Bulk *bulk = &problem->bulk;
    const double low[] = {mesh->x_min, mesh->dim > 2 ? mesh->y_min : mesh->z_min, mesh->z_min};
    const double high[] = {mesh->x_max, mesh->dim > 2 ? mesh->y_max : mesh->z_max, mesh->z_max};
    double tiny = 1e-9 * (mesh->x_max - mesh->x_min);
    double *force = NEW_ARRAY(double, bulk->dof_count, err);
    if (!force) return false;
    for (int32_t node = 0; node < mesh->node_count; node++) {
        const double *x = mesh_place(mesh, node);
        bool inside = true;
        for (int32_t d = 0; d < mesh->dim; d++)
            inside = inside && x[d] > low[d] + tiny && x[d] < high[d] - tiny;
        Chosen at = chosen(mesh->dim, x);
        for (int32_t d = 0; d < mesh->dim && !inside; d++)
            problem->u[node_dof(mesh->dim, node, d)] = at.u[d];
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
    // One unknown as the border.
    analysis = sparse_analyse(&bulk->pattern, bulk->place, &border, 1, err);
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

// As strains are ordered, shear twice.
static void strains_of(const Chosen *at, int32_t dim, double strain[STRAINS_MAX])
{
    static const int32_t axes[2][6][2] = {{{0, 0}, {1, 1}, {0, 1}},
                                          {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
    for (int32_t k = 0; k < strain_count(dim); k++) {
        int32_t a = axes[dim - 2][k][0], b = axes[dim - 2][k][1];
        strain[k] = a == b ? at->gradient[a][a] : at->gradient[a][b] + at->gradient[b][a];
    }
}

// Squares, summed over the block.
typedef struct Sums {
    double wrong, size, wrong_energy, energy;
} Sums;

static void add_place(const Problem *problem, const Place *place, const int32_t *nodes,
                      int32_t count, Sums *sums)
{
    int32_t dim = problem->mesh.dim, strains = strain_count(dim);
    double d[STRAINS_MAX][STRAINS_MAX], exact[STRAINS_MAX], off[STRAINS_MAX], ours[3] = {0};
    Chosen at = chosen(dim, place->x);
    moduli_matrix(material_elastic(&problem->material), dim, d);
    strains_of(&at, dim, exact);
    for (int32_t r = 0; r < strains; r++) off[r] = -exact[r];
    for (int32_t a = 0; a < count; a++)
        for (int32_t c = 0; c < dim; c++) {
            double nodal = problem->u[node_dof(dim, nodes[a], c)];
            ours[c] += place->shape.value[a] * nodal;
            for (int32_t r = 0; r < strains; r++) off[r] += place->b[r][dim * a + c] * nodal;
        }
    for (int32_t c = 0; c < dim; c++) {
        sums->wrong += place->weight * (ours[c] - at.u[c]) * (ours[c] - at.u[c]);
        sums->size += place->weight * at.u[c] * at.u[c];
    }
    for (int32_t r = 0; r < strains; r++)
        for (int32_t c = 0; c < strains; c++) {
            sums->wrong_energy += place->weight * off[r] * d[r][c] * off[c];
            sums->energy += place->weight * exact[r] * d[r][c] * exact[c];
        }
}

static void print_errors(const Problem *problem)
{
    const Mesh *mesh = &problem->mesh;
    Sums sums = {0, 0, 0, 0};
    for (int32_t e = 0; e < mesh->element_count; e++) {
        MeshPlace position[ELEMENT_NODES_MAX];
        double point[FINE_MAX][3], weight[FINE_MAX];
        int32_t count = element_positions(mesh, e, position);
        int32_t points = fine_points(mesh->kind[e], point, weight);
        for (int32_t q = 0; q < points; q++) {
            Place place = place_at(mesh->kind[e], (const MeshPlace *)position, point[q], weight[q]);
            add_place(problem, &place, mesh->element_nodes + mesh->first_node[e], count, &sums);
        }
    }
    printf("%.17g %.17g %.17g\n", pow(problem->bulk.area / mesh->element_count, 1.0 / mesh->dim),
           sqrt(sums.wrong / sums.size), sqrt(sums.wrong_energy / sums.energy));
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
    TRY(mesh_file_read(argv[1], parameters, count, false, NULL, &file, &err));
    TRY(mesh_build(&file, argv[1], &problem.mesh, &err));
    problem.material.plane_strain = problem.mesh.dim > 2;   // moduli in space are its
    TRY(bulk_create(&problem.mesh, &problem.bulk, &err));
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
