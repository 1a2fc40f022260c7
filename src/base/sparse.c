// SPDX-License-Identifier: GPL-2.0-or-later
// CHOLMOD (Chen, Davis, Hager, Rajamanickam, ACM TOMS 35, 2008): CAMD orders the border last, the
// factor is supernodal LL', and L_bb is read out of its supernodes.
//
// A pattern is analysed once and factored for every rung of the ladder (on 80 x 80 cells: 5 ms for
// the analysis, 25 ms for a factor, 1 ms for a solve). Workspaces of solves belong to the analysis:
// factors of one analysis must not be used by two threads.
#include "base/sparse.h"

#include "base/dense.h"
#include "base/memory.h"
#include "base/share.h"

#include <cholmod.h>
#include <string.h>

// Of GNU's OpenMP, which Debian's CHOLMOD comes with.
int omp_get_max_active_levels(void) __attribute__((weak));
void omp_set_max_active_levels(int levels) __attribute__((weak));

enum { TOGETHER = 48 };   // columns of one pass over a factor

// Work space of passes over a factor with many columns, of one thread.
typedef struct Passage {
    cholmod_common common;
    cholmod_dense *columns;   // [size * TOGETHER]; NULL: not open
    cholmod_dense *work;
} Passage;

struct SparseAnalysis {
    cholmod_common common;
    bool started;
    cholmod_sparse *pattern;   // lower triangle is what CHOLMOD reads (stype -1)
    cholmod_factor *symbolic;
    cholmod_factor *spare;   // of a factor that was destroyed: the next one's memory; NULL: none
    int32_t border_count;
    int32_t *border_position;   // [border_count] where border[j] stands in L's border
    cholmod_dense *forward;   // solve2's workspaces, shared by all factors
    cholmod_dense *work_y, *work_e;
    cholmod_dense *permuted;   // right-hand side in L's order
    Passage passages[2];
};

struct SparseFactor {
    SparseAnalysis *analysis;   // not owned
    cholmod_factor *numeric;
    double *border_factor;   // L_bb, in L's order
    double *schur;   // S, in the caller's order
    double *border_work;   // [border_count]
};

void sparse_pattern_destroy(SparsePattern *pattern)
{
    memory_free(pattern->start);
    memory_free(pattern->index);
    *pattern = (SparsePattern){0};
}

// Bisection: the columns of a row are ascending. The entry must exist.
int32_t sparse_entry(const SparsePattern *pattern, int32_t row, int32_t column)
{
    int32_t low = pattern->start[row], high = pattern->start[row + 1] - 1;
    while (low < high) {
        int32_t middle = (low + high) / 2;
        if (pattern->index[middle] < column)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// By rows, as both triangles are stored: one pass over the values without scattered writes.
void sparse_apply(const SparsePattern *pattern, const double *values, const double *x, double *y)
{
    const int32_t *start = pattern->start, *index = pattern->index;
    for (int32_t row = 0; row < pattern->size; row++) {
        double sum = 0.0;
        for (int32_t k = start[row]; k < start[row + 1]; k++) sum += values[k] * x[index[k]];
        y[row] = sum;
    }
}

// `wide` columns share a pass, their entries of a row side by side; a constant where inlined.
static inline void apply_together(const SparsePattern *pattern, const double *values,
                                  const double *x, int wide, double *y, double *work)
{
    int64_t size = pattern->size;
    for (int64_t k = 0; k < size * wide; k++) work[k] = x[k % wide * size + k / wide];
    for (int64_t row = 0; row < size; row++) {
        double sum[SPARSE_WIDE] = {0};
        for (int32_t k = pattern->start[row]; k < pattern->start[row + 1]; k++) {
            const double *from = work + (int64_t)pattern->index[k] * wide;
            for (int j = 0; j < wide; j++) sum[j] += values[k] * from[j];
        }
        for (int j = 0; j < wide; j++) y[j * size + row] = sum[j];
    }
}

void sparse_apply_many(const SparsePattern *pattern, const double *values, const double *x,
                       int64_t columns, double *y, double *work)
{
    enum { WIDE = SPARSE_WIDE, HALF = WIDE / 2 };
    int64_t size = pattern->size, column = 0;
    for (; column + WIDE <= columns; column += WIDE)
        apply_together(pattern, values, x + column * size, WIDE, y + column * size, work);
    for (; column + HALF <= columns; column += HALF)
        apply_together(pattern, values, x + column * size, HALF, y + column * size, work);
    for (; column < columns; column++)
        sparse_apply(pattern, values, x + column * size, y + column * size);
}

// A CHOLMOD view of the pattern; `values` may be NULL. Points into the caller's arrays.
static cholmod_sparse sparse_view(const SparsePattern *pattern, double *values)
{
    return (cholmod_sparse){.nrow = (size_t)pattern->size,
                            .ncol = (size_t)pattern->size,
                            .nzmax = (size_t)pattern->start[pattern->size],
                            .p = pattern->start,
                            .i = pattern->index,
                            .x = values,
                            .stype = -1,
                            .itype = CHOLMOD_INT,
                            .xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
}

// Whether the analysis left the border's unknowns (member 1) last.
static bool border_is_last(const SparseAnalysis *analysis, const int32_t *member)
{
    const int32_t *permutation = analysis->symbolic->Perm;
    int32_t size = (int32_t)analysis->pattern->nrow, first = size - analysis->border_count;
    for (int32_t k = 0; k < size; k++) {
        if ((member[permutation[k]] == 1) != (k >= first)) return false;
    }
    return true;
}

// Symbolic factorisation in the given `order` [n]; an earlier one is dropped.
static bool analyse_in_order(SparseAnalysis *analysis, int32_t *order, bool postorder, Error *err)
{
    cholmod_common *common = &analysis->common;
    cholmod_free_factor(&analysis->symbolic, common);
    common->postorder = postorder;
    analysis->symbolic = cholmod_analyze_p(analysis->pattern, order, NULL, 0, common);
    if (!analysis->symbolic)
        FAIL(err, ERROR_LIBRARY, "CHOLMOD: the analysis failed (status %d)", common->status);
cleanup:
    return error_is_clean(err);
}

// The order that keeps the border last, checked. Postordering makes larger supernodes and keeps the
// border where it is when the interior is connected, as in a mesh; where it is not, CAMD's own
// order is taken as it is.
static bool analyse_with_border(SparseAnalysis *analysis, const int32_t *border, Error *err)
{
    cholmod_common *common = &analysis->common;
    int32_t size = (int32_t)analysis->pattern->nrow, count = analysis->border_count;
    int32_t *member = NEW_ARRAY(int32_t, size, err);
    int32_t *order = NEW_ARRAY(int32_t, size, err);
    if (!member || !order) goto cleanup;
    for (int32_t j = 0; j < count; j++) member[border[j]] = 1;
    if (!cholmod_camd(analysis->pattern, NULL, 0, member, order, common))
        FAIL(err, ERROR_LIBRARY, "CHOLMOD: the fill-reducing order failed (status %d)",
             common->status);
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_GIVEN;
    common->supernodal = CHOLMOD_SUPERNODAL;
    common->final_ll = 1;
    TRY(analyse_in_order(analysis, order, true, err));
    if (!border_is_last(analysis, member)) TRY(analyse_in_order(analysis, order, false, err));
    if (!border_is_last(analysis, member))
        FAIL(err, ERROR_LIBRARY, "CHOLMOD did not keep the interface last in its order");

    const int32_t *permutation = analysis->symbolic->Perm;
    for (int32_t k = 0; k < size; k++) order[permutation[k]] = k - (size - count);
    for (int32_t j = 0; j < count; j++) analysis->border_position[j] = order[border[j]];
cleanup:
    memory_free(member);
    memory_free(order);
    return error_is_clean(err);
}

// The pattern is copied: the analysis outlives the caller's arrays. CHOLMOD prints nothing.
SparseAnalysis *sparse_analyse(const SparsePattern *pattern, const int32_t *border,
                               int32_t border_count, Error *err)
{
    SparseAnalysis *analysis = NEW_ARRAY(SparseAnalysis, 1, err);
    if (!analysis) goto cleanup;
    cholmod_start(&analysis->common);
    analysis->started = true;
    analysis->common.print = 0;
    analysis->border_count = border_count;
    analysis->border_position = NEW_ARRAY(int32_t, border_count, err);
    if (!analysis->border_position) goto cleanup;
    cholmod_sparse view = sparse_view(pattern, NULL);
    analysis->pattern = cholmod_copy_sparse(&view, &analysis->common);
    analysis->permuted = cholmod_zeros((size_t)pattern->size, 1, CHOLMOD_REAL, &analysis->common);
    if (!analysis->pattern || !analysis->permuted)
        FAIL(err, ERROR_MEMORY, "no memory for a sparse pattern of %d unknowns", pattern->size);
    TRY(analyse_with_border(analysis, border, err));
cleanup:
    if (error_is_clean(err)) return analysis;
    sparse_analysis_destroy(analysis);
    return NULL;
}

static void close_passage(Passage *passage)
{
    if (!passage->columns && !passage->work) return;
    cholmod_free_dense(&passage->columns, &passage->common);
    cholmod_free_dense(&passage->work, &passage->common);
    cholmod_finish(&passage->common);
}

// Kept from call to call: memory that is asked for anew comes page by page.
static bool open_passage(const SparseAnalysis *analysis, Passage *passage, Error *err)
{
    if (passage->columns) return true;
    cholmod_start(&passage->common);
    passage->common.print = 0;
    passage->columns =
        cholmod_zeros(analysis->pattern->nrow, TOGETHER, CHOLMOD_REAL, &passage->common);
    passage->work =
        cholmod_zeros(analysis->symbolic->maxesize + 1, TOGETHER, CHOLMOD_REAL, &passage->common);
    if (!passage->columns || !passage->work)
        FAIL(err, ERROR_MEMORY, "no memory for %d answers of a factor", TOGETHER);
cleanup:
    if (!error_is_clean(err)) close_passage(passage);
    return error_is_clean(err);
}

// Also of one half built. Factors made from it must have been destroyed.
void sparse_analysis_destroy(SparseAnalysis *analysis)
{
    if (!analysis) return;
    if (analysis->started) {
        cholmod_common *common = &analysis->common;
        cholmod_free_factor(&analysis->symbolic, common);
        cholmod_free_factor(&analysis->spare, common);
        cholmod_free_sparse(&analysis->pattern, common);
        cholmod_free_dense(&analysis->forward, common);
        cholmod_free_dense(&analysis->work_y, common);
        cholmod_free_dense(&analysis->work_e, common);
        cholmod_free_dense(&analysis->permuted, common);
        for (int which = 0; which < 2; which++) close_passage(&analysis->passages[which]);
        cholmod_finish(common);
    }
    memory_free(analysis->border_position);
    memory_free(analysis);
}

// Copies L_bb out of the supernodes: column c of supernode s holds rows s.rows[0 .. n) from its own
// first row down; only rows and columns from `first` on belong to the border.
static void read_border_factor(const cholmod_factor *factor, int32_t count, double *border_factor)
{
    const int32_t *super = factor->super, *row_start = factor->pi, *value_start = factor->px;
    const int32_t *rows = factor->s;
    const double *values = factor->x;
    int32_t first = (int32_t)factor->n - count;
    for (int32_t s = (int32_t)factor->nsuper - 1; s >= 0 && super[s + 1] > first; s--) {
        int32_t height = row_start[s + 1] - row_start[s];
        for (int32_t column = super[s]; column < super[s + 1]; column++) {
            if (column < first) continue;
            const double *entries = values + value_start[s] + (int64_t)height * (column - super[s]);
            double *out = border_factor + (int64_t)count * (column - first);
            for (int32_t k = column - super[s]; k < height; k++)
                out[rows[row_start[s] + k] - first] = entries[k];
        }
    }
}

// S = L_bb L_bb', brought into the caller's order of the border.
// square: [border_count^2] work.
static void compute_schur(SparseFactor *factor, double *square)
{
    int32_t count = factor->analysis->border_count;
    const int32_t *position = factor->analysis->border_position;
    dense_lower_square(factor->border_factor, count, square);
    for (int32_t j = 0; j < count; j++) {
        for (int32_t i = 0; i < count; i++)
            factor->schur[(int64_t)count * j + i] =
                square[(int64_t)count * position[j] + position[i]];
    }
}

// In this thread alone. CHOLMOD 5 asks for a team of four for every supernode, whatever
// OMP_NUM_THREADS says, and waking them takes longer than the work they share: a factor of 80 x 80
// cells took twice as long with them, one of 2000 unknowns four times.
static bool factorise_alone(cholmod_sparse *matrix, cholmod_factor *numeric, cholmod_common *common)
{
    bool teams = omp_get_max_active_levels && omp_set_max_active_levels;
    int levels = teams ? omp_get_max_active_levels() : 0;
    if (teams) omp_set_max_active_levels(0);
    bool done = cholmod_factorize(matrix, numeric, common);
    if (teams) omp_set_max_active_levels(levels);
    return done;
}

// S is formed once, with the factor. Not positive definite: a user's mesh or material can cause it.
SparseFactor *sparse_factorise(SparseAnalysis *analysis, const double *values, Error *err)
{
    cholmod_common *common = &analysis->common;
    int64_t count = analysis->border_count;
    double *square = NEW_ARRAY(double, count *count, err);
    SparseFactor *factor = NEW_ARRAY(SparseFactor, 1, err);
    if (!factor || !square) goto cleanup;
    factor->analysis = analysis;
    factor->border_factor = NEW_ARRAY(double, count *count, err);
    factor->schur = NEW_ARRAY(double, count *count, err);
    factor->border_work = NEW_ARRAY(double, count, err);
    if (!factor->border_factor || !factor->schur || !factor->border_work) goto cleanup;

    factor->numeric = analysis->spare ? analysis->spare
                                      : cholmod_copy_factor(analysis->symbolic, common);
    analysis->spare = NULL;
    if (!factor->numeric) FAIL(err, ERROR_MEMORY, "no memory for a sparse factor");
    cholmod_sparse matrix = *analysis->pattern;
    matrix.x = (double *)(uintptr_t)values;   // CHOLMOD only reads it
    matrix.xtype = CHOLMOD_REAL;
    if (!factorise_alone(&matrix, factor->numeric, common))
        FAIL(err, common->status == CHOLMOD_OUT_OF_MEMORY ? ERROR_MEMORY : ERROR_LIBRARY,
             "CHOLMOD: the factorisation failed (status %d)", common->status);
    if (factor->numeric->minor < factor->numeric->n)
        FAIL(err, ERROR_COMPUTE, "the matrix is not positive definite (pivot %zu of %zu)",
             factor->numeric->minor, factor->numeric->n);
    read_border_factor(factor->numeric, analysis->border_count, factor->border_factor);
    compute_schur(factor, square);
cleanup:
    memory_free(square);
    if (error_is_clean(err)) return factor;
    sparse_factor_destroy(factor);
    return NULL;
}

void sparse_factor_destroy(SparseFactor *factor)
{
    if (!factor) return;
    if (factor->analysis && !factor->analysis->spare) {
        factor->analysis->spare = factor->numeric;
        factor->numeric = NULL;
    }
    if (factor->analysis) cholmod_free_factor(&factor->numeric, &factor->analysis->common);
    memory_free(factor->border_factor);
    memory_free(factor->schur);
    memory_free(factor->border_work);
    memory_free(factor);
}

// Owned by the factor.
const double *sparse_schur(const SparseFactor *factor)
{
    return factor->schur;
}

// L y = rhs; then g = L_bb y_b = rhs_b - A_bi A_ii^-1 rhs_i. y stays in `forward` for the
// sparse_expand that follows.
bool sparse_condense(SparseFactor *factor, const double *rhs, double *g, Error *err)
{
    SparseAnalysis *analysis = factor->analysis;
    const int32_t *permutation = factor->numeric->Perm;
    int32_t size = (int32_t)factor->numeric->n, count = analysis->border_count;
    double *permuted = analysis->permuted->x;
    for (int32_t k = 0; k < size; k++) permuted[k] = rhs[permutation[k]];
    if (!cholmod_solve2(CHOLMOD_L, factor->numeric, analysis->permuted, NULL, &analysis->forward,
                        NULL, &analysis->work_y, &analysis->work_e, &analysis->common))
        FAIL(err, ERROR_MEMORY, "CHOLMOD: the forward substitution failed (status %d)",
             analysis->common.status);
    double *border = factor->border_work;
    memcpy(border, (double *)analysis->forward->x + (size - count), (size_t)count * sizeof *border);
    dense_lower_apply(factor->border_factor, count, border);
    for (int32_t j = 0; j < count; j++) g[j] = border[analysis->border_position[j]];
cleanup:
    return error_is_clean(err);
}

// With x_b known, L_bb' x_b takes the place of y_b, and L' x = y gives the interior. CHOLMOD keeps
// its workspaces from call to call.
bool sparse_expand(SparseFactor *factor, const double *x_border, double *x, Error *err)
{
    SparseAnalysis *analysis = factor->analysis;
    const int32_t *permutation = factor->numeric->Perm;
    int32_t size = (int32_t)factor->numeric->n, count = analysis->border_count;
    double *border = factor->border_work;
    for (int32_t j = 0; j < count; j++) border[analysis->border_position[j]] = x_border[j];
    dense_lower_apply_transposed(factor->border_factor, count, border);
    memcpy((double *)analysis->forward->x + (size - count), border, (size_t)count * sizeof *border);
    cholmod_dense *solution = analysis->permuted;
    if (!cholmod_solve2(CHOLMOD_Lt, factor->numeric, analysis->forward, NULL, &solution, NULL,
                        &analysis->work_y, &analysis->work_e, &analysis->common))
        FAIL(err, ERROR_MEMORY, "CHOLMOD: the backward substitution failed (status %d)",
             analysis->common.status);
    analysis->permuted = solution;
    const double *permuted = solution->x;
    for (int32_t k = 0; k < size; k++) x[permutation[k]] = permuted[k];
cleanup:
    return error_is_clean(err);
}

typedef struct Expansion {
    SparseFactor *factor;
    const double *border;   // [border_count * count]
    int32_t count;
    double *x;   // [size * count]
} Expansion;

// One half's columns, TOGETHER at a time: they fill a block that the factor passes over once; more
// would leave the cache. The halves share nothing that either writes to.
static void expand_half(void *context, int32_t which)
{
    const Expansion *all = context;
    SparseAnalysis *analysis = all->factor->analysis;
    Passage *passage = &analysis->passages[which];
    cholmod_factor *numeric = all->factor->numeric;
    const int32_t *permutation = numeric->Perm, *position = analysis->border_position;
    int32_t border_count = analysis->border_count;
    int32_t first = which ? all->count / 2 : 0, end = which ? all->count : all->count / 2;
    int64_t size = (int64_t)numeric->n;
    int32_t passes = (end - first + TOGETHER - 1) / TOGETHER, columns = 0;
    for (int32_t pass = 0; pass < passes; pass++, first += columns) {
        columns = (end - first) / (passes - pass);   // alike: a few alone take as long as many
        double *values = passage->columns->x;
        passage->columns->ncol = (size_t)columns;
        memset(values, 0, (size_t)(size * columns) * sizeof *values);
        for (int32_t j = 0; j < columns; j++) {
            const double *given = all->border + (int64_t)(first + j) * border_count;
            double *border = values + (j + 1) * size - border_count;
            for (int32_t k = 0; k < border_count; k++) border[position[k]] = given[k];
            dense_lower_apply_transposed(all->factor->border_factor, border_count, border);
        }
        cholmod_super_ltsolve(numeric, passage->columns, passage->work, &passage->common);
        for (int32_t j = 0; j < columns; j++) {
            double *out = all->x + (first + j) * size;
            for (int64_t k = 0; k < size; k++) out[permutation[k]] = values[j * size + k];
        }
    }
}

bool sparse_expand_many(SparseFactor *factor, const double *x_border, int32_t count, double *x,
                        Error *err)
{
    Expansion all = {factor, x_border, count, x};
    for (int which = 0; which < 2; which++)
        TRY(open_passage(factor->analysis, &factor->analysis->passages[which], err));
    share_in_two(expand_half, &all);
cleanup:
    return error_is_clean(err);
}
