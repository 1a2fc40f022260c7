// SPDX-License-Identifier: GPL-2.0-or-later
// A field over U, or seconds of film, and x: its pixels in colours, with the gaps between pads. The
// maps themselves, slip-map, state-map, contact-density and contact-area, are declared in
// figures.h. Called by film_page.
#ifndef AMONTONS_RENDER_FIGURES_FIGURE_MAPS_H
#define AMONTONS_RENDER_FIGURES_FIGURE_MAPS_H

#include "render/canvas/colorbar.h"
#include "render/view/result_view.h"
#include "render/view/space_time.h"

typedef struct MapPage {
    Axes axes;
    PixelGrid grid;   // fills the frame; a column a pixel; owned
    Colorbar bar;
    bool mean;   // a pixel shows the mean over its U, not the fastest; the slip has been read
    const double *states;   // [rows * nodes] shown in the place of slip rates; NULL: none
    int32_t sign;   // of these, as SpaceTime has it
    double mark_width;   // points right of the frame kept for a mark's name
    double pads_width;   // points between that and the bar: the pads' names
} MapPage;

// Fills the grid, whose size and axes are set, from `data`, with places in the bar's colours.
bool map_page_fill(const SpaceTime *data, MapPage *map, Error *err);
// Draws them into the frame, with the pads' gaps.
void map_page_draw_field(const Page *page, const ResultView *view, const MapPage *map);
void map_page_destroy(MapPage *map);   // zeroed is fine

#endif
