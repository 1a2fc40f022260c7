// SPDX-License-Identifier: GPL-2.0-or-later
// A rod on a spring: what its condensed form gives is the solution of all equations at once, rod
// and spring among them, written out.
#include "reduction/machine.h"

#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

#include <string.h>

enum { COUNT = 7, FIRST = 4, RODS = COUNT - FIRST, ALL = COUNT + 1 };

// S of the test: random, symmetric, positive definite.
static void fill_schur(Random *random, double *schur)
{
    double half[COUNT * COUNT];
    for (int32_t k = 0; k < COUNT * COUNT; k++) half[k] = random_between(random, -1, 1);
    for (int32_t a = 0; a < COUNT; a++)
        for (int32_t b = 0; b < COUNT; b++) {
            schur[b * COUNT + a] = a == b;
            for (int32_t k = 0; k < COUNT; k++)
                schur[b * COUNT + a] += half[k * COUNT + a] * half[k * COUNT + b];
        }
}

// Unknowns: v [COUNT] with the reactions of rod nodes that touch in their place, and v_R. Nodes
// that touch have v = bound + v_R, all others no reaction; sum r + kappa v_R = force.
static void solve_all(const double *schur, const double *g, const double *bound, double kappa,
                      double force, double *v)
{
    double matrix[ALL * ALL] = {0}, right[ALL] = {0};
    for (int32_t row = 0; row < COUNT; row++) {
        right[row] = g[row];
        for (int32_t b = 0; b < COUNT; b++) {
            double s = schur[b * COUNT + row];
            bool touches = b >= FIRST && b != FIRST + 1;
            matrix[b * ALL + row] = touches ? -(row == b) : s;
            if (touches) right[row] -= s * bound[b];
            if (touches) matrix[COUNT * ALL + row] += s;
        }
    }
    for (int32_t b = FIRST; b < COUNT; b++) matrix[b * ALL + COUNT] = b != FIRST + 1;
    matrix[COUNT * ALL + COUNT] = kappa;
    right[COUNT] = force;
    assert_true(hand_solve(matrix, ALL, right, 1));
    memcpy(v, right, sizeof right);
    for (int32_t b = FIRST; b < COUNT; b++)
        if (b != FIRST + 1) v[b] = bound[b] + v[COUNT];
}

TEST(test_at_once)
{
    Error err = {0};
    Random random = {.state = 5};
    for (double stiffness = 1e-3; stiffness < 1e7; stiffness *= 30) {
        double schur[COUNT * COUNT], soft[COUNT * COUNT], g[COUNT], bound[COUNT], wanted[ALL];
        double force = random_between(&random, -2, 2), reach = 0.3;
        MachineColumn column = {0};
        Machine machine = {.stiffness = stiffness, .first = FIRST};
        fill_schur(&random, schur);
        for (int32_t k = 0; k < COUNT; k++) {
            g[k] = random_between(&random, -1, 1);
            bound[k] = random_between(&random, -1, 1);
        }
        solve_all(schur, g, bound, reach * stiffness, force, wanted);
        memcpy(soft, schur, sizeof soft);
        assert_true(machine_soften(&machine, reach, COUNT, soft, &column, &err));
        column.force = force;
        machine_refer(&column, g);
        // S' y = g' on what is free, y = bound on what touches.
        double matrix[(FIRST + 1) * (FIRST + 1)], y[COUNT], right[FIRST + 1];
        for (int32_t a = 0; a <= FIRST; a++) {
            int32_t row = a < FIRST ? a : FIRST + 1;
            right[a] = g[row];
            for (int32_t b = 0; b <= FIRST; b++)
                matrix[b * (FIRST + 1) + a] = soft[(b < FIRST ? b : FIRST + 1) * COUNT + row];
            right[a] -= soft[FIRST * COUNT + row] * bound[FIRST] +
                        soft[(FIRST + 2) * COUNT + row] * bound[FIRST + 2];
        }
        assert_true(hand_solve(matrix, FIRST + 1, right, 1));
        memcpy(y, right, FIRST * sizeof *y);
        y[FIRST] = bound[FIRST];
        y[FIRST + 1] = right[FIRST];
        y[FIRST + 2] = bound[FIRST + 2];
        double own = machine_release(&column, y);
        assert_near("v_R", own, wanted[COUNT], 1e-10 * (1 + fabs(wanted[COUNT])));
        assert_all_near("v", y, wanted, COUNT, 1e-10);
        for (int32_t a = 0; a < COUNT; a++)
            for (int32_t b = 0; b < a; b++) assert_true(soft[b * COUNT + a] == soft[a * COUNT + b]);
        machine_column_destroy(&column);
    }
}

// Damping alone, or a step so short that the spring is rounding beside the block: a rod that
// nothing touches leaves S' regular, and hardly more than nothing against its own motion.
TEST(test_loose)
{
    Error err = {0};
    Random random = {.state = 8};
    const double reaches[] = {0, 1e-30, 1e-13};
    for (int32_t k = 0; k < 3; k++) {
        double schur[COUNT * COUNT], along = 0, resists = 0;
        MachineColumn column = {0};
        Machine machine = {.stiffness = 1, .first = FIRST};
        fill_schur(&random, schur);
        for (int32_t a = FIRST; a < COUNT; a++)
            for (int32_t b = FIRST; b < COUNT; b++) resists += schur[b * COUNT + a];
        assert_true(machine_soften(&machine, reaches[k], COUNT, schur, &column, &err));
        for (int32_t a = FIRST; a < COUNT; a++)
            for (int32_t b = FIRST; b < COUNT; b++) along += schur[b * COUNT + a];
        double part = reaches[k] > 0 ? 1e-10 : 1e-6;
        assert_true(along > 0.1 * part * resists && along < 10 * part * resists);
        machine_column_destroy(&column);
    }
}
