// SPDX-License-Identifier: GPL-2.0-or-later
// LAPACK and BLAS behind algebra/dense against linear algebra written out by hand, over random
// matrices; only the lower triangle may be looked at.
#include "algebra/dense.h"

#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

#include <dirent.h>
#include <dlfcn.h>
#include <time.h>

enum { SIZE_MAX_TRIED = 24 };

// L L' with a random lower triangle that is far from singular.
static void random_positive(Random *random, int32_t n, double *lower, double *a)
{
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < n; i++)
            lower[j * n + i] =
                i < j ? 0
                      : (i == j ? random_between(random, 1, 2) : random_between(random, -0.5, 0.5));
    for (int32_t j = 0; j < n; j++) {
        for (int32_t i = 0; i < n; i++) {
            a[j * n + i] = 0;
            for (int32_t k = 0; k < n; k++) a[j * n + i] += lower[k * n + i] * lower[k * n + j];
        }
    }
}

static void spoil_upper(double *a, int32_t n)
{
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < j; i++) a[j * n + i] = NAN;
}

TEST(test_cholesky_and_triangles)
{
    dense_use_one_thread();
    Random random = {.state = 1};
    for (int32_t n = 0; n <= SIZE_MAX_TRIED; n++) {
        double lower[SIZE_MAX_TRIED * SIZE_MAX_TRIED], a[SIZE_MAX_TRIED * SIZE_MAX_TRIED];
        double square[SIZE_MAX_TRIED * SIZE_MAX_TRIED], x[SIZE_MAX_TRIED], y[SIZE_MAX_TRIED];
        random_positive(&random, n, lower, a);
        for (int32_t k = 0; k < n; k++) x[k] = random_between(&random, -1, 1);
        double wanted[SIZE_MAX_TRIED];
        hand_apply(a, n, n, x, wanted);
        spoil_upper(a, n);
        dense_symmetric_apply(a, n, x, y);
        assert_all_near("A x", y, wanted, n, 1e-14);

        double through[SIZE_MAX_TRIED];   // L (L' x) is A x
        memcpy(through, x, sizeof through);
        dense_lower_apply_transposed(lower, n, through);
        dense_lower_apply(lower, n, through);
        assert_all_near("L L' x", through, wanted, n, 1e-13);
        dense_lower_square(lower, n, square);
        hand_apply(square, n, n, x, y);
        assert_all_near("square", y, wanted, n, 1e-13);
        dense_transpose(dense_view(lower, n, n), square, n);   // A - L L' is 0
        double left[SIZE_MAX_TRIED * SIZE_MAX_TRIED];
        memcpy(left, a, sizeof left);
        dense_subtract_square(dense_view(square, n, n), left);
        for (int32_t k = 0; k < n * n; k++) assert_near("A - L L'", left[k], 0, 1e-13);
        spoil_upper(lower, n);

        double both[2 * SIZE_MAX_TRIED], back[2 * SIZE_MAX_TRIED];   // L'^-1 (L^-1 (A x)) is x
        for (int32_t k = 0; k < 2 * n; k++) both[k] = (1 + k / n) * wanted[k % n];
        dense_lower_divide(lower, n, 2, both);
        memcpy(back, both, sizeof back);
        dense_lower_divide_transposed(lower, n, 2, back);
        for (int32_t k = 0; k < 2 * n; k++) assert_near("x", back[k], (1 + k / n) * x[k % n], 1e-9);
        dense_lower_multiply(lower, n, 2, both);   // L (L^-1 (A x)) is A x
        for (int32_t k = 0; k < 2 * n; k++)
            assert_near("A x", both[k], (1 + k / n) * wanted[k % n], 1e-12);

        assert_true(dense_cholesky(a, n));
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = j; i < n; i++) assert_near("L", a[j * n + i], lower[j * n + i], 1e-12);
    }
}

// A matrix with one eigenvalue below zero is told from one with all above, however close.
// A chain of springs between walls, 2 on the diagonal and -1 beside it, has the eigenvalues
// 2 - 2 cos(k pi/(n + 1)); what is taken off its diagonal makes the least of them `least` parts of
// what is left there. Units of the unknowns range over sixty decades.
TEST(test_definite_in_single_precision)
{
    enum { CHAIN = 300 };
    static double a[CHAIN * CHAIN];
    static float work[CHAIN * (CHAIN + 2)];
    static const struct {
        double least;
        DenseAnswer less, more;   // with 1e-4 of the diagonal less, and more
    } cases[] = {{1e-2, DENSE_YES, DENSE_UNSURE},       {1.2e-4, DENSE_YES, DENSE_UNSURE},
                 {0.8e-4, DENSE_UNSURE, DENSE_UNSURE},  {1e-6, DENSE_UNSURE, DENSE_UNSURE},
                 {-0.8e-4, DENSE_UNSURE, DENSE_UNSURE}, {-1e-3, DENSE_UNSURE, DENSE_NO},
                 {-0.1, DENSE_UNSURE, DENSE_NO}};
    for (int k = 0; k < 7; k++) {
        double first = 2 - 2 * cos(M_PI / (CHAIN + 1)), least = cases[k].least;
        double off = (first - 2 * least) / (1 - least);
        for (int32_t j = 0; j < CHAIN; j++)
            for (int32_t i = 0; i < CHAIN; i++) {
                double unit = pow(10, 0.1 * (i + j) - 30);
                a[j * CHAIN + i] = i < j ? NAN : unit * (i == j ? 2 - off : i == j + 1 ? -1 : 0);
            }
        DenseAnswer less = dense_definite_single(a, CHAIN, -1e-4, work);
        assert_true(less == cases[k].less || (least < 0 && less == DENSE_NO));
        assert_int_equal(dense_definite_single(a, CHAIN, 1e-4, work), cases[k].more);
    }
    a[0] = NAN;
    assert_int_equal(dense_definite_single(a, CHAIN, -1e-4, work), DENSE_NO);
    a[0] = -1;
    assert_int_equal(dense_definite_single(a, CHAIN, 1e-4, work), DENSE_NO);
    assert_int_equal(dense_definite_single(a, 0, -1e-4, work), DENSE_YES);
}

// The unit matrix but for one direction, in which all unknowns have a part: a factor breaks down in
// one of its last columns.
TEST(test_definite_in_single_precision_when_all_is_joined)
{
    enum { SIZE = 260 };
    static double a[SIZE * SIZE];
    static float work[SIZE * (SIZE + 2)];
    double direction[SIZE], square = 0;
    Random random = {.state = 77};
    for (int32_t k = 0; k < SIZE; k++) {
        direction[k] = random_between(&random, 0.5, 1) * (k % 2 ? 1 : -1);
        square += direction[k] * direction[k];
    }
    static const double least[] = {1e-2, -1e-2, -0.5};
    for (int32_t k = 0; k < 3; k++) {
        for (int32_t j = 0; j < SIZE; j++)
            for (int32_t i = 0; i < SIZE; i++) {
                double unit = pow(10, 0.1 * (i + j) - 26);
                double entry = (i == j) - (1 - least[k]) * direction[i] * direction[j] / square;
                a[j * SIZE + i] = i < j ? NAN : unit * entry;
            }
        assert_int_equal(dense_definite_single(a, SIZE, k == 0 ? -1e-4 : 1e-4, work),
                         k == 0 ? DENSE_YES : DENSE_NO);
    }
    a[SIZE - 1] = NAN;
    assert_true(dense_definite_single(a, SIZE, -1e-4, work) != DENSE_YES);
    a[SIZE - 1] = INFINITY;
    assert_true(dense_definite_single(a, SIZE, -1e-4, work) != DENSE_YES);
}

TEST(test_not_definite)
{
    for (double least = 1e-9; least > -2e-9; least -= 2e-9) {
        double a[] = {1 + least, 1, 1, 1 + least};   // eigenvalues least and 2 + least
        assert_int_equal(dense_cholesky(a, 2), least > 0);
    }
    double zero[] = {0}, negative[] = {-1}, none[] = {NAN};
    assert_false(dense_cholesky(zero, 1));
    assert_false(dense_cholesky(negative, 1));
    assert_false(dense_cholesky(none, 1));
}

TEST(test_lu)
{
    Random random = {.state = 2};
    for (int32_t n = 0; n <= SIZE_MAX_TRIED; n++) {
        double a[SIZE_MAX_TRIED * SIZE_MAX_TRIED], copy[SIZE_MAX_TRIED * SIZE_MAX_TRIED];
        double b[SIZE_MAX_TRIED], wanted[SIZE_MAX_TRIED];
        int32_t pivots[SIZE_MAX_TRIED];
        for (int32_t k = 0; k < n * n; k++) a[k] = random_between(&random, -1, 1);
        if (n > 1) a[0] = 0;   // not solvable without exchanging rows
        for (int32_t k = 0; k < n; k++) b[k] = wanted[k] = random_between(&random, -1, 1);
        memcpy(copy, a, sizeof copy);
        assert_true(hand_solve(copy, n, wanted, 1));
        assert_true(dense_lu(a, n, pivots));
        dense_lu_solve(a, n, pivots, b);
        assert_all_near("x", b, wanted, n, 1e-9);
    }
    double singular[] = {1, 2, 2, 4};
    int32_t pivots[2];
    assert_false(dense_lu(singular, 2, pivots));
}

// By panels and pieces, the last of which are narrower: rows are swapped, and L U solves the system
// to single precision. A matrix with a column of zeros in its last panel is singular.
TEST(test_lu_by_columns_side_by_side)
{
    enum { ROWS = 1100 };
    int64_t size = (int64_t)ROWS * ROWS;
    double *a = malloc((size_t)size * sizeof *a);
    float *lu = malloc((size_t)size * sizeof *lu), work[ROWS];
    double x[ROWS], b[ROWS];
    int32_t pivots[ROWS];
    Random random = {.state = 5};
    for (int64_t k = 0; k < size; k++) a[k] = random_between(&random, -1, 1);
    for (int32_t k = 0; k < ROWS; k++) x[k] = random_between(&random, 1, 2);
    dense_apply(dense_view(a, ROWS, ROWS), x, 1, 0, b);
    for (int64_t k = 0; k < size; k++) lu[k] = (float)a[k];
    assert_true(dense_lu_single(lu, ROWS, pivots));
    dense_lu_single_solve(lu, ROWS, pivots, b, work);
    assert_all_near("x", b, x, ROWS, 5e-2);   // a condition of some 1e4 times 6e-8, and a margin
    for (int64_t k = 0; k < size; k++) lu[k] = k / ROWS == ROWS - 3 ? 0 : (float)a[k];
    assert_false(dense_lu_single(lu, ROWS, pivots));
    free(a);
    free(lu);
}

TEST(test_vectors)
{
    const double x[] = {1, -5, 2}, y[] = {3, 1, -1};
    assert_near("dot", dense_dot(x, y, 3), -4, 0);
    assert_near("dot of nothing", dense_dot(x, y, 0), 0, 0);
    assert_near("largest", dense_max_abs(x, 3), 5, 0);
    assert_near("largest of nothing", dense_max_abs(x, 0), 0, 0);
}

static int32_t thread_count(void)
{
    int32_t count = 0;
    DIR *tasks = opendir("/proc/self/task");
    assert_non_null(tasks);
    for (struct dirent *entry; (entry = readdir(tasks));) count += entry->d_name[0] != '.';
    closedir(tasks);
#ifdef __SANITIZE_THREAD__
    count--;   // its own
#endif
    return count;
}

// The kernel still lists a thread for a moment after it was joined.
static void assert_alone(void)
{
    struct timespec moment = {.tv_nsec = 1000000};
    for (int32_t look = 0; look < 1000 && thread_count() > 1; look++) nanosleep(&moment, NULL);
    assert_int_equal(thread_count(), 1);
}

// OpenBLAS's own threads go, once and for all; a second call does not bring them back.
TEST(test_one_thread)
{
    void *symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
    void (*set_threads)(int) = NULL;
    assert_non_null(symbol);
    memcpy(&set_threads, &symbol, sizeof set_threads);
    set_threads(3);
    if (thread_count() == 1) skip();   // an OpenBLAS built without threads
    for (int32_t call = 0; call < 2; call++) {
        dense_use_one_thread();
        assert_alone();
    }
    double lower[4] = {2, 1, 0, 1}, square[4];
    dense_lower_square(lower, 2, square);
    assert_near("still computes", square[3], 2, 1e-15);
    assert_alone();
}

// Long enough for several blocks of rows and a rest.
TEST(test_two_vectors_at_once)
{
    enum { ROWS = 5003, COLUMNS = 37 };
    static double a[ROWS * COLUMNS], x[2][COLUMNS], one[ROWS], y[2][ROWS];
    dense_use_one_thread();   // as all of the program: two would share the rows otherwise
    Random random = {.state = 8};
    for (int32_t k = 0; k < ROWS * COLUMNS; k++) a[k] = random_between(&random, -1, 1);
    for (int32_t k = 0; k < 2 * COLUMNS; k++)
        x[k / COLUMNS][k % COLUMNS] = random_between(&random, -1, 1);
    DenseView view = {a, ROWS, COLUMNS};
    dense_apply_each(view, 2, (const double *[]){x[0], x[1]}, (double *[]){y[0], y[1]});
    for (int k = 0; k < 2; k++) {
        dense_apply(view, x[k], 1, 0, one);
        assert_memory_equal(y[k], one, sizeof one);
        for (int32_t i = 0; i < ROWS; i += 101) {
            double sum = 0;
            for (int32_t j = 0; j < COLUMNS; j++) sum += a[j * ROWS + i] * x[k][j];
            assert_near("a x", one[i], sum, 1e-13);
        }
    }
}

// Every pattern of zeros in up to seven entries; what meets a 0 would spoil the sum.
TEST(test_add_nonzero)
{
    enum { ROWS = 5, COLUMNS = 7 };
    Random random = {.state = 21};
    for (int32_t columns = 0; columns <= COLUMNS; columns++) {
        for (uint32_t pattern = 0; pattern < 1U << columns; pattern++) {
            double a[ROWS * COLUMNS], x[COLUMNS], y[ROWS], wanted[ROWS];
            for (int32_t i = 0; i < ROWS; i++) wanted[i] = y[i] = random_between(&random, -1, 1);
            for (int32_t j = 0; j < columns; j++) {
                bool is_zero = (pattern >> j & 1) == 0;
                x[j] = is_zero ? 0 : random_between(&random, 1, 2);
                for (int32_t i = 0; i < ROWS; i++) {
                    double entry = random_between(&random, -1, 1);
                    a[j * ROWS + i] = is_zero ? NAN : entry;
                    if (!is_zero) wanted[i] -= 0.5 * entry * x[j];
                }
            }
            dense_add_nonzero((DenseView){a, ROWS, columns}, x, -0.5, y);
            assert_all_near("y - a x/2", y, wanted, ROWS, 1e-15);
        }
    }
    dense_add_nonzero((DenseView){NULL, 0, COLUMNS}, (double[COLUMNS]){1}, 1, NULL);
}

// Little and most of x is 0: columns that meet a 0, or the upper triangle, are not read.
TEST(test_add_symmetric)
{
    enum { ROWS = 2001 };
    Random random = {.state = 33};
    double *a = hand_matrix(ROWS, ROWS), x[ROWS], y[ROWS], wanted[ROWS];
    const int32_t nonzero[] = {0, 1, ROWS / 2, ROWS / 2 + 1, ROWS};
    for (int32_t k = 0; k < 5; k++) {
        bool many = 2 * nonzero[k] > ROWS;
        for (int64_t j = 0; j < ROWS; j++)
            for (int64_t i = 0; i <= j; i++)
                a[j * ROWS + i] = a[i * ROWS + j] = random_between(&random, -1, 1);
        for (int32_t j = 0; j < ROWS; j++)
            x[j] = j * 2 % ROWS < nonzero[k] ? random_between(&random, 1, 2) : 0;
        for (int32_t i = 0; i < ROWS; i++) {
            y[i] = wanted[i] = i;
            for (int64_t j = 0; j < ROWS; j++) wanted[i] -= 0.5 * a[j * ROWS + i] * x[j];
        }
        for (int64_t j = 0; j < ROWS; j++)
            for (int64_t i = 0; i < ROWS; i++)
                if (many ? i < j : x[j] == 0) a[j * ROWS + i] = NAN;
        dense_add_symmetric(a, ROWS, x, -0.5, y);
        assert_all_near("y - A x/2", y, wanted, ROWS, 1e-11);
    }
    free(a);
}

// A matrix that is large enough for its rows to be shared among threads.
TEST(test_add_nonzero_of_many)
{
    enum { ROWS = 2501, COLUMNS = 2000 };
    Random random = {.state = 9};
    double *a = malloc(sizeof *a * ROWS * COLUMNS), x[COLUMNS], y[ROWS], wanted[ROWS];
    for (int64_t k = 0; k < (int64_t)ROWS * COLUMNS; k++) a[k] = random_between(&random, -1, 1);
    for (int32_t j = 0; j < COLUMNS; j++) x[j] = j % 7 == 3 ? 0 : random_between(&random, -1, 1);
    for (int32_t i = 0; i < ROWS; i++) {
        y[i] = wanted[i] = i;
        for (int64_t j = 0; j < COLUMNS; j++) wanted[i] += 2 * a[j * ROWS + i] * x[j];
    }
    dense_add_nonzero(dense_view(a, ROWS, COLUMNS), x, 2, y);
    assert_all_near("y + 2 A x", y, wanted, ROWS, 1e-12);
    free(a);
}

// Sizes of 0 are answered as sums over nothing are, and nothing is touched: BLAS refuses them, with
// a sentence on standard error.
TEST(test_nothing)
{
    double a[4] = {3, 5, 7, 9}, c[4] = {1, 2, 3, 4}, x[2] = {1, 1};
    const double kept[4] = {1, 2, 3, 4};
    const DenseView none = {a, 0, 2}, thin = {a, 2, 0}, full = {a, 2, 2};
    int32_t pivots[1];
    assert_true(dense_cholesky(c, 0) && dense_lu(c, 0, pivots) && dense_invert_factored(c, 0));
    assert_true(dense_eigen_above(c, 0, 1, x, x));
    assert_true(dense_eigen(c, 0, x, x) && dense_eigen_general(c, 0, x, x, x, x));
    dense_lower_apply(a, 0, c);
    dense_lower_apply_transposed(a, 0, c);
    dense_lower_solve_transposed(a, 0, c);
    dense_lower_square(a, 0, c);
    dense_add_scaled(2, a, 0, c);
    dense_lower_divide(a, 0, 2, c);
    dense_lower_divide(a, 2, 0, c);
    dense_divide_both_sides(a, 0, c);
    dense_multiply_transposed(thin, full, 1, 0, c);
    dense_multiply_transposed(full, thin, 1, 0, c);
    dense_multiply(none, full, 1, 0, c);
    dense_multiply(thin, none, 1, 0, c);
    dense_multiply(full, thin, 1, 0, c);
    dense_multiply_by_transposed(thin, thin, c);
    dense_multiply_by_transposed(none, full, c);
    dense_multiply_transposed_rows(thin, full, 1, 0, c, 2);
    dense_multiply_transposed_rows(full, thin, 1, 0, c, 2);
    dense_multiply_transposed_rows(none, none, 1, 0, c, 2);
    dense_multiply_rows(thin, a, 2, 2, 1, c);
    dense_multiply_rows(full, a, 2, 0, 1, c);
    dense_multiply_rows(none, a, 2, 2, 1, c);
    assert_true(dense_eigen_pair(c, c, 0, x, x));
    dense_apply(none, x, 1, 0, c);
    dense_apply(thin, x, 1, 0, c);
    dense_apply_transposed(thin, x, 1, 0, c);
    assert_memory_equal(c, kept, sizeof kept);
    dense_multiply_transposed(none, none, 1, 0.5, c);   // no rows: what was there alone
    for (int k = 0; k < 4; k++) assert_true(c[k] == 0.5 * kept[k]);
    dense_multiply_transposed(none, none, 1, 0, c);
    for (int k = 0; k < 4; k++) assert_true(c[k] == 0);
}
