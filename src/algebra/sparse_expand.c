// SPDX-License-Identifier: GPL-2.0-or-later
// Solves L' x = 0 inside, with x given on the border, for many columns. Rows of x stand together.
// Where supernodes are narrow, as in the plane, each entry of L is read once for up to 16 columns
// and no row is gathered: CHOLMOD's own solve calls BLAS twice for each supernode (160 x 160 cells:
// the same 5 Gflop in a third of the time). Where they are wide, as in space, BLAS multiplies 64
// columns by them.
#include "algebra/lanes.h"
#include "algebra/sparse_analysis.h"

#include <cblas.h>
#include <string.h>

// Entries of L for each unknown from which on supernodes are wide.
enum { WIDE_FROM = 256 };

enum {
    LANES_MAX = PASSAGE_COLUMNS / LANE,
    TOGETHER = 3   // columns of L: 12 sums stay in registers
};

// A supernode of L has `height` rows, from its first column down; the rows of its own columns come
// first.
typedef struct Supernode {
    int32_t first, height;
    const int32_t *rows;   // [height]
    const double *values;   // [height] of each column
} Supernode;

// Unknowns of columns `column` to `column + together - 1` from those below. x: [lanes] of each row.
WITH_CONSTANTS void find_unknowns(const Supernode *node, int32_t column, int together, int lanes,
                                  Lane *x)
{
    Lane sum[TOGETHER][LANES_MAX] = {0};
    const double *entries = node->values + (int64_t)column * node->height;
    for (int32_t row = column + together; row < node->height; row++) {
        const Lane *below = x + (int64_t)node->rows[row] * lanes;
        UNROLLED
        for (int c = 0; c < together; c++) {
            double entry = entries[(int64_t)c * node->height + row];
            UNROLLED
            for (int k = 0; k < lanes; k++) sum[c][k] -= entry * below[k];
        }
    }
    UNROLLED
    for (int c = together - 1; c >= 0; c--) {
        const double *own = entries + (int64_t)c * node->height + column;
        UNROLLED
        for (int d = c + 1; d < together; d++) {
            UNROLLED
            for (int k = 0; k < lanes; k++) sum[c][k] -= own[d] * sum[d][k];
        }
        UNROLLED
        for (int k = 0; k < lanes; k++)
            x[(int64_t)(node->first + column + c) * lanes + k] = sum[c][k] /= own[c];
    }
}

// end: of its columns, those beyond are the border's.
WITH_CONSTANTS void pass_supernode(const Supernode *node, int32_t end, int lanes, Lane *x)
{
    int32_t column = end;
    for (; column >= TOGETHER; column -= TOGETHER)
        find_unknowns(node, column - TOGETHER, TOGETHER, lanes, x);
    if (column == 2) find_unknowns(node, 0, 2, lanes, x);
    if (column == 1) find_unknowns(node, 0, 1, lanes, x);
}

WITH_CONSTANTS void pass_down(const cholmod_factor *factor, int32_t first_border, int lanes,
                              Lane *x)
{
    const int32_t *super = factor->super, *row_start = factor->pi, *value_start = factor->px;
    for (int64_t s = (int64_t)factor->nsuper - 1; s >= 0; s--) {
        Supernode node = {.first = super[s],
                          .height = row_start[s + 1] - row_start[s],
                          .rows = (const int32_t *)factor->s + row_start[s],
                          .values = (const double *)factor->x + value_start[s]};
        int32_t end = super[s + 1] < first_border ? super[s + 1] : first_border;
        pass_supernode(&node, end - node.first, lanes, x);
    }
}

// x: [lanes] of each row; those from `first_border` on are given.
FOR_EACH_PROCESSOR static void pass_with(const cholmod_factor *factor, int32_t first_border,
                                         int lanes, Lane *x)
{
    if (lanes == 1) pass_down(factor, first_border, 1, x);
    if (lanes == 2) pass_down(factor, first_border, 2, x);
    if (lanes == 3) pass_down(factor, first_border, 3, x);
    if (lanes == 4) pass_down(factor, first_border, 4, x);
}

// The same by BLAS for any number of columns. gathered: room for `columns` of all rows of a
// supernode.
static void pass_wide(const cholmod_factor *factor, int32_t first_border, int32_t columns,
                      double *x, double *gathered)
{
    const int32_t *super = factor->super, *row_start = factor->pi, *value_start = factor->px;
    for (int64_t s = (int64_t)factor->nsuper - 1; s >= 0; s--) {
        int32_t end = super[s + 1] < first_border ? super[s + 1] : first_border,
                own = end - super[s];
        int32_t height = row_start[s + 1] - row_start[s], below = height - own;
        const int32_t *rows = (const int32_t *)factor->s + row_start[s] + own;
        const double *values = (const double *)factor->x + value_start[s];
        double *unknowns = x + (int64_t)super[s] * columns;
        if (own <= 0) continue;
        for (int32_t k = 0; k < below; k++)
            memcpy(gathered + (int64_t)k * columns, x + (int64_t)rows[k] * columns,
                   (size_t)columns * sizeof *x);
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, columns, own, below, -1, gathered,
                    columns, values + own, height, 0, unknowns, columns);
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, columns, own,
                    1, values, height, unknowns, columns);
    }
}

typedef struct Expansion {
    SparseFactor *factor;
    const double *x_border;   // [border_count * count]
    int32_t count, passes;
    bool wide_supernodes;
    double *x;   // [size * count]
} Expansion;

// work: rows of x, `stride` columns in each, and behind them room for what pass_wide gathers.
static void expand_columns(const Expansion *all, int32_t first, int32_t columns, double *work)
{
    const SparseAnalysis *analysis = all->factor->analysis;
    const int32_t *permutation = all->factor->numeric->Perm;
    int32_t lanes = (columns + LANE - 1) / LANE;
    int32_t stride = all->wide_supernodes ? columns : lanes * LANE;
    int64_t size = analysis->size, border_count = analysis->border_count;
    int32_t first_border = (int32_t)(size - border_count);
    double *given = work + first_border * (int64_t)stride;
    for (int64_t k = 0; k < border_count; k++)
        for (int32_t j = 0; j < stride; j++)
            given[k * stride + j] = j < columns ? all->x_border[(first + j) * border_count + k] : 0;
    if (all->wide_supernodes)
        pass_wide(all->factor->numeric, first_border, stride, work, work + size * stride);
    else
        pass_with(all->factor->numeric, first_border, lanes, (Lane *)work);
    for (int32_t j = 0; j < columns; j++) {
        double *out = all->x + (first + j) * size;
        for (int64_t k = 0; k < size; k++) out[permutation[k]] = work[k * stride + j];
    }
}

static void expand_pass(void *context, int32_t pass, int32_t worker)
{
    const Expansion *all = context;
    int32_t first = (int32_t)((int64_t)all->count * pass / all->passes);
    int32_t end = (int32_t)((int64_t)all->count * (pass + 1) / all->passes);
    expand_columns(all, first, end - first, all->factor->analysis->passages[worker]->x);
}

bool sparse_expand_many(SparseFactor *factor, const double *x_border, int32_t count, double *x,
                        Error *err)
{
    SparseAnalysis *analysis = factor->analysis;
    const cholmod_factor *symbolic = analysis->symbolic;
    bool wide_supernodes = symbolic->xsize > WIDE_FROM * (size_t)analysis->size;
    int32_t columns = wide_supernodes ? PASSAGE_COLUMNS_WIDE : PASSAGE_COLUMNS;
    // Work arrays are kept: memory asked for anew comes page by page.
    for (int32_t k = 0; k < parallel_workers(); k++) {
        cholmod_dense **work = &analysis->passages[k];
        size_t gathered = wide_supernodes ? symbolic->maxesize + (size_t)analysis->border_count : 0;
        if (!*work)
            *work = cholmod_zeros((size_t)analysis->size + gathered, (size_t)columns, CHOLMOD_REAL,
                                  &analysis->common);
        if (!*work)
            return FAULT(err, ERROR_MEMORY, "no memory for %d answers of a factor", columns);
    }
    // Passes have as many columns each, as a few alone take as long as many.
    Expansion all = {.factor = factor,
                     .x_border = x_border,
                     .count = count,
                     .passes = (count + columns - 1) / columns,
                     .wide_supernodes = wide_supernodes,
                     .x = x};
    parallel_for(all.passes, expand_pass, &all);
    return true;
}
