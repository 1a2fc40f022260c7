// SPDX-License-Identifier: GPL-2.0-or-later
// Draws a plot read by plot_file. Called by render_plot.
#ifndef AMONTONS_RENDER_FIGURE_CURVES_H
#define AMONTONS_RENDER_FIGURE_CURVES_H

#include "render/plot.h"

bool figure_curves(const Page *page, const Plot *plot, Error *err);

#endif
