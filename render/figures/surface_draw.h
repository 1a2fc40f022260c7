// SPDX-License-Identifier: GPL-2.0-or-later
// The surface of a block in colours, with contours, edges of elements and an outline; a block in
// the plane is a surface by itself. Called by block_page and space_page.
#ifndef AMONTONS_RENDER_FIGURES_SURFACE_DRAW_H
#define AMONTONS_RENDER_FIGURES_SURFACE_DRAW_H

#include "render/canvas/colorbar.h"
#include "render/figures/depth_image.h"
#include "render/view/surface.h"

typedef struct SurfaceDrawing {
    const Block *block;
    const Axes *axes;   // of what is drawn: lengths across and up
    const Colorbar *bar;   // contours lie at its numbers
    const SpaceCut *cut;
    bool edges;   // of elements are drawn
    double unit;   // pixels: a point times the size of marks
} SurfaceDrawing;

DepthPoint surface_see(const Block *block, const Axes *axes, const double place[3]);

bool surface_draw(const Page *page, const SurfaceDrawing *drawing, Error *err);

// Its parts. image: NULL in the plane, where nothing hides a line. Colours go from the quantity
// `low` to `high`, or beyond, in the frame of the axes, which is whole pixels.
bool surface_colors(Canvas *canvas, const SurfaceDrawing *drawing, const Surface *surface,
                    double low, double high, const DepthImage *image, Error *err);
void surface_contour(Canvas *canvas, const SurfaceDrawing *drawing, const Surface *surface,
                     double level, const Stroke *stroke, const DepthImage *image);
void surface_lines(Canvas *canvas, const SurfaceDrawing *drawing, const SurfaceParts *lines,
                   const Stroke *stroke, const DepthImage *image);
// Parts along a side of an element in the plane, each some pixels wide; 0 in space.
int32_t surface_parts(const Block *block, const Axes *axes);

#endif
