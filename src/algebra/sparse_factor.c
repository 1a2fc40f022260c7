// SPDX-License-Identifier: GPL-2.0-or-later
// CHOLMOD (Chen, Davis, Hager, Rajamanickam, ACM TOMS 35, 2008): the factor is supernodal LL', with
// the border last, and L_bb is read out of its supernodes. Before the border stands the interior in
// an order of few entries in L: by nested dissection where places are known (algebra/sparse_order),
// else by CAMD.
//
// A pattern is analysed once and factored for every level of dt (on 80 x 80 cells: 5 ms for
// the analysis, 25 ms for a factor, 1 ms for a solve). sparse_condense and
// sparse_expand have their workspaces in the analysis: two threads must not call them at the same
// time for factors of one analysis.
#include "algebra/dense.h"
#include "algebra/sparse.h"
#include "algebra/sparse_order.h"
#include "base/memory.h"
#include "base/parallel.h"

#include <cholmod.h>
#include <string.h>

// --- analysis -----------------------------------------------------------------------------------

// L's border stands in the caller's order.
struct SparseAnalysis {
    cholmod_common common;
    bool started;
    cholmod_sparse pattern;   // a view of the caller's, without values
    int32_t size;
    cholmod_factor *symbolic;
    cholmod_factor *spare;   // of a factor that was destroyed: the next one's memory; NULL: none
    int32_t border_count;
    cholmod_dense *forward;   // solve2's workspaces, shared by all factors
    cholmod_dense *work_y, *work_e;
    cholmod_dense *permuted;   // right-hand side in L's order
};

#define NO_MEMORY "no memory for a sparse matrix of %d unknowns"

// Frees an analysis that is half built, too. Factors made from it must have been destroyed.
void sparse_analysis_destroy(SparseAnalysis *analysis)
{
    if (!analysis) return;
    if (analysis->started) {
        cholmod_common *common = &analysis->common;
        cholmod_free_factor(&analysis->symbolic, common);
        cholmod_free_factor(&analysis->spare, common);
        cholmod_free_dense(&analysis->forward, common);
        cholmod_free_dense(&analysis->work_y, common);
        cholmod_free_dense(&analysis->work_e, common);
        cholmod_free_dense(&analysis->permuted, common);
        cholmod_finish(common);
    }
    memory_free(analysis);
}

// A CHOLMOD view of the pattern, into the caller's arrays.
static cholmod_sparse pattern_view(const SparsePattern *pattern)
{
    return (cholmod_sparse){.nrow = (size_t)pattern->size,
                            .ncol = (size_t)pattern->size,
                            .nzmax = (size_t)pattern->start[pattern->size],
                            .p = pattern->start,
                            .i = pattern->index,
                            .stype = -1,
                            .itype = CHOLMOD_INT,
                            .xtype = CHOLMOD_PATTERN,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
}

static ErrorCode error_code_of(const cholmod_common *common)
{
    return common->status == CHOLMOD_OUT_OF_MEMORY ? ERROR_MEMORY : ERROR_LIBRARY;
}

// Without a postorder of the elimination tree the given order is kept, so that the border is last.
static bool analyse_with_border(SparseAnalysis *analysis, const SparsePattern *pattern,
                                const double *place, const int32_t *border, Error *err)
{
    cholmod_common *common = &analysis->common;
    int32_t size = analysis->size, count = analysis->border_count;
    int32_t *member = NULL;   // of CAMD's sets: the border is the last
    int32_t *order = NEW_ARRAY(int32_t, size, err);
    if (!order) goto cleanup;
    if (place) {
        TRY(sparse_order_dissect(pattern, place, border, count, order, err));
    } else {
        TRY((member = NEW_ARRAY(int32_t, size, err)));
        for (int32_t j = 0; j < count; j++) member[border[j]] = 1;
        // Without an interior there is nothing to order, and CAMD takes no set whose number is not
        // below the size.
        if (count < size && !cholmod_camd(&analysis->pattern, NULL, 0, member, order, common))
            FAIL(err, error_code_of(common), "CHOLMOD: the fill-reducing order failed (status %d)",
                 common->status);
        // S is full, in whatever order.
        memcpy(order + size - count, border, (size_t)count * sizeof *border);
    }
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_GIVEN;
    common->supernodal = CHOLMOD_SUPERNODAL;
    common->final_ll = 1;
    common->postorder = false;
    analysis->symbolic = cholmod_analyze_p(&analysis->pattern, order, NULL, 0, common);
    if (!analysis->symbolic)
        FAIL(err, error_code_of(common), "CHOLMOD: the analysis failed (status %d)",
             common->status);
    if (memcmp((int32_t *)analysis->symbolic->Perm + size - count, border,
               (size_t)count * sizeof *border) != 0)
        FAIL(err, ERROR_LIBRARY, "CHOLMOD did not keep the interface last in its order");
cleanup:
    memory_free_all(member, order);
    return error_is_clean(err);
}

// CHOLMOD prints nothing. NULL: no memory.
static SparseAnalysis *begin_analysis(const cholmod_sparse *pattern, int32_t border_count,
                                      Error *err)
{
    SparseAnalysis *analysis = NEW_ARRAY(SparseAnalysis, 1, err);
    if (!analysis) return NULL;
    cholmod_start(&analysis->common);
    analysis->started = true;
    analysis->common.print = 0;
    analysis->pattern = *pattern;
    analysis->size = (int32_t)pattern->nrow;
    analysis->border_count = border_count;
    analysis->permuted = cholmod_zeros(pattern->nrow, 1, CHOLMOD_REAL, &analysis->common);
    if (!analysis->permuted) FAIL(err, ERROR_MEMORY, NO_MEMORY, analysis->size);
cleanup:
    if (error_is_clean(err)) return analysis;
    sparse_analysis_destroy(analysis);
    return NULL;
}

SparseAnalysis *sparse_analyse(const SparsePattern *pattern, const double *place,
                               const int32_t *border, int32_t border_count, Error *err)
{
    cholmod_sparse view = pattern_view(pattern);
    SparseAnalysis *analysis = begin_analysis(&view, border_count, err);
    if (!analysis || analyse_with_border(analysis, pattern, place, border, err)) return analysis;
    sparse_analysis_destroy(analysis);
    return NULL;
}

SparseAnalysis *sparse_analysis_copy(const SparseAnalysis *from, Error *err)
{
    SparseAnalysis *analysis = begin_analysis(&from->pattern, from->border_count, err);
    if (!analysis) return NULL;
    analysis->symbolic = cholmod_copy_factor(from->symbolic, &analysis->common);
    if (analysis->symbolic) return analysis;
    error_set(err, ERROR_MEMORY, __FILE__, __LINE__, NO_MEMORY, from->size);
    sparse_analysis_destroy(analysis);
    return NULL;
}

// --- factors ------------------------------------------------------------------------------------

struct SparseFactor {
    SparseAnalysis *analysis;   // not owned
    cholmod_factor *numeric;
    double *border_factor;   // L_bb
};

// Functions of GNU's OpenMP, which Debian's CHOLMOD comes with.
int omp_get_max_active_levels(void) __attribute__((weak));
void omp_set_max_active_levels(int levels) __attribute__((weak));

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

// Factorises in this thread alone. CHOLMOD 5 asks for a team of four for every supernode, whatever
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

// The matrix may not be positive definite: a user's mesh or material can cause it.
SparseFactor *sparse_factorise(SparseAnalysis *analysis, const double *values, Error *err)
{
    cholmod_common *common = &analysis->common;
    int64_t count = analysis->border_count;
    SparseFactor *factor = NEW_ARRAY(SparseFactor, 1, err);
    if (!factor) goto cleanup;
    factor->analysis = analysis;
    TRY((factor->border_factor = NEW_ARRAY(double, count *count, err)));

    factor->numeric = analysis->spare ? analysis->spare
                                      : cholmod_copy_factor(analysis->symbolic, common);
    analysis->spare = NULL;
    if (!factor->numeric) FAIL(err, ERROR_MEMORY, "no memory for a sparse factor");
    cholmod_sparse matrix = analysis->pattern;
    matrix.stype = 1;   // of the upper triangle one transpose is in L's order, of the lower one two
    matrix.xtype = CHOLMOD_REAL;
    matrix.x = (void *)(uintptr_t)values;   // CHOLMOD's views are not const, and only read
    if (!factorise_alone(&matrix, factor->numeric, common))
        FAIL(err, common->status == CHOLMOD_OUT_OF_MEMORY ? ERROR_MEMORY : ERROR_LIBRARY,
             "CHOLMOD: the factorisation failed (status %d)", common->status);
    if (factor->numeric->minor < factor->numeric->n)
        FAIL(err, ERROR_COMPUTE, "the matrix is not positive definite (pivot %zu of %zu)",
             factor->numeric->minor, factor->numeric->n);
    read_border_factor(factor->numeric, analysis->border_count, factor->border_factor);
cleanup:
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
    memory_free_all(factor->border_factor, factor);
}

void sparse_schur(const SparseFactor *factor, double *schur)
{
    dense_lower_square(factor->border_factor, factor->analysis->border_count, schur);
}

const double *sparse_schur_lower(const SparseFactor *factor)
{
    return factor->border_factor;
}

// Solves L y = rhs; then g = L_bb y_b = rhs_b - A_bi A_ii^-1 rhs_i. y stays in `forward` for the
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
        return FAULT(err, ERROR_MEMORY, "CHOLMOD: the forward substitution failed (status %d)",
                     analysis->common.status);
    memcpy(g, (double *)analysis->forward->x + (size - count), (size_t)count * sizeof *g);
    dense_lower_apply(factor->border_factor, count, g);
    return true;
}

// With x_b known, L_bb' x_b takes the place of y_b, and L' x = y gives the interior. CHOLMOD keeps
// its workspaces from call to call.
bool sparse_expand(SparseFactor *factor, const double *x_border, double *x, Error *err)
{
    SparseAnalysis *analysis = factor->analysis;
    const int32_t *permutation = factor->numeric->Perm;
    int32_t size = (int32_t)factor->numeric->n, count = analysis->border_count;
    double *border = (double *)analysis->forward->x + (size - count);
    memcpy(border, x_border, (size_t)count * sizeof *border);
    dense_lower_apply_transposed(factor->border_factor, count, border);
    cholmod_dense *solution = analysis->permuted;
    if (!cholmod_solve2(CHOLMOD_Lt, factor->numeric, analysis->forward, NULL, &solution, NULL,
                        &analysis->work_y, &analysis->work_e, &analysis->common))
        return FAULT(err, ERROR_MEMORY, "CHOLMOD: the backward substitution failed (status %d)",
                     analysis->common.status);
    analysis->permuted = solution;
    const double *permuted = solution->x;
    for (int32_t k = 0; k < size; k++) x[permutation[k]] = permuted[k];
    return true;
}

// --- many columns at once -----------------------------------------------------------------------

// Columns that are solved for at once: enough for products of matrices, while the work arrays of
// each thread stay small. All values of one unknown stand side by side, so that the rows of a
// supernode, which lie anywhere, are gathered in long pieces.
enum { COLUMNS = 96 };

typedef struct Columns {
    const SparseFactor *factor;
    bool forward;   // to the border, else from it
    const double *from;
    int32_t count, pieces;
    double *to;
} Columns;

// Forward over the interior: L_ii y_i = x_i, then L_bi y_i is taken off x_b. Or backward: L_ii' x_i
// = y_i - L_bi' x_b. x: [columns * n], below: [columns * rows of a supernode].
static void solve_interior(const Columns *all, int32_t columns, double *x, double *below)
{
    const cholmod_factor *factor = all->factor->numeric;
    const int32_t *super = factor->super, *row_start = factor->pi, *value_start = factor->px;
    int32_t interior = (int32_t)factor->n - all->factor->analysis->border_count, nodes = 0;
    size_t row = (size_t)columns * sizeof *x;
    while (nodes < (int32_t)factor->nsuper && super[nodes] < interior) nodes++;
    for (int32_t k = 0; k < nodes; k++) {
        int32_t s = all->forward ? k : nodes - 1 - k;
        int32_t height = row_start[s + 1] - row_start[s];
        int32_t end = super[s + 1] < interior ? super[s + 1] : interior, count = end - super[s];
        const int32_t *rows = (const int32_t *)factor->s + row_start[s] + count;
        const double *panel = (const double *)factor->x + value_start[s];
        double *own = x + (int64_t)super[s] * columns;
        if (all->forward) dense_panel_forward(panel, height, count, columns, own, below);
        for (int32_t i = 0; i < height - count; i++) {
            double *there = x + (int64_t)rows[i] * columns, *here = below + (int64_t)i * columns;
            if (!all->forward) memcpy(here, there, row);
            for (int32_t j = 0; all->forward && j < columns; j++) there[j] -= here[j];
        }
        if (!all->forward) dense_panel_backward(panel, height, count, columns, own, below);
    }
}

// Solves for every chunk of COLUMNS columns whose number is `piece` modulo all.pieces.
static bool solve_piece(void *context, int32_t piece, Error *err)
{
    const Columns *all = context;
    const cholmod_factor *factor = all->factor->numeric;
    const int32_t *permutation = factor->Perm;
    int64_t size = (int64_t)factor->n, count = all->factor->analysis->border_count;
    int64_t interior = size - count, chunk = all->count < COLUMNS ? all->count : COLUMNS;
    int64_t tallest = (int64_t)factor->maxesize + count;   // where one reaches into the border
    double *x = memory_bytes(chunk * size * (int64_t)sizeof *x, err);
    double *below = memory_bytes(chunk * tallest * (int64_t)sizeof *x, err);
    for (int64_t first = (int64_t)piece * COLUMNS; x && below && first < all->count;
         first += (int64_t)all->pieces * COLUMNS) {
        int64_t columns = all->count - first < COLUMNS ? all->count - first : COLUMNS;
        const double *from = all->from + first * (all->forward ? size : count);
        double *to = all->to + first * (all->forward ? count : size);
        for (int64_t k = 0; all->forward && k < size; k++)
            for (int64_t j = 0; j < columns; j++)
                x[k * columns + j] = from[j * size + permutation[k]];
        if (!all->forward) {
            memset(x, 0, (size_t)(interior * columns) * sizeof *x);
            dense_transpose(dense_view(from, count, columns), x + interior * columns, columns);
        }
        solve_interior(all, (int32_t)columns, x, below);
        if (all->forward)
            dense_transpose(dense_view(x + interior * columns, columns, count), to, count);
        for (int64_t k = 0; !all->forward && k < size; k++)
            for (int64_t j = 0; j < columns; j++)
                to[j * size + permutation[k]] = x[k * columns + j];
    }
    memory_free_all(x, below);
    return error_is_clean(err);
}

static bool solve_columns(Columns all, Error *err)
{
    int32_t chunks = (all.count + COLUMNS - 1) / COLUMNS;
    all.pieces = chunks < PARALLEL_WORKERS_MAX ? chunks : PARALLEL_WORKERS_MAX;
    return parallel_try(all.pieces, solve_piece, &all, err);
}

bool sparse_condense_many(const SparseFactor *factor, const double *rhs, int32_t count, double *g,
                          Error *err)
{
    return solve_columns((Columns){factor, true, rhs, count, 0, g}, err);
}

bool sparse_expand_many(const SparseFactor *factor, const double *x_border, int32_t count,
                        double *x, Error *err)
{
    return solve_columns((Columns){factor, false, x_border, count, 0, x}, err);
}
