// SPDX-License-Identifier: GPL-2.0-or-later
// The contact of a block in space seen from above, each node as the part of the faces that is
// nearest to it: maps at moments below and beside each other, in one scale.
#include "render/figures/figure_contact_plane.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/canvas/key.h"
#include "render/figures/color_scale.h"
#include "render/figures/figures.h"
#include "render/quantities.h"
#include "render/view/block.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 6, WORDS_SIZE = 120, NAMES_SIZE = 200 };

static const double GAP = 15, WORDS_HEIGHT = 10;   // points: between maps; above each
static const double WORDS_OVER = 4;   // points: by which words may be longer than their map
static const double BAR_GAP = 6;   // points
static const double SHAPE_LIKED = 0.6, EMPTY = 0.2;   // of all maps, in a logarithm; a missing map
static const double SHAPE_MOST = 0.95;   // height of all maps over the width that they have
static const double OUTLINE_WIDTH = 0.4, SEAM = 0.15;   // points
static const Color NOTHING = {0.84f, 0.85f, 0.87f, 1};   // stick, open, not reached

// --- one map -------------------------------------------------------------------------------------

Axes contact_map_axes(const ResultView *view)
{
    const ContactPlane *plane = &view->plane;
    return (Axes){.x = figure_length_axis(view, "x", plane->low[0], plane->high[0]),
                  .y = figure_length_axis(view, "y", plane->low[1], plane->high[1])};
}

bool contact_map_draw(const Page *page, const ContactPlane *plane, const float *level,
                      Color neutral, const Axes *axes, Error *err)
{
    static const int32_t turn[6] = {0, 1, 2, 0, 2, 3};
    int64_t count = 0;
    GlCorner *corners = NULL;
    TRY(corners = NEW_ARRAY(GlCorner, 6 * (int64_t)plane->patch_count, err));
    for (int32_t k = 0; k < plane->patch_count; ++k) {
        const ContactPatch *patch = &plane->patches[k];
        Point corner[PATCH_CORNERS];
        for (int32_t c = 0; c < PATCH_CORNERS; ++c)
            corner[c] = axes_place(axes, patch->corner[c][0], patch->corner[c][1]);

        if (level[patch->node] < 0) {
            // Its edge, too: between shapes side by side the paper would shine through.
            Stroke stroke = {.color = neutral, .width = fmax(1, SEAM * page->point)};
            Point round[PATCH_CORNERS + 1];
            memcpy(round, corner, PATCH_CORNERS * sizeof *corner);
            round[PATCH_CORNERS] = corner[0];
            draw_polygon(page->canvas, neutral, corner, PATCH_CORNERS);
            draw_line(page->canvas, &stroke, round, PATCH_CORNERS + 1);
        }

        for (int32_t c = 0; c < 6 && level[patch->node] >= 0; ++c) {
            const Point *at = &corner[turn[c]];
            corners[count++] = (GlCorner){(float)(at->x - axes->box.left),
                                          (float)(at->y - axes->box.top), level[patch->node], 0};
        }
    }
    if (count > 0) canvas_heat_triangles(page->canvas, &axes->box, corners, count, NULL);
    Stroke stroke = {.color = INK, .width = OUTLINE_WIDTH * page->point};
    for (int32_t k = 0; k < plane->side_count; ++k) {
        Point line[3];
        for (int32_t c = 0; c < 3; ++c)
            line[c] = axes_place(axes, plane->sides[k].point[c][0], plane->sides[k].point[c][1]);
        draw_line(page->canvas, &stroke, line, 3);
    }
cleanup:
    memory_free(corners);
    return error_is_clean(err);
}

// --- moments -------------------------------------------------------------------------------------
// Slip is rapid from twice the rod's velocity on, as in the events of a run, and slip at all from a
// hundredth of it on, as in the slip map. Moments are those at which it had come to equal parts of
// the contact: what spreads is seen spreading, however unevenly steps lie.

enum { MOMENTS_MAX = 12, SLOW_PARTS = 3, RAPID_PARTS = 2, MOMENT_SIZE = 64 };

static const double RAPID = 2, SLIPS = 0.01;   // of the rod's velocity
static const double ROUNDING = 1e-9;   // of sums of areas

typedef struct ContactMoments {
    int32_t count;
    int64_t row[MOMENTS_MAX];   // [count] of the history, rising
    bool asked;   // by the caller; else they are of one event
    int64_t first, last;   // rows of that event, from the step before it
    int64_t before;   // row where the event before it ended; 0: there was none
    double start;   // time when slip was first rapid somewhere in it
    double *arrival;   // [nodes] time since then, NaN: not in this event; owned; NULL where moments
        // were asked for
} ContactMoments;

// The event is the rapid one nearest to what is asked for; without a wish the sliding of the cycle
// that is asked for, else the last that carried the whole block, or else the last.
static bool take_event(const ResultView *view, const char *at, ContactMoments *moments, Error *err)
{
    bool by_U = true;
    double wanted = 0;
    if (at) {
        if (!block_moment_seen(view, at, &by_U, &wanted, err)) return false;
        if (!by_U) wanted = view->U[result_view_nearest_row(view, view->t, wanted)];
    }
    const ViewEvent *event = at ? NULL : zoom_sliding(view);
    if (event && !isfinite(event->U_stop)) event = NULL;
    bool chosen = event != NULL;
    double least = INFINITY;
    for (int32_t k = 0; k < view->event_count && !chosen; ++k) {
        const ViewEvent *seen = &view->events[k];
        if (seen->kind <= VIEW_QUASI_STATIC || !isfinite(seen->U_start + seen->U_stop)) continue;
        double away = at ? fabs(seen->U_start - wanted) : seen->kind == VIEW_LEADING ? 0 : 1;
        if (!(away <= least)) continue;
        least = away;
        event = seen;
    }
    if (!event)
        return REFUSE(err,
                      "no rapid slip has been seen from start to end: say when, as --at U=%.4g",
                      view->U[view->rows / 2]);
    moments->first = result_view_nearest_row(view, view->U, event->U_start);
    moments->last = result_view_nearest_row(view, view->U, event->U_stop);
    while (moments->first > 0 && view->U[moments->first] >= event->U_start) --moments->first;
    for (int32_t k = 0; k < view->rapid_count; ++k)
        if (view->rapid[k][1] < event->U_start)
            moments->before = result_view_nearest_row(view, view->U, view->rapid[k][1]);
    return true;
}

// Area of the contact that rapid slip had come to at a step.
static double area_reached(const ResultView *view, const ContactPlane *plane,
                           const ContactMoments *moments, int64_t row)
{
    double area = 0;
    for (int32_t i = 0; i < plane->nodes; ++i)
        if (moments->arrival[i] <= view->t[row] - moments->start) area += plane->weight[i];
    return area;
}

// Each row once; they come in order but for the last.
static void add_row(ContactMoments *moments, int64_t row)
{
    if (moments->count == 0 || row > moments->row[moments->count - 1])
        moments->row[moments->count++] = row;
}

// Area of the contact that slips at a step.
static double area_slipping(const ResultView *view, const ContactPlane *plane, const double *rates,
                            int64_t row)
{
    double area = 0, least = SLIPS * fabs(view->number[NUMBER_ROD_VELOCITY]);
    for (int32_t i = 0; i < plane->nodes; ++i)
        if (rates[row * plane->nodes + i] >= least) area += plane->weight[i];
    return area;
}

// rates: [rows * nodes] |slip rate|. at: "U=0.01,U=0.02", "t=12", or NULL: six of the last sliding,
// or else of the last rapid event: two while slow slip grows before it, the step before it, when
// rapid slip had come to half and to all that it reached, and the fastest. whole: `at` names an
// event instead, the nearest. ERROR_INPUT: there is none.
static bool find_moments(const ResultView *view, const double *rates, const char *at, bool whole,
                         ContactMoments *moments, Error *err)
{
    const ContactPlane *plane = &view->plane;
    int32_t nodes = plane->nodes;
    *moments = (ContactMoments){0};

    // The moments that are asked for, in the order of time.
    if (at && !whole) {
        char word[MOMENT_SIZE];
        for (; *at; at += strcspn(at, ","), at += *at == ',') {
            bool by_U = false;
            double value = 0;
            if (moments->count == MOMENTS_MAX)
                return REFUSE(err, "a figure shows %d moments at most", MOMENTS_MAX);
            snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
            if (!block_moment_seen(view, word, &by_U, &value, err)) return false;
            moments->row[moments->count++] =
                result_view_nearest_row(view, by_U ? view->U : view->t, value);
        }
        qsort(moments->row, (size_t)moments->count, sizeof *moments->row, order_int64);
        moments->asked = true;
        moments->first = moments->row[0];
        moments->last = moments->row[moments->count - 1];
        return true;
    }
    if (!take_event(view, at, moments, err)) return false;

    // Time when each node was first rapid in the event, counted from the first of them.
    double rapid_rate = RAPID * fabs(view->number[NUMBER_ROD_VELOCITY]);
    double *arrival = moments->arrival = NEW_ARRAY(double, nodes, err);
    if (!arrival) return false;
    moments->start = INFINITY;
    for (int32_t i = 0; i < nodes; ++i) {
        int64_t row = moments->first;
        while (row <= moments->last && !(rates[row * nodes + i] >= rapid_rate)) ++row;
        arrival[i] = row <= moments->last ? view->t[row] : NAN;
        moments->start = fmin(moments->start, arrival[i]);
    }
    for (int32_t i = 0; i < nodes; ++i) arrival[i] -= moments->start;

    // Two moments while slow slip grows. Between the events it begins anew where less than the
    // first part slips.
    double all = 0, rapid = area_reached(view, plane, moments, moments->last);
    int64_t row = moments->before;
    for (int32_t i = 0; i < nodes; ++i) all += plane->weight[i];
    while (row < moments->first && area_slipping(view, plane, rates, row) > all / SLOW_PARTS) ++row;
    for (int32_t part = 1; part < SLOW_PARTS; ++part) {
        double wanted = (double)part / SLOW_PARTS * all;
        while (row < moments->first && area_slipping(view, plane, rates, row) < wanted) ++row;
        if (row < moments->first) add_row(moments, row);
    }

    // The step before the event, and when rapid slip had come to half and to all that it reached.
    add_row(moments, moments->first);
    row = moments->first;
    for (int32_t part = 1; part <= RAPID_PARTS; ++part) {
        double wanted = (double)part / RAPID_PARTS * (1 - ROUNDING) * rapid;
        while (row < moments->last && area_reached(view, plane, moments, row) < wanted) ++row;
        add_row(moments, row);
    }

    // The step in which the contact is fastest in the mean.
    double most = -INFINITY;
    int64_t fastest = moments->first;
    for (int64_t k = moments->first; k <= moments->last; ++k) {
        double sum = 0;
        for (int32_t i = 0; i < nodes; ++i) sum += plane->weight[i] * rates[k * nodes + i];
        if (sum > most) fastest = k;
        most = fmax(most, sum);
    }
    add_row(moments, fastest);
    return true;
}

// --- the figure ----------------------------------------------------------------------------------

typedef enum ContactQuantity {
#define X(symbol, ...) symbol,
    CONTACT_QUANTITIES(X) CONTACT_QUANTITY_COUNT
#undef X
} ContactQuantity;

typedef struct QuantityWords {
    const char *name, *words, *si, *normalised;
} QuantityWords;

static const QuantityWords quantities[] = {
#define X(symbol, name, words, si, normalised) {name, words, si, normalised},
    CONTACT_QUANTITIES(X)
#undef X
};

typedef struct Maps {
    ResultView *view;
    ContactMoments moments;
    ContactQuantity quantity;
    double *rate;   // [rows * nodes]
    double *values;   // [count * nodes] of the maps, in the bar's numbers
    int32_t count, columns, lines;   // maps
    Colorbar bar;
    float *level;   // [nodes] of the map that is drawn
    double scale, width, height;   // points a length; of a map, points
} Maps;

// Finds a quantity by name, a state's own name included, which the view then stands for;
// CONTACT_QUANTITY_COUNT: none has it.
static ContactQuantity quantity_of(ResultView *view, const char *name)
{
    int32_t k = 0;
    while (k < CONTACT_QUANTITY_COUNT && strcmp(quantities[k].name, name) != 0) ++k;
    bool state = result_view_choose_state(view, name) && k == CONTACT_QUANTITY_COUNT;
    return state ? CONTACT_STATE : (ContactQuantity)k;
}

bool figure_contact_plane_is_there(const ResultView *view)
{
    return view->line && view->rapid_count > 0 && result_file_has_faces(view->file);
}

bool figure_contact_plane_shows(ResultView *view, const char *name)
{
    return quantity_of(view, name) != CONTACT_QUANTITY_COUNT;
}

// --- values --------------------------------------------------------------------------------------

// The values of all maps. Slip is counted from the first moment, or from the rod's start where
// there is one moment alone. Shear over pressure and density are NaN where the contact is open.
static bool take_values(Maps *maps, Error *err)
{
    static const ResultSeries series[CONTACT_QUANTITY_COUNT] = {
        [CONTACT_SLIP_RATE] = SERIES_SLIP_RATE, [CONTACT_DENSITY] = SERIES_SLIP_RATE,
        [CONTACT_PRESSURE] = SERIES_PRESSURE,   [CONTACT_SHEAR] = SERIES_SHEAR,
        [CONTACT_RATIO] = SERIES_SHEAR,         [CONTACT_SLIP] = SERIES_SLIP,
        [CONTACT_STATE] = SERIES_STATE,         [CONTACT_GAP] = SERIES_GAP};
    ContactQuantity quantity = maps->quantity;
    int32_t nodes = maps->view->plane.nodes;
    int64_t count = (int64_t)maps->count * nodes;
    double critical = maps->view->number[NUMBER_CRITICAL_VELOCITY], *values = NULL, *over = NULL;
    if (quantity == CONTACT_ARRIVAL) {
        TRY(maps->values = NEW_ARRAY(double, count, err));
        memcpy(maps->values, maps->moments.arrival, (size_t)nodes * sizeof *values);
        return true;
    }
    TRY(result_view_read_at(maps->view, series[quantity], true, maps->moments.row, maps->count,
                            &maps->values, err));
    values = maps->values;
    if (quantity == CONTACT_SLIP && maps->count > 1)
        for (int64_t k = count - 1; k >= 0; --k) values[k] -= values[k % nodes];
    if (quantity == CONTACT_DENSITY || quantity == CONTACT_RATIO) {
        bool density = quantity == CONTACT_DENSITY;
        if (density && !(critical > 0)) FAIL(err, ERROR_INPUT, FIGURE_NO_DENSITY);
        TRY(result_view_read_at(maps->view, density ? SERIES_STATUS : SERIES_PRESSURE, true,
                                maps->moments.row, maps->count, &over, err));
        for (int64_t k = 0; k < count; ++k)
            values[k] = !(over[k] > 0) ? NAN
                        : density      ? fmax(0, 1 - values[k] / critical)
                                       : values[k] / over[k];
    }
cleanup:
    memory_free(over);
    return error_is_clean(err);
}

// --- colours -------------------------------------------------------------------------------------

// One scale for all maps: decades of slip rates, as the slip map has them, or else numbers.
static bool fit_colors(Maps *maps, const PictureStyle *style, Error *err)
{
    const ResultView *view = maps->view;
    const QuantityWords *own = &quantities[maps->quantity];
    Colorbar *bar = &maps->bar;
    int32_t nodes = view->plane.nodes;
    int64_t count = (int64_t)maps->count * nodes;
    char name[VIEW_STATE_SIZE];
    WeighedValue *weighed = NULL;
    if (maps->quantity == CONTACT_SLIP_RATE) {
        double V = fabs(view->number[NUMBER_ROD_VELOCITY]), most = 0;
        if (!(V > 0)) return REFUSE(err, "the result does not say how fast the rod moves");
        for (int64_t k = 0; k < count; ++k) most = fmax(most, maps->values[k]);
        *bar = slip_scale_up_to(most, V);
        return true;
    }
    ValueWords words = {own->words, own->si, own->normalised, view->si, false};
    if (maps->quantity == CONTACT_STATE) words = state_words(view, name);
    if (maps->quantity == CONTACT_SLIP && maps->count == 1) words.words = "slip";
    TRY(weighed = NEW_ARRAY(WeighedValue, count, err));
    for (int64_t k = 0; k < count; ++k)
        weighed[k] = (WeighedValue){maps->values[k], view->plane.weight[k % nodes]};
    TRY(value_bar_fit(weighed, count, &words, style, bar, err));
    bar->neutral_color = NOTHING;
    if (maps->quantity == CONTACT_DENSITY) {
        bar->falling = true;
        bar->high = fmin(bar->high, 1);
    }
    if (maps->quantity == CONTACT_DENSITY || maps->quantity == CONTACT_RATIO) bar->neutral = "open";
    if (maps->quantity == CONTACT_ARRIVAL) {
        bar->falling = true;
        bar->low = 0;
        bar->clipped = false;
        bar->neutral = "never";
    }
cleanup:
    memory_free(weighed);
    return error_is_clean(err);
}

// --- words ---------------------------------------------------------------------------------------

// "(b) -3.1 t_0" or "(b) +1.2 ms", three digits, from when slip turns rapid, or "(b) 0.0117" of
// moments that were asked for; none of arrivals.
static void write_words(const Maps *maps, int32_t k, char words[WORDS_SIZE])
{
    const ResultView *view = maps->view;
    int64_t row = maps->moments.row[k];
    char when[WORDS_SIZE];
    double t = view->t[row] - maps->moments.start;
    const char *sign = t < 0 ? "\u2212" : "+";
    words[0] = '\0';
    if (maps->quantity == CONTACT_ARRIVAL) return;
    if (maps->moments.asked) {
        Axis U = figure_length_axis(view, "U", view->U[row], view->U[row]);
        snprintf(when, sizeof when, "%.6g", view->U[row] * U.factor);
    } else if (view->si) {
        Axis axis = {.low = 0, .high = fabs(t), .factor = 1};
        axis_set_unit(&axis, "", "s");   // " (ms)"
        const char *unit = strchr(axis.label, '(');
        int length = unit ? (int)strcspn(unit + 1, ")") : 0;
        snprintf(when, sizeof when, "%s%.3g %.*s", sign, fabs(t) * axis.factor, length,
                 unit ? unit + 1 : "");
    } else {
        snprintf(when, sizeof when, "%s%.3g ~{t}_{0}", sign, fabs(t));
    }
    snprintf(words, WORDS_SIZE, "(%c)  %.80s", 'a' + k, when);
}

// --- the page ------------------------------------------------------------------------------------

// The page is begun twice: what numbers and bar take beside the maps is known on a page only.
static bool draw_page(Page *page, const FigureInput *input, Maps *maps, Error *err)
{
    const ResultView *view = maps->view;
    const ContactPlane *plane = &view->plane;
    PageDef def = input->def;
    char note[WORDS_SIZE], words[WORDS_SIZE];
    Axes axes = contact_map_axes(view);
    double extent[2] = {plane->high[0] - plane->low[0], plane->high[1] - plane->low[1]};
    double width = page_width(def.style), left = 0;
    def.height = 1;
    for (int32_t pass = 0; pass < 2; ++pass) {
        page_destroy(page);
        if (!page_begin(page, &def, err)) return false;
        left = axes_left_margin(page, &axes);
        double room = width - left - BAR_GAP - colorbar_width(page, &maps->bar);

        // A line has as many maps as make all of them nearest to a square, unless they would be
        // higher than SHAPE_MOST.
        double best = INFINITY;
        for (int32_t columns = 1; columns <= COLUMNS_MAX && columns <= maps->count; ++columns) {
            int32_t lines = (maps->count + columns - 1) / columns;
            double map_width = (room - (columns - 1) * GAP) / columns;
            double map_height = map_width * extent[1] / extent[0];
            double shape = lines * (map_height + WORDS_HEIGHT) / room;
            double away = fabs(log(shape / SHAPE_LIKED)) + EMPTY * (columns * lines - maps->count);
            if (!(away < best)) continue;
            best = away;
            maps->columns = columns;
            maps->lines = lines;
            double fits = fmin(1, SHAPE_MOST * room / (lines * (map_height + WORDS_HEIGHT)));
            maps->width = fits * map_width;
            maps->height = fits * map_height;
        }
        double height = maps->lines * (maps->height + WORDS_HEIGHT) + axes_bottom_margin(&axes) +
                        key_line_height();
        double used = maps->columns * (maps->width + GAP) - GAP;
        left += (room - used) / 2;
        def.height = height / width;
    }

    // The maps, words above each, and the bar beside all.
    double point = page->point;
    Box all = {INFINITY, INFINITY, 0, 0};
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK};
    for (int32_t k = 0; k < maps->count; ++k) {
        int32_t line = k / maps->columns, column = k % maps->columns;
        axes.box.left = round(round(left * point) + column * (maps->width + GAP) * point);
        axes.box.right = axes.box.left + round(maps->width * point);
        axes.box.top = page->room.top +
                       round((WORDS_HEIGHT + line * (maps->height + WORDS_HEIGHT)) * point);
        axes.box.bottom = axes.box.top + round(maps->height * point);
        axes.bare_y = column > 0;
        axes.bare_x = k + maps->columns < maps->count;
        const double *values = maps->values + (int64_t)k * plane->nodes;
        for (int32_t i = 0; i < plane->nodes; ++i)
            maps->level[i] = colorbar_level(&maps->bar, values[i]);
        if (!contact_map_draw(page, plane, maps->level, maps->bar.neutral_color, &axes, err))
            return false;
        axes_draw(page, &axes);
        write_words(maps, k, words);
        text_draw_within(page->text, &style, (Point){axes.box.left, axes.box.top - 2.5 * point},
                         (maps->width + WORDS_OVER) * point, words);
        all.right = fmax(all.right, axes.box.right);
        all.top = fmin(all.top, axes.box.top);
        all.bottom = fmax(all.bottom, axes.box.bottom);
    }
    colorbar_draw(page, &maps->bar, &all, BAR_GAP);

    // A note says what the words above the maps count.
    int64_t row = maps->moments.first;
    Axis U = figure_length_axis(view, "U", view->U[row], view->U[row]);
    if (maps->moments.asked)
        snprintf(note, WORDS_SIZE, "above the maps: %s", U.label);
    else
        snprintf(note, WORDS_SIZE, "times from when slip turns rapid, %.60s = %.6g", U.label,
                 view->U[row] * U.factor);
    Page same = *page;   // what is warned of stands below all of its room
    key_draw(&same, &(KeyEntry){.words = note}, 1);
    return true;
}

bool figure_contact_plane(Page *page, const FigureInput *input, Error *err)
{
    Maps maps = {.view = input->view};
    const FieldChoice *field = input->field;
    maps.quantity = field->of ? quantity_of(input->view, field->of) : CONTACT_SLIP_RATE;
    if (maps.quantity == CONTACT_QUANTITY_COUNT) {
        char names[NAMES_SIZE] = "";
        for (int32_t k = 0; k < CONTACT_QUANTITY_COUNT; ++k) {
            size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s%s", k ? ", " : "", quantities[k].name);
        }
        return REFUSE(err, "contact-plane shows nothing called \"%.40s\"; known are: %s", field->of,
                      names);
    }
    bool arrival = maps.quantity == CONTACT_ARRIVAL;
    TRY(result_view_read_plane(input->view, err));
    TRY(result_view_read(input->view, SERIES_SLIP_RATE, true, &maps.rate, err));
    TRY(find_moments(input->view, maps.rate, field->at, arrival, &maps.moments, err));
    maps.count = arrival ? 1 : maps.moments.count;
    TRY(take_values(&maps, err));
    TRY(fit_colors(&maps, input->def.style, err));
    TRY(maps.level = NEW_ARRAY(float, input->view->plane.nodes, err));
    TRY(draw_page(page, input, &maps, err));
cleanup:
    memory_free_all(maps.moments.arrival, maps.rate, maps.values, maps.level);
    return error_is_clean(err);
}
