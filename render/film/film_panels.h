// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of a film's page: F_T/F_N against U with a dot that runs along, and the slip rate, or a
// state, as it is now: along the contact, or in space over all of it. Called by film_page.
#ifndef AMONTONS_RENDER_FILM_FILM_PANELS_H
#define AMONTONS_RENDER_FILM_FILM_PANELS_H

#include "render/canvas/colorbar.h"
#include "render/canvas/page.h"
#include "render/film/film_times.h"

typedef struct FilmForce {
    const ResultView *view;
    Axes axes;
    int64_t first, last;   // rows of the history inside the film
    int64_t drawn;   // the row up to which the curve is drawn in full colour
} FilmForce;

// In `cell`, pixels, for times from t[0] to t[1].
void film_force_place(const Page *page, const Box *cell, const double t[2], FilmForce *force);
void film_force_draw(const Page *page, const FilmForce *force);   // what stands
// Draws the part that the film has passed on the page that stands, so that it stays.
void film_force_pass(const Page *page, FilmForce *force, const FilmMoment *now);
void film_force_now(const Page *page, const FilmForce *force, const FilmMoment *now);

typedef struct FilmProfile {
    const ResultView *view;
    const double *values;   // [rows * nodes] slip rates, or states; not owned
    Colorbar bar;   // of them
    Axes axes;
} FilmProfile;

void film_profile_place(const Page *page, const Box *cell, FilmProfile *profile);
void film_profile_draw(const Page *page, const FilmProfile *profile);   // what stands
void film_profile_now(const Page *page, const FilmProfile *profile, const FilmMoment *now);

typedef struct FilmPlane {
    ResultView *view;   // in space, with faces
    bool state;   // the view's is shown in the place of slip rates
    Colorbar bar;   // of what is shown
    Axes axes;
    double *values;   // [rows * all_nodes]; owned, like the next
    float *level;   // [all_nodes] work
} FilmPlane;

// Draws to scale in `cell`, pixels. Reads what it needs.
bool film_plane_create(const Page *page, const Box *cell, FilmPlane *plane, Error *err);
void film_plane_destroy(FilmPlane *plane);   // zeroed is fine
void film_plane_draw(const Page *page, const FilmPlane *plane);   // what stands
bool film_plane_now(const Page *page, const FilmPlane *plane, const FilmMoment *now, Error *err);

#endif
