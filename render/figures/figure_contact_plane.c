// SPDX-License-Identifier: GPL-2.0-or-later
// The contact of a block in space seen from above, each node as the part of the faces that is
// nearest to it: maps at moments below and beside each other, in one scale.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/canvas/key.h"
#include "render/figures/contact_map.h"
#include "render/view/contact_moments.h"
#include "render/figures/slip_scale.h"
#include "render/figures/state_scale.h"
#include "render/render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { COLUMNS_MAX = 6, WORDS_SIZE = 120, NAMES_SIZE = 200 };

static const double GAP = 15, WORDS_HEIGHT = 10;   // points: between maps; above each
static const double WORDS_OVER = 4;   // points: by which words may be longer than their map
static const double BAR_GAP = 6;   // points
static const double SHAPE_LIKED = 0.6, EMPTY = 0.2;   // of all maps, in a logarithm; a missing map
static const double SHAPE_MOST = 0.95;   // height of all maps over the width that they have
static const Color NOTHING = {0.84f, 0.85f, 0.87f, 1};   // stick, open, not reached

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
    ContactMoments moments;   // owned, like all that follows
    ContactQuantity quantity;
    double *rate;   // [rows * nodes]
    double *values;   // [count * nodes] of the maps, in the bar's numbers
    int32_t count, columns, lines;   // maps
    Colorbar bar;
    float *level;   // [nodes] of the map that is drawn
    double scale, width, height;   // points a length; of a map, points
} Maps;

// By name, a state's own included, which the view then stands for; CONTACT_QUANTITY_COUNT: none.
static ContactQuantity quantity_of(ResultView *view, const char *name)
{
    int32_t k = 0;
    while (k < CONTACT_QUANTITY_COUNT && strcmp(quantities[k].name, name) != 0) ++k;
    bool state = result_view_choose_state(view, name) && k == CONTACT_QUANTITY_COUNT;
    return state ? CONTACT_STATE : (ContactQuantity)k;
}

bool figure_contact_plane_shows(ResultView *view, const char *name)
{
    return quantity_of(view, name) != CONTACT_QUANTITY_COUNT;
}

static bool find_quantity(ResultView *view, const char *name, ContactQuantity *quantity, Error *err)
{
    char names[NAMES_SIZE] = "";
    *quantity = name ? quantity_of(view, name) : CONTACT_SLIP_RATE;
    if (*quantity != CONTACT_QUANTITY_COUNT) return true;
    for (int32_t k = 0; k < CONTACT_QUANTITY_COUNT; ++k) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", k ? ", " : "", quantities[k].name);
    }
    FAIL(err, ERROR_INPUT, "contact-plane shows nothing called \"%.40s\"; known are: %s", name,
         names);
cleanup:
    return false;
}

// --- values --------------------------------------------------------------------------------------

// A number a node at each moment, in `values`.
static bool take_series(Maps *maps, ResultSeries series, double *values, Error *err)
{
    double *all = NULL;
    int32_t nodes = maps->view->plane.nodes;
    if (series == SERIES_STATE)
        TRY(state_read(maps->view, true, &all, err));
    else
        TRY(result_view_read_contact(maps->view, series, &all, err));
    for (int32_t k = 0; k < maps->count; ++k)
        memcpy(values + (int64_t)k * nodes, all + maps->moments.row[k] * nodes,
               (size_t)nodes * sizeof *values);
cleanup:
    memory_free(all);
    return error_is_clean(err);
}

// Of slip what each node has done since the first moment; of one alone since the rod's start.
static void take_from_first(Maps *maps)
{
    int32_t nodes = maps->view->plane.nodes;
    for (int32_t k = maps->count - 1; k >= 0 && maps->count > 1; --k)
        for (int32_t i = 0; i < nodes; ++i) maps->values[(int64_t)k * nodes + i] -= maps->values[i];
}

static bool take_ratio(Maps *maps, Error *err)
{
    int64_t count = (int64_t)maps->count * maps->view->plane.nodes;
    double *pressure = NEW_ARRAY(double, count, err);
    TRY(pressure);
    TRY(take_series(maps, SERIES_PRESSURE, pressure, err));
    TRY(take_series(maps, SERIES_SHEAR, maps->values, err));
    for (int64_t k = 0; k < count; ++k)
        maps->values[k] = pressure[k] > 0 ? maps->values[k] / pressure[k] : NAN;
cleanup:
    memory_free(pressure);
    return error_is_clean(err);
}

// Open: NaN.
static bool take_density(Maps *maps, Error *err)
{
    int64_t count = (int64_t)maps->count * maps->view->plane.nodes;
    double critical = maps->view->number[NUMBER_CRITICAL_VELOCITY];
    double *status = NEW_ARRAY(double, count, err);
    TRY(status);
    if (!(critical > 0))
        FAIL(err, ERROR_INPUT,
             "the result has no critical velocity, which the contact density is "
             "defined by");
    TRY(take_series(maps, SERIES_STATUS, status, err));
    TRY(take_series(maps, SERIES_SLIP_RATE, maps->values, err));
    for (int64_t k = 0; k < count; ++k)
        maps->values[k] = status[k] == 0 ? NAN : fmax(0, 1 - maps->values[k] / critical);
cleanup:
    memory_free(status);
    return error_is_clean(err);
}

static bool take_values(Maps *maps, Error *err)
{
    int32_t nodes = maps->view->plane.nodes;
    TRY(maps->values = NEW_ARRAY(double, (int64_t)maps->count *nodes, err));
    switch (maps->quantity) {
    case CONTACT_DENSITY:
        return take_density(maps, err);
    case CONTACT_RATIO:
        return take_ratio(maps, err);
    case CONTACT_ARRIVAL:
        memcpy(maps->values, maps->moments.arrival, (size_t)nodes * sizeof *maps->values);
        return true;
    case CONTACT_PRESSURE:
        return take_series(maps, SERIES_PRESSURE, maps->values, err);
    case CONTACT_SHEAR:
        return take_series(maps, SERIES_SHEAR, maps->values, err);
    case CONTACT_STATE:
        return take_series(maps, SERIES_STATE, maps->values, err);
    case CONTACT_SLIP:
        TRY(take_series(maps, SERIES_SLIP, maps->values, err));
        take_from_first(maps);
        return true;
    default:
        return take_series(maps, SERIES_SLIP_RATE, maps->values, err);
    }
cleanup:
    return error_is_clean(err);
}

// --- colours -------------------------------------------------------------------------------------

static bool fit_linear(Maps *maps, const PictureStyle *style, Error *err)
{
    const QuantityWords *own = &quantities[maps->quantity];
    char name[VIEW_STATE_SIZE];
    ValueWords words = {own->words, own->si, own->normalised, maps->view->si, false};
    if (maps->quantity == CONTACT_STATE) words = state_words(maps->view, name);
    if (maps->quantity == CONTACT_SLIP && maps->count == 1) words.words = "slip";
    int32_t nodes = maps->view->plane.nodes;
    int64_t count = (int64_t)maps->count * nodes;
    WeighedValue *weighed = NEW_ARRAY(WeighedValue, count, err);
    TRY(weighed);
    for (int64_t k = 0; k < count; ++k)
        weighed[k] = (WeighedValue){maps->values[k], maps->view->plane.weight[k % nodes]};
    TRY(value_bar_fit(weighed, count, &words, style, &maps->bar, err));
cleanup:
    memory_free(weighed);
    return error_is_clean(err);
}

// The decades of all maps, as the slip map has them.
static bool fit_rates(Maps *maps, Error *err)
{
    double V = fabs(maps->view->number[NUMBER_ROD_VELOCITY]), most = 0;
    if (!(V > 0)) FAIL(err, ERROR_INPUT, "the result does not say how fast the rod moves");
    for (int64_t k = 0; k < (int64_t)maps->count * maps->view->plane.nodes; ++k)
        most = fmax(most, maps->values[k]);
    maps->bar = slip_scale_up_to(most, V);
cleanup:
    return error_is_clean(err);
}

static bool fit_colors(Maps *maps, const PictureStyle *style, Error *err)
{
    Colorbar *bar = &maps->bar;
    if (maps->quantity == CONTACT_SLIP_RATE) return fit_rates(maps, err);
    TRY(fit_linear(maps, style, err));
    bar->neutral_color = NOTHING;
    if (maps->quantity == CONTACT_DENSITY) {
        bar->falling = true;
        bar->high = fmin(bar->high, 1);
        bar->neutral = "open";
    }
    if (maps->quantity == CONTACT_ARRIVAL) {
        bar->falling = true;
        bar->low = 0;
        bar->clipped = false;
        bar->neutral = "never";
    }
cleanup:
    return error_is_clean(err);
}

// --- words ---------------------------------------------------------------------------------------

// A time in the unit of the scene, three digits: "0.312 t_0", "1.2 ms".
static void write_time(const ResultView *view, double t, const char *sign, char words[WORDS_SIZE])
{
    Axis axis = {.low = 0, .high = fabs(t), .factor = 1};
    if (!view->si) {
        snprintf(words, WORDS_SIZE, "%s%.3g ~{t}_{0}", sign, fabs(t));
        return;
    }
    axis_set_unit(&axis, "", "s");   // " (ms)"
    const char *unit = strchr(axis.label, '(');
    int length = unit ? (int)strcspn(unit + 1, ")") : 0;
    snprintf(words, WORDS_SIZE, "%s%.3g %.*s", sign, fabs(t) * axis.factor, length,
             unit ? unit + 1 : "");
}

// "(b) -3.1 t_0" from when slip turns rapid, or "(b) 0.0117" of moments that were asked for.
static void write_words(const Maps *maps, int32_t k, char words[WORDS_SIZE])
{
    const ResultView *view = maps->view;
    int64_t row = maps->moments.row[k];
    char when[WORDS_SIZE];
    Axis U = figure_length_axis(view, "U", view->U[row], view->U[row]);
    double t = view->t[row] - maps->moments.start;
    if (maps->moments.asked)
        snprintf(when, sizeof when, "%.6g", view->U[row] * U.factor);
    else
        write_time(view, t, t < 0 ? "\u2212" : "+", when);
    snprintf(words, WORDS_SIZE, "(%c)  %.80s", 'a' + k, when);
    if (maps->quantity == CONTACT_ARRIVAL) words[0] = '\0';
}

// What the words above the maps count.
static void write_note(const Maps *maps, char words[WORDS_SIZE])
{
    const ResultView *view = maps->view;
    int64_t row = maps->moments.first;
    Axis U = figure_length_axis(view, "U", view->U[row], view->U[row]);
    if (maps->moments.asked)
        snprintf(words, WORDS_SIZE, "above the maps: %s", U.label);
    else
        snprintf(words, WORDS_SIZE, "times from when slip turns rapid, %.60s = %.6g", U.label,
                 view->U[row] * U.factor);
}

// --- the page ------------------------------------------------------------------------------------

// As many maps in a line as make all of them nearest to a square, but not so that they would be
// higher than SHAPE_MOST; returns the points that all take in height.
static double lay_out(Maps *maps, double room)
{
    const ContactPlane *plane = &maps->view->plane;
    double size[2] = {plane->high[0] - plane->low[0], plane->high[1] - plane->low[1]};
    double best = INFINITY;
    for (int32_t columns = 1; columns <= COLUMNS_MAX && columns <= maps->count; ++columns) {
        int32_t lines = (maps->count + columns - 1) / columns;
        double width = (room - (columns - 1) * GAP) / columns, height = width * size[1] / size[0];
        double shape = lines * (height + WORDS_HEIGHT) / room;
        double away = fabs(log(shape / SHAPE_LIKED)) + EMPTY * (columns * lines - maps->count);
        if (!(away < best)) continue;
        best = away;
        maps->columns = columns;
        maps->lines = lines;
        double fits = fmin(1, SHAPE_MOST * room / (lines * (height + WORDS_HEIGHT)));
        maps->width = fits * width;
        maps->height = fits * height;
    }
    return maps->lines * (maps->height + WORDS_HEIGHT);
}

static bool draw_map(const Page *page, const Maps *maps, int32_t k, const Axes *axes, Error *err)
{
    const ContactPlane *plane = &maps->view->plane;
    const double *values = maps->values + (int64_t)k * plane->nodes;
    for (int32_t i = 0; i < plane->nodes; ++i)
        maps->level[i] = colorbar_level(&maps->bar, values[i]);
    return contact_map_draw(page, plane, maps->level, maps->bar.neutral_color, axes, err);
}

static bool draw_maps(const Page *page, const Maps *maps, double left, Error *err)
{
    double point = page->point;
    Axes axes = contact_map_axes(maps->view);
    Box all = {INFINITY, INFINITY, 0, 0};
    TextStyle style = {.color = INK};
    for (int32_t k = 0; k < maps->count; ++k) {
        char words[WORDS_SIZE];
        int32_t line = k / maps->columns, column = k % maps->columns;
        axes.box.left = round(left + column * (maps->width + GAP) * point);
        axes.box.right = axes.box.left + round(maps->width * point);
        axes.box.top = page->room.top +
                       round((WORDS_HEIGHT + line * (maps->height + WORDS_HEIGHT)) * point);
        axes.box.bottom = axes.box.top + round(maps->height * point);
        axes.bare_y = column > 0;
        axes.bare_x = k + maps->columns < maps->count;
        TRY(draw_map(page, maps, k, &axes, err));
        axes_draw(page, &axes);
        write_words(maps, k, words);
        style.size = SMALL_SIZE * point;
        style.size *=
            fmin(1, (maps->width + WORDS_OVER) * point / text_width(page->text, style.size, words));
        text_draw(page->text, &style, (Point){axes.box.left, axes.box.top - 2.5 * point}, words);
        all.right = fmax(all.right, axes.box.right);
        all.top = fmin(all.top, axes.box.top);
        all.bottom = fmax(all.bottom, axes.box.bottom);
    }
    Box beside = {.left = round(all.right + BAR_GAP * point), .top = all.top, .bottom = all.bottom};
    colorbar_draw(page, &maps->bar, &beside);
cleanup:
    return error_is_clean(err);
}

// The page is begun twice: what numbers and bar take beside the maps is known on a page only.
static bool draw_page(Page *page, const FigureInput *input, Maps *maps, Error *err)
{
    PageDef def = input->def;
    uint8_t colors[3 * MAP_SIZE];
    char note[WORDS_SIZE];
    Axes axes = contact_map_axes(maps->view);
    double width = page_width(def.style), left = 0;
    def.height = 1;
    for (int32_t pass = 0; pass < 2; ++pass) {
        page_destroy(page);
        TRY(page_begin(page, &def, err));
        left = axes_left_margin(page, &axes);
        double room = width - left - BAR_GAP - colorbar_width(page, &maps->bar);
        double height = lay_out(maps, room) + axes_bottom_margin(&axes) + key_line_height();
        double used = maps->columns * (maps->width + GAP) - GAP;
        left += (room - used) / 2;
        def.height = height / width;
    }
    color_map_fill(colors);
    canvas_set_map(page->canvas, colors, maps->bar.neutral_color);
    write_note(maps, note);
    TRY(draw_maps(page, maps, round(left * page->point), err));
    Page same = *page;   // what is warned of stands below all of its room
    key_draw(&same, &(KeyEntry){.words = note}, 1);
cleanup:
    return error_is_clean(err);
}

bool figure_contact_plane(Page *page, const FigureInput *input, Error *err)
{
    Maps maps = {.view = input->view};
    const FieldChoice *field = input->field;
    TRY(find_quantity(input->view, field->of, &maps.quantity, err));
    bool arrival = maps.quantity == CONTACT_ARRIVAL;
    TRY(result_view_read_plane(input->view, err));
    TRY(result_view_read_contact(input->view, SERIES_SLIP_RATE, &maps.rate, err));
    TRY(contact_moments_find(input->view, maps.rate, field->at, arrival, &maps.moments, err));
    maps.count = arrival ? 1 : maps.moments.count;
    TRY(take_values(&maps, err));
    TRY(fit_colors(&maps, input->def.style, err));
    TRY(maps.level = NEW_ARRAY(float, input->view->plane.nodes, err));
    TRY(draw_page(page, input, &maps, err));
cleanup:
    contact_moments_destroy(&maps.moments);
    memory_free(maps.rate);
    memory_free(maps.values);
    memory_free(maps.level);
    return error_is_clean(err);
}
