// SPDX-License-Identifier: GPL-2.0-or-later
// By libpng (ISO/IEC 15948): 8-bit RGB or a palette, sRGB, with the density that gives the picture
// its printed width, which Cairo's own writer leaves out.
#include "render/canvas/png_encode.h"

#include "base/memory.h"

#include <png.h>

#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

// Large areas of one colour: the lowest level is five times as fast as the default and 12 % larger.
// A palette has few bytes to begin with, and is for a page that is sent around.
enum { COMPRESSION_LEVEL = 1, COMPRESSION_SMALL = 6, TEXTS = 2 };

// --- palette -------------------------------------------------------------------------------------

enum { PALETTE_SIZE = 256, BITS = 5, DROPPED = 8 - BITS, BINS = 1 << 3 * BITS };

// The 256 colours that a picture needs most, for a file of one byte a pixel.
typedef struct Palette {
    int32_t count;
    uint8_t color[PALETTE_SIZE][3];   // [count] red, green, blue
    uint8_t *index;   // [height * width] of the picture; owned
} Palette;

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

// Colours that agree in their upper five bits are one, their mean; of these the most frequent stay,
// and the others become the nearest of them.
static bool palette_make(const PngPicture *picture, Palette *palette, Error *err)
{
    int64_t pixels = (int64_t)picture->width * picture->height;
    int32_t used = 0;
    uint8_t *of_bin = NULL;
    Bin *bins = NEW_ARRAY(Bin, BINS, err);
    TRY(bins);
    TRY(of_bin = NEW_ARRAY(uint8_t, BINS, err));
    TRY(palette->index = memory_bytes(pixels, err));
    for (int32_t row = 0; row < picture->height; ++row) {
        const uint8_t *pixel = picture->pixels + (int64_t)row * picture->stride;
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
        const uint8_t *line = picture->pixels + (int64_t)row * picture->stride;
        uint8_t *index = palette->index + (int64_t)row * picture->width;
        for (int32_t k = 0; k < picture->width; ++k) index[k] = of_bin[bin_of(line + 4 * k)];
    }
cleanup:
    memory_free_all(bins, of_bin);
    return error_is_clean(err);
}

// --- file ----------------------------------------------------------------------------------------

// libpng's way to report: keep the cause, then jump back into png_encode.
static void fault_keep(png_structp png, png_const_charp message)
{
    Error *err = png_get_error_ptr(png);
    error_set(err, ERROR_FILE, __FILE__, __LINE__, "%s", message);
    png_longjmp(png, 1);
}

// libpng would print it.
static void warning_drop(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

// Three bytes a pixel, which libpng would make by itself in twice the time. Most rows of a figure
// are the one before once more.
static void row_pack(const PngPicture *picture, int32_t row, uint8_t *packed)
{
    const uint8_t *pixels = picture->pixels + (size_t)row * (size_t)picture->stride;
    if (row > 0 && memcmp(pixels, pixels - picture->stride, 4 * (size_t)picture->width) == 0)
        return;
    for (int32_t k = 0; k < picture->width; ++k) {
        packed[3 * k] = pixels[4 * k + 2];
        packed[3 * k + 1] = pixels[4 * k + 1];
        packed[3 * k + 2] = pixels[4 * k];
    }
}

// Size, colour space, density for print, title and program: everything before the rows.
static void head_write(png_structp png, png_infop info, const PngPicture *picture,
                       const Palette *palette)
{
    png_uint_32 density = (png_uint_32)lround(picture->pixels_per_metre);
    png_text texts[TEXTS] = {
        {.compression = PNG_ITXT_COMPRESSION_NONE, .key = "Title", .text = (char *)picture->title},
        {.compression = PNG_TEXT_COMPRESSION_NONE,
         .key = "Software",
         .text = "amontons " AMONTONS_VERSION}};
    bool small = palette->count > 0;
    png_set_compression_level(png, small ? COMPRESSION_SMALL : COMPRESSION_LEVEL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, small ? PNG_FILTER_NONE : PNG_FILTER_UP);
    png_set_IHDR(png, info, (png_uint_32)picture->width, (png_uint_32)picture->height, 8,
                 small ? PNG_COLOR_TYPE_PALETTE : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_pHYs(png, info, density, density, PNG_RESOLUTION_METER);
    png_set_text(png, info, texts, TEXTS);
    if (small) {
        png_color colors[PALETTE_SIZE];
        for (int32_t k = 0; k < palette->count; ++k)
            colors[k] = (png_color){.red = palette->color[k][0],
                                    .green = palette->color[k][1],
                                    .blue = palette->color[k][2]};
        png_set_PLTE(png, info, colors, palette->count);
    }
    png_write_info(png, info);
}

// libpng jumps back to setjmp on a fault: nothing here may change between the two.
bool png_encode(const PngPicture *picture, FILE *out, Error *err)
{
    Palette palette = {0};
    png_infop info = NULL;
    uint8_t *packed = memory_bytes(3 * (int64_t)picture->width, err);
    if (!packed || (picture->few_colors && !palette_make(picture, &palette, err))) {
        memory_free_all(packed, palette.index);
        return false;
    }
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, err, fault_keep, warning_drop);
    if (png) info = png_create_info_struct(png);
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        memory_free_all(packed, palette.index);
        error_set(err, ERROR_MEMORY, __FILE__, __LINE__, "no memory for libpng");
        return false;
    }
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_init_io(png, out);
        head_write(png, info, picture, &palette);
        for (int32_t row = 0; row < picture->height; ++row) {
            if (palette.count == 0) row_pack(picture, row, packed);
            png_write_row(png, palette.count == 0
                                   ? packed
                                   : palette.index + (size_t)row * (size_t)picture->width);
        }
        png_write_end(png, info);
    }
    png_destroy_write_struct(&png, &info);
    memory_free_all(packed, palette.index);
    return error_is_clean(err);
}
