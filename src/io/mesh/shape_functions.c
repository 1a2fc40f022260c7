// SPDX-License-Identifier: GPL-2.0-or-later
// Lagrange elements: simplices, products of lines, the wedge (a triangle times a line), and the
// eight-node serendipity element. With L = (1 - xi - eta - ..., xi, eta, ...) and c = -1, 0, 1:
//   T6, TET10     corner a: L_a (2 L_a - 1),  mid-side ab: 4 L_a L_b
//   L3, Q9, HEX27 products of the 1D quadratics  s (s + c) / 2 at c = -1, 1  and  1 - s^2 at c = 0
//   Q8            corner: (1 + xi_a xi)(1 + eta_a eta)(xi_a xi + eta_a eta - 1) / 4,
//                 mid-side: (1 - xi^2)(1 + eta_a eta) / 2, or with xi and eta exchanged
// Reference: Hughes, The Finite Element Method (1987), section 3.6 and appendix 3.I.
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <string.h>

// Reference coordinates of the nodes, in gmsh's order: corners, mid-sides, faces, centre.
static const double LINE_NODES[3][DIM_MAX] = {{-1}, {1}, {0}};
static const double TRIANGLE_NODES[6][DIM_MAX] = {{0, 0},  {1, 0},   {0, 1},
                                                  {.5, 0}, {.5, .5}, {0, .5}};
static const double SQUARE_NODES[9][DIM_MAX] = {{-1, -1}, {1, -1}, {1, 1},  {-1, 1}, {0, -1},
                                                {1, 0},   {0, 1},  {-1, 0}, {0, 0}};
static const double TETRAHEDRON_NODES[10][DIM_MAX] = {
    {0, 0, 0},   {1, 0, 0},  {0, 1, 0},  {0, 0, 1},   {.5, 0, 0},
    {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {0, .5, .5}, {.5, 0, .5}};
static const double WEDGE_NODES[6][DIM_MAX] = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1},
                                               {0, 0, 1},  {1, 0, 1},  {0, 1, 1}};
static const double CUBE_NODES[27][DIM_MAX] = {
    {-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},
    {-1, 1, 1},   {0, -1, -1}, {-1, 0, -1}, {-1, -1, 0}, {1, 0, -1},  {1, -1, 0}, {0, 1, -1},
    {1, 1, 0},    {-1, 1, 0},  {0, -1, 1},  {-1, 0, 1},  {1, 0, 1},   {0, 1, 1},  {0, 0, -1},
    {0, -1, 0},   {-1, 0, 0},  {1, 0, 0},   {0, 1, 0},   {0, 0, 1},   {0, 0, 0}};

// A reference element.
typedef struct Reference {
    int32_t dim, nodes;
    const double (*node)[DIM_MAX];   // [nodes]
} Reference;

// N_a = L_a, the area or volume coordinates themselves.
static void shape_simplex(const Reference *of, const double *point, ShapeValues *shape)
{
    int32_t dim = of->dim;
    shape->value[0] = 1;
    for (int32_t d = 0; d < dim; d++) {
        shape->value[0] -= point[d];
        shape->value[d + 1] = point[d];
        shape->slope[0][d] = -1;
        shape->slope[d + 1][d] = 1;
    }
}

// Which corners a mid-side node is between: in the triangle and in the base of the tetrahedron one
// and the next.
static const uint8_t SIMPLEX_SIDES[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};

static void shape_simplex_2(const Reference *of, const double *point, ShapeValues *shape)
{
    ShapeValues linear = {0};   // L_0, L_1, ... and their slopes
    int32_t dim = of->dim, corners = dim + 1;
    shape_simplex(of, point, &linear);
    for (int32_t a = 0; a < corners; a++) {
        double la = linear.value[a];
        shape->value[a] = la * (2 * la - 1);
        for (int32_t d = 0; d < dim; d++) shape->slope[a][d] = (4 * la - 1) * linear.slope[a][d];
    }
    for (int32_t m = corners; m < of->nodes; m++) {
        int32_t a = SIMPLEX_SIDES[m - corners][0], b = SIMPLEX_SIDES[m - corners][1];
        double la = linear.value[a], lb = linear.value[b];
        shape->value[m] = 4 * la * lb;
        for (int32_t d = 0; d < dim; d++)
            shape->slope[m][d] = 4 * (linear.slope[a][d] * lb + la * linear.slope[b][d]);
    }
}

// The 1D functions that are 1 at c (-1, 0 or 1), and their slopes.
static double linear(double c, double s, double *slope)
{
    *slope = c / 2;
    return (1 + c * s) / 2;
}

static double quadratic(double c, double s, double *slope)
{
    *slope = c == 0 ? -2 * s : s + c / 2;
    return c == 0 ? 1 - s * s : s * (s + c) / 2;
}

// N_a = their product over the axes, c the node's place there.
static void shape_product(const Reference *of, const double *point, ShapeValues *shape)
{
    int32_t dim = of->dim;
    double (*along)(double, double, double *) = of->nodes == 1 << dim ? linear : quadratic;
    for (int32_t a = 0; a < of->nodes; a++) {
        double factor[DIM_MAX], slope[DIM_MAX];
        shape->value[a] = 1;
        for (int32_t d = 0; d < dim; d++) {
            factor[d] = along(of->node[a][d], point[d], &slope[d]);
            shape->value[a] *= factor[d];
        }
        for (int32_t d = 0; d < dim; d++) {
            shape->slope[a][d] = 1;
            for (int32_t f = 0; f < dim; f++) shape->slope[a][d] *= f == d ? slope[f] : factor[f];
        }
    }
}

// N_a = L_a (1 + c zeta) / 2, c = -1 below and 1 above.
static void shape_wedge(const Reference *of, const double *point, ShapeValues *shape)
{
    ShapeValues flat = {0};
    shape_simplex(&(Reference){2, 3, TRIANGLE_NODES}, point, &flat);
    for (int32_t a = 0; a < of->nodes; a++) {
        double c = WEDGE_NODES[a][2], height = (1 + c * point[2]) / 2;
        shape->value[a] = flat.value[a % 3] * height;
        shape->slope[a][0] = flat.slope[a % 3][0] * height;
        shape->slope[a][1] = flat.slope[a % 3][1] * height;
        shape->slope[a][2] = flat.value[a % 3] * c / 2;
    }
}

// With p = 1 + xi_a xi and q = 1 + eta_a eta; mid-sides 4 and 6 have xi_a = 0, 5 and 7 eta_a = 0.
static void shape_q8(const Reference *of, const double *point, ShapeValues *shape)
{
    double xi = point[0], eta = point[1];
    for (int32_t a = 0; a < of->nodes; a++) {
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

// --- quadrature ---------------------------------------------------------------------------------

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

// Exact to degree 1 and 2 on the tetrahedron (Hughes, table 3.I.1).
static Quadrature tetrahedron_rule_1(void)
{
    return (Quadrature){.count = 1, .point = {{.25, .25, .25}}, .weight = {1. / 6}};
}

// Appends the points whose volume coordinates are `high` at one corner, `low` at the others.
static void add_corners(double low, double high, double weight, Quadrature *rule)
{
    for (int32_t corner = 0; corner < 4; corner++) {
        int32_t q = rule->count++;
        rule->weight[q] = weight;
        for (int32_t d = 0; d < 3; d++) rule->point[q][d] = corner == d + 1 ? high : low;
    }
}

static Quadrature tetrahedron_rule_2(void)
{
    Quadrature rule = {0};
    add_corners((5 - sqrt(5)) / 20, (5 + 3 * sqrt(5)) / 20, 1. / 24, &rule);
    return rule;
}

// Degree 5, 15 points: Stroud, Approximate Calculation of Multiple Integrals (1971), T3: 5-1.
static Quadrature tetrahedron_rule_5(void)
{
    Quadrature rule = {.count = 1, .point = {{.25, .25, .25}}, .weight = {16. / 135 / 6}};
    for (int32_t sign = -1; sign <= 1; sign += 2) {
        double root = sign * sqrt(15), low = (7 - root) / 34;
        add_corners(low, 1 - 3 * low, (2665 + 14 * root) / 37800 / 6, &rule);
    }
    for (int32_t side = 0; side < 6; side++, rule.count++) {
        double high = (5 + sqrt(15)) / 20, low = (5 - sqrt(15)) / 20;
        rule.weight[rule.count] = 10. / 189 / 6;
        for (int32_t d = 0; d < 3; d++) {
            const uint8_t *ends = SIMPLEX_SIDES[side];
            rule.point[rule.count][d] = ends[0] == d + 1 || ends[1] == d + 1 ? high : low;
        }
    }
    return rule;
}

// Data of a kind of element; its number of nodes stands in io/mesh/mesh_file. An element is the
// product of a simplex and of lines for the rest of its dimensions.
typedef struct ShapeRow {
    const double (*node)[DIM_MAX];   // reference coordinates
    void (*values)(const Reference *of, const double *point, ShapeValues *shape);
    Quadrature (*rule)(void);   // of the simplex; NULL: lines alone
    Quadrature (*mass_rule)(void);
    int32_t simplex_dim;
    int32_t line_points;   // Gauss points along each of its lines: exact to degree 2 n - 1
} ShapeRow;

// Exact for B' D B where sides are straight and opposite ones parallel, mass_rule for N_a^2.
static const ShapeRow ROWS[ELEMENT_KIND_COUNT] = {
    [ELEMENT_L2] = {LINE_NODES, shape_product, .line_points = 2},
    [ELEMENT_L3] = {LINE_NODES, shape_product, .line_points = 3},
    [ELEMENT_T3] = {TRIANGLE_NODES, shape_simplex, triangle_rule_1, triangle_rule_1, 2, 0},
    [ELEMENT_T6] = {TRIANGLE_NODES, shape_simplex_2, triangle_rule_2, triangle_rule_4, 2, 0},
    [ELEMENT_Q4] = {SQUARE_NODES, shape_product, .line_points = 2},
    [ELEMENT_Q8] = {SQUARE_NODES, shape_q8, .line_points = 3},
    [ELEMENT_Q9] = {SQUARE_NODES, shape_product, .line_points = 3},
    [ELEMENT_TET4] = {TETRAHEDRON_NODES, shape_simplex, tetrahedron_rule_1, tetrahedron_rule_1, 3,
                      0},
    [ELEMENT_TET10] = {TETRAHEDRON_NODES, shape_simplex_2, tetrahedron_rule_2, tetrahedron_rule_5,
                       3, 0},
    [ELEMENT_WEDGE6] = {WEDGE_NODES, shape_wedge, triangle_rule_2, triangle_rule_2, 2, 2},
    [ELEMENT_HEX8] = {CUBE_NODES, shape_product, .line_points = 2},
    [ELEMENT_HEX27] = {CUBE_NODES, shape_product, .line_points = 3}};

const double *shape_node(ElementKind kind, int32_t a)
{
    return ROWS[kind].node[a];
}

ShapeValues shape_at(ElementKind kind, const double *point)
{
    const ElementInfo *info = &ELEMENTS[kind];
    const ShapeRow *row = &ROWS[kind];
    ShapeValues shape = {0};
    row->values(&(Reference){info->dim, info->node_count, row->node}, point, &shape);
    return shape;
}

static Quadrature rule_of(ElementKind kind, Quadrature (*simplex)(void))
{
    const ShapeRow *row = &ROWS[kind];
    Quadrature rule = {.count = 1, .weight = {1}};
    if (simplex) rule = simplex();

    // Times Gauss's rule with n = 2 or 3 points along each further axis.
    int32_t n = row->line_points;
    double point[3] = {-sqrt(1. / 3), sqrt(1. / 3), 0}, weight[3] = {1, 1, 0};
    if (n == 3) {
        point[0] = -sqrt(0.6), point[1] = 0, point[2] = sqrt(0.6);
        weight[0] = 5. / 9, weight[1] = 8. / 9, weight[2] = 5. / 9;
    }
    for (int32_t axis = row->simplex_dim; axis < element_dim(kind); axis++) {
        int32_t count = rule.count;
        for (int32_t k = n - 1; k >= 0; k--)   // downwards: points that are there are read last
            for (int32_t q = 0; q < count; q++) {
                int32_t to = k * count + q;
                memcpy(rule.point[to], rule.point[q], sizeof(MeshPlace));
                rule.point[to][axis] = point[k];
                rule.weight[to] = rule.weight[q] * weight[k];
            }
        rule.count = n * count;
    }
    return rule;
}

Quadrature shape_quadrature(ElementKind kind)
{
    return rule_of(kind, ROWS[kind].rule);
}

Quadrature shape_mass_quadrature(ElementKind kind)
{
    return rule_of(kind, ROWS[kind].mass_rule);
}

// --- the element in its place -------------------------------------------------------------------

// j[i][k] = d x_i / d xi_k: [axes of a place][axes of the element].
static void fill_jacobian(ElementKind kind, int32_t axes, const ShapeValues *shape,
                          const MeshPlace *position, double j[DIM_MAX][DIM_MAX])
{
    int32_t dim = element_dim(kind), nodes = element_node_count(kind);
    memset(j, 0, DIM_MAX * sizeof *j);
    for (int32_t a = 0; a < nodes; a++)
        for (int32_t row = 0; row < axes; row++)
            for (int32_t column = 0; column < dim; column++)
                j[row][column] += position[a][row] * shape->slope[a][column];
}

// Cofactors c of j, so that j^-1 = c' / det j; returns det j. In space rows and columns are counted
// round, which has the signs in it.
static double find_cofactors(int32_t dim, const double j[DIM_MAX][DIM_MAX],
                             double c[DIM_MAX][DIM_MAX])
{
    double determinant = 0;
    for (int32_t row = 0; row < dim; row++)
        for (int32_t k = 0; k < dim; k++) {
            int32_t r1 = (row + 1) % dim, r2 = (row + 2) % dim, k1 = (k + 1) % dim,
                    k2 = (k + 2) % dim;
            if (dim == 1)
                c[row][k] = 1;
            else if (dim == 2)
                c[row][k] = row == k ? j[r1][k1] : -j[r1][k1];
            else
                c[row][k] = j[r1][k1] * j[r2][k2] - j[r1][k2] * j[r2][k1];
        }
    for (int32_t k = 0; k < dim; k++) determinant += j[0][k] * c[0][k];
    return determinant;
}

double shape_jacobian(ElementKind kind, const ShapeValues *shape, const MeshPlace *position)
{
    double j[DIM_MAX][DIM_MAX], cofactor[DIM_MAX][DIM_MAX];
    int32_t dim = element_dim(kind);
    fill_jacobian(kind, dim, shape, position, j);
    return find_cofactors(dim, (const double(*)[DIM_MAX])j, cofactor);
}

double shape_gradients(ElementKind kind, const ShapeValues *shape, const MeshPlace *position,
                       MeshPlace *gradient)
{
    double j[DIM_MAX][DIM_MAX], cofactor[DIM_MAX][DIM_MAX];
    int32_t dim = element_dim(kind), nodes = element_node_count(kind);
    fill_jacobian(kind, dim, shape, position, j);
    double determinant = find_cofactors(dim, (const double(*)[DIM_MAX])j, cofactor);
    for (int32_t a = 0; a < nodes; a++)
        for (int32_t d = 0; d < dim; d++) {
            double sum = 0;
            for (int32_t k = 0; k < dim; k++) sum += cofactor[d][k] * shape->slope[a][k];
            gradient[a][d] = sum / determinant;
        }
    return determinant;
}

// As the functions reproduce reference coordinates, d xi/d x is the sum of the nodes' reference
// coordinates times their functions' gradients.
bool shape_locate(ElementKind kind, const MeshPlace *position, const double *place, MeshPlace at)
{
    enum { STEPS = 20 };
    static const double LEFT = 1e-10;   // of the step that is the last: the next is rounding
    int32_t dim = element_dim(kind), count = element_node_count(kind);
    double sense = 0;   // of the nodes' order, as seen where it begins
    memset(at, 0, sizeof(MeshPlace));
    for (int32_t a = 0; a < count; a++)
        for (int32_t d = 0; d < dim; d++) at[d] += shape_node(kind, a)[d] / count;
    for (int32_t step = 0; step < STEPS; step++) {
        MeshPlace gradient[ELEMENT_NODES_MAX], away = {0};
        ShapeValues shape = shape_at(kind, at);
        double moved = 0, determinant = shape_gradients(kind, &shape, position, gradient);
        if (step == 0) sense = determinant;
        if (!(determinant * sense > 0)) return false;
        for (int32_t d = 0; d < dim; d++) {
            away[d] = place[d];
            for (int32_t a = 0; a < count; a++) away[d] -= shape.value[a] * position[a][d];
        }
        for (int32_t a = 0; a < count; a++) {
            double along = 0;
            for (int32_t d = 0; d < dim; d++) along += gradient[a][d] * away[d];
            for (int32_t d = 0; d < dim; d++) at[d] += shape_node(kind, a)[d] * along;
            moved = fmax(moved, fabs(along));
        }
        if (moved < LEFT) return true;
    }
    return false;
}

// The last column of cofactors of a Jacobian whose last column is the normal.
void shape_normal(ElementKind kind, const ShapeValues *shape, const MeshPlace *position,
                  MeshPlace normal)
{
    double j[DIM_MAX][DIM_MAX], cofactor[DIM_MAX][DIM_MAX];
    int32_t axes = element_dim(kind) + 1;
    fill_jacobian(kind, axes, shape, position, j);
    find_cofactors(axes, (const double(*)[DIM_MAX])j, cofactor);
    for (int32_t d = 0; d < axes; d++) normal[d] = cofactor[d][axes - 1];
}
