// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/palette.h"

#include "base/memory.h"

#include <stdlib.h>

enum { BITS = 5, DROPPED = 8 - BITS, BINS = 1 << 3 * BITS };

// Pixels whose colours agree in their upper bits.
typedef struct Bin {
    int64_t sum[3];
    int32_t count, place;   // place: in the table, then in the palette
} Bin;

// Bin of a pixel, whose bytes are blue, green, red.
static int32_t bin_of(const uint8_t *pixel)
{
    return pixel[2] >> DROPPED << 2 * BITS | pixel[1] >> DROPPED << BITS | pixel[0] >> DROPPED;
}

// The most frequent first; equally frequent ones by their place: same picture, same palette.
static int compare_bins(const void *left, const void *right)
{
    const Bin *a = left, *b = right;
    if (a->count != b->count) return a->count < b->count ? 1 : -1;
    return a->place - b->place;
}

// The colour of the palette nearest to the mean of a bin.
static uint8_t nearest(const Palette *palette, const Bin *bin)
{
    int64_t least = INT64_MAX;
    int32_t best = 0;
    for (int32_t k = 0; k < palette->count; ++k) {
        int64_t distance = 0;
        for (int32_t c = 0; c < 3; ++c) {
            int64_t away = bin->sum[c] / bin->count - palette->color[k][c];
            distance += away * away;
        }
        if (distance >= least) continue;
        least = distance;
        best = k;
    }
    return (uint8_t)best;
}

bool palette_make(const PalettePixels *picture, Palette *palette, Error *err)
{
    int64_t pixels = (int64_t)picture->width * picture->height;
    int32_t used = 0;
    uint8_t *of_bin = NULL;
    *palette = (Palette){0};
    Bin *bins = NEW_ARRAY(Bin, BINS, err);
    TRY(bins);
    TRY(of_bin = NEW_ARRAY(uint8_t, BINS, err));
    TRY(palette->index = memory_bytes(pixels, err));
    for (int32_t row = 0; row < picture->height; ++row) {
        const uint8_t *pixel = picture->bytes + (int64_t)row * picture->stride;
        for (int32_t k = 0; k < picture->width; ++k, pixel += 4) {
            Bin *bin = &bins[bin_of(pixel)];
            for (int32_t c = 0; c < 3; ++c) bin->sum[c] += pixel[2 - c];
            ++bin->count;
        }
    }

    // Bins that hold pixels, `used` of them, are moved to the front and sorted.
    used = 0;
    for (int32_t k = 0; k < BINS; ++k) {
        if (bins[k].count == 0) continue;
        bins[k].place = k;
        bins[used++] = bins[k];
    }
    qsort(bins, (size_t)used, sizeof *bins, compare_bins);

    palette->count = used < PALETTE_SIZE ? used : PALETTE_SIZE;
    for (int32_t k = 0; k < palette->count; ++k)
        for (int32_t c = 0; c < 3; ++c)
            palette->color[k][c] = (uint8_t)(bins[k].sum[c] / bins[k].count);
    for (int32_t k = 0; k < used; ++k)
        of_bin[bins[k].place] = k < palette->count ? (uint8_t)k : nearest(palette, &bins[k]);
    for (int32_t row = 0; row < picture->height; ++row) {
        const uint8_t *line = picture->bytes + (int64_t)row * picture->stride;
        uint8_t *index = palette->index + (int64_t)row * picture->width;
        for (int32_t k = 0; k < picture->width; ++k) index[k] = of_bin[bin_of(line + 4 * k)];
    }
cleanup:
    memory_free_all(bins, of_bin);
    if (!error_is_clean(err)) palette_destroy(palette);
    return error_is_clean(err);
}

void palette_destroy(Palette *palette)
{
    memory_free(palette->index);
    *palette = (Palette){0};
}
