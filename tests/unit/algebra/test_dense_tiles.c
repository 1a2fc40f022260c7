// SPDX-License-Identifier: GPL-2.0-or-later
// Transposes, mirror images and squares that are made piece by piece, number by number.
#include "algebra/dense.h"
#include "base/memory.h"
#include "near.h"
#include "random_numbers.h"

enum { SIZES = 6 };
static const int32_t SIZE[SIZES] = {0, 1, 31, 33, 128, 130};   // beside the edges of the pieces

static double *draw(Random *random, int64_t count)
{
    Error err = {0};
    double *numbers = NEW_ARRAY(double, count, &err);
    assert_non_null(numbers);
    for (int64_t k = 0; k < count; k++) numbers[k] = random_between(random, -1, 1);
    return numbers;
}

TEST(test_transpose)
{
    Random random = {.state = 3};
    for (int32_t a = 0; a < SIZES; a++)
        for (int32_t b = 0; b < SIZES; b++) {
            int64_t rows = SIZE[a], columns = SIZE[b], stride = columns + 3;
            double *from = draw(&random, rows * columns), *to = draw(&random, stride * rows);
            double beyond = rows > 0 ? to[columns] : 0;
            dense_transpose(dense_view(from, rows, columns), to, stride);
            for (int64_t i = 0; i < rows; i++)
                for (int64_t j = 0; j < columns; j++)
                    assert_true(to[i * stride + j] == from[j * rows + i]);
            assert_true(rows == 0 || to[columns] == beyond);
            memory_free(from);
            memory_free(to);
        }
}

TEST(test_mirror)
{
    Random random = {.state = 4};
    for (int32_t s = 0; s < SIZES; s++) {
        int64_t n = SIZE[s];
        double *a = draw(&random, n * n), *before = draw(&random, n * n);
        for (int64_t k = 0; k < n * n; k++) before[k] = a[k];
        dense_mirror(a, n);
        for (int64_t j = 0; j < n; j++)
            for (int64_t i = j; i < n; i++)
                assert_true(a[j * n + i] == before[j * n + i] && a[i * n + j] == a[j * n + i]);
        memory_free(a);
        memory_free(before);
    }
}

TEST(test_square)
{
    Random random = {.state = 5};
    dense_use_one_thread();
    for (int32_t s = 0; s < SIZES; s++) {
        int32_t n = SIZE[s];
        double *lower = draw(&random, (int64_t)n * n), *square = draw(&random, (int64_t)n * n);
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < j; i++) lower[j * n + i] = 0;
        dense_lower_square(lower, n, square);
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < n; i++) {
                double sum = 0;
                for (int32_t k = 0; k < n; k++) sum += lower[k * n + i] * lower[k * n + j];
                assert_near("L L'", square[j * n + i], sum, 1e-13);
            }
        memory_free(lower);
        memory_free(square);
    }
}
