// SPDX-License-Identifier: GPL-2.0-or-later
// PNG by libpng (ISO/IEC 15948): 8-bit RGB, sRGB, with the density that gives the picture its
// printed width. Written as `path`.part and renamed. Bytes are the same for the same pixels: no
// time is stored.
#include "render/png_file.h"

#include <png.h>

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Large areas of one colour: a low level is five times as fast as the default and 10 % larger.
enum { COMPRESSION_LEVEL = 3, TEXTS = 2 };

// libpng's way to report: keep the cause, then jump back into picture_write.
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

// Size, colour space, density for print, title and program: everything before the rows.
static void head_write(png_structp png, png_infop info, const PngPicture *picture)
{
    png_uint_32 density = (png_uint_32)lround(picture->pixels_per_metre);
    png_text texts[TEXTS] = {
        {.compression = PNG_ITXT_COMPRESSION_NONE, .key = "Title", .text = (char *)picture->title},
        {.compression = PNG_TEXT_COMPRESSION_NONE,
         .key = "Software",
         .text = "amontons " AMONTONS_VERSION}};
    png_set_compression_level(png, COMPRESSION_LEVEL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_set_IHDR(png, info, (png_uint_32)picture->width, (png_uint_32)picture->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_pHYs(png, info, density, density, PNG_RESOLUTION_METER);
    png_set_text(png, info, texts, TEXTS);
    png_write_info(png, info);
}

// libpng jumps back to setjmp on a fault: nothing here may change between the two.
static bool picture_write(FILE *out, const PngPicture *picture, Error *err)
{
    png_infop info = NULL;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, err, fault_keep, warning_drop);
    if (png) info = png_create_info_struct(png);
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        error_set(err, ERROR_MEMORY, __FILE__, __LINE__, "no memory for libpng");
        return false;
    }
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_init_io(png, out);
        head_write(png, info, picture);
        for (int32_t row = 0; row < picture->height; ++row)
            png_write_row(png, picture->pixels + (size_t)row * (size_t)picture->width * 3);
        png_write_end(png, info);
    }
    png_destroy_write_struct(&png, &info);
    return error_is_clean(err);
}

// ERROR_FILE says what the system or libpng said, and which file.
bool png_file_write(const char *path, const PngPicture *picture, Error *err)
{
    char part[PATH_MAX + 8];
    FILE *out = NULL;
    snprintf(part, sizeof part, "%s.part", path);
    out = fopen(part, "wb");
    if (!out) FAIL(err, ERROR_FILE, "%s", strerror(errno));
    TRY(picture_write(out, picture, err));
    if (fflush(out) != 0 || fsync(fileno(out)) != 0) FAIL(err, ERROR_FILE, "%s", strerror(errno));
    int closed = fclose(out);
    out = NULL;
    if (closed != 0 || rename(part, path) != 0) FAIL(err, ERROR_FILE, "%s", strerror(errno));
cleanup:
    if (out) fclose(out);
    if (!error_is_clean(err)) {
        unlink(part);
        error_context(err, "cannot write %s", path);
    }
    return error_is_clean(err);
}
