// SPDX-License-Identifier: GPL-2.0-or-later
// T'AT, T y and T'x of a block's bulk against T written out as a dense matrix: unknowns as they
// are, pairs, blocks of many unknowns and few modes, and unknowns in no block.
#include "reduction/transform.h"
#include "base/memory.h"
#include "random_numbers.h"
#include "reduced_block.h"
#include "near.h"

static const Material MATERIAL = {.young = 2, .poisson = 0.3, .density = 3, .eta1 = 1, .eta2 = 0.5};
static const BlockDef SHAPE = {.kind = ELEMENT_Q4, .nx = 9, .nz = 7, .length = 2, .height = 1.3};
enum { COLUMNS = 3, LARGE = 20, MODES = 6 };

// (x + sign x*) / sqrt(2) of an unknown and its image; of its own image: x.
static void append_pair(Transform *by, int32_t one, int32_t image, double sign)
{
    transform_append_images(by, (int32_t[]){one, image}, one == image ? 1 : 2, (double[]){1, sign});
}

// Unknowns from both ends in pairs, from the first on; then of the rest each of three in turn as it
// is, in one of two blocks in turns, or in none.
static void make_transform(int32_t size, Transform *by)
{
    Error err = {0};
    Random random = {.state = 3};
    int32_t pairs = 15, rows[2][LARGE], filled[2] = {0};
    assert_true(transform_create(size, size, (int64_t)size * MODES, by, &err));
    for (int32_t k = 0; k < pairs; k++) append_pair(by, k, size - 1 - k, k % 2 ? 1 : -1);
    for (int32_t k = pairs; k < size - pairs; k++) {
        int32_t which = k / 3 % 2;
        if (k % 3 == 0) append_pair(by, k, k, -1);
        if (k % 3 == 1 && filled[which] < LARGE) rows[which][filled[which]++] = k;
    }
    for (int32_t which = 0; which < 2; which++) {
        double *values = transform_append(by, rows[which], filled[which], MODES - which);
        for (int32_t k = 0; k < filled[which] * (MODES - which); k++)
            values[k] = random_between(&random, -1, 1);
    }
}

static double *written_out(const Transform *by)
{
    double *t = hand_matrix(by->size, by->count);
    for (int32_t k = 0; k < by->block_count; k++) {
        const TransformBlock *block = &by->blocks[k];
        for (int32_t i = 0; i < block->size; i++)
            for (int32_t j = 0; j < block->count; j++)
                t[(block->first + j) * by->size + block->rows[i]] =
                    block->values[i * block->count + j];
    }
    return t;
}

// t' a t; a: [size^2]
static double *congruent(const Transform *by, const double *t, const double *a)
{
    int32_t n = by->size, m = by->count;
    double *half = hand_matrix(n, m), *out = hand_matrix(m, m);
    for (int32_t j = 0; j < m; j++) hand_apply(a, n, n, t + j * n, half + j * n);
    for (int32_t j = 0; j < m; j++)
        for (int32_t i = 0; i < m; i++)
            for (int32_t k = 0; k < n; k++) out[j * m + i] += t[i * n + k] * half[j * n + k];
    free(half);
    return out;
}

static void check_matrix(const Bulk *from, const double *values, const Bulk *to, const double *made,
                         const Transform *by, const double *t)
{
    double *a = dense_matrix(from, values), *wanted = congruent(by, t, a);
    double *found = dense_matrix(to, made);
    double size = dense_max_abs(wanted, by->count * by->count);
    assert_all_near("T'AT", found, wanted, by->count * by->count, 1e-14 * size);
    for (int32_t j = 0; j < by->count; j++)   // symmetric to the bit
        for (int32_t i = 0; i < j; i++)
            assert_true(found[j * by->count + i] == found[i * by->count + j]);
    free(a), free(wanted), free(found);
}

TEST(test_bulk)
{
    Error err = {0};
    ReducedBlock block;
    Transform by;
    Bulk to;
    reduced_block_build(&SHAPE, &MATERIAL, 0.3, 0, &block);
    Bulk *from = &block.bulk;
    bulk_hold(1, from);   // one of a pair, and one alone
    bulk_hold(18, from);
    make_transform(from->dof_count, &by);
    assert_true(bulk_transform(from, &by, &to, &err));
    assert_int_equal(to.dof_count, by.count);
    for (int32_t k = 0; k < to.pattern.start[by.count]; k++) {
        int32_t row = 0;
        while (to.pattern.start[row + 1] <= k) row++;
        assert_true(k == to.pattern.start[row] || to.pattern.index[k] > to.pattern.index[k - 1]);
    }
    double *t = written_out(&by), *load = hand_matrix(by.count, 1), *mass = dense_mass(from);
    double *masses = congruent(&by, t, mass);
    check_matrix(from, from->stiffness, &to, to.stiffness, &by, t);
    check_matrix(from, from->damping, &to, to.damping, &by, t);
    for (int32_t j = 0; j < by.count; j++)
        for (int32_t i = 0; i < by.size; i++) load[j] += t[j * by.size + i] * from->load[i];
    assert_all_near("load", to.load, load, by.count, 1e-15);
    for (int32_t j = 0; j < by.count; j++)
        assert_near("mass", to.mass[j], masses[j * (by.count + 1)], 1e-14);
    int32_t held = 0;
    for (int32_t j = 0; j < by.count; j++) held += to.held[j];
    assert_int_equal(held, 1);
    assert_int_equal(to.held[transform_column(&by, 18)], 1);
    assert_int_equal(transform_column(&by, 17), NO_BLOCK);
    free(t), free(load), free(mass), free(masses);
    bulk_destroy(&to);
    transform_destroy(&by);
    reduced_block_destroy(&block);
}

// T y of blocks; T y and T'x of pairs and unknowns as they are, and of T = 1.
TEST(test_vectors)
{
    Error err = {0};
    Random random = {.state = 11};
    enum { SIZE = 130 };
    double x[SIZE], wanted[SIZE], found[SIZE];
    Transform by, pairs, one = {.size = SIZE, .count = SIZE};
    make_transform(SIZE, &by);
    int32_t m = by.count;
    double *t = written_out(&by), *y = hand_matrix(SIZE, COLUMNS);
    double *many = hand_matrix(SIZE, COLUMNS);
    for (int32_t k = 0; k < SIZE * COLUMNS; k++) y[k] = random_between(&random, -1, 1);
    for (int32_t k = 0; k < SIZE; k++) x[k] = random_between(&random, -1, 1);
    assert_true(transform_apply_many(&by, y, COLUMNS, many, &err));
    for (int32_t c = 0; c < COLUMNS; c++) {
        hand_apply(t, SIZE, m, y + c * m, wanted);
        assert_all_near("T y of many", many + c * SIZE, wanted, SIZE, 1e-14);
    }
    free(t);
    assert_true(transform_create(SIZE, SIZE, SIZE, &pairs, &err));
    for (int32_t k = 0; k < SIZE / 2 - 2; k++)
        append_pair(&pairs, k, k % 3 ? SIZE - 1 - k : k, k % 2 ? 1 : -1);
    t = written_out(&pairs);
    hand_apply(t, SIZE, pairs.count, y, wanted);
    for (int32_t k = 0; k < SIZE; k++) found[k] = x[k], wanted[k] += x[k];
    transform_apply(&pairs, y, found);
    assert_all_near("x + T y", found, wanted, SIZE, 1e-14);
    transform_apply_transposed(&pairs, x, found);
    for (int32_t j = 0; j < pairs.count; j++) {
        double sum = 0;
        for (int32_t i = 0; i < SIZE; i++) sum += t[j * SIZE + i] * x[i];
        assert_near("T'x", found[j], sum, 1e-14);
    }
    transform_apply_transposed(&one, x, found);
    assert_memory_equal(found, x, sizeof x);
    transform_apply(&one, x, found);
    for (int32_t k = 0; k < SIZE; k++) assert_true(found[k] == 2 * x[k]);
    free(t), free(y), free(many);
    transform_destroy(&by);
    transform_destroy(&pairs);
}

// a + T s T' of pairs, two unknowns that are their own images, one in none.
TEST(test_square)
{
    Error err = {0};
    Random random = {.state = 7};
    Transform by;
    enum { SIZE = 9, COUNT = 5 };
    assert_true(transform_create(SIZE, SIZE, SIZE, &by, &err));
    for (int32_t k = 0; k < 3; k++) append_pair(&by, k, 8 - k, k % 2 ? 1 : -1);
    append_pair(&by, 5, 5, 1);
    append_pair(&by, 3, 3, 1);
    assert_int_equal(by.count, COUNT);
    double *t = written_out(&by), s[COUNT * COUNT], a[SIZE * SIZE], wanted[SIZE * SIZE];
    for (int32_t j = 0; j < COUNT; j++)
        for (int32_t i = 0; i <= j; i++)
            s[j * COUNT + i] = s[i * COUNT + j] = random_between(&random, -1, 1);
    for (int32_t k = 0; k < SIZE * SIZE; k++) wanted[k] = a[k] = random_between(&random, -1, 1);
    for (int32_t q = 0; q < COUNT; q++)
        for (int32_t p = 0; p < COUNT; p++)
            for (int32_t j = 0; j < SIZE; j++)
                for (int32_t i = 0; i < SIZE; i++)
                    wanted[j * SIZE + i] += t[p * SIZE + i] * s[q * COUNT + p] * t[q * SIZE + j];
    for (int32_t j = 0; j < SIZE; j++) transform_add_square(&by, s, j, a + (ptrdiff_t)j * SIZE);
    assert_all_near("a + T s T'", a, wanted, SIZE * SIZE, 1e-15);
    Transform one = {.size = COUNT, .count = COUNT};
    for (int32_t k = 0; k < COUNT * COUNT; k++) a[k] = 1;
    for (int32_t j = 0; j < COUNT; j++) transform_add_square(&one, s, j, a + (ptrdiff_t)j * COUNT);
    for (int32_t k = 0; k < COUNT * COUNT; k++) assert_true(a[k] == 1 + s[k]);
    free(t);
    transform_destroy(&by);
}

TEST(test_memory_faults)
{
    ReducedBlock block;
    reduced_block_build(&SHAPE, &MATERIAL, 0.3, 0, &block);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        Transform by;
        Bulk to = {0};
        double y = 1, *x = NULL;
        memory_fail_after(k);
        done = transform_create(block.bulk.dof_count, 1, 1, &by, &err) &&
               (append_pair(&by, 2, 2, 1), bulk_transform(&block.bulk, &by, &to, &err)) &&
               (x = NEW_ARRAY(double, by.size, &err)) && transform_apply_many(&by, &y, 1, x, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        memory_free(x);
        bulk_destroy(&to);
        transform_destroy(&by);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 40);
    }
    reduced_block_destroy(&block);
}
