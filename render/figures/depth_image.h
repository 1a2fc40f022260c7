// SPDX-License-Identifier: GPL-2.0-or-later
// Triangles in space as an image: at each pixel the value of the nearest; and which lines it does
// not hide. Called by space_page.
#ifndef AMONTONS_RENDER_FIGURES_DEPTH_IMAGE_H
#define AMONTONS_RENDER_FIGURES_DEPTH_IMAGE_H

#include "render/canvas/page.h"

typedef struct DepthPoint {
    Point at;   // pixels, from the image's upper left corner
    double depth;   // how far from the camera
    double value;
} DepthPoint;

typedef struct DepthImage {
    int32_t columns, rows;
    float *values;   // [rows * columns] NaN: nothing; owned, like depth
    double *depth;   // [rows * columns] INFINITY: nothing
    double slack;   // what is farther than the image by no more lies on it
} DepthImage;

bool depth_image_create(int32_t columns, int32_t rows, double slack, DepthImage *image, Error *err);
void depth_image_destroy(DepthImage *image);   // zeroed is fine
void depth_image_add(DepthImage *image, const DepthPoint corner[3]);

// Draws what is seen of the line; `corner` is where the image's upper left corner lies.
void depth_image_line(const DepthImage *image, Canvas *canvas, Point corner, const Stroke *stroke,
                      const DepthPoint ends[2]);

#endif
