// SPDX-License-Identifier: GPL-2.0-or-later
// The bytes of a PNG file from the pixels of a Cairo image. Called by canvas.
#ifndef AMONTONS_RENDER_CANVAS_PNG_ENCODE_H
#define AMONTONS_RENDER_CANVAS_PNG_ENCODE_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct PngPicture {
    int32_t width, height, stride;   // stride: bytes from one row to the next
    const uint8_t *pixels;   // [height * stride] 4 bytes each: blue, green, red, unused
    double pixels_per_metre;   // at the size it is meant to be printed
    const char *title;   // stored in the file, UTF-8
    bool few_colors;   // a palette of the 256 most frequent: for a screen, a third of the bytes
} PngPicture;

// Takes the next bytes of the file; false: it failed, and its owner knows why.
typedef bool (*PngSink)(void *context, const uint8_t *bytes, size_t length);

// Same picture, same bytes: no date is stored.
bool png_encode(const PngPicture *picture, PngSink sink, void *context, Error *err);

#endif
