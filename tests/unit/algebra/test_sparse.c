// SPDX-License-Identifier: GPL-2.0-or-later
// Random sparse matrices, their Schur complements and solutions against dense elimination by hand.
#include "algebra/sparse.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "dense_by_hand.h"
#include "near.h"
#include "random_numbers.h"

#include <SuiteSparse_config.h>
#include <dlfcn.h>

enum { SIZE_TRIED = 60 };

// malloc counted, CHOLMOD's included: "nothing is allocated" is more than our own counters see.
// Sanitizers have a malloc of their own, and then it stays 0.
static int64_t malloc_calls;
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
void *malloc(size_t size)
{
    void *(*next)(size_t) = NULL;
    void *address = dlsym(RTLD_NEXT, "malloc");
    memcpy(&next, &address, sizeof next);
    malloc_calls++;
    return next(size);
}
#endif

typedef struct Case {
    int32_t size, border_count;
    double dense[SIZE_TRIED * SIZE_TRIED];
    double place[3 * SIZE_TRIED];   // anywhere: an order follows from it, no answer
    int32_t border[SIZE_TRIED];   // in a random order
    SparsePattern pattern;
    double *values;
} Case;

static void compress(Case *made)
{
    Error err = {0};
    int32_t n = made->size, filled = 0;
    made->pattern = (SparsePattern){.size = n,
                                    .start = NEW_ARRAY(int32_t, n + 1, &err),
                                    .index = NEW_ARRAY(int32_t, n * n, &err)};
    made->values = NEW_ARRAY(double, n *n, &err);
    for (int32_t j = 0; j < n; j++) {
        for (int32_t i = 0; i < n; i++) {
            if (made->dense[j * n + i] == 0) continue;
            made->pattern.index[filled] = i;
            made->values[filled++] = made->dense[j * n + i];
        }
        made->pattern.start[j + 1] = filled;
    }
}

// Positive definite by diagonal dominance, with about three neighbours an unknown.
static void make_case(Random *random, int32_t size, int32_t border_count, Case *made)
{
    *made = (Case){.size = size, .border_count = border_count};
    for (int32_t k = 0; k < 3 * size / 2; k++) {
        int32_t i = random_index(random, size), j = random_index(random, size);
        if (i == j) continue;
        made->dense[j * size + i] = made->dense[i * size + j] = random_between(random, -1, 1);
    }
    for (int32_t j = 0; j < size; j++) {
        double sum = random_between(random, 0.1, 1);
        for (int32_t i = 0; i < size; i++) sum += i == j ? 0 : fabs(made->dense[j * size + i]);
        made->dense[j * size + j] = sum;
    }
    for (int32_t k = 0; k < 3 * size; k++) made->place[k] = random_index(random, 3);
    int32_t order[SIZE_TRIED];
    for (int32_t k = 0; k < size; k++) order[k] = k;
    for (int32_t k = 0; k < border_count; k++) {
        int32_t other = k + random_index(random, size - k), swapped = order[other];
        order[other] = order[k];
        made->border[k] = order[k] = swapped;
    }
    compress(made);
}

static void free_case(Case *made)
{
    sparse_pattern_destroy(&made->pattern);
    memory_free(made->values);
}

static void check_schur(const Case *made, const SparseFactor *factor)
{
    int32_t count = made->border_count;
    double *wanted = hand_matrix(count, count);
    hand_schur(made->dense, made->size, made->border, count, wanted);
    double *schur = hand_matrix(count, count);
    sparse_schur(factor, schur);
    assert_all_near("S", schur, wanted, count * count, 1e-12);
    free(schur);
    const double *lower = sparse_schur_lower(factor);   // in the same order: S = L L'
    for (int32_t j = 0; j < count; j++)
        for (int32_t i = 0; i < count; i++) {
            double sum = 0;
            for (int32_t k = 0; k < count; k++) sum += lower[k * count + i] * lower[k * count + j];
            assert_near("L L'", sum, wanted[j * count + i], 1e-12);
            if (i < j) assert_true(lower[j * count + i] == 0);
        }
    free(wanted);
}

// condense, S x_b = g + r, expand against a dense solve of A x = b + r on the border.
static void check_solution(Random *random, const Case *made, SparseFactor *factor)
{
    Error err = {0};
    int32_t n = made->size, count = made->border_count;
    double rhs[SIZE_TRIED], wanted[SIZE_TRIED], g[SIZE_TRIED], x[SIZE_TRIED];
    double *a = hand_matrix(n, n), *schur = hand_matrix(count, count);
    memcpy(a, made->dense, (size_t)(n * n) * sizeof *a);
    sparse_schur(factor, schur);
    for (int32_t k = 0; k < n; k++) rhs[k] = wanted[k] = random_between(random, -1, 1);
    assert_true(sparse_condense(factor, rhs, g, &err));
    for (int32_t j = 0; j < count; j++) {
        double reaction = random_between(random, -1, 1);
        g[j] += reaction;
        wanted[made->border[j]] += reaction;
    }
    assert_true(hand_solve(schur, count, g, 1));
    assert_true(sparse_expand(factor, g, x, &err));
    assert_true(hand_solve(a, n, wanted, 1));
    assert_all_near("x", x, wanted, n, 1e-11);
    free(a);
    free(schur);
}

// Answers to many motions at once against A_ii x_i + A_ib x_b = 0, and what is condensed of many
// right sides against one by one: from one to more than fit together.
static void check_many(Random *random, const Case *made, SparseFactor *factor)
{
    Error err = {0};
    int32_t n = made->size, count = made->border_count, motions = 1 + random_index(random, 40);
    double *given = hand_matrix(count, motions), *x = hand_matrix(n, motions);
    double *condensed = hand_matrix(count, motions), *one = hand_matrix(count, 1);
    for (int32_t k = 0; k < n * motions; k++) x[k] = random_between(random, -1, 1);
    assert_true(sparse_condense_many(factor, x, motions, condensed, &err));
    for (int32_t j = 0; j < motions; j++) {
        assert_true(sparse_condense(factor, x + j * n, one, &err));
        assert_all_near("g", condensed + j * count, one, count, 1e-12);
    }
    for (int32_t k = 0; k < count * motions; k++) given[k] = random_between(random, -1, 1);
    assert_true(sparse_expand_many(factor, given, motions, x, &err));
    for (int32_t j = 0; j < motions; j++) {
        double inside[SIZE_TRIED];
        const double *answer = x + j * n;
        for (int32_t k = 0; k < count; k++)
            assert_near("border", answer[made->border[k]], given[j * count + k], 0);
        hand_apply(made->dense, n, n, answer, inside);
        for (int32_t k = 0; k < count; k++) inside[made->border[k]] = 0;
        for (int32_t k = 0; k < n; k++) assert_near("nothing presses inside", inside[k], 0, 1e-11);
    }
    free(given), free(x), free(condensed), free(one);
}

TEST(test_random_matrices)
{
    Error err = {0};
    dense_use_one_thread();
    Random random = {.state = 3};
    int64_t live = memory_counters().live;
    for (int32_t trial = 0; trial < 60; trial++) {
        Case made;
        int32_t size = 1 + random_index(&random, SIZE_TRIED);
        int32_t border_count = random_index(&random, size + 1);
        if (trial < 20) border_count = trial % 4 == 0 ? 0 : (trial % 4 == 1 ? 1 : size);
        make_case(&random, size, border_count, &made);
        SparseAnalysis *analysis = sparse_analyse(&made.pattern, trial % 3 == 0 ? NULL : made.place,
                                                  made.border, border_count, &err);
        if (!analysis) fail_msg("size %d, border %d: %s", size, border_count, err.message);
        SparseFactor *factor = sparse_factorise(analysis, made.values, &err);
        if (!factor) fail_msg("size %d, border %d: %s", size, border_count, err.message);
        check_schur(&made, factor);
        check_solution(&random, &made, factor);
        check_many(&random, &made, factor);
        sparse_factor_destroy(factor);
        sparse_analysis_destroy(analysis);
        free_case(&made);
    }
    assert_int_equal(memory_counters().live, live);
}

// Two factors of one analysis do not disturb each other, and a solve leaves no trace in the next.
TEST(test_two_factors_without_allocation)
{
    Error err = {0};
    Random random = {.state = 4};
    Case made;
    make_case(&random, 50, 12, &made);
    SparseAnalysis *analysis = sparse_analyse(&made.pattern, made.place, made.border, 12, &err);
    SparseFactor *first = sparse_factorise(analysis, made.values, &err);
    int32_t entries = made.pattern.start[made.size];
    for (int32_t k = 0; k < entries; k++) made.values[k] *= 2;
    SparseFactor *twice = sparse_factorise(analysis, made.values, &err);
    double rhs[50], g[2][12], x[2][50];
    for (int32_t k = 0; k < 50; k++) rhs[k] = random_between(&random, -1, 1);
    int64_t ours = 0, all = 0;
    for (int32_t round = 0; round < 10; round++) {
        SparseFactor *factors[] = {first, twice};
        for (int f = 0; f < 2; f++) {
            assert_true(sparse_condense(factors[f], rhs, g[f], &err));
            double border[12] = {[3] = 1};
            assert_true(sparse_expand(factors[f], border, x[f], &err));
        }
        if (round == 0) {
            ours = memory_counters().allocations;
            all = malloc_calls;
        }
    }
    assert_int_equal(memory_counters().allocations, ours);
    assert_int_equal(malloc_calls, all);
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
    assert_true(malloc_calls > 0);
#endif
    assert_all_near("g does not scale with A", g[1], g[0], 12, 1e-12);
    for (int32_t j = 0; j < 12; j++)   // the border is what it was told to be, in its order
        for (int f = 0; f < 2; f++)
            assert_near("x on the border", x[f][made.border[j]], j == 3 ? 1 : 0, 1e-12);
    double schur[2][144];
    sparse_schur(first, schur[0]);
    sparse_schur(twice, schur[1]);
    for (int32_t k = 0; k < 144; k++) assert_near("2 S", schur[1][k], 2 * schur[0][k], 1e-11);
    sparse_factor_destroy(first);
    sparse_factor_destroy(twice);
    sparse_analysis_destroy(analysis);
    free_case(&made);
}

TEST(test_apply)
{
    Random random = {.state = 6};
    Case made;
    make_case(&random, 40, 0, &made);
    double x[40], y[40], wanted[40];
    for (int32_t k = 0; k < 40; k++) x[k] = random_between(&random, -1, 1);
    hand_apply(made.dense, 40, 40, x, wanted);
    sparse_apply(&made.pattern, made.values, x, y);
    assert_all_near("A x", y, wanted, 40, 1e-14);
    double many[19 * 40], out[19 * 40];   // passes of four, and three more
    for (int32_t k = 0; k < 19 * 40; k++) many[k] = random_between(&random, -1, 1);
    sparse_apply_many(&made.pattern, made.values, many, 19, out);
    for (int32_t j = 0; j < 19; j++) {
        hand_apply(made.dense, 40, 40, many + j * 40, wanted);
        assert_all_near("A x, many", out + j * 40, wanted, 40, 1e-14);
    }
    free_case(&made);
}

// Two groups that share a point, and a point of none, of two unknowns each.
TEST(test_groups)
{
    Error err = {0};
    int32_t start[] = {0, 3, 5}, member[] = {3, 0, 1, 3, 2};
    static const int32_t neighbours[][5] = {
        {3, 0, 1, 3}, {3, 0, 1, 3}, {2, 2, 3}, {4, 0, 1, 2, 3}, {0}};
    const PointGroups groups = {5, 2, start, member};
    SparsePattern pattern = {0};
    if (!sparse_pattern_of_groups(&groups, 2, &pattern, &err)) fail_msg("%s", err.message);
    assert_int_equal(pattern.size, 10);
    for (int32_t row = 0, at = 0; row < 10; row++) {
        const int32_t *wanted = neighbours[row / 2];
        assert_int_equal(pattern.start[row + 1] - pattern.start[row], 2 * wanted[0]);
        for (int32_t k = 0; k < 2 * wanted[0]; k++)
            assert_int_equal(pattern.index[at++], 2 * wanted[1 + k / 2] + k % 2);
    }
    sparse_pattern_destroy(&pattern);
}

TEST(test_entries)
{
    Random random = {.state = 22};
    Case made;
    make_case(&random, 40, 0, &made);
    for (int32_t row = 0; row < 40; row++) {
        for (int32_t k = made.pattern.start[row]; k < made.pattern.start[row + 1]; k++)
            assert_int_equal(sparse_entry(&made.pattern, row, made.pattern.index[k]), k);
    }
    sparse_pattern_destroy(&made.pattern);
    memory_free(made.values);
}

TEST(test_not_definite)
{
    Error err = {0};
    Random random = {.state = 7};
    int64_t live = memory_counters().live;
    for (int32_t spoilt = 0; spoilt < 30; spoilt += 7) {
        Case made;
        make_case(&random, 30, 8, &made);
        for (int32_t k = made.pattern.start[spoilt]; k < made.pattern.start[spoilt + 1]; k++)
            if (made.pattern.index[k] == spoilt) made.values[k] = -1;
        SparseAnalysis *analysis = sparse_analyse(&made.pattern, made.place, made.border, 8, &err);
        assert_null(sparse_factorise(analysis, made.values, &err));
        assert_int_equal(err.code, ERROR_COMPUTE);
        assert_non_null(strstr(err.message, "not positive definite"));
        error_clear(&err);
        sparse_analysis_destroy(analysis);
        free_case(&made);
    }
    assert_int_equal(memory_counters().live, live);
}

TEST(test_memory_faults)
{
    Random random = {.state = 8};
    Case made;
    make_case(&random, 20, 5, &made);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        memory_fail_after(k);
        SparseAnalysis *analysis = sparse_analyse(&made.pattern, made.place, made.border, 5, &err);
        SparseFactor *factor = analysis ? sparse_factorise(analysis, made.values, &err) : NULL;
        memory_fail_after(-1);
        done = factor != NULL;
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        sparse_factor_destroy(factor);
        sparse_analysis_destroy(analysis);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 30);
    }
    free_case(&made);
}

// CHOLMOD's own memory. (Within a substitution CHOLMOD 3 does not look whether it got any.)
static int32_t library_left = -1, library_live;

static void *allocate(size_t bytes)
{
    if (library_left >= 0 && library_left-- == 0) return NULL;
    library_live++;
    return malloc(bytes);
}

static void release(void *memory)
{
    library_live -= memory != NULL;
    free(memory);
}

static void *allocate_zeroed(size_t count, size_t bytes)
{
    void *made = allocate(count * bytes);
    return made ? memset(made, 0, count * bytes) : NULL;
}

// Since SuiteSparse 6 the functions it allocates by are set by functions.
static void use_memory(void *(*make)(size_t), void *(*make_zeroed)(size_t, size_t),
                       void (*destroy)(void *))
{
#if SUITESPARSE_MAIN_VERSION >= 6
    SuiteSparse_config_malloc_func_set(make);
    SuiteSparse_config_calloc_func_set(make_zeroed);
    SuiteSparse_config_free_func_set(destroy);
#else
    SuiteSparse_config.malloc_func = make;
    SuiteSparse_config.calloc_func = make_zeroed;
    SuiteSparse_config.free_func = destroy;
#endif
}

TEST(test_memory_of_the_library)
{
    Random random = {.state = 9};
    Case made;
    make_case(&random, 20, 5, &made);
    int64_t live = memory_counters().live;
    bool done = false;
    int32_t failed = 0;
    double motions[3 * 5] = {0}, x[3 * 20];
    use_memory(allocate, allocate_zeroed, release);
    for (; !done; failed++) {
        Error err = {0};
        library_left = failed;
        SparseAnalysis *analysis = sparse_analyse(&made.pattern, made.place, made.border, 5, &err);
        SparseFactor *factor = analysis ? sparse_factorise(analysis, made.values, &err) : NULL;
        bool answered = factor && sparse_expand_many(factor, motions, 3, x, &err);
        done = library_left >= 0;   // not one of so many failed
        library_left = -1;
        if (!answered && err.code != ERROR_MEMORY && err.code != ERROR_LIBRARY)
            fail_msg("%d: %s", failed, err.message);
        if (answered) assert_int_equal(err.code, ERROR_NONE);
        sparse_factor_destroy(factor);
        sparse_analysis_destroy(analysis);
        assert_int_equal(memory_counters().live, live);
        assert_int_equal(library_live, 0);
        assert_true(failed < 200);
    }
    assert_true(failed > 20);
    use_memory(malloc, calloc, free);
    free_case(&made);
}
