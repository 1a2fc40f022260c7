// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_page.h"

#include "base/memory.h"
#include "render/film/film_block.h"
#include "render/figures/color_scale.h"
#include "render/figures/figure_axes.h"

#include <math.h>
#include <stdio.h>

enum { WORDS_SIZE = 200, RANGE_PARTS = 500, DECIMALS_MAX = 7 };

static const double HEIGHT = 308,
                    WIDTH = 440;   // points of a page at least: letters are seen from afar
static const double POINT_LEAST = 1.4;   // pixels: a small film has fewer points
static const double INCH = 25.4, POINTS_AN_INCH = 72;   // mm; of a page
static const double HEAD = 17, BASELINE = 12;   // points: title and clock; their baseline
static const double MARGIN = 5;   // points
static const double BAND_SHARE = 0.27, BAND_LEAST = 62, BAND_MOST = 95;   // of the height; points
static const double LEFT_SHARE = 0.60;   // of the width: the block, or the slip rate
static const double TITLE_SIZE = 8.5;   // points
static const double GAP = 10;   // points between the columns

struct FilmPage {
    FilmPageDef def;
    Page base, frame;   // what stands; what is seen. Owned
    FilmBand band;
    FilmForce force;
    FilmProfile profile;
    bool in_space;   // the contact as a plane, in the place of its profile
    FilmPlane plane;
    double *states;   // [rows * nodes] shown of the contact in the place of slip rates; NULL: none
    FilmBlock block;   // where fields are stored
    int32_t U_decimals, t_decimals;
};

// --- layout --------------------------------------------------------------------------------------

static bool page_open(const FilmPage *self, Page *page, Error *err)
{
    double point =
        fmax(fmin(self->def.film->height / HEIGHT, self->def.film->width / WIDTH), POINT_LEAST);
    PictureStyle style = {.dpi = point * POINTS_AN_INCH, .dark = self->def.film->style.dark};
    style.width = self->def.film->width / style.dpi * INCH;
    PageDef def = {.style = &style,
                   .height = (double)self->def.film->height / self->def.film->width};
    return page_begin(page, &def, err);
}

static bool lay_out(FilmPage *page, Error *err)
{
    double point = page->base.point;
    double width = page->def.film->width, height = page->def.film->height;
    const FilmClock *clock = page->def.clock;
    const double t[2] = {clock->t[0], clock->t[clock->frames - 1]};
    double band = fmin(fmax(BAND_SHARE * height, BAND_LEAST * point), BAND_MOST * point);
    Box main = {MARGIN * point, HEAD * point, width - MARGIN * point, height - band};
    Box left = main, right = main;
    Box foot = {main.left, main.bottom + 2 * point, main.right, height - 1 * point};
    left.right = round(main.left + LEFT_SHARE * (main.right - main.left));
    right.left = left.right + GAP * point;
    if (!(main.bottom - main.top > 60 * point) || !(right.right - right.left > 90 * point))
        return REFUSE(err, "%d by %d pixels are too few for a film", page->def.film->width,
                      page->def.film->height);
    if (page->block.stored) {
        Box lower = right;
        lower.top = right.bottom = (right.top + right.bottom) / 2;
        if (!film_block_place(&page->base, &left, &page->block, err)) return false;
        left = lower;
    }

    // The contact, now: its slip rates along x, in space all of it.
    if (page->in_space && !film_plane_create(&page->base, &left, &page->plane, err)) return false;
    if (!page->in_space) film_profile_place(&page->base, &left, &page->profile);
    film_force_place(&page->base, &right, t, &page->force);
    if (page->block.stored && !page->in_space)   // one above the other: frames begin at one line
        page->force.axes.box.left = page->profile.axes.box.left =
            fmax(page->force.axes.box.left, page->profile.axes.box.left);
    return film_band_create(&page->base, &foot, &page->band, err);
}

// Digits behind the point, so that the clock is seen to go on where it is slowest.
static int32_t decimals_of(double step, double range)
{
    double least = fmin(step, range / RANGE_PARTS);
    return least > 0 ? (int32_t)fmin(fmax(ceil(-log10(least)), 0), DECIMALS_MAX) : 0;
}

// --- what moves ----------------------------------------------------------------------------------

bool film_page_show(FilmPage *page, int32_t k, const uint8_t **pixels, int32_t *stride, Error *err)
{
    FilmMoment now = film_moment(page->def.view, page->def.clock->t[k]);
    if (page->block.stored && !film_block_show(&page->base, &page->block, k, now.t, err))
        return false;
    film_force_pass(&page->base, &page->force, &now);
    canvas_copy(page->frame.canvas, page->base.canvas);

    // "t = 1148.12 t_0", or in SI "t = 12.345 s", and U.
    char words[WORDS_SIZE];
    double point = page->frame.point;
    const ResultView *view = page->def.view;
    TextStyle style = {.size = TITLE_SIZE * point, .color = INK, .across = 1};
    const FilmClock *clock = page->def.clock;
    Axis U = figure_length_axis(view, "U", 0, film_moment(view, clock->t[clock->frames - 1]).U);
    snprintf(words, sizeof words, "%s = %.*f     ~{t} %s = %.*f", U.label, page->U_decimals,
             now.U * U.factor, view->si ? "(s)" : "/ ~{t}_{0}", page->t_decimals, now.t);
    text_draw(page->frame.text, &style,
              (Point){page->def.film->width - 2 * MARGIN * point, BASELINE * point}, words);

    film_band_now(&page->frame, &page->band, k);
    film_force_now(&page->frame, &page->force, &now);
    if (page->in_space && !film_plane_now(&page->frame, &page->plane, &now, err)) return false;
    if (!page->in_space) film_profile_now(&page->frame, &page->profile, &now);
    if (page->block.stored) film_block_contact(&page->frame, &page->block, film_nearest_row(&now));
    *pixels = canvas_pixels(page->frame.canvas, stride, err);
    return *pixels != NULL;
}

int32_t film_page_still(const FilmPage *page)
{
    return page->block.still_most;
}

// --- begin and end -------------------------------------------------------------------------------

FilmPage *film_page_create(const FilmPageDef *def, Error *err)
{
    FilmPage *page = NEW_ARRAY(FilmPage, 1, err);
    TRY(page);
    page->def = *def;
    page->block = (FilmBlock){
        .clock = def->clock,
        .source = {.folder = def->folder, .view = def->view, .depth = def->film->style.depth},
        .magnification = def->film->magnification};
    page->force.view = page->profile.view = page->band.view = page->plane.view = def->view;
    page->in_space = def->view->line && result_file_has_faces(def->view->file);
    page->band.clock = def->clock;

    // The values that the film shows: of the contact the state that def->film->of names, or slip
    // rates; of the block the field.
    ResultView *view = def->view;
    const FilmClock *clock = def->clock;
    Colorbar bar = slip_scale(view, fabs(view->number[NUMBER_ROD_VELOCITY]));
    bool state = def->film->of && result_view_choose_state(view, def->film->of);
    TRY(block_quantity_find(state ? NULL : def->film->of, &page->block.source.quantity, err));
    if (state) {
        char name[VIEW_STATE_SIZE];
        ValueWords words = state_words(view, name);
        const double range[2] = {film_moment(view, clock->t[0]).U,
                                 film_moment(view, clock->t[clock->frames - 1]).U};
        TRY(result_view_read(view, SERIES_STATE, false, &page->states, err));
        TRY(history_bar_fit(view, range, page->states, &words, NULL, &bar, err));
    }
    page->band.map.bar = page->profile.bar = page->plane.bar = bar;
    page->band.map.states = page->states;
    page->band.map.sign = state ? -1 : 0;
    page->plane.state = state;
    page->profile.values = state ? page->states : view->slip_rate;

    // The pages of what stands and of what moves.
    TRY(page_open(page, &page->base, err));
    TRY(page_open(page, &page->frame, err));
    TRY(film_block_open(&page->block, err));
    if (def->film->of && !state && !page->block.stored)
        FAIL(err, ERROR_INPUT,
             "of %s: the run stored no fields of its block then; run the scene with output: "
             "{fields: film}, and film that",
             def->film->of);
    TRY(lay_out(page, err));
    double V = fabs(view->number[NUMBER_ROD_VELOCITY]);
    double step = page->band.speed_low / clock->rate;
    double duration = clock->t[clock->frames - 1] - clock->t[0];
    double last = film_moment(view, clock->t[clock->frames - 1]).U;
    double factor = figure_length_axis(view, "U", 0, last).factor;
    page->t_decimals = decimals_of(step, duration);
    page->U_decimals = decimals_of(step * V * factor, duration * V * factor);
    page->block.U_decimals = page->U_decimals;
    double point = page->base.point;
    TextStyle style = {.size = TITLE_SIZE * point, .color = INK};
    if (page->def.title[0])
        text_draw(page->base.text, &style, (Point){2 * MARGIN * point, BASELINE * point},
                  page->def.title);
    film_band_draw(&page->base, &page->band);
    if (page->in_space)
        film_plane_draw(&page->base, &page->plane);
    else
        film_profile_draw(&page->base, &page->profile);
    film_force_draw(&page->base, &page->force);
    if (page->block.stored) film_block_draw(&page->base, &page->block);
    return page;
cleanup:
    film_page_destroy(page);
    return NULL;
}

void film_page_destroy(FilmPage *page)
{
    if (!page) return;
    page_destroy(&page->base);
    page_destroy(&page->frame);
    film_band_destroy(&page->band);
    film_block_close(&page->block);
    film_plane_destroy(&page->plane);
    memory_free_all(page->states, page);
}
