// SPDX-License-Identifier: GPL-2.0-or-later
// The band at the foot of a film: its time from left to right, on which the run's time is
// stretched where slip is rapid. A strip that is the darker the slower time goes, the slip map over
// this axis, and below it U. Called by film_page.
#ifndef AMONTONS_RENDER_FILM_FILM_BAND_H
#define AMONTONS_RENDER_FILM_FILM_BAND_H

#include "render/figures/figure_maps.h"
#include "render/film/film_clock.h"
#include "render/film/film_times.h"

typedef struct FilmBand {
    const ResultView *view;   // slip rates have been read
    const FilmClock *clock;
    MapPage map;   // its axes: x is seconds of film; the caller sets bar, states and sign; owned
    Box strip;
    double speed_low, speed_high;   // of the clock
} FilmBand;

// In `cell`, pixels. Fills the map.
bool film_band_create(const Page *page, const Box *cell, FilmBand *band, Error *err);
void film_band_destroy(FilmBand *band);   // zeroed is fine

// Draws the parts that stand: strip, map, axes.
void film_band_draw(const Page *page, const FilmBand *band);
// Draws the parts that move at frame k: the time to come is pale; "1 s of film = ...".
void film_band_now(const Page *page, const FilmBand *band, int32_t k);

// A time in words, with its unit: "0.43 ~{t}_{0}", "12 ms". decimals: below 0: two digits.
enum { FILM_WORDS_SIZE = 96 };
void film_time_words(const ResultView *view, double t, char words[FILM_WORDS_SIZE]);

#endif
