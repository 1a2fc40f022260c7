// SPDX-License-Identifier: GPL-2.0-or-later
// What the two maps of U against x share: the frame, the field itself with the gaps between pads,
// lines on it, the colour bar. Called by figure_slip_map and figure_contact_density.
#ifndef AMONTONS_RENDER_FIGURES_MAP_PAGE_H
#define AMONTONS_RENDER_FIGURES_MAP_PAGE_H

#include "render/canvas/colorbar.h"
#include "render/figures/figures.h"
#include "render/view/space_time.h"

typedef struct MapPage {
    Axes axes;
    PixelGrid grid;   // fills the frame; a column a pixel; owned
    Colorbar bar;
    bool mean;   // a pixel shows the mean over its U, not the fastest; the slip has been read
    double above;   // points above the frame kept for marks; more are kept where the axes need them
    double mark_width;   // points right of the frame kept for a mark's name
    double pads_width;   // points between that and the bar: the pads' names
} MapPage;

// Places the frame for U from low to high and all x; map->bar, above and mark_width are given.
void map_page_layout(const Page *page, const ResultView *view, double U_low, double U_high,
                     MapPage *map);

// Fills map->grid with the fastest |slip rate| at each pixel; INFINITY where `status` (or NULL) has
// 0, open.
bool map_page_fill(const ResultView *view, const double *status, MapPage *map, Error *err);

// Draws the grid, whose values are now 0 to 1 of the colour map or a HeatLevel, and the pads' gaps.
void map_page_draw_field(const Page *page, const ResultView *view, const MapPage *map);
// The front l(U) of each pad as a thin line; the statuses have been read.
bool map_page_draw_front(const Page *page, const ResultView *view, const MapPage *map, Error *err);
// Frame, axes, the pads' names and bar: last.
void map_page_draw_frame(const Page *page, const ResultView *view, const MapPage *map);
void map_page_destroy(MapPage *map);   // zeroed is fine

#endif
