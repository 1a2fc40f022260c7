// SPDX-License-Identifier: GPL-2.0-or-later
// Which cycle of a history figures of one cycle show, and which part of it is enlarged: the last
// precursors before a bulk sliding, as in figures 1(b) inset and 1(d) of the paper. A cycle goes
// from the end of one sliding to the end of the next; the first, the first loading, begins with the
// history. Numbers only; called by the figures.
#ifndef AMONTONS_RENDER_VIEW_ZOOM_H
#define AMONTONS_RENDER_VIEW_ZOOM_H

#include "amontons_pictures.h"
#include "render/view/result_view.h"

enum { ZOOM_WORDS_SIZE = 48 };

typedef struct Zoom {
    bool found;   // false: no sliding was seen, or all cycles are asked for; the rest is not set
    int32_t cycle, cycles;   // its number, from 1, of how many
    char words[ZOOM_WORDS_SIZE];   // "first loading", "cycle 5 of 6"; also "all cycles"; may be ""
    double U_stop;   // where the sliding ended, or the history does; length
    double U_behind;   // a little behind the sliding, for what shows the whole cycle; length
    double U_start;   // where the sliding before that ended, or the history begins, length
    bool smooth;   // no rapid precursor is in it: there is nothing that enlarging would show
    double U_slide;   // where bulk sliding starts, length
    double U_low, U_high;   // the part to show: precursors before it and the start of sliding
} Zoom;

// The cycle that is asked for. Where none is: in a run of one or two slidings the first loading;
// else the last cycle that is periodic and has bounded rapid precursors; where none is, the first
// loading if it has precursors, the last cycle with precursors, the last periodic one, the last.
// Without tables (a run that did not end) there is none.
Zoom zoom_choose(const ResultView *view);

// True if an event that began when the rod was at U belongs to the cycle, its sliding included; all
// do where no sliding bounds it.
bool zoom_covers(const Zoom *zoom, double U);

// The cycles that are shown one by one, from *first to *last, as view->cycle may be.
void zoom_cycles(const ResultView *view, int32_t *first, int32_t *last);

// Reads "first", "last", "all" or a number into view->cycle. ERROR_INPUT: it is none of these, or
// the block slid less often. Where it never slid, all of the history is the first loading.
bool zoom_choose_cycle(ResultView *view, const char *words, Error *err);

// The sliding of the cycle that is asked for; NULL: none is, or the history has no such table.
const ViewEvent *zoom_sliding(const ResultView *view);

enum { RANGE_WORDS_SIZE = 64 };

// Which part of U a figure against U shows: what was asked for, a cycle too; else all of it, or of
// a run with so many slidings that each would be a hair the last ones, and the figure says so.
typedef struct ViewRange {
    double low, high;   // U, length
    char words[RANGE_WORDS_SIZE];   // "the last 30 of 281 slidings"; "": all, or what was asked
} ViewRange;

bool view_range_find(const ResultView *view, const PictureStyle *style, ViewRange *shown,
                     Error *err);

#endif
