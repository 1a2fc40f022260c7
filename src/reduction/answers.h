// SPDX-License-Identifier: GPL-2.0-or-later
// Answers of the full mesh at points of the strip of reduction/reduction: columns x with A x = r on
// the interface and t f inside, f the unit load. A product of one with any other z is known without
// the mesh: x' A z = r' z_b + t f' z. Used by reduction/growing_basis and reduction/reduction.
#ifndef AMONTONS_REDUCTION_ANSWERS_H
#define AMONTONS_REDUCTION_ANSWERS_H

#include "reduction/interface_operator.h"
#include "reduction/strip.h"

enum {
    ANSWER_BLOCKS_MAX = STRIP_VISITS_MAX + 2,
    ANSWERS_TOGETHER = 96   // columns that are multiplied at once: their image stays in the cache
};

// Those at one point.
typedef struct AnswerBlock {
    StripPoint point;
    int64_t first, count;   // columns
    double *field;   // [dofs] each, x; in a shelf
    double *motion;   // [m + 1] each, x on the interface, then f'x; owned, as what follows
    double *reaction;   // [m + 1] each, r (with t: r less t f there), then t
} AnswerBlock;

// Fields of one kind side by side, so that many blocks are multiplied as one.
typedef struct AnswerShelf {
    double *field;   // [dofs * room]; owned
    int64_t room, filled;   // columns
} AnswerShelf;

typedef struct Answers {
    const BulkOperator *full;   // of the mesh; not owned
    BulkScales scales;
    double *unit_load;   // [dofs] f; owned
    double *image[2];   // [dofs * ANSWERS_TOGETHER] work of two threads; owned
    double *work[2];   // [dofs * SPARSE_WIDE] likewise
    double inertia_least;   // at which the energy of motion counts; set before the third block
    double *product[2];   // [rows * ANSWERS_TOGETHER] likewise, while answers are multiplied
    int32_t shelf_count;
    AnswerShelf shelves[ANSWER_BLOCKS_MAX + 2];   // [shelf_count]
    int32_t shelf_of[2];   // that in use for more elastic answers and for more viscous ones
    int64_t count;   // columns of all blocks
    int32_t block_count;
    AnswerBlock blocks[ANSWER_BLOCKS_MAX + 1];   // [block_count], and the one that comes next
} Answers;

// full: must outlive the answers.
bool answers_create(const BulkOperator *full, const BulkScales *scales, Answers *answers,
                    Error *err);
void answers_destroy(Answers *answers);

// Room for `columns` columns, behind all others: a block that counts from answers_keep on.
AnswerBlock *answers_next(Answers *answers, StripPoint point, int64_t columns, Error *err);
void answers_keep(Answers *answers);
void answers_drop(Answers *answers);   // if it was not kept

// gram [BULK_TERMS][all * added]: X' (K, C, M) X_next, X all columns with those of the next block.
bool answers_multiply(Answers *answers, double *const gram[BULK_TERMS], Error *err);

// y [dofs * columns] += factor X c, of the columns that are kept; c [count * columns].
void answers_combine(const Answers *answers, double factor, const double *c, int64_t columns,
                     double *y);
// product [count * columns] = X' T z; image [dofs * columns]: T z, too.
void answers_project(const Answers *answers, BulkTerm term, const double *z, int64_t columns,
                     double *image, double *product);

#endif
