// SPDX-License-Identifier: GPL-2.0-or-later
// The figures: three after figure 1(b), (c) and (d) of the paper, drawn on a page of known height,
// and the block, whose height its page takes. Called by picture.c.
#ifndef AMONTONS_RENDER_FIGURES_FIGURES_H
#define AMONTONS_RENDER_FIGURES_FIGURES_H

#include "render/figures/figure_axes.h"
#include "render/figures/measured.h"

#define FIGURE_MU "~{F}_{T} / ~{F}_{N}"
static const Color FIGURE_CURVE = {0.05f, 0.27f, 0.55f, 1};
static const Color FIGURE_LEVEL = {0.45f, 0.45f, 0.47f, 1};   // of what a curve is measured by

typedef enum FigureId {
#define X(symbol, name, title) symbol,
    PICTURE_FIGURES(X) FIGURE_COUNT
#undef X
} FigureId;

// The view may read more of the result, hence not const.
typedef bool (*FigureFunction)(const Page *page, ResultView *view, Error *err);

// Input with which a figure begins its page by itself.
typedef struct FigureInput {
    ResultView *view;
    const char *folder;   // of the result
    const FieldChoice *field;
    PageDef def;   // but its height
} FigureInput;
typedef bool (*WholeFigureFunction)(Page *page, const FigureInput *input, Error *err);

// One field of the block at one time.
bool figure_field(Page *page, const FigureInput *input, Error *err);
// True if fields are stored, and have that quantity; NULL: any quantity will do.
bool figure_field_shows(const char *folder, const char *quantity);
// The same, the velocity where none is named, in up to six frames of one sliding.
bool figure_strip(Page *page, const FigureInput *input, Error *err);

// The contact of a block in space: slip rates, or what is named, at moments of one sliding or those
// that are asked for; or when slip arrived.
bool figure_contact_plane(Page *page, const FigureInput *input, Error *err);
bool figure_contact_plane_shows(ResultView *view, const char *quantity);

// Readings of the probes, strains where nothing is named, against U.
bool figure_probes(Page *page, const FigureInput *input, Error *err);
bool figure_probes_show(const char *quantity);   // whether it knows that
// Draws which pad lets go first.
bool figure_pads(Page *page, const FigureInput *input, Error *err);
// The contact along x at moments, those around the last sliding where none are asked for.
bool figure_profile(Page *page, const FigureInput *input, Error *err);

// F_T/F_N against U with its peaks, mu_S, mu_M, mu_K, and above it an inset of the precursors.
bool figure_force(const Page *page, ResultView *view, Error *err);
// True if it has that inset, for which it is higher.
bool figure_force_enlarges(const ResultView *view, const PictureStyle *style);
// Slip rate over V, logarithmic, against U and x.
bool figure_slip_map(const Page *page, ResultView *view, Error *err);
// The state view->state of friction that remembers, against U and x.
bool figure_state_map(const Page *page, ResultView *view, Error *err);
// Contact density max(0, 1 - |slip rate| / v_c) in the last precursors; where open, neutral.
bool figure_contact_density(const Page *page, ResultView *view, Error *err);
// Area of the real contacts over that at rest, likewise, in colours of what the precursors leave.
bool figure_contact_area(const Page *page, ResultView *view, Error *err);

// Draws how long slip was when the load ratio first came so far, in the cycle that is enlarged.
bool figure_precursors(const Page *page, ResultView *view, Error *err);
// Draws how fast the front of the sliding that is enlarged ran, over x.
bool figure_front_speed(const Page *page, ResultView *view, Error *err);

// Writes the numbers that a figure shows to a csv file. field: the moments of profile.
typedef bool FigureTable(const char *path, ResultView *view, const FieldChoice *field, Error *err);
FigureTable figure_force_table, figure_slip_map_table, figure_state_map_table,
    figure_contact_area_table, figure_precursors_table, figure_front_speed_table,
    figure_probes_table, figure_pads_table, figure_profile_table;

// True if a result has what a figure shows.
typedef bool FigureThere(const ResultView *view);
FigureThere figure_state_map_is_there, figure_contact_area_is_there, figure_contact_plane_is_there,
    figure_probes_are_there, figure_pads_are_there;

// Axes of force curves of [count] results, in a frame that is known; y: headroom times their range,
// 0 included.
Axes figure_force_axes(const ResultView *views, int32_t count, Box box, double headroom);

#endif
