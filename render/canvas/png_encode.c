// SPDX-License-Identifier: GPL-2.0-or-later
// By libpng (ISO/IEC 15948): 8-bit RGB or a palette, sRGB, with the density that gives the picture
// its printed width, which Cairo's own writer leaves out.
#include "render/canvas/png_encode.h"

#include "base/memory.h"
#include "render/canvas/palette.h"
#include "render/canvas/run_deflate.h"

#include <png.h>

#include <math.h>
#include <setjmp.h>

// A palette is for a page that is sent around: few bytes count more than time.
enum { COMPRESSION_SMALL = 6, TEXTS = 2 };

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

static void palette_write(png_structp png, png_infop info, const Palette *palette)
{
    png_color colors[PALETTE_SIZE];
    for (int32_t k = 0; k < palette->count; ++k)
        colors[k] = (png_color){.red = palette->color[k][0],
                                .green = palette->color[k][1],
                                .blue = palette->color[k][2]};
    png_set_PLTE(png, info, colors, palette->count);
}

// Part of the compressed pixels.
static void idat_write(void *context, const uint8_t *bytes, size_t length)
{
    png_write_chunk(context, (png_const_bytep) "IDAT", bytes, length);
}

// libpng would compare every byte with earlier ones.
static void colors_write(png_structp png, const PngPicture *picture, RunDeflate *stream,
                         const uint8_t *blank)
{
    for (int32_t row = 0; row < picture->height; ++row) {
        const uint8_t *pixels = picture->pixels + (size_t)row * (size_t)picture->stride;
        run_deflate_row(stream, pixels, row > 0 ? pixels - picture->stride : blank, picture->width);
    }
    run_deflate_end(stream);
    png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
}

static void indices_write(png_structp png, png_infop info, const PngPicture *picture,
                          const Palette *palette)
{
    for (int32_t row = 0; row < picture->height; ++row)
        png_write_row(png, palette->index + (size_t)row * (size_t)picture->width);
    png_write_end(png, info);
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
    png_set_compression_level(png, COMPRESSION_SMALL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_IHDR(png, info, (png_uint_32)picture->width, (png_uint_32)picture->height, 8,
                 small ? PNG_COLOR_TYPE_PALETTE : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_pHYs(png, info, density, density, PNG_RESOLUTION_METER);
    png_set_text(png, info, texts, TEXTS);
    if (small) palette_write(png, info, palette);
    png_write_info(png, info);
}

// libpng jumps back to setjmp on a fault: nothing here may change between the two.
bool png_encode(const PngPicture *picture, PngSink sink, void *context, Error *err)
{
    Output output = {sink, context};
    Palette palette = {0};
    RunDeflate *stream = NULL;
    uint8_t *blank = NULL;
    png_infop info = NULL;
    const PalettePixels pixels = {picture->width, picture->height, picture->stride,
                                  picture->pixels};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, err, fault_keep, warning_drop);
    if (png) info = png_create_info_struct(png);
    if (!info) FAIL(err, ERROR_MEMORY, "no memory for libpng");
    if (picture->few_colors) TRY(palette_make(&pixels, &palette, err));
    TRY(stream = run_deflate_create(idat_write, png, err));
    TRY(blank = memory_array(picture->width, 4, err));
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_set_write_fn(png, &output, bytes_pass, bytes_flush);
        head_write(png, info, picture, &palette);
        if (picture->few_colors)
            indices_write(png, info, picture, &palette);
        else
            colors_write(png, picture, stream, blank);
    }
cleanup:
    png_destroy_write_struct(&png, &info);
    palette_destroy(&palette);
    run_deflate_destroy(stream);
    memory_free(blank);
    return error_is_clean(err);
}
