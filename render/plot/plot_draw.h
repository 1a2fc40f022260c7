// SPDX-License-Identifier: GPL-2.0-or-later
// Draws a plot read by plot_file. Called by page_figures.
#ifndef AMONTONS_RENDER_PLOT_PLOT_DRAW_H
#define AMONTONS_RENDER_PLOT_PLOT_DRAW_H

#include "render/plot/plot.h"

// Begins the page, as high as the plot asks for, and draws. A style without a width gets one that
// suits. title: NULL is fine.
bool plot_draw(Page *page, Plot *plot, const PictureStyle *style, const char *title, Error *err);

#endif
