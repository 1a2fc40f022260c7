// SPDX-License-Identifier: GPL-2.0-or-later
// Ends of the axes that a plot file leaves open: a little beyond the data of all panels, and at the
// outer edges of a map's cells. Called by plot_file.
#ifndef AMONTONS_RENDER_PLOT_PLOT_FIT_H
#define AMONTONS_RENDER_PLOT_PLOT_FIT_H

#include "render/plot/plot.h"

bool plot_fit_axes(Plot *plot, Error *err);

#endif
