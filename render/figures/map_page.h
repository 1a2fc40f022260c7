// SPDX-License-Identifier: GPL-2.0-or-later
// Parts that the maps of U against x share: the frame, the field itself with the gaps between pads,
// lines on it, the colour bar. Called by figure_slip_map, figure_state_map, figure_contact_density
// and figure_contact_area.
#ifndef AMONTONS_RENDER_FIGURES_MAP_PAGE_H
#define AMONTONS_RENDER_FIGURES_MAP_PAGE_H

#include "render/canvas/colorbar.h"
#include "render/canvas/key.h"
#include "render/figures/figures.h"
#include "render/figures/measured.h"
#include "render/view/space_time.h"
#include "render/view/range.h"

static const Color MAP_OPEN = {0.55f, 0.56f, 0.58f, 1};   // contact that has lifted off

typedef struct MapPage {
    Axes axes;
    PixelGrid grid;   // fills the frame; a column a pixel; owned
    Colorbar bar;
    bool mean;   // a pixel shows the mean over its U, not the fastest; the slip has been read
    double critical;   // > 0: shown is what slip at this velocity leaves of the contact
    const double *status;   // [rows * nodes] what is open is infinitely fast; NULL: nothing is
    const double *states;   // [rows * nodes] shown in the place of slip rates; NULL: none
    int32_t sign;   // of these, as SpaceTime has it
    double mark_width;   // points right of the frame kept for a mark's name
    double pads_width;   // points between that and the bar: the pads' names
} MapPage;

// Places the frame for U from U[0] to U[1] and all x, and draws the field with the gaps of pads;
// grid, pads_width and the axes but for `above` are set here.
bool map_page_draw(const Page *page, const ResultView *view, const double U[2], MapPage *map,
                   Error *err);

// Its parts, for who places the frame: the grid's values from `data` become places in the bar's
// colours ...
bool map_page_fill(const SpaceTime *data, MapPage *map, Error *err);

// Fills the entries of pads and shown in the key; returns how many they are, at most two.
int32_t map_page_key(const ResultView *view, const ViewRange *shown, KeyEntry entries[2]);

// ... and are drawn, with the pads' gaps.
void map_page_draw_field(const Page *page, const ResultView *view, const MapPage *map);
// The front l(U) of each pad as a thin line; the statuses have been read.
void map_page_draw_front(const Page *page, const ResultView *view, const MapPage *map);
// Measured areas, in the colours of the map.
void map_page_draw_areas(const Page *page, const Measured *measured, const MapPage *map);
// Frame, axes, the pads' names and bar: last.
void map_page_draw_frame(const Page *page, const ResultView *view, const MapPage *map);
void map_page_destroy(MapPage *map);   // zeroed is fine

#endif
