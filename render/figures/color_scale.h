// SPDX-License-Identifier: GPL-2.0-or-later
// Which values the colours of a map span, and the bar that says so. Of slip rates: their decimal
// logarithm over V; what is slower than it shows is neutral: stick. Of all else what the style asks
// for, or all but the outermost, which singular corners have; powers of ten where they span
// decades.
// Called by the figures and the film.
#ifndef AMONTONS_RENDER_FIGURES_COLOR_SCALE_H
#define AMONTONS_RENDER_FIGURES_COLOR_SCALE_H

#include "render/canvas/colorbar.h"
#include "render/view/result_view.h"

// The bar of slip rates, up to the half decade above all slip of the view, whose slip rates have
// been read. V: of the rod, velocity > 0.
Colorbar slip_scale(const ResultView *view, double V);
Colorbar slip_scale_up_to(double largest, double V);   // of slip rates up to `largest`

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

// The same of values [rows * nodes] while U is from U[0] to U[1], all counted alike.
bool history_bar_fit(const ResultView *view, const double U[2], const double *values,
                     const ValueWords *words, const PictureStyle *style, Colorbar *bar, Error *err);

// Name and unit of the state that the view stands for; `name` is what the words stand in.
ValueWords state_words(const ResultView *view, char name[VIEW_STATE_SIZE]);

#endif
