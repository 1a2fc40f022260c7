// SPDX-License-Identifier: GPL-2.0-or-later
// Isoparametric elements, full integration (Hughes, The Finite Element Method, ch. 3).
#include "fem/element.h"

#include <string.h>

//     (eps_xx, eps_zz, 2 eps_xz) = B u_e,     [ N_a,x    0   ]
//                                       B_a = [   0    N_a,z ]
//                                             [ N_a,z  N_a,x ]
//
// with slopes in x and z by the inverse of the Jacobian J = d(x, z)/d(xi, eta). Returns det J.
double element_strain_matrix(ElementKind kind, const double (*position)[2], const double point[2],
                             double b[3][ELEMENT_DOFS_MAX])
{
    ShapeValues shape = shape_at(kind, point[0], point[1]);
    double jacobian[2][2];
    double determinant = shape_jacobian(kind, &shape, position, jacobian);
    int32_t nodes = element_node_count(kind);
    for (int32_t a = 0; a < nodes; a++) {
        double xi = shape.slope[a][0], eta = shape.slope[a][1];
        double d_x = (jacobian[1][1] * xi - jacobian[1][0] * eta) / determinant;
        double d_z = (jacobian[0][0] * eta - jacobian[0][1] * xi) / determinant;
        b[0][2 * a] = d_x;
        b[0][2 * a + 1] = 0;
        b[1][2 * a] = 0;
        b[1][2 * a + 1] = d_z;
        b[2][2 * a] = d_z;
        b[2][2 * a + 1] = d_x;
    }
    return determinant;
}

// out += weight * B' D B
static void add_quadratic_form(int32_t dofs, const double b[3][ELEMENT_DOFS_MAX],
                               const double d[3][3], double weight,
                               double out[ELEMENT_DOFS_MAX][ELEMENT_DOFS_MAX])
{
    for (int32_t j = 0; j < dofs; j++) {
        double stress[3];
        for (int r = 0; r < 3; r++)
            stress[r] = weight * (d[r][0] * b[0][j] + d[r][1] * b[1][j] + d[r][2] * b[2][j]);
        for (int32_t i = 0; i < dofs; i++)
            out[i][j] += b[0][i] * stress[0] + b[1][i] * stress[1] + b[2][i] * stress[2];
    }
}

// Row sums would give corners of a T6 no mass, and those of a Q8 a negative one; this rule of
// Hinton, Rock and Zienkiewicz (Earthq. Eng. Struct. Dyn. 4, 1976) keeps all positive.
static void lump_mass(ElementKind kind, const double (*position)[2], double density,
                      ElementMatrices *out)
{
    Quadrature quadrature = shape_mass_quadrature(kind);
    int32_t nodes = element_node_count(kind);
    double square_sum = 0;
    for (int32_t q = 0; q < quadrature.count; q++) {
        const double *point = quadrature.point[q];
        ShapeValues shape = shape_at(kind, point[0], point[1]);
        double weight = quadrature.weight[q] * shape_jacobian(kind, &shape, position, NULL);
        for (int32_t a = 0; a < nodes; a++) {
            double square = weight * shape.value[a] * shape.value[a];
            out->mass[a] += square;
            square_sum += square;
        }
    }
    for (int32_t a = 0; a < nodes; a++) out->mass[a] *= density * out->area / square_sum;
}

// By the element's own quadrature, per unit width.
static void integrate(ElementKind kind, const double (*position)[2], const double elastic[3][3],
                      const double viscous[3][3], ElementMatrices *out)
{
    double b[3][ELEMENT_DOFS_MAX];
    memset(out, 0, sizeof *out);
    out->dof_count = 2 * element_node_count(kind);
    Quadrature quadrature = shape_quadrature(kind);
    for (int32_t q = 0; q < quadrature.count; q++) {
        const double *point = quadrature.point[q];
        double weight = quadrature.weight[q] * element_strain_matrix(kind, position, point, b);
        add_quadratic_form(out->dof_count, b, elastic, weight, out->stiffness);
        add_quadratic_form(out->dof_count, b, viscous, weight, out->damping);
        for (int32_t j = 0; j < out->dof_count; j++) out->areal[j] += weight * b[j % 2][j];
        out->area += weight;
    }
}

void element_matrices(ElementKind kind, const double (*position)[2], const Material *material,
                      ElementMatrices *out)
{
    double elastic[3][3], viscous[3][3];
    material_elastic(material, elastic);
    material_viscous(material, viscous);
    integrate(kind, position, elastic, viscous, out);
    lump_mass(kind, position, material->density, out);
}

// Of an isotropic material the areal part is that which xx and zz share.
static void take_areal_part(double d[3][3])
{
    d[0][0] = d[1][1] = d[2][2];
    d[0][1] = d[1][0] = -d[2][2];
}

void element_shape_matrices(ElementKind kind, const double (*position)[2], const Material *material,
                            ElementMatrices *out)
{
    double elastic[3][3], viscous[3][3];
    material_elastic(material, elastic);
    material_viscous(material, viscous);
    take_areal_part(elastic);
    take_areal_part(viscous);
    integrate(kind, position, elastic, viscous, out);
    lump_mass(kind, position, material->density, out);
}
