// SPDX-License-Identifier: GPL-2.0-or-later
// Shape functions of the five elements and the quadrature that goes with them, on the reference
// element: triangles xi, eta >= 0, xi + eta <= 1; quadrilaterals -1 <= xi, eta <= 1. Node order is
// gmsh's. Used by bulk (checks, matrices, recovered stresses) and render (fields in an element).
//
//     2           2            3---2      3-6-2      3-6-2
//     |\          5 4          |   |      7   5      7 8 5
//     0-1  T3     0-3-1  T6    0---1 Q4   0-4-1 Q8   0-4-1 Q9
#ifndef AMONTONS_IO_MESH_SHAPE_FUNCTIONS_H
#define AMONTONS_IO_MESH_SHAPE_FUNCTIONS_H

#include "io/mesh/mesh_file.h"

#include <stdint.h>

enum { QUADRATURE_POINTS_MAX = 9 };

typedef struct ShapeValues {
    double value[ELEMENT_NODES_MAX];   // N_a
    double slope[ELEMENT_NODES_MAX][2];   // (dN_a/dxi, dN_a/deta)
} ShapeValues;

// At the point (xi, eta); entries beyond the element's nodes are 0.
ShapeValues shape_at(ElementKind kind, double xi, double eta);

// Reference coordinates of node `a`.
void shape_node(ElementKind kind, int32_t a, double *xi, double *eta);

typedef struct Quadrature {
    int32_t count;
    double point[QUADRATURE_POINTS_MAX][2];   // (xi, eta)
    double weight[QUADRATURE_POINTS_MAX];   // sum: 1/2 for triangles, 4 for quadrilaterals
} Quadrature;

// Integrates the stiffness of a straight-sided element exactly: T3 1 point, T6 3, Q4 2x2, Q8 and
// Q9 3x3.
Quadrature shape_quadrature(ElementKind kind);

// Integrates N_a^2 exactly on straight-sided triangles and parallelograms: as above, but 6 points
// for T6.
Quadrature shape_mass_quadrature(ElementKind kind);

// J = [dx/dxi dx/deta; dz/dxi dz/deta] from the nodes' positions [nodes][2]; returns its
// determinant. `jacobian` may be NULL.
double shape_jacobian(ElementKind kind, const ShapeValues *shape, const double (*position)[2],
                      double jacobian[2][2]);

#endif
