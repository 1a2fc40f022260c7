// SPDX-License-Identifier: GPL-2.0-or-later
// Which part of a history is shown enlarged: the last precursors before a bulk sliding, as in
// figures 1(b) inset and 1(d) of the paper. Numbers only; called by the figures.
#ifndef AMONTONS_RENDER_VIEW_ZOOM_H
#define AMONTONS_RENDER_VIEW_ZOOM_H

#include "render/view/result_view.h"

typedef struct Zoom {
    bool found;   // false: no sliding was seen, the rest is not set
    double U_start;   // where the sliding before that ended, or the history begins, length
    bool smooth;   // no rapid precursor is in it: there is nothing that enlarging would show
    double U_slide;   // where bulk sliding starts, length
    double U_low, U_high;   // the part to show: precursors before it and the start of sliding
} Zoom;

// The last sliding whose cycle is periodic and has bounded rapid precursors; failing that the last
// periodic one, the last with precursors, the last. Without tables (a run that did not end): the
// last large drop of mu.
Zoom zoom_choose(const ResultView *view);

#endif
