// SPDX-License-Identifier: GPL-2.0-or-later
// The analysis that algebra/sparse_analysis makes and algebra/sparse_factor uses. Nobody else
// includes this.
#ifndef AMONTONS_ALGEBRA_SPARSE_ANALYSIS_H
#define AMONTONS_ALGEBRA_SPARSE_ANALYSIS_H

#include "algebra/sparse.h"

#include <cholmod.h>

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

struct SparseFactor {
    SparseAnalysis *analysis;   // not owned
    cholmod_factor *numeric;
    double *border_factor;   // L_bb
};

#endif
