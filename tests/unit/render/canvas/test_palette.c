// SPDX-License-Identifier: GPL-2.0-or-later
// Palettes of pictures whose colours are known.
#include "render/canvas/palette.h"

#include "cases.h"

#include <string.h>

enum { SIZE = 64 };

static uint8_t bytes[SIZE * SIZE * 4];

static const PalettePixels pixels = {SIZE, SIZE, SIZE * 4, bytes};

// Blue, green, red, as Cairo has them.
static void paint(int32_t k, uint8_t red, uint8_t green, uint8_t blue)
{
    bytes[4 * k] = blue;
    bytes[4 * k + 1] = green;
    bytes[4 * k + 2] = red;
    bytes[4 * k + 3] = 0xff;
}

TEST(few_colors_are_kept_exactly)
{
    Palette palette;
    Error err = {0};
    for (int32_t k = 0; k < SIZE * SIZE; ++k) paint(k, k % 3 ? 200 : 10, 20, k % 2 ? 30 : 250);
    assert_true(palette_make(&pixels, &palette, &err));
    assert_int_equal(palette.count, 4);
    for (int32_t k = 0; k < SIZE * SIZE; ++k) {
        const uint8_t *color = palette.color[palette.index[k]];
        assert_int_equal(color[0], k % 3 ? 200 : 10);
        assert_int_equal(color[1], 20);
        assert_int_equal(color[2], k % 2 ? 30 : 250);
    }
    palette_destroy(&palette);
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
    Palette palette;
    Error err = {0};
    for (int32_t k = 0; k < SIZE * SIZE; ++k)
        paint(k, (uint8_t)(17 * (k / 256)), (uint8_t)(17 * (k / 16 % 16)),
              (uint8_t)(17 * (k % 16)));
    memset(bytes, 0xff, SIZE * 4 * 8);
    assert_true(palette_make(&pixels, &palette, &err));
    assert_int_equal(palette.count, PALETTE_SIZE);
    assert_memory_equal(palette.color[palette.index[0]], "\xff\xff\xff", 3);
    for (int32_t k = 0; k < SIZE * SIZE; k += 7)
        for (int32_t c = 0; c < PALETTE_SIZE; ++c)
            assert_true(distance(palette.color[palette.index[k]], k) <=
                        distance(palette.color[c], k));
    palette_destroy(&palette);
}
