// SPDX-License-Identifier: GPL-2.0-or-later
// The block in a film: which stored field each frame shows, or which two of them mixed, and how
// long it stands still. Called by film_page.
#ifndef AMONTONS_RENDER_FILM_FILM_BLOCK_H
#define AMONTONS_RENDER_FILM_FILM_BLOCK_H

#include "render/figures/block_page.h"
#include "render/film/film_clock.h"

typedef struct FilmBlock {
    const FilmClock *clock;
    BlockSource source;   // folder, view and quantity are given; owned
    BlockPage map;   // view, share and magnification are given
    int32_t U_decimals;
    int32_t *stored;   // [clock->frames] the field nearest in time; NULL: there are none; owned
    int32_t still, still_most;   // frames for which the block has stood, and did at most
    int32_t shown;   // the one that stands on the page; -1: none, or a mixture
    Block pair[2];   // of neighbouring steps, to be mixed; owned
    int32_t pair_index[2];   // of `source`; -1: none
    Block block;   // that which is shown, its field; owned
    Axes axes;
} FilmBlock;

// Finds the fields, `stored` NULL where there are none.
bool film_block_open(FilmBlock *film, Error *err);
void film_block_close(FilmBlock *film);   // zeroed is fine

// Scale and place in `cell`, to scale, with its colour bar at its right.
bool film_block_place(const Page *page, const Box *cell, FilmBlock *film, Error *err);
void film_block_draw(const Page *page, const FilmBlock *film);   // what stands: bar and legend

// The block at frame k, at time t: over what is on the page of it.
bool film_block_show(const Page *page, FilmBlock *film, int32_t k, double t, Error *err);
// Draws the statuses of the contact at a step.
void film_block_contact(const Page *page, const FilmBlock *film, int64_t row);

#endif
