// SPDX-License-Identifier: GPL-2.0-or-later
// Which values the colours of a map span, and the bar that says so: what the style asks for, else
// all but the outermost of them, which singular corners have. Called by block_page and
// figure_contact_plane.
#ifndef AMONTONS_RENDER_FIGURES_VALUE_RANGE_H
#define AMONTONS_RENDER_FIGURES_VALUE_RANGE_H

#include "render/canvas/colorbar.h"

typedef struct WeighedValue {
    double value;   // not finite: not counted
    double weight;   // how much of what is shown has it
} WeighedValue;

typedef struct ValueWords {
    const char *words, *si,
        *normalised;   // name, its unit in SI and in normalised scenes; "": none
    bool in_si;
    bool decades;   // powers of ten where no value is below 0 and they span some of them
} ValueWords;

// values [count] are put in order. style: whose limits the bar has; NULL: those that fit.
// ERROR_FILE: there is no number.
bool value_bar_fit(WeighedValue *values, int64_t count, const ValueWords *words,
                   const PictureStyle *style, Colorbar *bar, Error *err);

#endif
