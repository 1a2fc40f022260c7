// SPDX-License-Identifier: GPL-2.0-or-later
// The bytes of a PNG file from the pixels of a Cairo image. Called by canvas.
#ifndef AMONTONS_RENDER_CANVAS_PNG_ENCODE_H
#define AMONTONS_RENDER_CANVAS_PNG_ENCODE_H

#include "base/error.h"

#include <stdint.h>
#include <stdio.h>

typedef struct PngPicture {
    int32_t width, height, stride;   // stride: bytes from one row to the next
    const uint8_t *pixels;   // [height * stride] 4 bytes each: blue, green, red, unused
    double pixels_per_metre;   // at the size it is meant to be printed
    const char *title;   // stored in the file, UTF-8
    bool few_colors;   // a palette of the 256 most frequent: for a screen, a third of the bytes
} PngPicture;

// Same picture, same bytes: no date is stored.
bool png_encode(const PngPicture *picture, FILE *out, Error *err);

#endif
