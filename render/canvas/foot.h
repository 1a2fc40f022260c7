// SPDX-License-Identifier: GPL-2.0-or-later
// Lines below a figure, outside of its axes: what the run it shows was warned of. Called by
// render.c, which makes the picture higher by their height.
#ifndef AMONTONS_RENDER_CANVAS_FOOT_H
#define AMONTONS_RENDER_CANVAS_FOOT_H

#include "render/canvas/page.h"

enum { FOOT_LINES_MAX = 6, FOOT_LINE_SIZE = 160 };

typedef struct Foot {
    int32_t count;
    char line[FOOT_LINES_MAX][FOOT_LINE_SIZE];   // [count]
} Foot;

// warnings: one a line; "": none. width: of the page, points.
// Words that do not fit are left to run.json, and the last line says so.
Foot foot_wrap(const char *warnings, double width);
double foot_height(const Foot *foot);   // points; 0 without lines
void foot_draw(const Page *page, const Foot *foot);

#endif
