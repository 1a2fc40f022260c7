// SPDX-License-Identifier: GPL-2.0-or-later
// One picture: a figure by its name, or several of them as panels of one page. Called by render.c
// for the files of a result, and by frames/ for a page.
#ifndef AMONTONS_RENDER_FIGURES_PICTURE_H
#define AMONTONS_RENDER_FIGURES_PICTURE_H

#include "render/figures/figures.h"

enum { PANELS_MAX = 12 };

// Shape of a figure, and the function that draws it.
typedef struct FigureShape {
    double height_over_width;   // on a column of a journal
    FigureFunction draw;
    bool own_axes;   // no U along x: it cannot be a panel, and is drawn for who asks
    WholeFigureFunction draw_whole;   // in its place: begins the page itself, and needs fields
} FigureShape;

typedef struct Figure {
    FigureId id;
    const char *name, *title;
    const FigureShape *shape;
} Figure;

const Figure *figure_get(FigureId id);

// The figure called `name`, or ERROR_INPUT with the names there are.
bool figure_find(const char *name, const Figure **figure, Error *err);

// Whether a result has what a figure of that name shows.
bool figure_is_there(const char *name, const ResultView *view);

// One of the panels of a page.
typedef struct Panel {
    const Figure *figure;
    double shape;   // height over the page's width
    int32_t state;   // which the view stands for while it is drawn
} Panel;

typedef struct Picture {
    const Figure *figure;   // NULL: panels
    int32_t count;
    Panel panels[PANELS_MAX];   // [count] only their figures are given
} Picture;

// Adds a figure to a picture that has room for one more. ERROR_INPUT: it is full.
bool picture_add(Picture *picture, const Figure *figure, Error *err);

// Draws it on a fresh page, to be finished. folder: that of the result.
bool picture_draw(const Picture *picture, const char *folder, const PictureRequest *request,
                  ResultView *view, Page *page, Error *err);

// The figure called `name`, one of the history alone, on a fresh page.
bool figure_draw(const char *name, ResultView *view, const PictureStyle *style, Page *page,
                 Error *err);

#endif
