// SPDX-License-Identifier: GPL-2.0-or-later
// The elements of a block as small triangles, of which pixels, contour lines and edges are made.
// Inside an element the quantity follows its shape functions, so that elements of order 2 are
// smooth. Called by the figures of fields.
#ifndef AMONTONS_RENDER_FIGURES_BLOCK_MESH_H
#define AMONTONS_RENDER_FIGURES_BLOCK_MESH_H

#include "render/canvas/axes.h"
#include "render/view/block.h"

// The block in colours, from the quantity `low` to `high`, or beyond, in the frame of the axes,
// which is whole pixels.
bool block_colors_draw(Canvas *canvas, const Block *block, const Axes *axes, double low,
                       double high, Error *err);

// Lines where the quantity is `level`, and a line round the block.
void block_contour_draw(const Page *page, const Block *block, const Axes *axes, double level,
                        const Stroke *stroke);
bool block_outline_draw(const Page *page, const Block *block, const Axes *axes,
                        const Stroke *stroke, Error *err);
void block_edges_draw(const Page *page, const Block *block, const Axes *axes, const Stroke *stroke);

#endif
