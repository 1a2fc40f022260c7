// SPDX-License-Identifier: GPL-2.0-or-later
// The one colour map: ivory for little slip over red to dark violet for much. Equal steps
// of the value are equal distances in CIELAB, and lightness falls all the way, so the map reads
// in grey print and with colour blindness too. Called by the map figures.
#ifndef AMONTONS_RENDER_COLORMAP_H
#define AMONTONS_RENDER_COLORMAP_H

#include "render/canvas.h"

// [MAP_SIZE * 3] bytes, red, green, blue, from value 0 to value 1.
void colormap_fill(uint8_t *colors);

#endif
