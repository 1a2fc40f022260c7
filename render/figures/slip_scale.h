// SPDX-License-Identifier: GPL-2.0-or-later
// The scale of slip rates: their decimal logarithm over V; what is slower than it shows is neutral:
// stick. Called by figure_slip_map and the film.
#ifndef AMONTONS_RENDER_FIGURES_SLIP_SCALE_H
#define AMONTONS_RENDER_FIGURES_SLIP_SCALE_H

#include "render/canvas/colorbar.h"
#include "render/view/result_view.h"

// Its bar, up to the half decade above all slip of the view, whose slip rates have been read.
// V: of the rod, velocity > 0.
Colorbar slip_scale(const ResultView *view, double V);
Colorbar slip_scale_up_to(double largest, double V);   // of slip rates up to `largest`

#endif
