// SPDX-License-Identifier: GPL-2.0-or-later
// One map of the contact of a block in space, seen from above. Called by film_page.
#ifndef AMONTONS_RENDER_FIGURES_FIGURE_CONTACT_PLANE_H
#define AMONTONS_RENDER_FIGURES_FIGURE_CONTACT_PLANE_H

#include "render/canvas/axes.h"
#include "render/view/result_view.h"

// x and y of its extent, the frame not yet placed.
Axes contact_map_axes(const ResultView *view);

// Draws patches in colours as an image; what has none is a shape. level: [nodes] 0 to 1 of the
// canvas's colours; below 0 a node has the colour `neutral`.
bool contact_map_draw(const Page *page, const ContactPlane *plane, const float *level,
                      Color neutral, const Axes *axes, Error *err);

#endif
