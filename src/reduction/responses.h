// SPDX-License-Identifier: GPL-2.0-or-later
// Responses of the full mesh at points of the parameter domain of reduction/reduction: columns x
// with A x = r on the interface and t f inside, f the unit load. A product of one with any other z
// is known without the mesh: x' A z = r' z_b + t f' z. Used by reduction/basis and
// reduction/reduction.
#ifndef AMONTONS_REDUCTION_RESPONSES_H
#define AMONTONS_REDUCTION_RESPONSES_H

#include "base/parallel.h"
#include "reduction/interface_operator.h"
#include "reduction/training_points.h"

enum {
    RESPONSE_BLOCKS_MAX = TRAINING_POINTS_MAX + 2,
    RESPONSES_TOGETHER = 96   // columns that are multiplied at once: their image stays in the cache
};

// Responses at one point.
typedef struct ResponseBlock {
    ParameterPoint point;
    bool formed;   // of a basis, no response: 0 on the interface, all its products are by the mesh
    int64_t first, count;   // columns
    double *field;   // [dofs] each, x; in a shelf; NULL: of Psi, released
    double *boundary;   // [m + 1] each, x on the interface, then f'x; owned, as what follows
    double *reaction;   // [m + 1] each, r (with t: r less t f there), then t
} ResponseBlock;

// Fields of one kind side by side, so that many blocks are multiplied as one.
typedef struct ResponseShelf {
    double *field;   // [dofs * room]; owned
    int64_t room, filled;   // columns
} ResponseShelf;

// Work arrays of one thread for products; owned.
typedef struct ResponseRoom {
    double *image;   // [dofs * RESPONSES_TOGETHER]
    double *product;   // [rows * RESPONSES_TOGETHER] while responses are multiplied
} ResponseRoom;

typedef struct Responses {
    const BulkOperator *full;   // of the mesh; not owned
    const InterfaceOperator *statics;   // it at K alone, once Psi is there; not owned
    BulkScales scales;
    int32_t term_count;   // K, C, M and the shape matrices
    double *unit_load;   // [dofs] f; owned
    double inertia_least;   // at which the energy of motion counts; set before the third block
    ResponseRoom room[PARALLEL_WORKERS_MAX];
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
ResponseBlock *responses_last(Responses *responses);   // that one
// Formed columns [dofs * columns], not more than it has, in its place.
void responses_replace(Responses *responses, int64_t columns, const double *field);
void responses_keep(Responses *responses);
void responses_drop(Responses *responses);   // if it was not kept
// The only block so far, the static modes Psi, leaves its fields: from here on Psi'y is what
// `statics`, the mesh at K alone, which must outlive the responses, condenses of y.
void responses_release_statics(Responses *responses, const InterfaceOperator *statics);

// gram [term_count][all * added]: X' (K, C, M, S_j) X_next, X all columns with those of the next
// block.
bool responses_multiply(Responses *responses, double *const *gram, Error *err);

// y [dofs * columns] += X c, of the columns that are kept, 0 on the interface to the last bit; c
// [count * columns].
bool responses_combine(const Responses *responses, const double *c, int64_t columns, double *y,
                       Error *err);

#endif
