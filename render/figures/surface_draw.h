// SPDX-License-Identifier: GPL-2.0-or-later
// The surface of a block in colours, with contours, edges of elements and an outline; a block in
// the plane is a surface by itself. Called by block_page.
#ifndef AMONTONS_RENDER_FIGURES_SURFACE_DRAW_H
#define AMONTONS_RENDER_FIGURES_SURFACE_DRAW_H

#include "render/canvas/colorbar.h"
#include "render/canvas/page.h"
#include "render/view/surface.h"

typedef struct DepthPoint {
    Point at;   // pixels of the page
    double depth;   // as GlCorner has it
} DepthPoint;

typedef struct DepthImage {
    Box box;   // of the page, that the triangles were drawn in; whole pixels
    int32_t columns, rows;   // pixels in it
    float *depth;   // [rows * columns] of the nearest triangle, as GlImageDef has it; owned
    double slack;   // what is farther than the image by no more lies on it
} DepthImage;

typedef struct BlockPage {
    const ResultView *view;   // its statuses have been read, and its plane, if it has one
    bool edges;   // of elements are drawn
    SpaceCut cut;   // of a block in space
    double share;   // of the sizes of marks: 1, or less on a small picture
    const PictureStyle *style;   // whose limits the colours have; NULL: those that fit
    double magnification;   // of the deformation; 0: block_page_fit chooses it
    Colorbar bar;   // contours lie at its numbers; block_page_fit sets it
    double extent[4];   // of the blocks as drawn, low and high of x, then of z; by block_page_fit
    double scale;   // points a length; block_page_size sets it, like the next
    double width, height;   // points: of the block with load, rod and contact
} BlockPage;

DepthPoint surface_see(const Block *block, const Axes *axes, const double place[3]);

// axes: of what is drawn, lengths across and up.
bool surface_draw(const Page *page, const BlockPage *map, const Block *block, const Axes *axes,
                  Error *err);

// Its parts. image: NULL in the plane, where nothing hides a line. Colours go from the quantity
// `low` to `high`, or beyond, in the frame of the axes, which is whole pixels.
bool surface_colors(Canvas *canvas, const Block *block, const Axes *axes, const Surface *surface,
                    double low, double high, const DepthImage *image, Error *err);
void surface_contour(Canvas *canvas, const Block *block, const Axes *axes, const Surface *surface,
                     double level, const Stroke *stroke, const DepthImage *image);
void surface_lines(Canvas *canvas, const Block *block, const Axes *axes, const SurfaceParts *lines,
                   const Stroke *stroke, const DepthImage *image);
// Parts along a side of an element in the plane, each some pixels wide; 0 in space.
int32_t surface_parts(const Block *block, const Axes *axes);

// A line among triangles: what these hide of it is not drawn.
void depth_image_line(const DepthImage *image, Canvas *canvas, const Stroke *stroke,
                      const DepthPoint ends[2]);

#endif
