// SPDX-License-Identifier: GPL-2.0-or-later
// Colours, and the one colour map: ivory for little slip over red to dark violet for much. Equal
// steps of the value are equal distances in CIELAB, and lightness falls all the way, so the map
// reads in grey print and with colour blindness too. Called by canvas and the map figures.
#ifndef AMONTONS_RENDER_CANVAS_COLOR_H
#define AMONTONS_RENDER_CANVAS_COLOR_H

#include <stdint.h>

enum { MAP_SIZE = 256 };

typedef struct Color {
    float red, green, blue, alpha;   // sRGB, 0 to 1; of a picture on white paper
} Color;

// [MAP_SIZE * 3] bytes, red, green, blue, from value 0 to value 1.
void color_map_fill(uint8_t *colors);

// Colour that `color` becomes on dark paper: its lightness is reversed, its hue is kept. White
// becomes the dark paper.
Color color_on_dark(Color color);

#endif
