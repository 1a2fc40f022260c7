// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures whose pixels are known, read back by libpng and zlib.
#include "render/canvas/run_deflate.h"

#include "cases.h"
#include "render/canvas/png_encode.h"

#include <png.h>

#include <string.h>

enum { WIDTH_MOST = 1200, HEIGHT = 60, ROOM = 1 << 20 };

static uint8_t pixels[HEIGHT * WIDTH_MOST * 4], back[HEIGHT * WIDTH_MOST * 3], file[ROOM];
static size_t size;

static bool keep(void *context, const uint8_t *bytes, size_t length)
{
    (void)context;
    if (size + length > ROOM) return false;
    memcpy(file + size, bytes, length);
    size += length;
    return true;
}

static void check(int32_t width)
{
    const PngPicture picture = {.width = width,
                                .height = HEIGHT,
                                .stride = 4 * width,
                                .pixels = pixels,
                                .pixels_per_metre = 1000,
                                .title = "pixels"};
    png_image image = {.version = PNG_IMAGE_VERSION};
    Error err = {0};
    size = 0;
    assert_true(png_encode(&picture, keep, NULL, &err));
    assert_true(png_image_begin_read_from_memory(&image, file, size));
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, HEIGHT);
    image.format = PNG_FORMAT_RGB;
    assert_true(png_image_finish_read(&image, NULL, back, 0, NULL));
    for (int32_t k = 0; k < width * HEIGHT; ++k)
        for (int32_t c = 0; c < 3; ++c) assert_int_equal(back[3 * k + c], pixels[4 * k + 2 - c]);
}

static uint32_t random_next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

// The fourth byte of a pixel is nobody's: it may be anything.
static void set(int32_t k, uint32_t value)
{
    for (int32_t c = 0; c < 4; ++c) pixels[4 * k + c] = (uint8_t)(value >> 6 * c);
}

// Of 1 to 1200 pixels, so around each length that a match may have, of changes and of none.
TEST(runs_of_every_length)
{
    for (int32_t width = 1; width <= WIDTH_MOST; width += width < 400 ? 1 : 97) {
        for (int32_t k = 0; k < width * HEIGHT; ++k) {
            int32_t row = k / width, run = row * (row + width) / 3 + 1;
            set(k, k % width < run % (width + 1) ? 0xffffffu : (uint32_t)(row % 7) * 40503u);
        }
        check(width);
    }
}

// Several blocks of symbols, all of them frequent.
TEST(noise)
{
    uint32_t seed = 5;
    for (int32_t k = 0; k < WIDTH_MOST * HEIGHT; ++k) set(k, random_next(&seed) ^ (uint32_t)k);
    check(WIDTH_MOST);
}

// A pixel here and there differs from the one above it by red, green or blue alone.
TEST(one_color_of_a_pixel_changes)
{
    uint32_t seed = 7;
    memset(pixels, 0x80, sizeof pixels);
    for (int32_t k = 0; k < WIDTH_MOST * HEIGHT; k += 1 + (int32_t)(random_next(&seed) % 50))
        ++pixels[4 * k + (int32_t)(random_next(&seed) % 3)];
    check(WIDTH_MOST);
}

// Each change half as frequent as the one before: codes would be longer than the format allows.
TEST(codes_that_would_be_too_long)
{
    uint32_t seed = 9;
    for (int32_t k = 0; k < WIDTH_MOST * HEIGHT * 4; ++k) {
        uint8_t change = 1;
        for (uint32_t bits = random_next(&seed); bits & 1; bits >>= 1) ++change;
        pixels[k] = (uint8_t)((k < 4 * WIDTH_MOST ? 0 : pixels[k - 4 * WIDTH_MOST]) + change);
    }
    check(WIDTH_MOST);
}

static void drop(void *context, const uint8_t *bytes, size_t length)
{
    (void)bytes;
    *(size_t *)context += length;
}

// A page without anything on it takes 1/500 of its pixels.
TEST(paper_takes_hardly_a_byte)
{
    Error err = {0};
    size_t bytes = 0;
    memset(pixels, 0xff, sizeof pixels);
    RunDeflate *stream = run_deflate_create(drop, &bytes, &err);
    assert_non_null(stream);
    for (int32_t row = 0; row < HEIGHT; ++row) run_deflate_row(stream, pixels, pixels, WIDTH_MOST);
    run_deflate_end(stream);
    run_deflate_destroy(stream);
    assert_in_range(bytes, HEIGHT, sizeof pixels / 500);
}
