// SPDX-License-Identifier: GPL-2.0-or-later
// The 256 colours that a picture needs most, for a PNG of one byte a pixel. Called by png_encode.
#ifndef AMONTONS_RENDER_CANVAS_PALETTE_H
#define AMONTONS_RENDER_CANVAS_PALETTE_H

#include "base/error.h"

#include <stdint.h>

enum { PALETTE_SIZE = 256 };

typedef struct PalettePixels {
    int32_t width, height, stride;   // stride: bytes from one row to the next
    const uint8_t *bytes;   // [height * stride] 4 a pixel: blue, green, red, unused
} PalettePixels;

typedef struct Palette {
    int32_t count;
    uint8_t color[PALETTE_SIZE][3];   // [count] red, green, blue
    uint8_t *index;   // [height * width] of the picture; owned
} Palette;

// Colours that agree in their upper five bits are one, their mean; of these the most frequent stay,
// and the others become the nearest of them.
bool palette_make(const PalettePixels *picture, Palette *palette, Error *err);
void palette_destroy(Palette *palette);   // zeroed is fine

#endif
