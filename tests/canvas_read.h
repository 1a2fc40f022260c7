// SPDX-License-Identifier: GPL-2.0-or-later
// Reads what is drawn on a canvas so far, for tests.
#ifndef AMONTONS_TESTS_CANVAS_READ_H
#define AMONTONS_TESTS_CANVAS_READ_H

#include "base/memory.h"
#include "render/canvas/canvas.h"

// *pixels [height * width * 3] bytes, red, green, blue, first row at the top (memory_free).
static inline bool canvas_read(Canvas *canvas, uint8_t **pixels, Error *err)
{
    int32_t width = canvas_width(canvas), height = canvas_height(canvas), stride = 0;
    const uint8_t *from = canvas_pixels(canvas, &stride, err);
    *pixels = from ? memory_bytes(3 * (int64_t)width * height, err) : NULL;
    for (int32_t row = 0; *pixels && row < height; ++row)
        for (int32_t k = 0; k < 3 * width; ++k)
            (*pixels)[(int64_t)row * 3 * width + k] =
                from[(int64_t)row * stride + 4 * (k / 3) + 2 - k % 3];
    return *pixels != NULL;
}

#endif
