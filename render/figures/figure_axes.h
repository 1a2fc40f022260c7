// SPDX-License-Identifier: GPL-2.0-or-later
// Axes that figures share: lengths of a result, and frames below each other over one x axis, whose
// numbers stand below the last. Called by the figures and the film.
#ifndef AMONTONS_RENDER_FIGURES_FIGURE_AXES_H
#define AMONTONS_RENDER_FIGURES_FIGURE_AXES_H

#include "render/canvas/axes.h"
#include "render/view/result_view.h"

enum { STACK_COLORS = 8 };

// An axis of lengths from low to high: "~{U} / ~{L}_{0}", or in SI "~{U} (mm)".
Axis figure_length_axis(const ResultView *view, const char *symbol, double low, double high);

// Colour of curve number k: any two of the first eight are told apart, also without one of the
// three kinds of cones.
Color stack_color(int32_t k);

// Height of a figure of so many frames over its width.
double stack_shape(int32_t frames);

// Places frames of equal size in the page's room, the first at its top; axes: [count], their axes
// set.
void stack_fit(const Page *page, Axes *axes, int32_t count);

// Widens [low, high] to `value`, where that is a number.
void stack_widen(double value, double *low, double *high);
// An axis from low to high with some room at both ends; 0 is one of them where it is near.
Axis stack_axis(double low, double high);

#endif
