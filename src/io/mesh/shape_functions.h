// SPDX-License-Identifier: GPL-2.0-or-later
// Shape functions of the elements and the quadrature that goes with them, on the reference element:
// triangles and tetrahedra xi, eta, zeta >= 0, their sum <= 1; lines, squares and cubes from -1 to
// 1; the wedge is such a triangle times such a line. Node order is gmsh's. Used by fem (checks,
// matrices, recovered stresses) and render (fields in an element).
//
//     2           2            3---2      3-6-2      3-6-2
//     |\          5 4          |   |      7   5      7 8 5
//     0-1  T3     0-3-1  T6    0---1 Q4   0-4-1 Q8   0-4-1 Q9
#ifndef AMONTONS_IO_MESH_SHAPE_FUNCTIONS_H
#define AMONTONS_IO_MESH_SHAPE_FUNCTIONS_H

#include "io/mesh/mesh_file.h"

#include <stdint.h>

enum { QUADRATURE_POINTS_MAX = 27 };

typedef struct ShapeValues {
    double value[ELEMENT_NODES_MAX];   // N_a
    MeshPlace slope[ELEMENT_NODES_MAX];   // dN_a/dxi, dN_a/deta, ...
} ShapeValues;

// Shape functions at a point [element_dim]; entries beyond the element's nodes are 0.
ShapeValues shape_at(ElementKind kind, const double *point);

// Reference coordinates of node `a`, [element_dim].
const double *shape_node(ElementKind kind, int32_t a);

typedef struct Quadrature {
    int32_t count;
    MeshPlace point[QUADRATURE_POINTS_MAX];   // xi, eta, ...
    double
        weight[QUADRATURE_POINTS_MAX];   // sum: the size of the reference element, such as 1/2 or 8
} Quadrature;

// Integrates the stiffness exactly where sides are straight and opposite ones parallel: T3 and TET4
// 1 point, T6 3, TET10 4, WEDGE6 3x2, Q4 and HEX8 2 along each axis, Q8, Q9 and HEX27 3.
Quadrature shape_quadrature(ElementKind kind);

// Integrates N_a^2 exactly there: as above, but 6 points for T6 and 15 for TET10.
Quadrature shape_mass_quadrature(ElementKind kind);

// The determinant of J = d(x ... z)/d(xi, eta, ...), from the nodes' positions.
double shape_jacobian(ElementKind kind, const ShapeValues *shape, const MeshPlace *position);

// Slopes in place, gradient[a] = (dN_a/dx ... dN_a/dz), [nodes]; returns the determinant.
double shape_gradients(ElementKind kind, const ShapeValues *shape, const MeshPlace *position,
                       MeshPlace *gradient);

// Newton's method for the reference coordinates of a place. false: it does not converge, and `at`
// is where it ended.
bool shape_locate(ElementKind kind, const MeshPlace *position, const double *place, MeshPlace at);

// Normal of a face, which is an element in a space of one dimension more: n |J| with the unit
// normal n. It points to the left of a line, and to the side from which a face's nodes run
// counter-clockwise.
void shape_normal(ElementKind kind, const ShapeValues *shape, const MeshPlace *position,
                  MeshPlace normal);

#endif
