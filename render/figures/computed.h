// SPDX-License-Identifier: GPL-2.0-or-later
// Computed results of a run in the form in which they are measured: a curve for each kind, and the
// area of the contact. Numbers only. Called by measured, figure_data and the figures.
#ifndef AMONTONS_RENDER_FIGURES_COMPUTED_H
#define AMONTONS_RENDER_FIGURES_COMPUTED_H

#include "render/view/result_view.h"

#define FIGURE_NO_DENSITY                                                                          \
    "the result has no critical velocity, which the contact density is defined by"

typedef enum MeasuredKind {
    MEASURED_MU,   // F_T/F_N over U
    MEASURED_FRONT,   // how far slip has come, x, over U
    MEASURED_AREA,   // contact area over what it was at rest, over U and x: no curve
    MEASURED_LENGTH,   // the farthest slip when F_T/F_N first came so far, in the cycle of the zoom
    MEASURED_SPEED,   // of the front of the sliding of the zoom, over x; below 0: it ran backwards
    MEASURED_PROBE,   // what probes saw, over U, several columns: no curve
    MEASURED_KINDS
} MeasuredKind;

// The curve of a kind, whose arrays stay the view's; of MEASURED_AREA and MEASURED_PROBE none
// (count 0).
bool computed_curve(ResultView *view, MeasuredKind kind, ViewCurve *curve, Error *err);

// Another cycle is shown from now on (render/view/zoom); curves of the one before are forgotten.
void computed_choose_cycle(ResultView *view, int32_t cycle);

// Load and length of a precursor or sliding of the cycle that is shown: F_T/F_N in the step before
// it, and how far slip came from the trailing end in it, L in a sliding. false: it is none of the
// cycle, or slip did not come from the trailing end.
bool computed_event(const ResultView *view, const ViewEvent *event, double *mu, double *length);

// Lengths over loads of all events of that kind, in order of their starts; the arrays are the
// caller's, also after a failure.
bool computed_events(const ResultView *view, ViewEventKind kind, ViewCurve *events, Error *err);

// Speed of the front of a rapid event over x, as of MEASURED_SPEED; below 0 where it ran towards
// the trailing end. The arrays are the caller's, also after a failure; there may be no points.
bool computed_front_speed(ResultView *view, const ViewEvent *event, ViewCurve *curve, Error *err);

// True if points k and k + 1 of such a curve are neighbours, and the front ran the same way in
// both.
bool computed_speeds_join(const ResultView *view, const ViewCurve *curve, int64_t k);
// Size of the speed at x: linear between points that join, else that of the point whose interval it
// lies in; NaN: there is none.
double computed_speed(const ResultView *view, const ViewCurve *curve, double x);

// Reads view->area: the law's own measure, which the history holds, else the contact density.
// ERROR_INPUT: there is neither.
bool computed_area_read(ResultView *view, Error *err);
// Contact area over that at rest when the rod was at U, of the node nearest to x, linear between
// steps; NaN: beyond the block. view->area and statuses have been read.
double computed_area(const ResultView *view, double U, double x);

#endif
