// SPDX-License-Identifier: GPL-2.0-or-later
// Palettes of pictures whose colours are known, as libpng reads them back.
#include "render/canvas/png_encode.h"

#include "cases.h"

#include <png.h>

#include <stdlib.h>
#include <string.h>

enum { SIZE = 64, PALETTE_SIZE = 256 };

static uint8_t bytes[SIZE * SIZE * 4], seen[SIZE * SIZE], palette[PALETTE_SIZE][3];

static const PngPicture picture = {SIZE, SIZE, 4 * SIZE, bytes, 4000, "Colours", true};

// Blue, green, red, as Cairo has them.
static void paint(int32_t k, uint8_t red, uint8_t green, uint8_t blue)
{
    bytes[4 * k] = blue;
    bytes[4 * k + 1] = green;
    bytes[4 * k + 2] = red;
    bytes[4 * k + 3] = 0xff;
}

// Encodes the picture and fills `seen` and `palette`; returns how many colours it has.
static int32_t encode(void)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    Error err = {0};
    char *file = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&file, &size);
    assert_non_null(out);
    assert_true(png_encode(&picture, out, &err));
    assert_int_equal(fclose(out), 0);
    assert_true(png_image_begin_read_from_memory(&image, file, size));
    assert_true(image.format & PNG_FORMAT_FLAG_COLORMAP);
    assert_true(image.width == SIZE && image.height == SIZE);
    image.format = PNG_FORMAT_RGB_COLORMAP;
    assert_true(png_image_finish_read(&image, NULL, seen, SIZE, palette));
    free(file);
    return (int32_t)image.colormap_entries;
}

TEST(few_colors_are_kept_exactly)
{
    for (int32_t k = 0; k < SIZE * SIZE; ++k) paint(k, k % 3 ? 200 : 10, 20, k % 2 ? 30 : 250);
    assert_int_equal(encode(), 4);
    for (int32_t k = 0; k < SIZE * SIZE; ++k) {
        const uint8_t *color = palette[seen[k]];
        assert_int_equal(color[0], k % 3 ? 200 : 10);
        assert_int_equal(color[1], 20);
        assert_int_equal(color[2], k % 2 ? 30 : 250);
    }
}

static int32_t distance(const uint8_t *color, int32_t k)
{
    const int32_t exact[3] = {bytes[4 * k + 2], bytes[4 * k + 1], bytes[4 * k]};
    int32_t sum = 0;
    for (int32_t c = 0; c < 3; ++c) sum += (color[c] - exact[c]) * (color[c] - exact[c]);
    return sum;
}

// 4096 colours over the whole cube; white is most frequent and must stay.
TEST(many_colors_become_the_nearest)
{
    for (int32_t k = 0; k < SIZE * SIZE; ++k)
        paint(k, (uint8_t)(17 * (k / 256)), (uint8_t)(17 * (k / 16 % 16)),
              (uint8_t)(17 * (k % 16)));
    memset(bytes, 0xff, SIZE * 4 * 8);
    assert_int_equal(encode(), PALETTE_SIZE);
    assert_memory_equal(palette[seen[0]], "\xff\xff\xff", 3);
    for (int32_t k = 0; k < SIZE * SIZE; k += 7)
        for (int32_t c = 0; c < PALETTE_SIZE; ++c)
            assert_true(distance(palette[seen[k]], k) <= distance(palette[c], k));
}

TEST(a_full_device_is_reported)
{
    Error err = {0};
    FILE *out = fopen("/dev/full", "w");
    assert_non_null(out);
    setvbuf(out, NULL, _IONBF, 0);
    assert_false(png_encode(&picture, out, &err));
    assert_int_equal(err.code, ERROR_FILE);
    fclose(out);
}
