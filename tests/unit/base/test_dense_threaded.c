// SPDX-License-Identifier: GPL-2.0-or-later
// Products in two halves against the whole ones, small and large, of even and odd columns.
#include "base/dense_threaded.h"

#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

static double *random_matrix(Random *random, int32_t rows, int32_t columns)
{
    double *made = hand_matrix(rows, columns);
    for (int32_t k = 0; k < rows * columns; k++) made[k] = random_between(random, -1, 1);
    return made;
}

// c [m * n], summed over k.
static void check(int32_t m, int32_t n, int32_t k)
{
    Random random = {.state = 7};
    double *a = random_matrix(&random, m, k), *b = random_matrix(&random, k, n);
    double *turned = hand_matrix(k, m);
    double *c = random_matrix(&random, m, n), *wanted = hand_matrix(m, n),
           *also = hand_matrix(m, n);
    memcpy(wanted, c, (size_t)(m * n) * sizeof *c);
    memcpy(also, c, (size_t)(m * n) * sizeof *c);
    for (int32_t j = 0; j < k; j++)
        for (int32_t i = 0; i < m; i++) turned[i * k + j] = a[j * m + i];
    dense_multiply(dense_view(a, m, k), dense_view(b, k, n), 0.5, -2, wanted);
    dense_multiply_threaded(dense_view(a, m, k), dense_view(b, k, n), 0.5, -2, c);
    assert_all_near("a b", c, wanted, m * n, 1e-12);
    dense_multiply_transposed_threaded(dense_view(turned, k, m), dense_view(b, k, n), 0.5, -2,
                                       also);
    assert_all_near("a' b", also, wanted, m * n, 1e-12);
    free(a), free(b), free(turned), free(c), free(wanted), free(also);
}

static void test_halves(void **state)
{
    (void)state;
    check(3, 1, 2);
    check(20, 7, 5);
    check(300, 281, 260);
    check(290, 300, 300);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_halves)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
