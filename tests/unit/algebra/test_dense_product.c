// SPDX-License-Identifier: GPL-2.0-or-later
// Products, small ones in one piece and large ones in several, against sums written out.
#include "algebra/dense.h"

#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

static double *random_matrix(Random *random, int32_t rows, int32_t columns)
{
    double *made = hand_matrix(rows, columns);
    for (int32_t k = 0; k < rows * columns; k++) made[k] = random_between(random, -1, 1);
    return made;
}

// c [m * n], summed over k: a b, a' b, and both with rows of larger matrices, `more` rows high.
static void check(int32_t m, int32_t n, int32_t k, int32_t more)
{
    Random random = {.state = 7};
    double *a = random_matrix(&random, m, k), *b = random_matrix(&random, k, n);
    double *turned = hand_matrix(k, m), *high = hand_matrix(k + more, n);
    double *c = random_matrix(&random, m, n), *wanted = hand_matrix(m, n);
    double *also = hand_matrix(m, n), *rows = hand_matrix(m + more, n), *sum = hand_matrix(m, n);
    for (int32_t j = 0; j < n; j++) {
        memcpy(high + j * (k + more), b + j * k, (size_t)k * sizeof *b);
        for (int32_t i = 0; i < m; i++) {
            for (int32_t l = 0; l < k; l++) sum[j * m + i] += a[l * m + i] * b[j * k + l];
            also[j * m + i] = c[j * m + i];
            rows[j * (m + more) + i] = c[j * m + i];
            wanted[j * m + i] = 0.5 * sum[j * m + i] - 2 * c[j * m + i];
        }
    }
    for (int32_t j = 0; j < k; j++)
        for (int32_t i = 0; i < m; i++) turned[i * k + j] = a[j * m + i];
    DenseView left = dense_view(a, m, k), across = dense_view(turned, k, m);
    dense_multiply(left, dense_view(b, k, n), 0.5, -2, c);
    assert_all_near("a b", c, wanted, m * n, 1e-12);
    dense_multiply_transposed(across, dense_view(b, k, n), 0.5, -2, also);
    assert_all_near("a' b", also, wanted, m * n, 1e-12);
    dense_multiply_transposed_rows(across, dense_view(b, k, n), 0.5, -2, rows, m + more);
    dense_multiply_rows(left, high, k + more, n, 2, also);
    for (int32_t j = 0; j < n; j++) {
        assert_all_near("rows", rows + j * (m + more), wanted + j * m, m, 1e-12);
        for (int32_t i = 0; i < more; i++) assert_true(rows[j * (m + more) + m + i] == 0);
        for (int32_t i = 0; i < m; i++) wanted[j * m + i] += 2 * sum[j * m + i];
    }
    assert_all_near("a rows of b", also, wanted, m * n, 1e-12);
    free(a), free(b), free(turned), free(high), free(c), free(wanted), free(also), free(rows);
    free(sum);
}

TEST(test_pieces)
{
    check(3, 1, 2, 0);
    check(20, 7, 5, 3);
    check(1, 40, 1, 1);
    check(300, 281, 260, 2);   // of 35 columns and more
    check(290, 63, 700, 0);
    check(400, 70, 400, 5);
}

// c := keep c, where there is nothing to sum over; a b is left as it is.
TEST(test_nothing_to_sum)
{
    double c[] = {1, 2, 3, 4, 5, 6}, x = 0;
    dense_multiply_transposed(dense_view(&x, 0, 2), dense_view(&x, 0, 3), 1, -2, c);
    for (int32_t k = 0; k < 6; k++) assert_true(c[k] == -2 * (k + 1));
    dense_multiply(dense_view(&x, 2, 0), dense_view(&x, 0, 3), 1, 7, c);
    for (int32_t k = 0; k < 6; k++) assert_true(c[k] == -2 * (k + 1));
    c[0] = NAN;
    dense_multiply_transposed(dense_view(&x, 0, 2), dense_view(&x, 0, 3), 1, 0, c);
    for (int32_t k = 0; k < 6; k++) assert_true(c[k] == 0);
}
