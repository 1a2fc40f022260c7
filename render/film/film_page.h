// SPDX-License-Identifier: GPL-2.0-or-later
// The page of a film: the block, or the slip rate alone where no fields are stored; the force
// curve; the band of stretched time. What stands is drawn once, on a page of its own, which each
// frame begins as a copy of. Called by film.
#ifndef AMONTONS_RENDER_FILM_FILM_PAGE_H
#define AMONTONS_RENDER_FILM_FILM_PAGE_H

#include "render/figures/block_page.h"
#include "render/film/film_clock.h"

typedef struct FilmPageDef {
    const char *folder;   // of the result
    ResultView *view;   // slip rates and statuses have been read
    const FilmClock *clock;
    const FilmRequest *film;   // complete
    const char *title;   // "": none
} FilmPageDef;

typedef struct FilmPage FilmPage;

FilmPage *film_page_create(const FilmPageDef *def, Error *err);
void film_page_destroy(FilmPage *page);   // NULL is fine

// Frame k, which follows k - 1: *pixels as canvas_pixels has them.
bool film_page_show(FilmPage *page, int32_t k, const uint8_t **pixels, int32_t *stride, Error *err);

// The most frames so far through which one stored field stood; 0: there are no fields.
int32_t film_page_still(const FilmPage *page);

#endif
