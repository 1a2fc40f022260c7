// SPDX-License-Identifier: GPL-2.0-or-later
// Part of the page of a film of a block in space: the slip rate, or a state, over its contact as it
// is now. Called by film_page.
#ifndef AMONTONS_RENDER_FILM_FILM_PLANE_H
#define AMONTONS_RENDER_FILM_FILM_PLANE_H

#include "render/canvas/colorbar.h"
#include "render/film/film_times.h"

typedef struct FilmPlane {
    ResultView *view;   // in space, with faces
    bool state;   // the view's is shown in the place of slip rates
    Colorbar bar;   // of what is shown
    Axes axes;
    double *values;   // [rows * all_nodes]; owned, like the next
    float *level;   // [all_nodes] work
} FilmPlane;

// To scale in `cell`, pixels. Reads what it needs.
bool film_plane_create(const Page *page, const Box *cell, FilmPlane *plane, Error *err);
void film_plane_destroy(FilmPlane *plane);   // zeroed is fine
void film_plane_draw(const Page *page, const FilmPlane *plane);   // what stands
bool film_plane_now(const Page *page, const FilmPlane *plane, const FilmMoment *now, Error *err);

#endif
