// SPDX-License-Identifier: GPL-2.0-or-later
// Responses of the full mesh at points of the parameter domain of reduction/reduction: columns x
// with A x = r on the interface and t f inside, f the unit load. A product of one with any other z
// is known without the mesh: x' A z = r' z_b + t f' z. Used by reduction/growing_basis and
// reduction/reduction.
#ifndef AMONTONS_REDUCTION_RESPONSES_H
#define AMONTONS_REDUCTION_RESPONSES_H

#include "reduction/interface_operator.h"
#include "reduction/training_points.h"

enum {
    RESPONSE_BLOCKS_MAX = TRAINING_POINTS_MAX + 2,
    RESPONSES_TOGETHER = 96   // columns that are multiplied at once: their image stays in the cache
};

// Those at one point.
typedef struct ResponseBlock {
    ParameterPoint point;
    int64_t first, count;   // columns
    double *field;   // [dofs] each, x; in a shelf
    double *boundary;   // [m + 1] each, x on the interface, then f'x; owned, as what follows
    double *reaction;   // [m + 1] each, r (with t: r less t f there), then t
} ResponseBlock;

// Fields of one kind side by side, so that many blocks are multiplied as one.
typedef struct ResponseShelf {
    double *field;   // [dofs * room]; owned
    int64_t room, filled;   // columns
} ResponseShelf;

typedef struct Responses {
    const BulkOperator *full;   // of the mesh; not owned
    BulkScales scales;
    double *unit_load;   // [dofs] f; owned
    double *image[2];   // [dofs * RESPONSES_TOGETHER] work of two threads; owned
    double *work[2];   // [dofs * SPARSE_WIDE] likewise
    double inertia_least;   // at which the energy of motion counts; set before the third block
    double *product[2];   // [rows * RESPONSES_TOGETHER] likewise, while responses are multiplied
    int32_t shelf_count;
    ResponseShelf shelves[RESPONSE_BLOCKS_MAX + 2];   // [shelf_count]
    int32_t shelf_of[2];   // that in use for more elastic responses and for more viscous ones
    int64_t count;   // columns of all blocks
    int32_t block_count;
    ResponseBlock blocks[RESPONSE_BLOCKS_MAX + 1];   // [block_count], and the one that comes next
} Responses;

// full: must outlive the responses.
bool responses_create(const BulkOperator *full, const BulkScales *scales, Responses *responses,
                      Error *err);
void responses_destroy(Responses *responses);

// Room for `columns` columns, behind all others: a block that counts from responses_keep on.
ResponseBlock *responses_next(Responses *responses, ParameterPoint point, int64_t columns,
                              Error *err);
void responses_keep(Responses *responses);
void responses_drop(Responses *responses);   // if it was not kept

// gram [BULK_TERMS][all * added]: X' (K, C, M) X_next, X all columns with those of the next block.
bool responses_multiply(Responses *responses, double *const gram[BULK_TERMS], Error *err);

// y [dofs * columns] += factor X c, of the columns that are kept; c [count * columns].
void responses_combine(const Responses *responses, double factor, const double *c, int64_t columns,
                       double *y);
// product [count * columns] = X' T z; image [dofs * columns]: T z, too.
void responses_project(const Responses *responses, BulkTerm term, const double *z, int64_t columns,
                       double *image, double *product);

#endif
