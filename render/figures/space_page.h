// SPDX-License-Identifier: GPL-2.0-or-later
// A block in space on a page: in perspective, deformed, cut open where that is asked; below it, as
// if the floor had been let down, what each part of the contact does. Part of block_page.
#ifndef AMONTONS_RENDER_FIGURES_SPACE_PAGE_H
#define AMONTONS_RENDER_FIGURES_SPACE_PAGE_H

#include "render/canvas/colorbar.h"
#include "render/view/surface.h"

typedef struct SpacePage {
    const ResultView *view;   // its plane has been read, if it has one
    const SpaceCut *cut;
    bool edges;
    double unit;   // pixels: a point times the size of marks
    Axes axes;   // of what the camera sees: lengths across and up
    const Colorbar *bar;
    Color status[4];   // of the contact, by its numbers in the history
} SpacePage;

// Finds where the camera sees the corners of its floor.
void space_page_floor_corners(const Block *block, double corner[4][2]);

bool space_page_draw(const Page *page, const SpacePage *space, const Block *block, Error *err);
// The floor alone, at a step of the history; the block is one of the same result.
void space_page_floor(const Page *page, const SpacePage *space, const Block *block, int64_t row);
// Numbers and names along the floor's edges and up the block's side.
void space_page_axes(const Page *page, const SpacePage *space, const Block *block);

#endif
