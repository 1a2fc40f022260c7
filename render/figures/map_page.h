// SPDX-License-Identifier: GPL-2.0-or-later
// What the maps of U against x share: the frame, the field itself with the gaps between pads, lines
// on it, the colour bar. Called by figure_slip_map, figure_state_map and figure_contact_density.
#ifndef AMONTONS_RENDER_FIGURES_MAP_PAGE_H
#define AMONTONS_RENDER_FIGURES_MAP_PAGE_H

#include "render/canvas/colorbar.h"
#include "render/canvas/key.h"
#include "render/figures/figures.h"
#include "render/view/space_time.h"
#include "render/view/window.h"

typedef struct MapPage {
    Axes axes;
    PixelGrid grid;   // fills the frame; a column a pixel; owned
    Colorbar bar;
    bool mean;   // a pixel shows the mean over its U, not the fastest; the slip has been read
    const double *states;   // [rows * nodes] shown in the place of slip rates; NULL: none
    int32_t sign;   // of these, as SpaceTime has it
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

// The grid's values become places in the bar's colours.
void map_page_levels(MapPage *map);

// What pads and the window say in the key: how many entries, at most two.
int32_t map_page_key(const ResultView *view, const Window *window, KeyEntry entries[2]);

// Draws the grid, whose values are now 0 to 1 of the colour map or a HeatLevel, and the pads' gaps.
void map_page_draw_field(const Page *page, const ResultView *view, const MapPage *map);
// The front l(U) of each pad as a thin line; the statuses have been read.
bool map_page_draw_front(const Page *page, const ResultView *view, const MapPage *map, Error *err);
// Frame, axes, the pads' names and bar: last.
void map_page_draw_frame(const Page *page, const ResultView *view, const MapPage *map);
void map_page_destroy(MapPage *map);   // zeroed is fine

#endif
