// SPDX-License-Identifier: GPL-2.0-or-later
// One picture: a figure by its name, or several of them as panels of one page. Called by render.c
// for the files of a result, and by frames/ for a page.
#ifndef AMONTONS_RENDER_FIGURES_PICTURE_H
#define AMONTONS_RENDER_FIGURES_PICTURE_H

#include "render/figures/figures.h"

enum { PANELS_MAX = 12 };

// A figure is made by a row of the table in picture.c.
typedef struct FigureKind {
    double height_over_width;   // on a column of a journal; 0: draw_whole finds it
    FigureFunction draw;   // on a page that has begun
    WholeFigureFunction draw_whole;   // in its place: begins the page itself, and may need fields
    bool own_axes;   // no U along x: it cannot be a panel
    bool asked_only;   // left out where all figures are drawn, unless measurements go with it
    FigureThere *is_there;   // NULL: every result has what it shows
    FigureTable *write_table;   // NULL: there are no numbers beside its picture
    const char *page_format;   // in a result's page, "svg" or "png"; NULL: it has no place there
    const char *page_words, *page_caption;   // for readers who do not see it; below it, markup
} FigureKind;

typedef struct Figure {
    FigureId id;
    const char *name, *title;   // as in PICTURE_FIGURES
    const FigureKind *kind;
} Figure;

const Figure *figure_get(FigureId id);

// The figure called `name`, or ERROR_INPUT with the names there are.
bool figure_find(const char *name, const Figure **figure, Error *err);

// True if a result has what the figure shows.
bool figure_is_there(const Figure *figure, const ResultView *view);

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

#endif
