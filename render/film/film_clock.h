// SPDX-License-Identifier: GPL-2.0-or-later
// From the time of a film to the time of the run. Numbers only; called by film and film_page.
//
// A second of film is a part of the run that is the shorter the faster the contact slips: by
// (2 V / v)^p while the fastest node slips at v > 2 V, rapidly, and the same otherwise. The power p
// is the one with which all rapid slip lasts as long on the film as all the rest (2 at most).
#ifndef AMONTONS_RENDER_FILM_FILM_CLOCK_H
#define AMONTONS_RENDER_FILM_FILM_CLOCK_H

#include "base/error.h"

typedef struct FilmClockDef {
    int64_t rows;   // accepted steps, at least 2
    const double *t;   // [rows] time, rising
    const double *fastest;   // [rows] largest |slip rate| of the contact, velocity
    double V;   // rod, velocity; 0: nothing counts as rapid
    double low, high;   // of t: the film's first and last frame
    int32_t frames, rate;   // frames: at least 2; a second
} FilmClockDef;

typedef struct FilmClock {
    int32_t frames, rate;
    double *t;   // [frames] time shown, rising from low to high; owned
    double *speed;   // [frames] time that passes in a second of film there; owned
} FilmClock;

bool film_clock_create(const FilmClockDef *def, FilmClock *clock, Error *err);
void film_clock_destroy(FilmClock *clock);   // zeroed is fine

// Seconds of film at time t, from 0 to those of the last frame.
double film_clock_seconds(const FilmClock *clock, double t);

#endif
