// SPDX-License-Identifier: GPL-2.0-or-later
// The moments of a history that maps of the contact show, and when rapid slip came to each node.
// Numbers only. Called by figure_contact_plane.
#ifndef AMONTONS_RENDER_VIEW_CONTACT_MOMENTS_H
#define AMONTONS_RENDER_VIEW_CONTACT_MOMENTS_H

#include "render/view/result_view.h"

enum { MOMENTS_MAX = 12 };

typedef struct ContactMoments {
    int32_t count;
    int64_t row[MOMENTS_MAX];   // [count] of the history, rising
    bool asked;   // by the caller; else they are of one event
    int64_t first, last;   // rows of that event, from the step before it
    int64_t before;   // row where the event before it ended; 0: there was none
    double start;   // time when slip was first rapid somewhere in it
    double *arrival;   // [nodes] time since then, NaN: not in this event; owned; NULL where moments
        // were asked for
} ContactMoments;

// rates: [rows * nodes] |slip rate|. at: "U=0.01,U=0.02", "t=12", or NULL: six of the last sliding,
// or else of the last rapid event: two while slow slip grows before it, the step before it, when
// rapid slip had come to half and to all that it reached, and the fastest. whole: `at` names an
// event instead, the nearest. ERROR_INPUT: there is none.
bool contact_moments_find(const ResultView *view, const double *rates, const char *at, bool whole,
                          ContactMoments *moments, Error *err);
void contact_moments_destroy(ContactMoments *moments);   // zeroed is fine

#endif
