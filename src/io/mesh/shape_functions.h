// SPDX-License-Identifier: GPL-2.0-or-later
// Shape functions of the five elements and the quadrature that goes with them, on the reference
// element: triangles xi, eta >= 0, xi + eta <= 1; quadrilaterals -1 <= xi, eta <= 1. Node order is
// gmsh's. Used by fem (checks, matrices, recovered stresses) and render (fields in an element).
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
    MeshPlace slope[ELEMENT_NODES_MAX];   // (dN_a/dxi, dN_a/deta)
} ShapeValues;

// At a point [element_dim]; entries beyond the element's nodes are 0.
ShapeValues shape_at(ElementKind kind, const double *point);

// Reference coordinates of node `a`, [element_dim].
const double *shape_node(ElementKind kind, int32_t a);

typedef struct Quadrature {
    int32_t count;
    MeshPlace point[QUADRATURE_POINTS_MAX];   // (xi, eta)
    double weight[QUADRATURE_POINTS_MAX];   // sum: 1/2 for triangles, 4 for quadrilaterals
} Quadrature;

// Integrates the stiffness of a straight-sided element exactly: T3 1 point, T6 3, Q4 2x2, Q8 and
// Q9 3x3.
Quadrature shape_quadrature(ElementKind kind);

// Integrates N_a^2 exactly on straight-sided triangles and parallelograms: as above, but 6 points
// for T6.
Quadrature shape_mass_quadrature(ElementKind kind);

// The determinant of J = d(x, z)/d(xi, eta), from the nodes' positions.
double shape_jacobian(ElementKind kind, const ShapeValues *shape, const MeshPlace *position);

// Slopes in place, gradient[a] = (dN_a/dx, dN_a/dz), [nodes]; returns the determinant.
double shape_gradients(ElementKind kind, const ShapeValues *shape, const MeshPlace *position,
                       MeshPlace *gradient);

#endif
