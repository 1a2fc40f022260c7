// SPDX-License-Identifier: GPL-2.0-or-later
// By libpng (ISO/IEC 15948): 8-bit RGB or a palette, sRGB, with the density that gives the picture
// its printed width, which Cairo's own writer leaves out.
#include "render/canvas/png_encode.h"

#include "base/memory.h"
#include "render/canvas/palette.h"

#include <png.h>

#include <math.h>
#include <setjmp.h>
#include <string.h>

// Large areas of one colour: the lowest level is five times as fast as the default and 12 % larger.
// A palette has few bytes to begin with, and is for a page that is sent around.
enum { COMPRESSION_LEVEL = 1, COMPRESSION_SMALL = 6, TEXTS = 2 };

typedef struct Output {
    PngSink sink;
    void *context;
} Output;

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

static void bytes_pass(png_structp png, png_bytep bytes, size_t length)
{
    const Output *output = png_get_io_ptr(png);
    if (!output->sink(output->context, bytes, length)) png_error(png, "no memory for a picture");
}

static void bytes_flush(png_structp png)
{
    (void)png;   // they are in memory
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
bool png_encode(const PngPicture *picture, PngSink sink, void *context, Error *err)
{
    Output output = {sink, context};
    Palette palette = {0};
    png_infop info = NULL;
    const PalettePixels pixels = {picture->width, picture->height, picture->stride,
                                  picture->pixels};
    uint8_t *packed = memory_bytes(3 * (int64_t)picture->width, err);
    if (!packed || (picture->few_colors && !palette_make(&pixels, &palette, err))) {
        memory_free(packed);
        return false;
    }
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, err, fault_keep, warning_drop);
    if (png) info = png_create_info_struct(png);
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        palette_destroy(&palette);
        memory_free(packed);
        error_set(err, ERROR_MEMORY, __FILE__, __LINE__, "no memory for libpng");
        return false;
    }
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_set_write_fn(png, &output, bytes_pass, bytes_flush);
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
    palette_destroy(&palette);
    memory_free(packed);
    return error_is_clean(err);
}
