// SPDX-License-Identifier: GPL-2.0-or-later
// The elements of a block as small triangles, of which pixels, contour lines and edges are made.
// Inside an element the quantity follows its shape functions, so that elements of order 2 are
// smooth. Called by the figures of fields.
#ifndef AMONTONS_RENDER_BLOCK_MESH_H
#define AMONTONS_RENDER_BLOCK_MESH_H

#include "render/axes.h"
#include "render/block.h"

// Pixels of a part of the picture, a value each.
typedef struct BlockRaster {
    Box box;   // whole pixels
    int32_t width, height;
    float *values;   // [height * width] first row at the top; NaN: outside of the block; owned
} BlockRaster;

// The value at the middle of each pixel of `box`. axes: where the block's places lie.
bool block_raster_fill(const Block *block, const Axes *axes, const Box *box, BlockRaster *raster,
                       Error *err);
void block_raster_destroy(BlockRaster *raster);   // zeroed is fine

// Lines where the quantity is `level`, and a line round the block.
bool block_contour_draw(const Page *page, const Block *block, const Axes *axes, double level,
                        const Stroke *stroke, Error *err);
bool block_outline_draw(const Page *page, const Block *block, const Axes *axes,
                        const Stroke *stroke, Error *err);
void block_edges_draw(const Page *page, const Block *block, const Axes *axes, const Stroke *stroke);

#endif
