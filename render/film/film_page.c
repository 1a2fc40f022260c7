// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_page.h"

#include "base/memory.h"
#include "render/film/film_plane.h"
#include "render/figures/slip_scale.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { SAMPLES_MAX = 24, WORDS_SIZE = 200, RANGE_PARTS = 500, DECIMALS_MAX = 7 };

static const double HEIGHT = 308,
                    WIDTH = 440;   // points of a page at least: letters are seen from afar
static const double POINT_LEAST = 1.4;   // pixels: a small film has fewer points
static const double INCH = 25.4, POINTS_AN_INCH = 72;   // mm; of a page
static const double HEAD = 17, BASELINE = 12;   // points: title and clock; their baseline
static const double MARGIN = 5;   // points
static const double BAND_SHARE = 0.27, BAND_LEAST = 62, BAND_MOST = 95;   // of the height; points
static const double LEFT_SHARE = 0.60;   // of the width: the block, or the slip rate
static const double BAR_GAP = 5, BAR_ROOM = 58;   // points: block to colour bar; what that takes
static const double WORDS_HEIGHT = 11, LEGEND_HEIGHT = 11;   // points: over and below the block
static const double TITLE_SIZE = 8.5;   // points
static const double LEGEND_LEFT = 12;   // points: block's frame to the words over and below it
static const double GAP = 10;   // points between the columns
static const double BAR_LONGEST = 130;   // points

struct FilmPage {
    FilmPageDef def;
    Page base, frame;   // what stands; what is seen. Owned
    FilmBand band;
    FilmForce force;
    FilmProfile profile;
    bool in_space;   // the contact as a plane, in the place of its profile
    FilmPlane plane;
    BlockTimes times;   // owned
    int32_t *stored;   // [clock->frames] the field nearest in time; NULL: there are none; owned
    int32_t still, still_most;   // frames for which the block has stood, and did at most
    int32_t shown;   // the one that stands on the base; -1: none, or a mixture
    Block pair[2];   // of neighbouring steps, to be mixed; owned
    int32_t pair_index[2];   // of `times`; -1: none
    BlockPage map;
    Axes block;
    Block block_shown;   // its field; owned
    BlockQuantity quantity;
    double magnification;
    int32_t U_decimals, t_decimals;
};

// --- fields --------------------------------------------------------------------------------------

static bool has_fields(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/fields.pvd", folder);
    return access(path, R_OK) == 0;
}

// For each frame the field stored nearest to it in time; none where all are outside of the film.
static bool choose_fields(FilmPage *page, Error *err)
{
    const FilmClock *clock = page->def.clock;
    const BlockTimes *times = &page->times;
    bool inside = false;
    if (!has_fields(page->def.folder)) return true;
    TRY(block_times_read(page->def.folder, page->def.view, &page->times, err));
    for (int32_t k = 0; k < times->count; ++k)
        inside = inside || (times->times[k].t >= clock->t[0] &&
                            times->times[k].t <= clock->t[clock->frames - 1]);
    if (!inside) return true;
    TRY(page->stored = NEW_ARRAY(int32_t, clock->frames, err));
    int32_t at = 0;
    for (int32_t k = 0; k < clock->frames; ++k) {
        while (at + 1 < times->count &&
               fabs(times->times[at + 1].t - clock->t[k]) <= fabs(times->times[at].t - clock->t[k]))
            ++at;
        page->stored[k] = at;
    }
cleanup:
    return error_is_clean(err);
}

static bool read_stored(const FilmPage *page, int32_t index, Block *block, Error *err)
{
    TRY(block_read(page->def.folder, page->def.view, &page->times, index, block, err));
    TRY(block_take(block, page->quantity, err));
    block_deform(block, page->magnification);
cleanup:
    return error_is_clean(err);
}

// Colours and size hold for the whole film: they are those of some of its fields, evenly spaced in
// its time.
static bool fit_fields(FilmPage *page, double extent[4], Error *err)
{
    Block sample[SAMPLES_MAX] = {0};
    int32_t count = 0, frames = page->def.clock->frames;
    for (int32_t k = 0; k < SAMPLES_MAX; ++k) {
        int32_t index = page->stored[(int64_t)k * (frames - 1) / (SAMPLES_MAX - 1)];
        if (k > 0 && index == page->stored[(int64_t)(k - 1) * (frames - 1) / (SAMPLES_MAX - 1)])
            continue;
        TRY(read_stored(page, index, &sample[count++], err));
    }
    page->magnification = page->def.magnification;
    for (int32_t k = 0; k < count && !(page->def.magnification > 0); ++k) {
        double own = block_magnification(&sample[k]);
        if (k == 0 || own < page->magnification) page->magnification = own;
    }
    for (int32_t k = 0; k < count; ++k) {
        double own[4];
        block_deform(&sample[k], page->magnification);
        block_extent(&sample[k], own);
        for (int32_t d = 0; d < 4; ++d)
            extent[d] = k == 0 ? own[d] : d % 2 ? fmax(extent[d], own[d]) : fmin(extent[d], own[d]);
    }
    TRY(block_page_fit(&page->map, sample, count, page->quantity, err));
cleanup:
    for (int32_t k = 0; k < SAMPLES_MAX; ++k) block_destroy(&sample[k]);
    return error_is_clean(err);
}

// --- layout --------------------------------------------------------------------------------------

static bool page_open(const FilmPage *self, Page *page, Error *err)
{
    double point = fmax(fmin(self->def.height / HEIGHT, self->def.width / WIDTH), POINT_LEAST);
    PictureStyle style = {.dpi = point * POINTS_AN_INCH, .dark = self->def.dark};
    style.width = self->def.width / style.dpi * INCH;
    PageDef def = {.style = &style, .height = (double)self->def.height / self->def.width};
    return page_begin(page, &def, err);
}

// The block in the middle of `cell`, to scale, with its colour bar at its right.
static void place_block(FilmPage *page, const Box *cell, const double extent[4])
{
    double point = page->base.point, words = WORDS_HEIGHT + LEGEND_HEIGHT;
    double width = (cell->right - cell->left) / point - BAR_ROOM;
    double height = (cell->bottom - cell->top) / point - words;
    double scale = block_page_scale(extent, width, 1);
    double needed = block_page_height(extent, scale, 1);
    if (needed > height) {
        scale *= (height - (needed - scale * (extent[3] - extent[2]))) /
                 (scale * (extent[3] - extent[2]));
        needed = block_page_height(extent, scale, 1);
    }
    block_page_ranges(extent, scale, 1, &page->block);
    width = scale * (page->block.x.high - page->block.x.low);
    double left = cell->left,
           top = cell->top + (cell->bottom - cell->top - (needed + words) * point) / 2;
    page->block.box.left = round(left);
    page->block.box.right = page->block.box.left + round(width * point);
    page->block.box.top = round(top + WORDS_HEIGHT * point);
    page->block.box.bottom = page->block.box.top + round(needed * point);
}

// The contact, now: its slip rates along x, in space all of it.
static bool place_contact(FilmPage *page, const Box *cell, Error *err)
{
    if (page->in_space) return film_plane_create(&page->base, cell, &page->plane, err);
    film_profile_place(&page->base, cell, &page->profile);
    return true;
}

static bool lay_out(FilmPage *page, Error *err)
{
    double point = page->base.point, extent[4] = {0};
    double width = page->def.width, height = page->def.height;
    const FilmClock *clock = page->def.clock;
    const double t[2] = {clock->t[0], clock->t[clock->frames - 1]};
    double band = fmin(fmax(BAND_SHARE * height, BAND_LEAST * point), BAND_MOST * point);
    Box main = {MARGIN * point, HEAD * point, width - MARGIN * point, height - band};
    Box left = main, right = main;
    Box foot = {main.left, main.bottom + 2 * point, main.right, height - 1 * point};
    left.right = round(main.left + LEFT_SHARE * (main.right - main.left));
    right.left = left.right + GAP * point;
    if (!(main.bottom - main.top > 60 * point) || !(right.right - right.left > 90 * point))
        FAIL(err, ERROR_INPUT, "%d by %d pixels are too few for a film", page->def.width,
             page->def.height);
    if (page->stored) {
        Box lower = right;
        lower.top = right.bottom = (right.top + right.bottom) / 2;
        TRY(fit_fields(page, extent, err));
        place_block(page, &left, extent);
        TRY(place_contact(page, &lower, err));
    } else {
        TRY(place_contact(page, &left, err));
    }
    film_force_place(&page->base, &right, t, &page->force);
    if (page->stored && !page->in_space)   // one above the other: frames begin at one line
        page->force.axes.box.left = page->profile.axes.box.left =
            fmax(page->force.axes.box.left, page->profile.axes.box.left);
    TRY(film_band_create(&page->base, &foot, &page->band, err));
cleanup:
    return error_is_clean(err);
}

// Digits behind the point, so that the clock is seen to go on where it is slowest.
static int32_t decimals_of(double step, double range)
{
    double least = fmin(step, range / RANGE_PARTS);
    return least > 0 ? (int32_t)fmin(fmax(ceil(-log10(least)), 0), DECIMALS_MAX) : 0;
}

static void choose_decimals(FilmPage *page)
{
    const FilmClock *clock = page->def.clock;
    const ResultView *view = page->def.view;
    double V = fabs(view->number[NUMBER_ROD_VELOCITY]);
    double step = page->band.speed_low / clock->rate;
    double range = clock->t[clock->frames - 1] - clock->t[0];
    double last = film_moment(view, clock->t[clock->frames - 1]).U;
    double factor = figure_length_axis(view, "U", 0, last).factor;
    page->t_decimals = decimals_of(step, range);
    page->U_decimals = decimals_of(step * V * factor, range * V * factor);
}

// --- what stands ---------------------------------------------------------------------------------

static void draw_title(const FilmPage *page)
{
    double point = page->base.point;
    TextStyle style = {.size = TITLE_SIZE * point, .color = INK};
    if (page->def.title[0])
        text_draw(page->base.text, &style, (Point){2 * MARGIN * point, BASELINE * point},
                  page->def.title);
}

static void draw_bar(const FilmPage *page)
{
    const Box *box = &page->block.box;
    double point = page->base.point, middle = (box->top + box->bottom) / 2;
    double half = fmin(BAR_LONGEST * point, box->bottom - box->top - 8 * point) / 2;
    Box beside = {.left = round(box->right + BAR_GAP * point),
                  .top = round(middle - half),
                  .bottom = round(middle + half)};
    colorbar_draw(&page->base, &page->map.bar, &beside);
    block_page_legend(&page->base, (Point){box->left + LEGEND_LEFT * point,
                                           box->bottom + 0.5 * LEGEND_HEIGHT * point});
}

static void set_block_map(const FilmPage *page)
{
    uint8_t colors[3 * MAP_SIZE];
    color_map_fill(colors);
    canvas_set_map(page->base.canvas, colors, PAPER);
}

static bool draw_standing(FilmPage *page, Error *err)
{
    draw_title(page);
    film_band_draw(&page->base, &page->band);
    if (page->in_space)
        film_plane_draw(&page->base, &page->plane);
    else
        film_profile_draw(&page->base, &page->profile);
    TRY(film_force_draw(&page->base, &page->force, err));
    if (page->stored) {
        set_block_map(page);
        draw_bar(page);
    }
cleanup:
    return error_is_clean(err);
}

// Over the block: when its field was stored, and how much the deformation is enlarged.
static void draw_block_words(const FilmPage *page, const Block *block, bool mixed)
{
    char words[WORDS_SIZE];
    double point = page->base.point;
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK};
    Axis U = figure_length_axis(page->def.view, "U", 0, block->U);
    Box line = {page->block.box.left, page->block.box.top - WORDS_HEIGHT * point,
                page->block.box.right, page->block.box.top};
    draw_fill(page->base.canvas, PAPER, &line);
    int length = mixed ? 0
                       : snprintf(words, sizeof words, "stored at %s = %.*f,  ", U.label,
                                  page->U_decimals, block->U * U.factor);
    snprintf(words + length, sizeof words - (size_t)length, "deformation \u00d7 %g",
             page->magnification);
    style.size *= fmin(1, (line.right - line.left - LEGEND_LEFT * point) /
                              text_width(page->base.text, style.size, words));
    text_draw(page->base.text, &style,
              (Point){line.left + LEGEND_LEFT * point, line.bottom - 3 * point}, words);
}

static bool put_block(FilmPage *page, const Block *block, bool mixed, Error *err)
{
    set_block_map(page);
    draw_fill(page->base.canvas, PAPER, &page->block.box);
    if (!block_page_draw(&page->base, &page->map, block, &page->block, err)) return false;
    draw_block_words(page, block, mixed);
    return true;
}

// Only where a frame shows another stored field than the one before.
static bool draw_stored(FilmPage *page, int32_t index, Error *err)
{
    Block *block = &page->block_shown;
    if (index == page->shown) return true;
    block_destroy(block);
    TRY(read_stored(page, index, block, err));
    TRY(put_block(page, block, false, err));
    page->shown = index;
cleanup:
    return error_is_clean(err);
}

// Both of a pair, the one that is there already kept.
static bool read_pair(FilmPage *page, int32_t first, Error *err)
{
    if (page->pair_index[1] == first) {
        Block kept = page->pair[1];
        page->pair[1] = page->pair[0];
        page->pair[0] = kept;
        page->pair_index[1] = page->pair_index[0];
        page->pair_index[0] = first;
    }
    for (int32_t k = 0; k < 2; ++k) {
        if (page->pair_index[k] == first + k) continue;
        block_destroy(&page->pair[k]);
        page->pair_index[k] = -1;
        TRY(read_stored(page, first + k, &page->pair[k], err));
        page->pair_index[k] = first + k;
    }
cleanup:
    return error_is_clean(err);
}

// What is drawn of two stored fields, linear in time, in the place of the first: its own is read
// again where it is wanted.
static bool draw_mixture(FilmPage *page, int32_t first, double t, Error *err)
{
    TRY(read_pair(page, first, err));
    Block *a = &page->pair[0], *b = &page->pair[1];
    double part = (t - a->t) / (b->t - a->t);
    if (a->frame.node_count != b->frame.node_count)
        FAIL(err, ERROR_FILE, "two fields of the film have %d and %d nodes", a->frame.node_count,
             b->frame.node_count);
    block_mix(a, b, part);
    a->t = t;   // from here on to the second
    page->shown = -1;
    TRY(put_block(page, a, true, err));
cleanup:
    return error_is_clean(err);
}

// From one step to the next the block is linear in time, as all else is in the film; where steps
// between two stored fields are not known it shows the nearer one, and says when that was stored.
static bool draw_block(FilmPage *page, int32_t k, double t, Error *err)
{
    const BlockTimes *times = &page->times;
    int32_t first = page->stored[k];
    if (times->times[first].t > t && first > 0) --first;
    bool neighbours = first + 1 < times->count && times->times[first].t <= t &&
                      times->row[first + 1] == times->row[first] + 1;
    page->still = !neighbours && page->shown == page->stored[k] ? page->still + 1 : 1;
    if (page->still > page->still_most) page->still_most = page->still;
    return neighbours ? draw_mixture(page, first, t, err) : draw_stored(page, page->stored[k], err);
}

// --- what moves ----------------------------------------------------------------------------------

// "t = 1148.12 t_0", or in SI "t = 12.345 s", and U.
static void draw_clock(const FilmPage *page, const FilmMoment *now)
{
    char words[WORDS_SIZE];
    double point = page->frame.point;
    const ResultView *view = page->def.view;
    TextStyle style = {.size = TITLE_SIZE * point, .color = INK, .across = 1};
    const FilmClock *clock = page->def.clock;
    Axis U = figure_length_axis(view, "U", 0, film_moment(view, clock->t[clock->frames - 1]).U);
    snprintf(words, sizeof words, "%s = %.*f     ~{t} %s = %.*f", U.label, page->U_decimals,
             now->U * U.factor, view->si ? "(s)" : "/ ~{t}_{0}", page->t_decimals, now->t);
    text_draw(page->frame.text, &style,
              (Point){page->def.width - 2 * MARGIN * point, BASELINE * point}, words);
}

bool film_page_show(FilmPage *page, int32_t k, const uint8_t **pixels, int32_t *stride, Error *err)
{
    FilmMoment now = film_moment(page->def.view, page->def.clock->t[k]);
    if (page->stored) TRY(draw_block(page, k, now.t, err));
    film_force_pass(&page->base, &page->force, &now);
    canvas_copy(page->frame.canvas, page->base.canvas);
    draw_clock(page, &now);
    film_band_now(&page->frame, &page->band, k);
    film_force_now(&page->frame, &page->force, &now);
    if (page->in_space)
        TRY(film_plane_now(&page->frame, &page->plane, &now, err));
    else
        film_profile_now(&page->frame, &page->profile, &now);
    if (page->stored)
        block_page_contact(&page->frame, &page->map,
                           page->shown >= 0 ? &page->block_shown : &page->pair[0],
                           film_nearest_row(&now), &page->block);
    *pixels = canvas_pixels(page->frame.canvas, stride, err);
cleanup:
    return error_is_clean(err);
}

int32_t film_page_still(const FilmPage *page)
{
    return page->still_most;
}

// --- begin and end -------------------------------------------------------------------------------

FilmPage *film_page_create(const FilmPageDef *def, Error *err)
{
    double V = fabs(def->view->number[NUMBER_ROD_VELOCITY]);
    FilmPage *page = NEW_ARRAY(FilmPage, 1, err);
    TRY(page);
    page->def = *def;
    page->shown = page->pair_index[0] = page->pair_index[1] = -1;
    page->map = (BlockPage){.view = def->view, .share = 1};
    page->force.view = page->profile.view = page->band.view = page->plane.view = def->view;
    page->in_space = def->view->line && result_file_has_faces(def->view->file);
    page->band.clock = def->clock;
    page->band.map.bar = page->profile.bar = page->plane.bar = slip_scale(def->view, V);
    TRY(block_quantity_find(def->of, &page->quantity, err));
    TRY(page_open(page, &page->base, err));
    TRY(page_open(page, &page->frame, err));
    TRY(choose_fields(page, err));
    TRY(lay_out(page, err));
    choose_decimals(page);
    TRY(draw_standing(page, err));
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
    block_times_destroy(&page->times);
    block_destroy(&page->block_shown);
    film_plane_destroy(&page->plane);
    for (int32_t k = 0; k < 2; ++k) block_destroy(&page->pair[k]);
    memory_free(page->stored);
    memory_free(page);
}
