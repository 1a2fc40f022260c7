// SPDX-License-Identifier: GPL-2.0-or-later
// Lagrange elements on triangle and square, and the eight-node serendipity element:
//   T6  corner a: L_a (2 L_a - 1),  mid-side ab: 4 L_a L_b,  L = (1 - xi - eta, xi, eta)
//   Q9  products of the 1D quadratics  s (s + c) / 2 at c = -1, 1  and  1 - s^2 at c = 0
//   Q8  corner: (1 + xi_a xi)(1 + eta_a eta)(xi_a xi + eta_a eta - 1) / 4,
//       mid-side: (1 - xi^2)(1 + eta_a eta) / 2, or with xi and eta exchanged
// Reference: Hughes, The Finite Element Method (1987), section 3.6 and appendix 3.I.
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stddef.h>

// Reference coordinates of the nodes, in gmsh's order: corners, mid-sides, centre.
static const double TRIANGLE_NODES[6][2] = {{0, 0}, {1, 0}, {0, 1}, {.5, 0}, {.5, .5}, {0, .5}};
static const double SQUARE_NODES[9][2] = {{-1, -1}, {1, -1}, {1, 1},  {-1, 1}, {0, -1},
                                          {1, 0},   {0, 1},  {-1, 0}, {0, 0}};

// On 0 <= xi, eta and xi + eta <= 1; the others on the square from -1 to 1.
static bool is_triangle(ElementKind kind)
{
    return kind == ELEMENT_T3 || kind == ELEMENT_T6;
}

void shape_node(ElementKind kind, int32_t a, double *xi, double *eta)
{
    const double *node = is_triangle(kind) ? TRIANGLE_NODES[a] : SQUARE_NODES[a];
    *xi = node[0];
    *eta = node[1];
}

// N = (1 - xi - eta, xi, eta), the area coordinates L themselves.
static void shape_t3(double xi, double eta, ShapeValues *shape)
{
    *shape = (ShapeValues){.value = {1 - xi - eta, xi, eta}, .slope = {{-1, -1}, {1, 0}, {0, 1}}};
}

// Mid-side node 3 + a lies between corners a and a + 1.
static void shape_t6(double xi, double eta, ShapeValues *shape)
{
    ShapeValues area;   // L_0, L_1, L_2 and their slopes
    shape_t3(xi, eta, &area);
    for (int32_t a = 0; a < 3; a++) {
        int32_t b = (a + 1) % 3;
        double la = area.value[a], lb = area.value[b];
        shape->value[a] = la * (2 * la - 1);
        shape->value[3 + a] = 4 * la * lb;
        for (int32_t d = 0; d < 2; d++) {
            shape->slope[a][d] = (4 * la - 1) * area.slope[a][d];
            shape->slope[3 + a][d] = 4 * (area.slope[a][d] * lb + la * area.slope[b][d]);
        }
    }
}

// N_a = (1 + xi_a xi)(1 + eta_a eta) / 4.
static void shape_q4(double xi, double eta, ShapeValues *shape)
{
    for (int32_t a = 0; a < 4; a++) {
        double xa = SQUARE_NODES[a][0], ea = SQUARE_NODES[a][1];
        shape->value[a] = (1 + xa * xi) * (1 + ea * eta) / 4;
        shape->slope[a][0] = xa * (1 + ea * eta) / 4;
        shape->slope[a][1] = ea * (1 + xa * xi) / 4;
    }
}

// With p = 1 + xi_a xi and q = 1 + eta_a eta; mid-sides 4 and 6 have xi_a = 0, 5 and 7 eta_a = 0.
static void shape_q8(double xi, double eta, ShapeValues *shape)
{
    for (int32_t a = 0; a < 8; a++) {
        double xa = SQUARE_NODES[a][0], ea = SQUARE_NODES[a][1];
        double p = 1 + xa * xi, q = 1 + ea * eta;
        if (a < 4) {
            shape->value[a] = p * q * (xa * xi + ea * eta - 1) / 4;
            shape->slope[a][0] = xa * q * (2 * xa * xi + ea * eta) / 4;
            shape->slope[a][1] = ea * p * (xa * xi + 2 * ea * eta) / 4;
        } else if (xa == 0) {
            shape->value[a] = (1 - xi * xi) * q / 2;
            shape->slope[a][0] = -xi * q;
            shape->slope[a][1] = (1 - xi * xi) * ea / 2;
        } else {
            shape->value[a] = (1 - eta * eta) * p / 2;
            shape->slope[a][0] = (1 - eta * eta) * xa / 2;
            shape->slope[a][1] = -eta * p;
        }
    }
}

// The 1D quadratic that is 1 at c (-1, 0 or 1), and its slope.
static double quadratic(double c, double s, double *slope)
{
    *slope = c == 0 ? -2 * s : s + c / 2;
    return c == 0 ? 1 - s * s : s * (s + c) / 2;
}

// N_a = l_a(xi) l_a(eta), l the quadratic through -1, 0, 1.
static void shape_q9(double xi, double eta, ShapeValues *shape)
{
    for (int32_t a = 0; a < 9; a++) {
        double p_slope, q_slope;
        double p = quadratic(SQUARE_NODES[a][0], xi, &p_slope);
        double q = quadratic(SQUARE_NODES[a][1], eta, &q_slope);
        shape->value[a] = p * q;
        shape->slope[a][0] = p_slope * q;
        shape->slope[a][1] = p * q_slope;
    }
}

ShapeValues shape_at(ElementKind kind, double xi, double eta)
{
    ShapeValues shape = {0};
    switch (kind) {
    case ELEMENT_T3:
        shape_t3(xi, eta, &shape);
        break;
    case ELEMENT_T6:
        shape_t6(xi, eta, &shape);
        break;
    case ELEMENT_Q4:
        shape_q4(xi, eta, &shape);
        break;
    case ELEMENT_Q8:
        shape_q8(xi, eta, &shape);
        break;
    case ELEMENT_Q9:
        shape_q9(xi, eta, &shape);
        break;
    case ELEMENT_KIND_COUNT:
        break;
    }
    return shape;
}

// Products of the Gauss rule with `n` = 2 or 3 points: exact to degree 2 n - 1 in xi and in eta.
static Quadrature square_rule(int32_t n)
{
    double point[3] = {-sqrt(1. / 3), sqrt(1. / 3), 0}, weight[3] = {1, 1, 0};
    if (n == 3) {
        point[0] = -sqrt(0.6), point[1] = 0, point[2] = sqrt(0.6);
        weight[0] = 5. / 9, weight[1] = 8. / 9, weight[2] = 5. / 9;
    }
    Quadrature rule = {.count = n * n};
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < n; i++) {
            rule.point[j * n + i][0] = point[i];
            rule.point[j * n + i][1] = point[j];
            rule.weight[j * n + i] = weight[i] * weight[j];
        }
    return rule;
}

// Exact for B' D B where sides are straight and opposite ones parallel: degree 0 for T3, 2 for T6.
Quadrature shape_quadrature(ElementKind kind)
{
    switch (kind) {
    case ELEMENT_T3:
        return (Quadrature){.count = 1, .point = {{1. / 3, 1. / 3}}, .weight = {.5}};
    case ELEMENT_T6:
        return (Quadrature){.count = 3,
                            .point = {{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}},
                            .weight = {1. / 6, 1. / 6, 1. / 6}};
    case ELEMENT_Q4:
        return square_rule(2);
    case ELEMENT_Q8:
    case ELEMENT_Q9:
        return square_rule(3);
    case ELEMENT_KIND_COUNT:
        break;
    }
    return (Quadrature){0};
}

// Degree 4 on the triangle (Dunavant, Int. J. Numer. Meth. Eng. 21, 1985, in closed form): points
// (a, a), (1 - 2 a, a), (a, 1 - 2 a) for each of two orbits.
static Quadrature triangle_rule_4(void)
{
    Quadrature rule = {.count = 6};
    for (int32_t orbit = 0; orbit < 2; orbit++) {
        double sign = orbit == 0 ? 1 : -1;
        double a = (8 - sqrt(10) + sign * sqrt(38 - 44 * sqrt(0.4))) / 18;
        double weight = (620 + sign * sqrt(213125 - 53320 * sqrt(10))) / 3720 / 2;
        for (int32_t corner = 0; corner < 3; corner++) {
            int32_t q = 3 * orbit + corner;
            rule.point[q][0] = corner == 1 ? 1 - 2 * a : a;
            rule.point[q][1] = corner == 2 ? 1 - 2 * a : a;
            rule.weight[q] = weight;
        }
    }
    return rule;
}

Quadrature shape_mass_quadrature(ElementKind kind)
{
    return kind == ELEMENT_T6 ? triangle_rule_4() : shape_quadrature(kind);
}

// jacobian[i][j] = d(x, z)_i / d(xi, eta)_j; NULL where only the determinant is wanted.
double shape_jacobian(ElementKind kind, const ShapeValues *shape, const double (*position)[2],
                      double jacobian[2][2])
{
    double j[2][2] = {{0}};
    for (int32_t a = 0; a < element_node_count(kind); a++)
        for (int32_t row = 0; row < 2; row++)
            for (int32_t column = 0; column < 2; column++)
                j[row][column] += position[a][row] * shape->slope[a][column];
    if (jacobian)
        for (int32_t row = 0; row < 2; row++)
            for (int32_t column = 0; column < 2; column++) jacobian[row][column] = j[row][column];
    return j[0][0] * j[1][1] - j[0][1] * j[1][0];
}
