// SPDX-License-Identifier: GPL-2.0-or-later
// The key beside a map: the colours from bottom to top, with ticks. Called by the map figures.
#ifndef AMONTONS_RENDER_CANVAS_COLORBAR_H
#define AMONTONS_RENDER_CANVAS_COLORBAR_H

#include "render/canvas/axes.h"

typedef struct Colorbar {
    double low, high;   // numbers shown at the bottom and the top of the bar
    double factor;   // numbers are the values times this
    bool falling;   // the colour map's value 0 stands at the top, not at the bottom
    bool clipped,
        clipped_above;   // what is below `low`, above `high`, is shown as that: its number
    // says so
    bool powers;   // low and high are decimal logarithms: ticks are powers of ten
    char label[AXIS_LABEL_SIZE];   // text.h's marks
    const char *neutral;   // name of the neutral colour, shown in a patch below; NULL: no patch
    Color neutral_color;
} Colorbar;

// Ends at handy numbers around `range`, which may be empty; of powers at whole ones.
void colorbar_fit(Colorbar *bar, const double range[2]);
Ticks colorbar_ticks(const Colorbar *bar);

// Place of a value in the colour map, 0 to 1, or a HeatLevel: NaN is no data; minus infinity,
// and of powers, which are of its size, what is below a bar with a neutral colour has that.
float colorbar_level(const Colorbar *bar, double value);

// Points to the right of the bar's left edge that it takes.
double colorbar_width(const Page *page, const Colorbar *bar);

// Draws the bar `gap` points right of a frame, as high as that; uses the canvas's colour map.
void colorbar_draw(const Page *page, const Colorbar *bar, const Box *frame, double gap);

#endif
