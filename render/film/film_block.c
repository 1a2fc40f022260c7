// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_block.h"

#include "base/memory.h"
#include "render/figures/figure_axes.h"

#include <math.h>
#include <stdio.h>

enum { SAMPLES_MAX = 24, WORDS_SIZE = 200 };

static const double BAR_GAP = 5, BAR_ROOM = 58;   // points: block to colour bar; what that takes
static const double WORDS_HEIGHT = 11, LEGEND_HEIGHT = 11;   // points: over and below the block
static const double LEGEND_LEFT = 12;   // points: block's frame to the words over and below it
static const double BAR_LONGEST = 130;   // points
static const double BAR_MARGIN = 4;   // points: above and below the bar, at least

// --- fields --------------------------------------------------------------------------------------

// Finds for each frame the field stored nearest to it in time; none where all are outside of the
// film.
bool film_block_open(FilmBlock *film, Error *err)
{
    const FilmClock *clock = film->clock;
    const BlockSource *source = &film->source;
    bool inside = false;
    film->shown = film->pair_index[0] = film->pair_index[1] = -1;
    if (!block_is_stored(source->folder)) return true;
    if (!block_source_open(&film->source, err)) return false;
    const FieldTime *times = source->times;
    for (int32_t k = 0; k < source->count; ++k)
        inside = inside || (times[k].t >= clock->t[0] && times[k].t <= clock->t[clock->frames - 1]);
    if (!inside) return true;
    if (!(film->stored = NEW_ARRAY(int32_t, clock->frames, err))) return false;
    int32_t at = 0;
    for (int32_t k = 0; k < clock->frames; ++k) {
        while (at + 1 < source->count &&
               fabs(times[at + 1].t - clock->t[k]) <= fabs(times[at].t - clock->t[k]))
            ++at;
        film->stored[k] = at;
    }
    return true;
}

static bool read_stored(const FilmBlock *film, int32_t index, Block *block, Error *err)
{
    if (!block_read(&film->source, index, block, err)) return false;
    block_deform(block, film->map.magnification);
    return true;
}

bool film_block_place(const Page *page, const Box *cell, FilmBlock *film, Error *err)
{
    int32_t sample[SAMPLES_MAX], count = 0, frames = film->clock->frames;

    // Colours and size hold for the whole film: they are those of some of its fields, evenly spaced
    // in its time.
    for (int32_t k = 0; k < SAMPLES_MAX; ++k) {
        int32_t index = film->stored[(int64_t)k * (frames - 1) / (SAMPLES_MAX - 1)];
        if (k > 0 && index == film->stored[(int64_t)(k - 1) * (frames - 1) / (SAMPLES_MAX - 1)])
            continue;
        sample[count++] = index;
    }
    if (!block_page_sample(&film->map, &film->source, sample, count, err)) return false;

    // The block in the middle of its cell.
    double point = page->point;
    double height = (cell->bottom - cell->top) / point - WORDS_HEIGHT - LEGEND_HEIGHT;
    block_page_size(&film->map, (cell->right - cell->left) / point - BAR_ROOM, height);
    double top = cell->top + (height - film->map.height) / 2 * point;
    block_page_place(page, &film->map, round(cell->left), round(top + WORDS_HEIGHT * point),
                     &film->axes);
    return true;
}

// --- what is drawn -------------------------------------------------------------------------------

void film_block_draw(const Page *page, const FilmBlock *film)
{
    const Box *box = &film->axes.box;
    double point = page->point, middle = (box->top + box->bottom) / 2;
    double half = fmin(BAR_LONGEST * point, box->bottom - box->top - 2 * BAR_MARGIN * point) / 2;
    Box beside = {.right = box->right, .top = round(middle - half), .bottom = round(middle + half)};
    colorbar_draw(page, &film->map.bar, &beside, BAR_GAP);
    block_page_legend(
        page, (Point){box->left + LEGEND_LEFT * point, box->bottom + 0.5 * LEGEND_HEIGHT * point},
        0);
}

// The block, and over it when its field was stored, and how much the deformation is enlarged.
static bool put_block(const Page *page, const FilmBlock *film, const Block *block, bool mixed,
                      Error *err)
{
    draw_fill(page->canvas, PAPER, &film->axes.box);
    if (!block_page_draw(page, &film->map, block, &film->axes, err)) return false;
    char words[WORDS_SIZE];
    double point = page->point;
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK};
    Axis U = figure_length_axis(film->source.view, "U", 0, block->U);
    Box line = {film->axes.box.left, film->axes.box.top - WORDS_HEIGHT * point,
                film->axes.box.right, film->axes.box.top};
    draw_fill(page->canvas, PAPER, &line);
    int length = mixed ? 0
                       : snprintf(words, sizeof words, "stored at %s = %.*f,  ", U.label,
                                  film->U_decimals, block->U * U.factor);
    snprintf(words + length, sizeof words - (size_t)length, "deformation \u00d7 %g",
             film->map.magnification);
    double left = line.left + LEGEND_LEFT * point;
    text_draw_within(page->text, &style, (Point){left, line.bottom - 3 * point}, line.right - left,
                     words);
    return true;
}

// From one step to the next the block is linear in time, as all else is in the film; where steps
// between two stored fields are not known it shows the nearer one, and says when that was stored.
bool film_block_show(const Page *page, FilmBlock *film, int32_t k, double t, Error *err)
{
    const BlockSource *source = &film->source;
    int32_t first = film->stored[k];
    if (source->times[first].t > t && first > 0) --first;
    bool neighbours = first + 1 < source->count && source->times[first].t <= t &&
                      source->row[first + 1] == source->row[first] + 1;
    film->still = !neighbours && film->shown == film->stored[k] ? film->still + 1 : 1;
    if (film->still > film->still_most) film->still_most = film->still;
    if (!neighbours) {
        if (film->stored[k] == film->shown) return true;   // it stands on the page
        block_destroy(&film->block);
        film->shown = film->stored[k];
        return read_stored(film, film->shown, &film->block, err) &&
               put_block(page, film, &film->block, false, err);
    }

    // A mixture of two stored fields, in the place of the first, which is read again where it is
    // wanted. Both of the pair, the one that is there already kept.
    if (film->pair_index[1] == first) {
        Block kept = film->pair[1];
        film->pair[1] = film->pair[0];
        film->pair[0] = kept;
        film->pair_index[1] = film->pair_index[0];
        film->pair_index[0] = first;
    }
    for (int32_t i = 0; i < 2; ++i) {
        if (film->pair_index[i] == first + i) continue;
        block_destroy(&film->pair[i]);
        film->pair_index[i] = -1;
        if (!read_stored(film, first + i, &film->pair[i], err)) return false;
        film->pair_index[i] = first + i;
    }

    Block *a = &film->pair[0], *b = &film->pair[1];
    double part = (t - a->t) / (b->t - a->t);
    if (a->frame.node_count != b->frame.node_count)
        return FAULT(err, ERROR_FILE, "two fields of the film have %d and %d nodes",
                     a->frame.node_count, b->frame.node_count);
    block_mix(a, b, part);
    a->t = t;   // from here on to the second
    film->shown = -1;
    return put_block(page, film, a, true, err);
}

void film_block_contact(const Page *page, const FilmBlock *film, int64_t row)
{
    block_page_contact(page, &film->map, film->shown >= 0 ? &film->block : &film->pair[0], row,
                       &film->axes);
}

void film_block_close(FilmBlock *film)
{
    block_source_close(&film->source);
    block_destroy(&film->block);
    for (int32_t k = 0; k < 2; ++k) block_destroy(&film->pair[k]);
    memory_free(film->stored);
}
