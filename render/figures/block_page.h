// SPDX-License-Identifier: GPL-2.0-or-later
// A block at one time on a page: its field in colours, what holds, drives and presses it. Called by
// figure_field and figure_strip.
#ifndef AMONTONS_RENDER_FIGURES_BLOCK_PAGE_H
#define AMONTONS_RENDER_FIGURES_BLOCK_PAGE_H

#include "render/canvas/colorbar.h"
#include "render/canvas/page.h"
#include "render/view/surface.h"

typedef struct BlockPage {
    const ResultView *view;   // its statuses have been read
    bool edges;   // of elements are drawn
    const SpaceCut *cut;   // of a block in space; NULL: none
    double share;   // of the sizes of marks: 1, or less on a small picture
    const PictureStyle *style;   // whose limits the colours have; NULL: those that fit
    Colorbar bar;   // block_page_fit sets it
} BlockPage;

// Reads as space_cut_read does. ERROR_INPUT also where the block is in the plane.
bool block_cut_read(const ResultView *view, const char *words, SpaceCut *cut, Error *err);

// Deforms all of [count] blocks by *magnification, by the least that suits any of them where it is
// 0, and finds what they take as drawn: low and high of x, then of z.
void block_page_deform(Block *blocks, int32_t count, double *magnification, double extent[4]);

// Width in points, of the block and what stands beside it, becomes the scale: points a length.
double block_page_scale(const double extent[4], double width, double share);
// Points of height that the block then takes, with load and contact.
double block_page_height(const double extent[4], double scale, double share);
// Ranges of the axes whose box has such a width and height.
void block_page_ranges(const double extent[4], double scale, double share, Axes *axes);

// Fits low, high and ticks of the bar to the values of all blocks, but for the outermost of them,
// which singular corners have.
bool block_page_fit(BlockPage *map, const Block *blocks, int32_t count, BlockQuantity quantity,
                    Error *err);

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
