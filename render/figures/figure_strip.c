// SPDX-License-Identifier: GPL-2.0-or-later
// Frames of one sliding on one page, in the same colours. Of the stored times those are taken
// between which the slip of the contact goes on by equal parts: what moves, moves evenly.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/figures/block_page.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

enum { FRAMES_MAX = 6, FRAMES_MIN = 2, COLUMNS = 2, LEGEND_LINES = 6, WORDS_SIZE = 160 };

static const double SHARE = 0.55;   // of marks, letters aside
static const double RIGHT = 58;   // points: the colour bar
static const double LEFT = 4, GAP = 5;   // points: beside and between frames
static const double WORDS_HEIGHT = 12;   // points above each frame
static const double LEGEND_HEIGHT = 12, NOTE_HEIGHT = 9;   // points below all: two lines
static const double BOTTOM = 4;   // points
static const double FREE_LEFT = 10, FREE_ABOVE = 6;   // points: to a legend in a frame's place
static const double FREE_LINE = 8;   // points: its lines
static const double SLACK = 1e-9;   // of U: a time at the border of an event belongs to it

typedef struct Strip {
    Block blocks[FRAMES_MAX];   // [count] owned
    int32_t count;
    BlockPage map;   // of each frame
} Strip;

static bool read_strip(const FigureInput *input, Strip *strip, BlockQuantity quantity, Error *err)
{
    BlockSource source = {.folder = input->folder,
                          .view = input->view,
                          .quantity = quantity,
                          .depth = input->def.style->depth};
    ResultView *view = input->view;
    const ViewEvent *event = NULL;
    int32_t chosen[FRAMES_MAX];
    TRY(block_source_open(&source, err));

    // The sliding that lies nearest to the asked time; without one that of the cycle that is asked
    // for, or else the last that has ended.
    int32_t index = -1;
    double nearest = INFINITY;
    if (input->field->at) TRY(block_time_find(&source, input->field->at, &index, err));
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *seen = &view->events[k];
        if (seen->kind != VIEW_LEADING || !isfinite(seen->U_start + seen->U_stop)) continue;
        double away = index >= 0 ? fabs(view->U[source.row[index]] - seen->U_start) : 0;
        if (!(away <= nearest)) continue;
        nearest = away;
        event = seen;
    }
    if (index < 0 && zoom_sliding(view)) event = zoom_sliding(view);
    if (!event)
        FAIL(err, ERROR_INPUT, "no sliding of the whole block has been seen from start to end");

    // Chooses the times that are nearest to equal parts of the slip, each once.
    TRY(result_view_read_status(view, err));
    TRY(result_view_read_slip(view, err));
    const int64_t *row = source.row;
    double slack = SLACK * fabs(event->U_stop);
    int32_t from = 0, to = source.count - 1, count = 0;
    while (from < source.count && view->U[row[from]] < event->U_start - slack) ++from;
    while (to >= from && view->U[row[to]] > event->U_stop + slack) --to;
    for (int32_t k = 0; k < FRAMES_MAX && from <= to; ++k) {
        int32_t best = from;
        double least = INFINITY, wanted = (double)k / (FRAMES_MAX - 1);
        for (int32_t at = from; at <= to; ++at) {
            // Share of the slip of an event that is done at a step: the mean over the contact
            // nodes, 0 to 1.
            double sum = 0;
            for (int32_t i = 0; i < view->nodes; ++i) {
                double start = view->slip[row[from] * view->nodes + i];
                double way = view->slip[row[to] * view->nodes + i] - start;
                double part = way > 0 ? (view->slip[row[at] * view->nodes + i] - start) / way : 0;
                sum += fmin(fmax(part, 0), 1);
            }
            double done = sum / view->nodes;

            if (fabs(done - wanted) < least) best = at;
            least = fmin(least, fabs(done - wanted));
        }
        if (count == 0 || chosen[count - 1] < best) chosen[count++] = best;
    }
    if (count < FRAMES_MIN)
        FAIL(err, ERROR_INPUT,
             "of the sliding at U = %.5g only %d time%s stored: output.fields takes more with "
             "at_events: true, or a smaller every_t",
             event->U_start, count, count == 1 ? " is" : "s are");
    for (; strip->count < count; ++strip->count)
        TRY(block_read(&source, chosen[strip->count], &strip->blocks[strip->count], err));
cleanup:
    block_source_close(&source);
    return error_is_clean(err);
}

// With an odd number of frames, the last one has nothing beside it: the legend stands there if the
// place is high enough for all of its lines.
static bool has_free_place(const Strip *strip)
{
    return strip->count % COLUMNS == 1 &&
           strip->map.height + WORDS_HEIGHT > FREE_ABOVE + LEGEND_LINES * FREE_LINE;
}

static bool draw_strip(const Page *page, const FigureInput *input, const Strip *strip, Error *err)
{
    char words[WORDS_SIZE];
    double point = page->point;
    const BlockPage *map = &strip->map;
    Box all = {0};
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK, .up = 0.5}, above = style;
    above.up = 0;
    for (int32_t k = 0; k < strip->count; ++k) {
        // "(a) U / L_0 = 0.011491" above the part of the page that the frame takes.
        const Block *block = &strip->blocks[k];
        Axis U = figure_length_axis(input->view, "U", block->U, block->U);
        Axes axes = {0};
        int32_t line = k / COLUMNS;
        double left = round((LEFT + k % COLUMNS * (map->width + GAP)) * point);
        double top = page->room.top +
                     round((WORDS_HEIGHT + line * (map->height + WORDS_HEIGHT)) * point);
        block_page_place(page, map, left, top, &axes);
        snprintf(words, sizeof words, "(%c)  %s = %.6g", 'a' + k, U.label, block->U * U.factor);
        text_draw(page->text, &above, (Point){axes.box.left, axes.box.top - 1.5 * point}, words);
        if (!block_page_draw(page, map, &strip->blocks[k], &axes, err)) return false;
        if (k == 0) all = axes.box;
        all.right = fmax(all.right, axes.box.right);
        all.bottom = axes.box.bottom;
    }
    colorbar_draw(page, &map->bar, &all, GAP);
    bool free = has_free_place(strip);
    double line = free ? FREE_LINE : 0;
    Point place = {LEFT * point, all.bottom + 0.5 * LEGEND_HEIGHT * point};
    if (free)
        place = (Point){all.right - (map->width - FREE_LEFT) * point,
                        all.bottom - (map->height + WORDS_HEIGHT - FREE_ABOVE) * point};
    block_page_legend(page, place, line);
    snprintf(words, sizeof words, "deformation \u00d7 %g", map->magnification);
    place.y += (free ? (LEGEND_LINES - 1) * line : NOTE_HEIGHT) * point;
    text_draw(page->text, &style, place, words);
    return true;
}

bool figure_strip(Page *page, const FigureInput *input, Error *err)
{
    PageDef def = input->def;
    BlockQuantity quantity = BLOCK_VELOCITY;
    Strip *strip = NEW_ARRAY(Strip, 1, err);
    TRY(strip);
    if (input->field->of) TRY(block_quantity_find(input->field->of, &quantity, err));
    TRY(read_strip(input, strip, quantity, err));

    // One magnification and one scale for all.
    double room = page_width(input->def.style) - LEFT - RIGHT;
    strip->map = (BlockPage){.view = input->view,
                             .edges = input->field->edges,
                             .share = SHARE,
                             .style = input->def.style};
    TRY(block_cut_read(input->view, input->field->cut, &strip->map.cut, err));
    TRY(block_page_fit(&strip->map, strip->blocks, strip->count, quantity, err));
    block_page_size(&strip->map, (room - (COLUMNS - 1) * GAP) / COLUMNS, INFINITY);

    int32_t rows = (strip->count + COLUMNS - 1) / COLUMNS;
    double below = has_free_place(strip) ? 0 : LEGEND_HEIGHT + NOTE_HEIGHT;
    def.height = (rows * (strip->map.height + WORDS_HEIGHT) + below + BOTTOM) /
                 page_width(def.style);
    TRY(page_begin(page, &def, err));
    TRY(draw_strip(page, input, strip, err));
cleanup:
    for (int32_t k = 0; strip && k < FRAMES_MAX; ++k) block_destroy(&strip->blocks[k]);
    memory_free(strip);
    return error_is_clean(err);
}
