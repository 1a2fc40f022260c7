// SPDX-License-Identifier: GPL-2.0-or-later
// Shape functions against what defines them: 1 at their node, 0 at the others, sum 1, slopes by
// finite differences, polynomials reproduced; quadrature against exact integrals.
#include "io/mesh/shape_functions.h"

#include "cases.h"
#include "plane.h"

#include <math.h>
#include <stdint.h>

// cmocka 1.1.5 compares floats only, in single precision.
static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, wanted, tolerance);
}

static const double PROBES[][2] = {{0.2, 0.3}, {0.05, 0.9}, {-0.7, 0.4}, {0.6, -0.9}};
enum { PROBE_COUNT = sizeof PROBES / sizeof *PROBES };

TEST(test_nodes)
{
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++)
        for (int32_t b = 0; b < element_node_count((ElementKind)kind); b++) {
            const double *at = shape_node((ElementKind)kind, b);
            double xi = at[0], eta = at[1];
            ShapeValues shape = shape_at((ElementKind)kind, (double[]){xi, eta});
            for (int32_t a = 0; a < ELEMENT_NODES_MAX; a++)
                assert_near(shape.value[a], a == b ? 1 : 0, 1e-15);
        }
}

TEST(test_sum_and_slopes)
{
    const double h = 1e-5;
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++)
        for (int32_t p = 0; p < PROBE_COUNT; p++) {
            double xi = PROBES[p][0], eta = PROBES[p][1], sum = 0, slopes[2] = {0};
            ShapeValues here = shape_at((ElementKind)kind, (double[]){xi, eta});
            ShapeValues right = shape_at((ElementKind)kind, (double[]){xi + h, eta});
            ShapeValues left = shape_at((ElementKind)kind, (double[]){xi - h, eta});
            ShapeValues above = shape_at((ElementKind)kind, (double[]){xi, eta + h});
            ShapeValues below = shape_at((ElementKind)kind, (double[]){xi, eta - h});
            for (int32_t a = 0; a < ELEMENT_NODES_MAX; a++) {
                sum += here.value[a];
                slopes[0] += here.slope[a][0];
                slopes[1] += here.slope[a][1];
                assert_near(here.slope[a][0], (right.value[a] - left.value[a]) / (2 * h), 1e-9);
                assert_near(here.slope[a][1], (above.value[a] - below.value[a]) / (2 * h), 1e-9);
            }
            assert_near(sum, 1, 1e-14);
            assert_near(slopes[0], 0, 1e-14);
            assert_near(slopes[1], 0, 1e-14);
        }
}

// Each element interpolates its polynomials exactly: all of degree 1 or 2, and its extra terms.
static double monomial(int32_t m, double xi, double eta)
{
    const double values[] = {xi,        eta,           xi * eta,       xi * xi,
                             eta * eta, xi * xi * eta, xi * eta * eta, xi * xi * eta * eta};
    return values[m];
}

TEST(test_polynomials)
{
    // xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2, xi^2 eta^2
    static const bool holds[PLANE_KINDS][8] = {[ELEMENT_T3] = {1, 1},
                                               [ELEMENT_T6] = {1, 1, 1, 1, 1},
                                               [ELEMENT_Q4] = {1, 1, 1},
                                               [ELEMENT_Q8] = {1, 1, 1, 1, 1, 1, 1},
                                               [ELEMENT_Q9] = {1, 1, 1, 1, 1, 1, 1, 1}};
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++)
        for (int32_t m = 0; m < 8; m++) {
            double error = 0;
            for (int32_t p = 0; p < PROBE_COUNT; p++) {
                ShapeValues shape = shape_at((ElementKind)kind, PROBES[p]);
                double value = 0;
                for (int32_t a = 0; a < element_node_count((ElementKind)kind); a++) {
                    const double *at = shape_node((ElementKind)kind, a);
                    double xi = at[0], eta = at[1];
                    value += shape.value[a] * monomial(m, xi, eta);
                }
                error = fmax(error, fabs(value - monomial(m, PROBES[p][0], PROBES[p][1])));
            }
            if (holds[kind][m])
                assert_true(error < 1e-14);
            else
                assert_true(error > 1e-3);
        }
}

static double factorial(int32_t n)
{
    return n < 2 ? 1 : n * factorial(n - 1);
}

// Integral of xi^i eta^j: i! j! / (i + j + 2)! on the triangle; product of 2/(i + 1) on the square.
static double exact_integral(bool triangle, int32_t i, int32_t j)
{
    if (triangle) return factorial(i) * factorial(j) / factorial(i + j + 2);
    return i % 2 || j % 2 ? 0 : 4. / (i + 1) / (j + 1);
}

TEST(test_quadrature)
{
    // Degree in total for triangles, in each direction for squares; one more must fail.
    static const int32_t degree[] = {
        [ELEMENT_T3] = 1, [ELEMENT_T6] = 2, [ELEMENT_Q4] = 3, [ELEMENT_Q8] = 5, [ELEMENT_Q9] = 5};
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        bool triangle = kind == ELEMENT_T3 || kind == ELEMENT_T6;
        Quadrature rule = shape_quadrature((ElementKind)kind);
        for (int32_t i = 0; i <= degree[kind] + 1; i++)
            for (int32_t j = 0; j <= degree[kind] + 1; j++) {
                double sum = 0;
                for (int32_t q = 0; q < rule.count; q++)
                    sum += rule.weight[q] * pow(rule.point[q][0], i) * pow(rule.point[q][1], j);
                double error = fabs(sum - exact_integral(triangle, i, j));
                bool within = triangle ? i + j <= degree[kind]
                                       : i <= degree[kind] && j <= degree[kind];
                if (within) assert_true(error < 1e-14);
                if (i == degree[kind] + 1 && j == 0) assert_true(error > 5e-4);   // one degree more
            }
    }
}

// x = 1 + 2 xi + 3 eta, z = -1 + eta has J = [2 3; 0 1] everywhere, whatever the element, and
// xi = (x - 1 - 3 (z + 1)) / 2, eta = z + 1.
TEST(test_jacobian)
{
    for (int32_t kind = 0; kind < PLANE_KINDS; kind++) {
        MeshPlace position[ELEMENT_NODES_MAX], gradient[ELEMENT_NODES_MAX];
        for (int32_t a = 0; a < element_node_count((ElementKind)kind); a++) {
            const double *at = shape_node((ElementKind)kind, a);
            double xi = at[0], eta = at[1];
            position[a][0] = 1 + 2 * xi + 3 * eta;
            position[a][1] = -1 + eta;
        }
        ShapeValues shape = shape_at((ElementKind)kind, (double[]){0.3, 0.1});
        const MeshPlace *places = (const MeshPlace *)position;
        assert_near(shape_jacobian((ElementKind)kind, &shape, places), 2, 1e-14);
        assert_near(shape_gradients((ElementKind)kind, &shape, places, gradient), 2, 1e-14);
        for (int32_t a = 0; a < element_node_count((ElementKind)kind); a++) {
            const double *slope = shape.slope[a];
            assert_near(gradient[a][0], slope[0] / 2, 1e-14);
            assert_near(gradient[a][1], slope[1] - 1.5 * slope[0], 1e-14);
        }
    }
}
