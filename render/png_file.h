// SPDX-License-Identifier: GPL-2.0-or-later
// Writes one PNG file, atomically: the final name appears when all is on disk. Called by render.c.
#ifndef AMONTONS_RENDER_PNG_FILE_H
#define AMONTONS_RENDER_PNG_FILE_H

#include "base/error.h"

typedef struct PngPicture {
    int32_t width, height;
    const uint8_t *pixels;   // [height * width * 3] red, green, blue, first row at the top
    double pixels_per_metre;   // at the size it is meant to be printed
    const char *title;   // stored in the file, UTF-8
} PngPicture;

// Same picture, same bytes: no date is stored. Errors (ERROR_FILE) name the path and the cause.
bool png_file_write(const char *path, const PngPicture *picture, Error *err);

#endif
