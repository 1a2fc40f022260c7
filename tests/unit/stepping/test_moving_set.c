// SPDX-License-Identifier: GPL-2.0-or-later
// The largest eigenvalue of A^-1 W against the roots of its characteristic equation, and the top of
// a parabola against the parabola itself.
#include "stepping/moving_set.h"

#include "algebra/dense.h"
#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

// det(x A - W) = 0 for two unknowns: a quadratic in x.
static double largest_root(const double *a, double first, double second)
{
    double square = a[0] * a[3] - a[1] * a[2], linear = -(a[0] * second + a[3] * first);
    double root = sqrt(linear * linear - 4 * square * first * second);
    return (-linear + root) / (2 * square);
}

TEST(test_two_unknowns)
{
    Random random = {.state = 3};
    for (int32_t trial = 0; trial < 100; trial++) {
        MovingUnknown list[2] = {{.weakening = random_between(&random, 0.1, 2)},
                                 {.weakening = random_between(&random, 0, 2)}};
        MovingSet set = {.list = list, .count = 2, .weakens = true};
        if (trial % 5 == 0) list[1].weakening = 0;   // moves, but weakens nothing
        double a[4] = {2, random_between(&random, -0.9, 0), random_between(&random, -0.9, 0), 1.5};
        double largest = largest_root(a, list[0].weakening, list[1].weakening), work[2];
        int32_t pivots[2];
        assert_true(dense_lu(a, 2, pivots));
        double ratio = weakening_ratio(&set, a, pivots, 1e-12, work);
        assert_near("ratio", ratio, largest, 1e-8 * largest);
    }
    MovingSet none = {.count = 0};
    assert_true(weakening_ratio(&none, NULL, NULL, 1e-6, NULL) == 0);
}

// The eigenvalues of A^-1 W are a complex pair: no power of it grows like the one before.
TEST(test_never_settled)
{
    MovingUnknown list[2] = {{.weakening = 1}, {.weakening = 0.25}};
    MovingSet set = {.list = list, .count = 2, .weakens = true};
    double a[4] = {1, -3, 3, 0}, work[2];
    int32_t pivots[2];
    assert_true(dense_lu(a, 2, pivots));
    assert_true(isinf(weakening_ratio(&set, a, pivots, 1e-6, work)));
}

TEST(test_top)
{
    for (double top = -0.45; top < 0.5; top += 0.1) {
        double ratio[3], octaves;
        for (int32_t k = 0; k < 3; k++) ratio[k] = 0.7 - 0.2 * (k - 1 - top) * (k - 1 - top);
        assert_near("height", weakening_ratio_top(ratio, &octaves), 0.7, 1e-14);
        assert_near("place", octaves, top, 1e-13);
    }
    double octaves, rising[3] = {1, 2, 4};
    assert_true(weakening_ratio_top(rising, &octaves) == 2 && octaves == 0);
}
