// SPDX-License-Identifier: GPL-2.0-or-later
// Several figures of the history on one page. Called by picture.c.
#ifndef AMONTONS_RENDER_FIGURES_PANELS_H
#define AMONTONS_RENDER_FIGURES_PANELS_H

#include "render/figures/figures.h"

enum { PANELS_MAX = 12 };

typedef struct PanelFigure {
    const char *name;
    FigureId figure;
    double shape;   // height over the page's width
    FigureFunction draw;
    int32_t state;   // which the view stands for while it is drawn
} PanelFigure;

// On a page begun here. figures: [count], at most PANELS_MAX; def: but its height.
bool panels_draw(Page *page, PageDef *def, const PanelFigure *figures, int32_t count,
                 ResultView *view, Error *err);

#endif
