// SPDX-License-Identifier: GPL-2.0-or-later
// Which part of U a figure against U shows: what was asked for, a cycle too; else all of it, or of
// a run with so many slidings that each would be a hair the last ones, and the figure says so.
#ifndef AMONTONS_RENDER_VIEW_RANGE_H
#define AMONTONS_RENDER_VIEW_RANGE_H

#include "amontons_pictures.h"
#include "render/view/result_view.h"

enum { RANGE_WORDS_SIZE = 64 };

typedef struct ViewRange {
    double low, high;   // U, length
    char words[RANGE_WORDS_SIZE];   // "the last 30 of 281 slidings"; "": all, or what was asked
} ViewRange;

bool view_range_find(const ResultView *view, const PictureStyle *style, ViewRange *shown,
                     Error *err);

#endif
