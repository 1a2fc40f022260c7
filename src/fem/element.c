// SPDX-License-Identifier: GPL-2.0-or-later
// Isoparametric elements, full integration (Hughes, The Finite Element Method, ch. 3).
#include "fem/element.h"

#include <string.h>

//     (eps_xx, eps_zz, 2 eps_xz) = B u_e,     [ N_a,x    0   ]
//                                       B_a = [   0    N_a,z ]
//                                             [ N_a,z  N_a,x ]
//
// a row for each axis, then one for each pair of axes. Returns det J, J = d(x ... z)/d(xi, eta,
// ...).
double element_strain_matrix(ElementKind kind, const MeshPlace *position, const double *point,
                             double b[STRAINS_MAX][ELEMENT_DOFS_MAX])
{
    ShapeValues shape = shape_at(kind, point);
    MeshPlace gradient[ELEMENT_NODES_MAX];
    double determinant = shape_gradients(kind, &shape, position, gradient);
    int32_t dim = element_dim(kind), nodes = element_node_count(kind);
    for (int32_t r = 0; r < strain_count(dim); r++)
        memset(b[r], 0, (size_t)(dim * nodes) * sizeof(double));
    for (int32_t a = 0; a < nodes; a++)
        for (int32_t d = 0; d < dim; d++) b[d][dim * a + d] = gradient[a][d];
    for (int32_t row = dim; row < strain_count(dim); row++) {
        int32_t d = SHEAR_AXES[row - dim][0], f = SHEAR_AXES[row - dim][1];
        for (int32_t a = 0; a < nodes; a++) {
            b[row][dim * a + d] = gradient[a][f];
            b[row][dim * a + f] = gradient[a][d];
        }
    }
    return determinant;
}

// out += weight * B' D B, B: [strains][dofs].
static void add_quadratic_form(int32_t strains, int32_t dofs,
                               const double b[STRAINS_MAX][ELEMENT_DOFS_MAX],
                               const double d[STRAINS_MAX][STRAINS_MAX], double weight,
                               double out[ELEMENT_DOFS_MAX][ELEMENT_DOFS_MAX])
{
    for (int32_t j = 0; j < dofs; j++) {
        double stress[STRAINS_MAX];
        for (int32_t r = 0; r < strains; r++) {
            double sum = 0;
            for (int32_t c = 0; c < strains; c++) sum += d[r][c] * b[c][j];
            stress[r] = weight * sum;
        }
        for (int32_t i = 0; i < dofs; i++) {
            double sum = 0;
            for (int32_t r = 0; r < strains; r++) sum += b[r][i] * stress[r];
            out[i][j] += sum;
        }
    }
}

// Row sums would give corners of a T6 no mass, and those of a Q8 a negative one; this rule of
// Hinton, Rock and Zienkiewicz (Earthq. Eng. Struct. Dyn. 4, 1976) keeps all positive.
static void lump_mass(ElementKind kind, const MeshPlace *position, double density,
                      ElementMatrices *out)
{
    Quadrature quadrature = shape_mass_quadrature(kind);
    int32_t nodes = element_node_count(kind);
    double square_sum = 0;
    for (int32_t q = 0; q < quadrature.count; q++) {
        const double *point = quadrature.point[q];
        ShapeValues shape = shape_at(kind, point);
        double weight = quadrature.weight[q] * shape_jacobian(kind, &shape, position);
        for (int32_t a = 0; a < nodes; a++) {
            double square = weight * shape.value[a] * shape.value[a];
            out->mass[a] += square;
            square_sum += square;
        }
    }
    for (int32_t a = 0; a < nodes; a++) out->mass[a] *= density * out->area / square_sum;
}

void element_matrices_clear(int32_t dof_count, ElementMatrices *out)
{
    size_t row = (size_t)dof_count * sizeof(double);
    for (int32_t i = 0; i < dof_count; i++) {
        memset(out->stiffness[i], 0, row);
        memset(out->damping[i], 0, row);
    }
    memset(out->mass, 0, sizeof out->mass);
    memset(out->areal, 0, row);
    out->area = 0;
    out->dof_count = dof_count;
}

// Integrates with the element's own quadrature; in the plane per unit width.
void element_matrices(ElementKind kind, const MeshPlace *position, const Material *material,
                      bool with_areal, ElementMatrices *out)
{
    double elastic[STRAINS_MAX][STRAINS_MAX], viscous[STRAINS_MAX][STRAINS_MAX];
    double b[STRAINS_MAX][ELEMENT_DOFS_MAX];
    int32_t dim = element_dim(kind), strains = strain_count(dim);
    Moduli moduli[2] = {material_elastic(material), material_viscous(material)};
    for (int32_t k = 0; k < 2 && !with_areal; k++) moduli[k].trace = -moduli[k].deviator / dim;
    moduli_matrix(moduli[0], dim, elastic);
    moduli_matrix(moduli[1], dim, viscous);
    element_matrices_clear(dim * element_node_count(kind), out);
    Quadrature quadrature = shape_quadrature(kind);
    for (int32_t q = 0; q < quadrature.count; q++) {
        const double *point = quadrature.point[q];
        double weight = quadrature.weight[q] * element_strain_matrix(kind, position, point, b);
        add_quadratic_form(strains, out->dof_count, b, elastic, weight, out->stiffness);
        add_quadratic_form(strains, out->dof_count, b, viscous, weight, out->damping);
        for (int32_t j = 0; j < out->dof_count; j++) out->areal[j] += weight * b[j % dim][j];
        out->area += weight;
    }
    lump_mass(kind, position, material->density, out);
}
