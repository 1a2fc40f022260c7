// SPDX-License-Identifier: GPL-2.0-or-later
// Pencils with a chosen spectrum: a = L H D H L', b = L L', H the product of two reflections. Then
// D's entries are the eigenvalues and the columns of H the vectors L'x.
#include "base/largest_eigen.h"

#include "base/dense.h"
#include "base/memory.h"

#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

enum { SIZE = 160 };
static const double ABOVE = 1e-3, LEAST = -1e-6;

typedef struct Pencil {
    int32_t size;
    double spectrum[SIZE];   // in no order
    double *a, *b, *lower, *vectors, *work;
    LargestEigenDef def;
} Pencil;

static void reflect(double *columns, int32_t n, const double *v)
{
    double square = 0;
    for (int32_t i = 0; i < n; i++) square += v[i] * v[i];
    for (int32_t j = 0; j < n; j++) {
        double along = 0;
        for (int32_t i = 0; i < n; i++) along += v[i] * columns[j * n + i];
        for (int32_t i = 0; i < n; i++) columns[j * n + i] -= 2 * along / square * v[i];
    }
}

// The k-th entry of what Lanczos begins with.
static double start(int32_t k)
{
    return fmod(0.6180339887498949 * (k + 1.0), 1) - 0.5;
}

// v becomes the reflection that turns the last column to what of v is orthogonal to the start.
static void turn_to_hidden(const double *columns, int32_t n, double *v)
{
    double along = 0, square = 0, left = 0;
    for (int32_t i = 0; i < n; i++) {
        along += start(i) * v[i];
        square += start(i) * start(i);
    }
    for (int32_t i = 0; i < n; i++) {
        v[i] -= along / square * start(i);
        left += v[i] * v[i];
    }
    for (int32_t i = 0; i < n; i++) v[i] = v[i] / sqrt(left) - columns[(n - 1) * n + i];
}

// c = L x D x' L', x: the columns of `vectors` (or D = 1, x = 1).
static void fill_product(const Pencil *pencil, const double *x, double *c)
{
    int32_t n = pencil->size;
    double *image = hand_matrix(n, n);
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < n; i++)
            for (int32_t k = 0; k <= i; k++)
                image[j * n + i] += pencil->lower[k * n + i] * (x ? x[j * n + k] : k == j);
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < n; i++) c[j * n + i] = 0;
    for (int32_t k = 0; k < n; k++)
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < n; i++)
                c[j * n + i] += (x ? pencil->spectrum[k] : 1) * image[k * n + i] * image[k * n + j];
    free(image);
}

// spectrum: filled. hidden: Lanczos begins orthogonally to the last vector.
static void pencil_build(int32_t n, bool hidden, Random *random, Pencil *pencil)
{
    double v[SIZE];
    dense_use_one_thread();
    pencil->size = n;
    pencil->a = hand_matrix(n, n), pencil->b = hand_matrix(n, n);
    pencil->lower = hand_matrix(n, n), pencil->vectors = hand_matrix(n, n);
    pencil->work = hand_matrix(n, 2 * n);
    for (int32_t j = 0; j < n; j++) {
        pencil->vectors[j * n + j] = 1;
        for (int32_t i = j; i < n; i++)
            pencil->lower[j * n + i] = i == j ? 2 : random_between(random, -0.1, 0.1);
    }
    for (int turn = 0; turn < 2; turn++) {
        for (int32_t i = 0; i < n; i++) v[i] = random_between(random, -1, 1);
        if (hidden && turn == 1) turn_to_hidden(pencil->vectors, n, v);
        reflect(pencil->vectors, n, v);
    }
    fill_product(pencil, pencil->vectors, pencil->a);
    fill_product(pencil, NULL, pencil->b);
    pencil->def = (LargestEigenDef){.size = n,
                                    .a = pencil->a,
                                    .b = pencil->b,
                                    .lower = pencil->lower,
                                    .above = ABOVE,
                                    .least = LEAST,
                                    .work = pencil->work};
}

static void pencil_destroy(Pencil *pencil)
{
    free(pencil->a), free(pencil->b), free(pencil->lower), free(pencil->vectors);
    free(pencil->work);
}

// 10^-first, and on by `ratio`, in places that are shuffled.
static void fill_spectrum(int32_t n, double first, double ratio, Random *random, double *spectrum)
{
    for (int32_t k = 0; k < n; k++) {
        int32_t at = random_index(random, k + 1);
        spectrum[k] = spectrum[at];
        spectrum[at] = pow(10, -first) * pow(ratio, k);
    }
}

// The values above ABOVE are those that were chosen, each with its column of H; `next` bounds the
// rest closely.
static void assert_largest(const Pencil *pencil, const LargestEigen *largest)
{
    int32_t n = pencil->size, wanted = 0;
    double next = 0;
    for (int32_t k = 0; k < n; k++) {
        double value = pencil->spectrum[k], along = 0;
        if (value <= ABOVE) {
            next = fmax(next, value);
            continue;
        }
        int32_t place = 0;
        for (int32_t i = 0; i < n; i++)
            place += pencil->spectrum[i] > ABOVE && pencil->spectrum[i] < value;
        wanted++;
        assert_true(place < largest->count);
        assert_near("value", largest->values[place], value, 1e-12);
        for (int32_t i = 0; i < n; i++)
            along += largest->vectors[place * n + i] * pencil->vectors[k * n + i];
        assert_near("vector", fabs(along), 1, 1e-12);
    }
    assert_int_equal(largest->count, wanted);
    if (!(largest->next > next && largest->next <= fmax(1.01 * next, next + 1e-3 * ABOVE)))
        fail_msg("next: %.12g for %.12g", largest->next, next);
}

static void test_few_are_wanted(void **state)
{
    (void)state;
    Random random = {.state = 11};
    for (int32_t trial = 0; trial < 6; trial++) {
        Error err = {0};
        Pencil pencil = {0};
        LargestEigen largest;
        bool found = false;
        // From 3 wanted to none, and smaller by a factor of 5 to 2.5 from one to the next.
        fill_spectrum(SIZE, 1 + 0.45 * trial, 0.2 + 0.04 * trial, &random, pencil.spectrum);
        pencil_build(SIZE - trial % 2, false, &random, &pencil);
        assert_true(largest_eigen_find(&pencil.def, &largest, &found, &err));
        assert_true(found);
        assert_largest(&pencil, &largest);
        largest_eigen_destroy(&largest);
        pencil_destroy(&pencil);
    }
}

// Nothing in place of what is not all: one that Lanczos does not find, as it begins with no part of
// it (without the proof 4 of 5 are returned), one below `least`, more than steps, a small size.
static void test_what_is_left_to_others(void **state)
{
    (void)state;
    Random random = {.state = 12};
    for (int32_t what = 0; what < 4; what++) {
        Error err = {0};
        Pencil pencil = {0};
        LargestEigen largest;
        bool found = true;
        fill_spectrum(SIZE, 1, what == 2 ? 0.95 : 0.25, &random, pencil.spectrum);
        if (what == 0) pencil.spectrum[SIZE - 1] = 2 * ABOVE;
        if (what == 1) pencil.spectrum[SIZE / 2] = 2 * LEAST;
        pencil_build(what == 3 ? 79 : SIZE, what == 0, &random, &pencil);
        assert_true(largest_eigen_find(&pencil.def, &largest, &found, &err));
        assert_false(found);
        assert_true(largest.count == 0 && !largest.values && !largest.vectors);
        pencil_destroy(&pencil);
    }
}

static void test_memory_faults(void **state)
{
    (void)state;
    Random random = {.state = 13};
    Pencil pencil = {0};
    fill_spectrum(SIZE, 1, 0.2, &random, pencil.spectrum);
    pencil_build(SIZE, false, &random, &pencil);
    int64_t live = memory_counters().live;
    bool found = false;
    for (int32_t k = 0; !found; k++) {
        Error err = {0};
        LargestEigen largest;
        memory_fail_after(k);
        largest_eigen_find(&pencil.def, &largest, &found, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, found ? ERROR_NONE : ERROR_MEMORY);
        largest_eigen_destroy(&largest);
        assert_int_equal(memory_counters().live, live);
    }
    pencil_destroy(&pencil);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_few_are_wanted),
        cmocka_unit_test(test_what_is_left_to_others),
        cmocka_unit_test(test_memory_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
