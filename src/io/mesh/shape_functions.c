// SPDX-License-Identifier: GPL-2.0-or-later
// Lagrange elements on triangle and square, and the eight-node serendipity element:
//   T6  corner a: L_a (2 L_a - 1),  mid-side ab: 4 L_a L_b,  L = (1 - xi - eta, xi, eta)
//   Q9  products of the 1D quadratics  s (s + c) / 2 at c = -1, 1  and  1 - s^2 at c = 0
//   Q8  corner: (1 + xi_a xi)(1 + eta_a eta)(xi_a xi + eta_a eta - 1) / 4,
//       mid-side: (1 - xi^2)(1 + eta_a eta) / 2, or with xi and eta exchanged
// Reference: Hughes, The Finite Element Method (1987), section 3.6 and appendix 3.I.
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <string.h>

// Reference coordinates of the nodes, in gmsh's order: corners, mid-sides, centre.
static const double TRIANGLE_NODES[6][2] = {{0, 0}, {1, 0}, {0, 1}, {.5, 0}, {.5, .5}, {0, .5}};
static const double SQUARE_NODES[9][2] = {{-1, -1}, {1, -1}, {1, 1},  {-1, 1}, {0, -1},
                                          {1, 0},   {0, 1},  {-1, 0}, {0, 0}};

// N = (1 - xi - eta, xi, eta), the area coordinates L themselves.
static void shape_t3(const double *point, ShapeValues *shape)
{
    double xi = point[0], eta = point[1];
    *shape = (ShapeValues){.value = {1 - xi - eta, xi, eta}, .slope = {{-1, -1}, {1, 0}, {0, 1}}};
}

// Mid-side node 3 + a lies between corners a and a + 1.
static void shape_t6(const double *point, ShapeValues *shape)
{
    ShapeValues area;   // L_0, L_1, L_2 and their slopes
    shape_t3(point, &area);
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
static void shape_q4(const double *point, ShapeValues *shape)
{
    double xi = point[0], eta = point[1];
    for (int32_t a = 0; a < 4; a++) {
        double xa = SQUARE_NODES[a][0], ea = SQUARE_NODES[a][1];
        shape->value[a] = (1 + xa * xi) * (1 + ea * eta) / 4;
        shape->slope[a][0] = xa * (1 + ea * eta) / 4;
        shape->slope[a][1] = ea * (1 + xa * xi) / 4;
    }
}

// With p = 1 + xi_a xi and q = 1 + eta_a eta; mid-sides 4 and 6 have xi_a = 0, 5 and 7 eta_a = 0.
static void shape_q8(const double *point, ShapeValues *shape)
{
    double xi = point[0], eta = point[1];
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
static void shape_q9(const double *point, ShapeValues *shape)
{
    double xi = point[0], eta = point[1];
    for (int32_t a = 0; a < 9; a++) {
        double p_slope, q_slope;
        double p = quadratic(SQUARE_NODES[a][0], xi, &p_slope);
        double q = quadratic(SQUARE_NODES[a][1], eta, &q_slope);
        shape->value[a] = p * q;
        shape->slope[a][0] = p_slope * q;
        shape->slope[a][1] = p * q_slope;
    }
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

static Quadrature square_rule_2(void)
{
    return square_rule(2);
}

static Quadrature square_rule_3(void)
{
    return square_rule(3);
}

// Exact to degree 1 and 2 on the triangle.
static Quadrature triangle_rule_1(void)
{
    return (Quadrature){.count = 1, .point = {{1. / 3, 1. / 3}}, .weight = {.5}};
}

static Quadrature triangle_rule_2(void)
{
    return (Quadrature){.count = 3,
                        .point = {{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}},
                        .weight = {1. / 6, 1. / 6, 1. / 6}};
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

// What makes a kind of element; how many nodes it has stands in io/mesh/mesh_file.
typedef struct ShapeRow {
    const double (*node)[DIM_MAX];   // reference coordinates of its nodes
    void (*values)(const double *point, ShapeValues *shape);
    Quadrature (*rule)(
        void);   // exact for B' D B where sides are straight and opposite ones parallel
    Quadrature (*mass_rule)(void);   // and for N_a^2
} ShapeRow;

static const ShapeRow ROWS[ELEMENT_KIND_COUNT] = {
    [ELEMENT_T3] = {TRIANGLE_NODES, shape_t3, triangle_rule_1, triangle_rule_1},
    [ELEMENT_T6] = {TRIANGLE_NODES, shape_t6, triangle_rule_2, triangle_rule_4},
    [ELEMENT_Q4] = {SQUARE_NODES, shape_q4, square_rule_2, square_rule_2},
    [ELEMENT_Q8] = {SQUARE_NODES, shape_q8, square_rule_3, square_rule_3},
    [ELEMENT_Q9] = {SQUARE_NODES, shape_q9, square_rule_3, square_rule_3}};

const double *shape_node(ElementKind kind, int32_t a)
{
    return ROWS[kind].node[a];
}

ShapeValues shape_at(ElementKind kind, const double *point)
{
    ShapeValues shape = {0};
    ROWS[kind].values(point, &shape);
    return shape;
}

Quadrature shape_quadrature(ElementKind kind)
{
    return ROWS[kind].rule();
}

Quadrature shape_mass_quadrature(ElementKind kind)
{
    return ROWS[kind].mass_rule();
}

// j[i][k] = d x_i / d xi_k.
static void fill_jacobian(ElementKind kind, const ShapeValues *shape, const MeshPlace *position,
                          double j[DIM_MAX][DIM_MAX])
{
    int32_t dim = element_dim(kind), nodes = element_node_count(kind);
    memset(j, 0, DIM_MAX * sizeof *j);
    for (int32_t a = 0; a < nodes; a++)
        for (int32_t row = 0; row < dim; row++)
            for (int32_t column = 0; column < dim; column++)
                j[row][column] += position[a][row] * shape->slope[a][column];
}

// Of dimension 2, the only one yet.
static double determinant_of(const double j[DIM_MAX][DIM_MAX])
{
    return j[0][0] * j[1][1] - j[0][1] * j[1][0];
}

double shape_jacobian(ElementKind kind, const ShapeValues *shape, const MeshPlace *position)
{
    double j[DIM_MAX][DIM_MAX];
    fill_jacobian(kind, shape, position, j);
    return determinant_of(j);
}

double shape_gradients(ElementKind kind, const ShapeValues *shape, const MeshPlace *position,
                       MeshPlace *gradient)
{
    double j[DIM_MAX][DIM_MAX];
    int32_t dim = element_dim(kind), nodes = element_node_count(kind);
    fill_jacobian(kind, shape, position, j);
    double determinant = determinant_of(j);
    const double cofactor[DIM_MAX][DIM_MAX] = {{j[1][1], -j[1][0]}, {-j[0][1], j[0][0]}};
    for (int32_t a = 0; a < nodes; a++)
        for (int32_t d = 0; d < dim; d++) {
            double sum = 0;
            for (int32_t k = 0; k < dim; k++) sum += cofactor[d][k] * shape->slope[a][k];
            gradient[a][d] = sum / determinant;
        }
    return determinant;
}
