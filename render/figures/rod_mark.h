// SPDX-License-Identifier: GPL-2.0-or-later
// The rod beside a block: the strip of the face that it pushes, and an arrow against it. Called by
// mesh_picture and block_page.
#ifndef AMONTONS_RENDER_FIGURES_ROD_MARK_H
#define AMONTONS_RENDER_FIGURES_ROD_MARK_H

#include "render/canvas/axes.h"

static const Color ROD_COLOR = {0.80f, 0.22f, 0.08f, 1};

typedef struct RodMark {
    double face;   // its x
    double low, high;   // the strip's z; NaN: nothing is drawn
    double share;   // of the usual size: 1
} RodMark;
// True if a node at height z is of the body that a rod pushes between these heights: a base lies
// below z = 0.
static inline bool rod_mark_pushes(double low, double high, double z)
{
    return low + high < 0 ? z < 0 : z > 0;
}
void rod_mark_draw(const Page *page, const Axes *axes, const RodMark *rod);

// A line from `from` to `to` with a head there, `size` pixels long.
void arrow_draw(const Page *page, const Stroke *stroke, Point from, Point to, double size);

#endif
