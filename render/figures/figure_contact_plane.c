// SPDX-License-Identifier: GPL-2.0-or-later
// The contact of a block in space seen from above, each node as the part of the faces that is
// nearest to it: maps at moments below and beside each other, in one scale.
#include "render/figures/figure_contact_plane.h"

#include "base/memory.h"
#include "render/canvas/key.h"
#include "render/figures/color_scale.h"
#include "render/figures/figures.h"
#include "render/quantities.h"
#include "render/view/contact_moments.h"

#include <math.h>
#include <stdio.h>
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
    ContactMoments moments;   // owned, like all that follows
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

// A number a node at each moment, in `values`.
static bool take_series(Maps *maps, ResultSeries series, double *values, Error *err)
{
    double *all = NULL;
    int32_t nodes = maps->view->plane.nodes;
    TRY(result_view_read(maps->view, series, true, &all, err));
    for (int32_t k = 0; k < maps->count; ++k)
        memcpy(values + (int64_t)k * nodes, all + maps->moments.row[k] * nodes,
               (size_t)nodes * sizeof *values);
cleanup:
    memory_free(all);
    return error_is_clean(err);
}

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
    TRY(values = maps->values = NEW_ARRAY(double, count, err));
    if (quantity == CONTACT_ARRIVAL) {
        memcpy(values, maps->moments.arrival, (size_t)nodes * sizeof *values);
        return true;
    }
    TRY(take_series(maps, series[quantity], values, err));
    if (quantity == CONTACT_SLIP && maps->count > 1)
        for (int64_t k = count - 1; k >= 0; --k) values[k] -= values[k % nodes];
    if (quantity == CONTACT_DENSITY || quantity == CONTACT_RATIO) {
        bool density = quantity == CONTACT_DENSITY;
        TRY(over = NEW_ARRAY(double, count, err));
        if (density && !(critical > 0)) FAIL(err, ERROR_INPUT, FIGURE_NO_DENSITY);
        TRY(take_series(maps, density ? SERIES_STATUS : SERIES_PRESSURE, over, err));
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
        bar->neutral = "open";
    }
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
    TRY(contact_moments_find(input->view, maps.rate, field->at, arrival, &maps.moments, err));
    maps.count = arrival ? 1 : maps.moments.count;
    TRY(take_values(&maps, err));
    TRY(fit_colors(&maps, input->def.style, err));
    TRY(maps.level = NEW_ARRAY(float, input->view->plane.nodes, err));
    TRY(draw_page(page, input, &maps, err));
cleanup:
    contact_moments_destroy(&maps.moments);
    memory_free_all(maps.rate, maps.values, maps.level);
    return error_is_clean(err);
}
