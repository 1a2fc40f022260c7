// SPDX-License-Identifier: GPL-2.0-or-later
// What base/sparse_analysis makes and base/sparse_factor, which alone includes this, works with.
#ifndef AMONTONS_BASE_SPARSE_ANALYSIS_H
#define AMONTONS_BASE_SPARSE_ANALYSIS_H

#include "base/sparse.h"

#include <cholmod.h>

enum { PASSAGE_COLUMNS = 48 };   // columns of one pass over a factor

// Work space of passes over a factor with many columns, of one thread.
typedef struct Passage {
    cholmod_common common;
    cholmod_dense *columns;   // [size * TOGETHER]; NULL: not open
    cholmod_dense *work;
} Passage;

struct SparseAnalysis {
    cholmod_common common;
    bool started;
    int32_t size;
    cholmod_factor *symbolic;
    cholmod_sparse *ordered;   // the matrix in L's order, its lower triangle (stype -1)
    int32_t *source;   // [entries of it] where they stand among the caller's values
    cholmod_factor *spare;   // of a factor that was destroyed: the next one's memory; NULL: none
    int32_t border_count;
    int32_t *border_position;   // [border_count] where border[j] stands in L's border
    cholmod_dense *forward;   // solve2's workspaces, shared by all factors
    cholmod_dense *work_y, *work_e;
    cholmod_dense *permuted;   // right-hand side in L's order
    Passage passages[2];
};

// Kept from call to call: memory that is asked for anew comes page by page.
bool sparse_open_passage(const SparseAnalysis *analysis, Passage *passage, Error *err);

#endif
