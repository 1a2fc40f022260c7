// SPDX-License-Identifier: GPL-2.0-or-later
// Eigenvalues, inverses, products and the sign of a determinant behind algebra/dense, against
// matrices whose answers are known in closed form and against sums written out.
#include "algebra/dense.h"

#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

enum { SIZE_TRIED = 30 };
static const double PI = 3.14159265358979323846;

static void fill_random(Random *random, double *a, int32_t count)
{
    for (int32_t k = 0; k < count; k++) a[k] = random_between(random, -1, 1);
}

// c = a b + keep c, or a' b, by the definition.
static void hand_product(DenseView a, DenseView b, bool transposed, double factor, double keep,
                         double *c)
{
    int32_t rows = transposed ? a.columns : a.rows, inner = transposed ? a.rows : a.columns;
    for (int32_t j = 0; j < b.columns; j++) {
        for (int32_t i = 0; i < rows; i++) {
            double sum = 0;
            for (int32_t k = 0; k < inner; k++)
                sum += a.values[transposed ? i * a.rows + k : k * a.rows + i] *
                       b.values[j * b.rows + k];
            c[j * rows + i] = factor * sum + (keep == 0 ? 0 : keep * c[j * rows + i]);
        }
    }
}

// The second difference of a string held at both ends: 2 - 2 cos(k pi / (n + 1)), with sines.
TEST(test_eigen_of_a_string)
{
    dense_use_one_thread();
    for (int32_t n = 0; n <= SIZE_TRIED; n++) {
        double a[SIZE_TRIED * SIZE_TRIED + 1] = {0}, values[SIZE_TRIED + 1];
        double *work = hand_matrix((int32_t)DENSE_EIGEN_WORK(n), 1);
        for (int32_t k = 0; k < n; k++) {
            a[k * n + k] = 2;
            if (k + 1 < n) a[k * n + k + 1] = -1;   // the lower triangle is read
            if (k + 1 < n) a[(k + 1) * n + k] = NAN;
        }
        assert_true(dense_eigen(a, n, values, work));
        for (int32_t k = 0; k < n; k++) {
            double angle = (k + 1) * PI / (n + 1), sign = a[k * n] < 0 ? -1 : 1;
            assert_near("eigenvalue", values[k], 2 - 2 * cos(angle), 1e-14 * (n + 1));
            for (int32_t i = 0; i < n; i++)
                assert_near("eigenvector", sign * a[k * n + i],
                            sqrt(2. / (n + 1)) * sin(angle * (i + 1)), 1e-12);
        }
        free(work);
    }
}

// Jacobi's rotations agree on random matrices; the vectors are orthonormal and give A back, even
// where eigenvalues meet.
TEST(test_eigen_of_random_matrices)
{
    Random random = {.state = 2};
    for (int32_t n = 1; n <= SIZE_TRIED; n += 3) {
        double a[SIZE_TRIED * SIZE_TRIED], kept[SIZE_TRIED * SIZE_TRIED], values[SIZE_TRIED];
        double wanted[SIZE_TRIED], back[SIZE_TRIED * SIZE_TRIED], unit[SIZE_TRIED * SIZE_TRIED];
        double scaled[SIZE_TRIED * SIZE_TRIED];
        double *work = hand_matrix((int32_t)DENSE_EIGEN_WORK(n), 1);
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i <= j; i++)
                a[j * n + i] = a[i * n + j] = n % 2 ? random_between(&random, -1, 1) : i == j;
        memcpy(kept, a, sizeof a);
        memcpy(back, a, sizeof a);
        hand_eigenvalues(back, n, wanted);
        assert_true(dense_eigen(a, n, values, work));
        assert_all_near("eigenvalues", values, wanted, n, 1e-13);
        DenseView vectors = {a, n, n};
        hand_product(vectors, vectors, true, 1, 0, unit);
        for (int32_t k = 0; k < n * n; k++) assert_near("Q'Q", unit[k], k % (n + 1) == 0, 1e-13);
        for (int32_t k = 0; k < n * n; k++)   // Q' transposed back: rows scaled by eigenvalues
            scaled[k] = values[k % n] * a[(k % n) * n + k / n];
        hand_product(vectors, (DenseView){scaled, n, n}, false, 1, 0, back);
        assert_all_near("Q D Q'", back, kept, n * n, 1e-13);
        free(work);
    }
}

enum { ARRAYS_MAX = 8 };
static const double GUARD = 12345.678;

// Arrays with a guard number behind each.
typedef struct Guarded {
    double *array[ARRAYS_MAX];
    int64_t size[ARRAYS_MAX];
    int32_t count;
} Guarded;

static double *guarded_array(Guarded *all, int64_t size)
{
    double *array = malloc((size_t)(size + 1) * sizeof *array);
    assert_non_null(array);
    for (int64_t k = 0; k < size; k++) array[k] = 0;
    array[size] = GUARD;
    all->array[all->count] = array;
    all->size[all->count++] = size;
    return array;
}

// n on the diagonal and sines beside it: positive definite, symmetric or not.
static void fill_guarded(double *a, int32_t n, bool symmetric)
{
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < n; i++)
            a[j * n + i] = i == j ? n : symmetric ? sin(1.0 + i + j) : sin(1.0 + i + 7.0 * j);
}

// LAPACK writes no further than the sizes that algebra/dense.h names; its own sizes of work arrays
// change from one function to the next.
TEST(test_guard_numbers_stay)
{
    for (int32_t n = 1; n <= SIZE_TRIED; n++) {
        Guarded all = {0};
        int64_t square = (int64_t)n * n;
        double *a = guarded_array(&all, square), *b = guarded_array(&all, square);
        double *values = guarded_array(&all, n), *re = guarded_array(&all, n);
        double *im = guarded_array(&all, n), *right = guarded_array(&all, n);
        double *work = guarded_array(&all, DENSE_EIGEN_WORK(n));
        int32_t pivots[SIZE_TRIED + 1] = {[SIZE_TRIED] = 0};
        pivots[n] = -77;
        fill_guarded(a, n, true);
        assert_true(dense_eigen(a, n, values, work));
        fill_guarded(a, n, true);
        assert_true(dense_eigen_above(a, n, values[n / 2], values, work));
        fill_guarded(a, n, true);
        fill_guarded(b, n, true);
        assert_true(dense_eigen_pair(a, b, n, values, work));
        fill_guarded(a, n, false);
        assert_true(dense_eigen_general(a, n, re, im, b, work));
        fill_guarded(a, n, false);
        assert_true(dense_lu(a, n, pivots));
        dense_lu_solve(a, n, pivots, right);
        fill_guarded(a, n, true);
        assert_true(dense_cholesky(a, n) && dense_invert_factored(a, n));
        assert_int_equal(pivots[n], -77);
        for (int32_t k = 0; k < all.count; k++) {
            if (all.array[k][all.size[k]] != GUARD) fail_msg("n = %d: beyond array %d", n, k);
            free(all.array[k]);
        }
    }
}

// Hilbert's matrix has an inverse in whole numbers.
TEST(test_inverse_of_hilbert)
{
    const double inverse[] = {16,  -120,  240,  -140,  -120, 1200, -2700, 1680,
                              240, -2700, 6480, -4200, -140, 1680, -4200, 2800};
    double a[16];
    for (int32_t k = 0; k < 16; k++) a[k] = k % 4 >= k / 4 ? 1. / (k % 4 + k / 4 + 1) : NAN;
    assert_true(dense_cholesky(a, 4));
    assert_true(dense_invert_factored(a, 4));
    assert_all_near("inverse", a, inverse, 16, 1e-11);   // both triangles
    assert_true(dense_invert_factored(NULL, 0));
}

// As has the second difference: i (n + 1 - j) / (n + 1) for i <= j, counted from 1.
TEST(test_inverse_of_second_difference)
{
    for (int32_t n = 1; n < 300; n += n < 97 ? 48 : 97) {
        double *a = hand_matrix(n, n);
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < n; i++) a[j * n + i] = i == j ? 2 : i == j + 1 ? -1 : 0;
        assert_true(dense_cholesky(a, n));
        assert_true(dense_invert_factored(a, n));
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < n; i++) {
                double least = fmin(i, j) + 1, most = fmax(i, j) + 1;
                assert_near("inverse", a[j * n + i], least * (n + 1 - most) / (n + 1), 1e-10);
            }
        free(a);
    }
}

TEST(test_products)
{
    Random random = {.state = 3};
    for (int32_t trial = 0; trial < 100; trial++) {
        int32_t m = random_index(&random, 9), n = random_index(&random, 9);
        int32_t k = 1 + random_index(&random, 9);
        double a[81], b[81], c[81], wanted[81], x[9], y[9];
        double factor = random_between(&random, -2, 2), keep = trial % 3 == 0 ? 0 : -0.5;
        fill_random(&random, a, 81);
        fill_random(&random, b, 81);
        fill_random(&random, c, 81);
        memcpy(wanted, c, sizeof c);
        if (keep == 0)   // then what stood there does not matter
            for (int32_t e = 0; e < m * n; e++) c[e] = NAN;
        DenseView tall = {a, k, m}, wide = {a, m, k}, right = {b, k, n};
        hand_product(tall, right, true, factor, keep, wanted);
        dense_multiply_transposed(tall, right, factor, keep, c);
        assert_all_near("a' b", c, wanted, m * n, 1e-14);
        if (m == 0 || n == 0) continue;
        hand_product(wide, right, false, factor, 1, wanted);
        dense_multiply(wide, right, factor, 1, c);
        assert_all_near("a b", c, wanted, m * n, 1e-13);

        fill_random(&random, y, 9);
        memcpy(x, y, sizeof y);
        hand_product(wide, (DenseView){b, k, 1}, false, factor, 1, x);
        dense_apply(wide, b, factor, 1, y);
        assert_all_near("a x", y, x, 9, 1e-13);
        hand_product(tall, (DenseView){b, k, 1}, true, factor, keep, x);
        dense_apply_transposed(tall, b, factor, keep, y);
        assert_all_near("a' x", y, x, m, 1e-13);
    }
}

// The string again, and two that do not touch, whose eigenvalues are double: the vectors above
// any bound, few of them or all, are orthonormal, A v = s v, and values are those of the string.
TEST(test_eigen_above)
{
    for (int32_t n = 0; n <= SIZE_TRIED; n += 2) {
        for (int32_t wanted = 0; wanted <= n; wanted++) {
            bool two = (n / 2 + wanted) % 2;
            int32_t cells = two ? n / 2 : n, first = n - wanted;
            double a[SIZE_TRIED * SIZE_TRIED + 1] = {0}, full[SIZE_TRIED * SIZE_TRIED + 1] = {0};
            double values[SIZE_TRIED + 1], image[SIZE_TRIED], unit[SIZE_TRIED * SIZE_TRIED];
            double *work = hand_matrix((int32_t)DENSE_EIGEN_WORK(n), 1);
            if (two && wanted % 2) first++;   // both of a pair or none
            for (int32_t k = 0; k < n; k++) {
                a[k * n + k] = full[k * n + k] = 2;
                if (k + 1 == n || (two && k + 1 == cells)) continue;
                a[k * n + k + 1] = full[k * n + k + 1] = full[(k + 1) * n + k] = -1;
                a[(k + 1) * n + k] = NAN;   // the lower triangle is read
            }
            int32_t each = two ? 2 : 1, waves = first / each;   // not wanted
            double below = 2 - 2 * cos(waves * PI / (cells + 1));
            double above = 2 - 2 * cos((waves + 1) * PI / (cells + 1));
            assert_true(dense_eigen_above(a, n, (below + above) / 2, values, work));
            for (int32_t k = 0; k < n; k++) {
                int32_t wave = k / each + 1;
                assert_near("value", values[k], 2 - 2 * cos(wave * PI / (cells + 1)), 1e-14 * n);
            }
            DenseView vectors = {a + first * n, n, n - first};
            hand_product(vectors, vectors, true, 1, 0, unit);
            for (int32_t k = 0; k < (n - first) * (n - first); k++)
                assert_near("Q'Q", unit[k], k % (n - first + 1) == 0, 1e-13);
            for (int32_t k = first; k < n; k++) {
                hand_apply(full, n, n, a + k * n, image);
                for (int32_t i = 0; i < n; i++)
                    assert_near("A v", image[i], values[k] * a[k * n + i], 1e-13 * n);
            }
            free(work);
        }
    }
}

// L^-1 (L A L') L^-T is A, from the lower triangle of L.
TEST(test_divide_both_sides)
{
    Random random = {.state = 5};
    for (int32_t n = 0; n <= SIZE_TRIED; n += 5) {
        double lower[SIZE_TRIED * SIZE_TRIED], a[SIZE_TRIED * SIZE_TRIED];
        double wanted[SIZE_TRIED * SIZE_TRIED], half[SIZE_TRIED * SIZE_TRIED];
        for (int32_t j = 0; j < n; j++) {
            for (int32_t i = 0; i < n; i++) {
                lower[j * n + i] = i < j ? 0 : random_between(&random, -0.5, 0.5) + 2 * (i == j);
                if (i >= j) wanted[j * n + i] = wanted[i * n + j] = random_between(&random, -1, 1);
            }
        }
        // half = L A, transposed back and forth by the symmetry of A: (L (L A)')'.
        DenseView factor = {lower, n, n};
        hand_product(factor, (DenseView){wanted, n, n}, false, 1, 0, half);
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < n; i++) a[j * n + i] = half[i * n + j];
        hand_product(factor, (DenseView){a, n, n}, false, 1, 0, half);
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < j; i++) lower[j * n + i] = NAN;
        dense_divide_both_sides(lower, n, half);
        for (int32_t j = 0; j < n; j++)
            assert_all_near("A", half + j * n + j, wanted + j * n + j, n - j, 1e-11);
    }
}

// A v = s v with s and v complex; pairs stand together, the one with im > 0 first; the sum of all s
// is the trace. Random matrices have both kinds.
TEST(test_general_eigenvalues)
{
    Random random = {.state = 6};
    int32_t pairs = 0, real = 0;
    for (int32_t n = 1; n <= SIZE_TRIED; n += 2) {
        double a[SIZE_TRIED * SIZE_TRIED], kept[SIZE_TRIED * SIZE_TRIED], re[SIZE_TRIED];
        double im[SIZE_TRIED], v[SIZE_TRIED * SIZE_TRIED], x[SIZE_TRIED], y[SIZE_TRIED];
        double *work = hand_matrix((int32_t)DENSE_EIGEN_WORK(n), 1), trace = 0, sum = 0;
        fill_random(&random, a, n * n);
        memcpy(kept, a, sizeof a);
        assert_true(dense_eigen_general(a, n, re, im, v, work));
        for (int32_t k = 0; k < n; k++) {
            trace += kept[k * n + k];
            sum += re[k];
            const double *p = v + k * n, *q = p + n;
            hand_apply(kept, n, n, p, x);
            if (im[k] == 0) {
                real++;
                for (int32_t i = 0; i < n; i++) assert_near("A v", x[i], re[k] * p[i], 1e-12 * n);
                continue;
            }
            pairs++;
            assert_true(k + 1 < n && im[k] > 0 && im[k + 1] == -im[k] && re[k + 1] == re[k]);
            hand_apply(kept, n, n, q, y);
            for (int32_t i = 0; i < n; i++) {
                assert_near("real part", x[i], re[k] * p[i] - im[k] * q[i], 1e-12 * n);
                assert_near("imaginary part", y[i], re[k] * q[i] + im[k] * p[i], 1e-12 * n);
            }
            sum += re[k + 1];
            trace += kept[(k + 1) * n + k + 1];
            k++;
        }
        assert_near("trace", sum, trace, 1e-12 * n);
        free(work);
    }
    assert_true(pairs > 20 && real > 20);
}

static int lu_sign(double *a, int32_t n)
{
    int32_t pivots[SIZE_TRIED];
    dense_lu(a, n, pivots);
    return dense_lu_sign(a, n, pivots);
}

// Permutations have the sign of their inversions; a symmetric matrix that of its negative
// eigenvalues; a block that turns has a positive determinant without any real eigenvalue.
TEST(test_lu_sign)
{
    Random random = {.state = 4};
    int32_t seen[2] = {0};
    for (int32_t trial = 0; trial < 200; trial++) {
        int32_t n = 1 + random_index(&random, 12), order[12], inversions = 0;
        double a[144] = {0}, copy[144], values[12];
        for (int32_t k = 0; k < n; k++) {
            int32_t at = random_index(&random, k + 1);
            order[k] = order[at];
            order[at] = k;
        }
        for (int32_t i = 0; i < n; i++)
            for (int32_t j = 0; j < i; j++) inversions += order[j] > order[i];
        for (int32_t k = 0; k < n; k++) a[k * n + order[k]] = random_between(&random, 0.5, 2);
        assert_int_equal(lu_sign(a, n), inversions % 2 ? -1 : 1);

        int32_t negative = 0;
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i <= j; i++)
                a[j * n + i] = a[i * n + j] = random_between(&random, -1, 1);
        memcpy(copy, a, sizeof a);
        hand_eigenvalues(copy, n, values);
        for (int32_t k = 0; k < n; k++) negative += values[k] < 0;
        seen[negative % 2]++;
        assert_int_equal(lu_sign(a, n), negative % 2 ? -1 : 1);
    }
    assert_true(seen[0] > 50 && seen[1] > 50);
    double turn[] = {0.1, 1, -1, 0.1}, singular[] = {1, 2, 2, 4};
    assert_int_equal(lu_sign(turn, 2), 1);
    assert_int_equal(lu_sign(singular, 2), 0);
    assert_int_equal(dense_lu_sign(NULL, 0, NULL), 1);   // the empty product
}

// A Y = B Y diag(values), Y'B Y = 1, for a definite B; none for another.
TEST(test_pair)
{
    enum { SIZE = 7 };
    Random random = {.state = 31};
    for (int32_t n = 0; n <= SIZE; n++) {
        double a[SIZE * SIZE], b[SIZE * SIZE], y[SIZE * SIZE], factor[SIZE * SIZE];
        double values[SIZE], work[26 * SIZE + 64], left[SIZE], right[SIZE];
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i <= j; i++)
                b[j * n + i] = b[i * n + j] = random_between(&random, -0.3, 0.3) + (i == j ? 3 : 0);
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i <= j; i++)
                y[j * n + i] = y[i * n + j] = a[j * n + i] = a[i * n + j] =
                    random_between(&random, -1, 1);
        memcpy(factor, b, sizeof b);
        assert_true(DENSE_EIGEN_WORK(n) <= 26 * SIZE + 64);
        assert_true(dense_eigen_pair(y, factor, n, values, work));
        for (int32_t j = 0; j < n; j++) {
            hand_apply(a, n, n, y + j * n, left);
            hand_apply(b, n, n, y + j * n, right);
            for (int32_t i = 0; i < n; i++) {
                double product = 0;
                for (int32_t k = 0; k < n; k++) product += y[i * n + k] * right[k];
                assert_near("Y'B Y", product, i == j, 1e-14);
                assert_near("A Y", left[i], values[j] * right[i], 1e-14);
            }
            if (j > 0) assert_true(values[j] >= values[j - 1]);
        }
        if (n == 0) continue;
        b[n * n - 1] = -1;
        assert_false(dense_eigen_pair(a, b, n, values, work));
    }
}
