// SPDX-License-Identifier: GPL-2.0-or-later
// Lines among triangles in space: what these hide of them is not drawn. Called by space_page.
#ifndef AMONTONS_RENDER_FIGURES_DEPTH_IMAGE_H
#define AMONTONS_RENDER_FIGURES_DEPTH_IMAGE_H

#include "render/canvas/page.h"

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

void depth_image_line(const DepthImage *image, Canvas *canvas, const Stroke *stroke,
                      const DepthPoint ends[2]);

#endif
