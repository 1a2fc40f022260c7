// SPDX-License-Identifier: GPL-2.0-or-later
// The border comes last. Before it stands the interior in an order of few entries in L: by nested
// dissection where places are known (algebra/sparse_order), else by CAMD.
#include "algebra/sparse_analysis.h"

#include "algebra/sparse_order.h"
#include "base/memory.h"

#include <string.h>

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

// True if the analysis left the border last, in the caller's order.
static bool border_is_last(const SparseAnalysis *analysis, const int32_t *border)
{
    int64_t count = analysis->border_count, first = analysis->size - count;
    const int32_t *permutation = analysis->symbolic->Perm;
    return memcmp(permutation + first, border, (size_t)count * sizeof *border) == 0;
}

static ErrorCode error_code_of(const cholmod_common *common)
{
    return common->status == CHOLMOD_OUT_OF_MEMORY ? ERROR_MEMORY : ERROR_LIBRARY;
}

// Symbolic factorisation in the given `order` [n]; an earlier one is dropped.
static bool analyse_in_order(SparseAnalysis *analysis, int32_t *order, bool postorder, Error *err)
{
    cholmod_common *common = &analysis->common;
    cholmod_free_factor(&analysis->symbolic, common);
    common->postorder = postorder;
    analysis->symbolic = cholmod_analyze_p(&analysis->pattern, order, NULL, 0, common);
    if (!analysis->symbolic)
        return FAULT(err, error_code_of(common), "CHOLMOD: the analysis failed (status %d)",
                     common->status);
    return true;
}

// The order that keeps the border last, checked. Postordering makes larger supernodes and keeps the
// border where it is when the interior is connected, as in a mesh; where it is not, the order is
// taken as it is.
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
    TRY(analyse_in_order(analysis, order, true, err));
    if (!border_is_last(analysis, border)) TRY(analyse_in_order(analysis, order, false, err));
    if (!border_is_last(analysis, border))
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
