// SPDX-License-Identifier: GPL-2.0-or-later
// The block at one stored time, as a picture shows it: which time, deformed by how much, and one
// quantity at its nodes. Numbers only. Called by the figures of fields.
#ifndef AMONTONS_RENDER_VIEW_BLOCK_H
#define AMONTONS_RENDER_VIEW_BLOCK_H

#include "amontons_pictures.h"
#include "io/fields/field_read.h"
#include "render/view/camera.h"
#include "render/view/result_view.h"
#include "render/quantities.h"

typedef enum BlockQuantity {
#define X(symbol, name, words, si, normalised) symbol,
    BLOCK_QUANTITIES(X) BLOCK_QUANTITY_COUNT
#undef X
} BlockQuantity;

typedef struct BlockWords {
    const char *name, *words, *si, *normalised;
} BlockWords;
BlockWords block_words(BlockQuantity quantity);
// ERROR_INPUT lists the names. NULL: von_mises.
bool block_quantity_find(const char *name, BlockQuantity *quantity, Error *err);

typedef struct Block {
    FieldFrame frame;   // owned, like all
    double t, U;   // of this time; U by the history
    int64_t row;   // of the history, the nearest step
    double *value;   // [frame.node_count] the quantity
    double (
        *place)[2];   // [frame.node_count] (x, z) as drawn, in space as seen by the camera; length
    double (*moved)[3];   // [frame.node_count] (x, y, z) as drawn; NULL in the plane
    double low[3], high[3];   // in space: extent before anything moved
    Camera camera;
} Block;

// The fields stored in a result.
typedef struct BlockSource {
    const char *folder;   // borrowed, like the view
    ResultView *view;
    BlockQuantity quantity;   // that blocks are read with
    double depth;   // of a base, below its floor: what lies deeper is left out; 0: nothing is
    int32_t count;   // times, rising
    FieldTime *times;   // [count] owned
    int64_t *row;   // [count] of the history, the nearest; owned
} BlockSource;
bool block_source_open(BlockSource *source, Error *err);   // folder, view and quantity are given
void block_source_close(BlockSource *source);   // zeroed is fine
bool block_is_stored(const char *folder);   // whether there are fields

// "U=0.0117" or "t=120" as a number of one of the two; ERROR_INPUT: neither of them.
bool block_moment_read(const char *at, bool *is_U, double *value, Error *err);
// The same; ERROR_INPUT also where it lies outside of the history by more than 1 % of it: the last
// step may end short of what the scene says.
bool block_moment_seen(const ResultView *view, const char *at, bool *is_U, double *value,
                       Error *err);
// The index of the time nearest to such a moment.
bool block_time_find(const BlockSource *source, const char *at, int32_t *index, Error *err);
// The last one up to this displacement of the rod; the first where there is none.
int32_t block_time_before(const BlockSource *source, double U);

bool block_read(const BlockSource *source, int32_t index, Block *block, Error *err);
void block_destroy(Block *block);   // zeroed is fine
// Fills block->value with another quantity.
bool block_take(Block *block, BlockQuantity quantity, Error *err);

// 1, 2 or 5 times a power of ten: the deformation then shows, but folds nothing over.
double block_magnification(const Block *block);
// Fills block->place: position and `magnification` times the displacement less its mean along x,
// which is how far the whole block has been pushed.
void block_deform(Block *block, double magnification);
// In place: so much of the way to the values and places of `other`, a block of as many nodes.
void block_mix(Block *block, const Block *other, double part);

#endif
