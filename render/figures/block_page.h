// SPDX-License-Identifier: GPL-2.0-or-later
// A block at one time on a page: its field in colours, what holds, drives and presses it. In space
// it is seen in perspective, cut open where that is asked; below it, as if the floor had been let
// down, what each part of the contact does. Called by
// figure_field and figure_strip.
#ifndef AMONTONS_RENDER_FIGURES_BLOCK_PAGE_H
#define AMONTONS_RENDER_FIGURES_BLOCK_PAGE_H

#include "render/figures/surface_draw.h"

// Reads as space_cut_read does. ERROR_INPUT also where the block is in the plane.
bool block_cut_read(const ResultView *view, const char *words, SpaceCut *cut, Error *err);

// Deforms all of [count] blocks by map->magnification, by the least that suits any of them where it
// is 0, and finds what they take as drawn. Fits low, high and ticks of the bar to the values of
// all, but for the outermost of them, which singular corners have.
bool block_page_fit(BlockPage *map, Block *blocks, int32_t count, BlockQuantity quantity,
                    Error *err);
// Fits to [count] times of a source, whose quantity is shown.
bool block_page_sample(BlockPage *map, const BlockSource *source, const int32_t *index,
                       int32_t count, Error *err);

// Scale, width and height, in points, of the block with what stands beside it: as wide as `width`,
// or less where it would be higher than most_height.
void block_page_size(BlockPage *map, double width, double most_height);
// Ranges and box of the axes with that size, its corner at left and top, pixels.
void block_page_place(const Page *page, const BlockPage *map, double left, double top, Axes *axes);

// Draws into axes->box; colours and lines.
bool block_page_draw(const Page *page, const BlockPage *map, const Block *block, const Axes *axes,
                     Error *err);

// Draws the statuses of the contact at a step of the history below the block, each where its node
// is drawn; part of block_page_draw. block: one of this result.
void block_page_contact(const Page *page, const BlockPage *map, const Block *block, int64_t row,
                        const Axes *axes);

// Frame, numbers and names; of a block in space along its edges.
void block_page_axes(const Page *page, const BlockPage *map, const Block *block, const Axes *axes);

// Draws the meaning of the contact's colours, from `place` to the right; below > 0: four lines so
// many points apart under one that says "contact".
void block_page_legend(const Page *page, Point place, double below);

#endif
