// SPDX-License-Identifier: GPL-2.0-or-later
// A zlib stream (RFC 1950, 1951) of the rows of a PNG, each as its difference to the row above it
// (filter "up"). A figure is paper and what goes on from row to row, so that pixel after pixel has
// the same difference, mostly none: only such runs are looked for. zlib at level 3, which compares
// every byte with earlier ones, takes ten times as long for a tenth fewer bytes. Called by
// png_encode.
#ifndef AMONTONS_RENDER_CANVAS_RUN_DEFLATE_H
#define AMONTONS_RENDER_CANVAS_RUN_DEFLATE_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct RunDeflate RunDeflate;

// Takes the next bytes of the stream.
typedef void (*RunSink)(void *context, const uint8_t *bytes, size_t length);

RunDeflate *run_deflate_create(RunSink sink, void *context, Error *err);
void run_deflate_destroy(RunDeflate *stream);   // NULL is fine

// The next row, [width] pixels of four bytes, blue, green, red, unused; above: the row before it.
void run_deflate_row(RunDeflate *stream, const uint8_t *row, const uint8_t *above, int32_t width);
void run_deflate_end(RunDeflate *stream);

#endif
