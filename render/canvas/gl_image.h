// SPDX-License-Identifier: GPL-2.0-or-later
// An image made of pixels, drawn off-screen by OpenGL 3.3: triangles between whose corners a value
// is linear, or values in rows and columns, shown through a table of colours. This file and
// gl_image.c are all that knows OpenGL and where it comes from: OSMesa, or EGL without a surface
// where there is no OSMesa (Mesa 25.1 dropped it). Neither is loaded before the first image. Called
// by canvas.c.
#ifndef AMONTONS_RENDER_CANVAS_GL_IMAGE_H
#define AMONTONS_RENDER_CANVAS_GL_IMAGE_H

#include "base/error.h"

typedef enum GlSource { GL_OSMESA, GL_EGL, GL_SOURCES } GlSource;   // the second where no first

typedef struct GlCorner {
    float x, y;   // pixels, (0, 0) the upper left corner of the image, y downwards
    float value;
    float depth;   // from 0, the nearest, to 1, where nothing is drawn any more; 0 in a plane
} GlCorner;

typedef struct GlImageDef {
    int32_t width, height, stride;   // pixels; of the rows in memory
    const uint32_t *colors;   // [color_count] from value 0 to value 1; beyond: the last ones
    int32_t color_count;
    // Values, [rows * columns] first row at the top, or NULL: then triangles. From -1.5 to 0 they
    // have the colour `below`, lower ones none: the pixel stays what it is.
    const float *values;
    int32_t columns, rows;
    uint32_t below;
    const GlCorner *corners;   // [corner_count] three a triangle
    int64_t corner_count;
    // Filled where it is not NULL, [height * width]: depth of the nearest triangle, 1: there is
    // none. Only that triangle is drawn; without it each is drawn over the ones before.
    float *depth;
} GlImageDef;

// Draws over pixels [height * stride]. ERROR_LIBRARY: no OpenGL from `first` on, or not that large.
bool gl_image_draw(GlSource first, const GlImageDef *def, uint32_t *pixels, Error *err);

#endif
