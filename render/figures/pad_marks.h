// SPDX-License-Identifier: GPL-2.0-or-later
// Names of the pads beside a map of U against x: a bar along each pad's x, its name next to it.
// Called by map_page; nothing is drawn for a contact in one piece.
#ifndef AMONTONS_RENDER_FIGURES_PAD_MARKS_H
#define AMONTONS_RENDER_FIGURES_PAD_MARKS_H

#include "render/canvas/axes.h"
#include "render/view/result_view.h"

// Points right of the frame that the marks take; 0: there are none.
double pad_marks_width(const Page *page, const ResultView *view);
// beside: points between the frame and the marks.
void pad_marks_draw(const Page *page, const ResultView *view, const Axes *axes, double beside);

#endif
