// SPDX-License-Identifier: GPL-2.0-or-later
// Responses of the interior to unit motions of the border, against dense elimination by hand; and
// where an entry of a pattern stands.
#include "base/sparse.h"

#include "base/dense.h"
#include "base/memory.h"
#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

enum { SIZE_TRIED = 90 };

typedef struct Case {
    int32_t size, border_count;
    double *dense;   // [size^2]
    int32_t border[SIZE_TRIED];
    SparsePattern pattern;
    double *values;
} Case;

// A ring with random chords, positive definite by its diagonal; the border in a random order.
static void make_case(Random *random, int32_t size, int32_t border_count, Case *made)
{
    Error err = {0};
    *made = (Case){.size = size, .border_count = border_count, .dense = hand_matrix(size, size)};
    double *a = made->dense;
    for (int32_t k = 0; k < 2 * size; k++) {
        int32_t i = k < size ? k : random_index(random, size);
        int32_t j = k < size ? (k + 1) % size : random_index(random, size);
        if (i != j) a[j * size + i] = a[i * size + j] = random_between(random, -1, 1);
    }
    made->pattern.size = size;
    made->pattern.start = NEW_ARRAY(int32_t, size + 1, &err);
    made->pattern.index = NEW_ARRAY(int32_t, size * size, &err);
    made->values = NEW_ARRAY(double, size *size, &err);
    int32_t filled = 0;
    for (int32_t j = 0; j < size; j++) {
        double sum = 0.3;
        for (int32_t i = 0; i < size; i++) sum += fabs(a[j * size + i]);
        a[j * size + j] = sum;
        for (int32_t i = 0; i < size; i++) {
            if (a[j * size + i] == 0) continue;
            made->pattern.index[filled] = i;
            made->values[filled++] = a[j * size + i];
        }
        made->pattern.start[j + 1] = filled;
    }
    int32_t order[SIZE_TRIED];
    for (int32_t k = 0; k < size; k++) order[k] = k;
    for (int32_t k = 0; k < border_count; k++) {
        int32_t other = k + random_index(random, size - k);
        made->border[k] = order[other];
        order[other] = order[k];
    }
}

static void free_case(Case *made)
{
    free(made->dense);
    sparse_pattern_destroy(&made->pattern);
    memory_free(made->values);
}

// Every column against A_ii x = -A_ib e_j, with blocks of columns full and not.
static void test_against_dense(void **state)
{
    (void)state;
    Error err = {0};
    dense_use_one_thread();
    Random random = {.state = 21};
    const int32_t borders[] = {0, 1, 2, 7, 16, 17, 31, 32, 33, 64, 65, 80};
    int64_t live = memory_counters().live;
    for (size_t trial = 0; trial < sizeof borders / sizeof *borders; trial++) {
        Case made;
        int32_t size = SIZE_TRIED - (int32_t)(trial % 4), count = borders[trial];
        make_case(&random, size, count, &made);
        SparseAnalysis *analysis = sparse_analyse(&made.pattern, made.border, count, &err);
        SparseFactor *factor = analysis ? sparse_factorise(analysis, made.values, &err) : NULL;
        if (!factor) fail_msg("border %d: %s", count, err.message);
        double *x = hand_matrix(size, count), *a = hand_matrix(size, size);
        double *wanted = hand_matrix(size, count);
        for (int32_t k = 0; k < size * count; k++) x[k] = NAN;
        assert_true(sparse_border_responses(factor, x, &err));
        // Rows of the border replaced by those of the unit matrix: the whole answer in one solve.
        memcpy(a, made.dense, (size_t)(size * size) * sizeof *a);
        for (int32_t j = 0; j < count; j++) {
            for (int32_t i = 0; i < size; i++) a[i * size + made.border[j]] = 0;
            a[made.border[j] * size + made.border[j]] = wanted[j * size + made.border[j]] = 1;
        }
        assert_true(hand_solve(a, size, wanted, count));
        assert_all_near("responses", x, wanted, size * count, 1e-12);
        sparse_factor_destroy(factor);
        sparse_analysis_destroy(analysis);
        free(x);
        free(a);
        free(wanted);
        free_case(&made);
    }
    assert_int_equal(memory_counters().live, live);
}

static void test_entries(void **state)
{
    (void)state;
    Random random = {.state = 22};
    Case made;
    make_case(&random, 40, 0, &made);
    for (int32_t row = 0; row < 40; row++) {
        for (int32_t k = made.pattern.start[row]; k < made.pattern.start[row + 1]; k++)
            assert_int_equal(sparse_entry(&made.pattern, row, made.pattern.index[k]), k);
    }
    free_case(&made);
}

static void test_memory_faults(void **state)
{
    (void)state;
    Error err = {0};
    Random random = {.state = 23};
    Case made;
    make_case(&random, 30, 9, &made);
    SparseAnalysis *analysis = sparse_analyse(&made.pattern, made.border, 9, &err);
    SparseFactor *factor = sparse_factorise(analysis, made.values, &err);
    double x[270];
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        memory_fail_after(k);
        done = sparse_border_responses(factor, x, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        error_clear(&err);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 20);
    }
    sparse_factor_destroy(factor);
    sparse_analysis_destroy(analysis);
    free_case(&made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_dense),
        cmocka_unit_test(test_entries),
        cmocka_unit_test(test_memory_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
