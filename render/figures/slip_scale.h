// SPDX-License-Identifier: GPL-2.0-or-later
// The scale of slip rates: their decimal logarithm over V; what is slower than it shows is neutral:
// stick. Called by figure_slip_map and the film.
#ifndef AMONTONS_RENDER_FIGURES_SLIP_SCALE_H
#define AMONTONS_RENDER_FIGURES_SLIP_SCALE_H

#include "render/canvas/colorbar.h"
#include "render/view/result_view.h"
#include "render/view/space_time.h"

// Its bar, up to the half decade above all slip of the view, whose slip rates have been read.
// V: of the rod, velocity > 0.
Colorbar slip_scale(const ResultView *view, double V);
Colorbar slip_scale_up_to(double largest, double V);   // of slip rates up to `largest`

// Place of |slip rate| in the colour map, or a HeatLevel; NaN: no data.
float slip_scale_level(const Colorbar *bar, double V, double rate);
// The same for all values of a grid.
void slip_scale_levels(const Colorbar *bar, double V, PixelGrid *grid);

#endif
