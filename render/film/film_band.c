// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_band.h"

#include "base/memory.h"
#include "render/figures/figure_axes.h"

#include <math.h>
#include <stdio.h>

enum { TICKS_WANTED = 12 };

static const double WORDS_HEIGHT = 12, STRIP_HEIGHT = 5, STRIP_GAP = 1.5;   // points
static const double TICK_LENGTH = 2.6, NUMBER_GAP = 1.6;   // points, as of axes
static const double LABEL_DROP = 14;   // points: axis to the top of its name
static const double SIDE = 6;   // points: frame to the cell's right end
static const double NUMBER_PITCH = 1.25;   // a number's room over its width
static const double CURSOR_WIDTH = 1.1;   // points
static const double WORDS_SIZE = 8.5;   // points
static const double SLOW_LEAST = 1.15;   // a slow motion that is named
static const Color STRIP_COLOR = {0.08f, 0.35f, 0.70f, 1};
static const Color STRIP_PALE = {0.90f, 0.92f, 0.95f, 1};
static const Color TO_COME = {1, 1, 1, 0.72f};

// --- words ---------------------------------------------------------------------------------------

// Two digits; powers of ten only where plain numbers get long.
static void short_number(double value, char *words, size_t size)
{
    int32_t power = value > 0 ? (int32_t)floor(log10(value) + 1e-9) : 0;
    double unit = pow(10, power - 1), rounded = round(value / unit) * unit;
    if (rounded >= 9.95 * pow(10, power)) ++power;
    if (power < -3 || power > 4)
        snprintf(words, size, "%.1f\u00b710^{%d}", rounded / pow(10, power), power);
    else
        snprintf(words, size, "%.*f", power < 1 ? 1 - power : 0, rounded);
}

void film_time_words(const ResultView *view, double t, char words[FILM_WORDS_SIZE])
{
    static const char *const prefix[] = {"n", "\u00b5", "m", ""};
    char number[32];
    int32_t k = 3;
    if (!view->si) {
        short_number(t, number, sizeof number);
        snprintf(words, FILM_WORDS_SIZE, "%s ~{t}_{0}", number);
        return;
    }
    for (; k > 0 && fabs(t) < 0.9995; --k) t *= 1000;
    short_number(t, number, sizeof number);
    snprintf(words, FILM_WORDS_SIZE, "%s %ss", number, prefix[k]);
}

// --- what stands ---------------------------------------------------------------------------------

static void lay_out(const Page *page, const Box *cell, FilmBand *band)
{
    double point = page->point;
    const ResultView *view = band->view;
    MapPage *map = &band->map;
    Axes *axes = &map->axes;
    double low = 0, high = 0;
    result_view_x_extent(view, &low, &high);
    axes->x = (Axis){.high = (double)(band->clock->frames - 1) / band->clock->rate, .factor = 1};
    axes->y = figure_length_axis(view, "x", low, high);
    band->strip.top = round(cell->top + WORDS_HEIGHT * point);
    band->strip.bottom = round(band->strip.top + STRIP_HEIGHT * point);
    axes->box.top = round(band->strip.bottom + STRIP_GAP * point);
    axes->box.bottom = round(cell->bottom - (LABEL_DROP + 1.1 * LABEL_SIZE) * point);
    axes->box.left = round(cell->left + axes_left_margin(page, axes) * point);
    axes->box.right = round(cell->right - SIDE * point);
    band->strip.left = axes->box.left;
    band->strip.right = axes->box.right;
}

// The slip map over seconds of film in the place of U.
static bool fill_map(FilmBand *band, Error *err)
{
    const ResultView *view = band->view;
    MapPage *map = &band->map;
    double *seconds = NEW_ARRAY(double, view->rows, err);
    TRY(seconds);
    for (int64_t row = 0; row < view->rows; ++row) {
        bool shown = view->t[row] >= band->clock->t[0] &&
                     view->t[row] <= band->clock->t[band->clock->frames - 1];
        seconds[row] = shown ? film_clock_seconds(band->clock, view->t[row]) : NAN;
        // The first step behind the end: what lies in the last long step has its value.
        if (!shown && row > 0 && isfinite(seconds[row - 1]))
            seconds[row] = map->axes.x.high * (1 + 1e-9);
    }
    SpaceTime data = {.rows = view->rows,
                      .U = seconds,
                      .nodes = view->nodes,
                      .x = view->x,
                      .pad = view->pad,
                      .value = map->states ? map->states : view->slip_rate,
                      .sign = map->sign};
    map->grid = (PixelGrid){.U_high = map->axes.x.high,
                            .x_low = map->axes.y.low,
                            .x_high = map->axes.y.high,
                            .columns = (int32_t)(map->axes.box.right - map->axes.box.left),
                            .rows = (int32_t)(map->axes.box.bottom - map->axes.box.top)};
    TRY(map_page_fill(&data, map, err));
cleanup:
    memory_free(seconds);
    return error_is_clean(err);
}

bool film_band_create(const Page *page, const Box *cell, FilmBand *band, Error *err)
{
    const FilmClock *clock = band->clock;
    lay_out(page, cell, band);
    band->speed_low = band->speed_high = clock->speed[0];
    for (int32_t k = 1; k < clock->frames; ++k) {
        band->speed_low = fmin(band->speed_low, clock->speed[k]);
        band->speed_high = fmax(band->speed_high, clock->speed[k]);
    }
    return fill_map(band, err);
}

void film_band_destroy(FilmBand *band)
{
    map_page_destroy(&band->map);
}

static Color between(Color from, Color to, double part)
{
    float p = (float)part;
    return (Color){from.red + p * (to.red - from.red), from.green + p * (to.green - from.green),
                   from.blue + p * (to.blue - from.blue), 1};
}

// A column a frame, by the logarithm of its speed.
static void draw_strip(const Page *page, const FilmBand *band)
{
    const Axes *axes = &band->map.axes;
    const FilmClock *clock = band->clock;
    Stroke stroke = {.color = INK, .width = FRAME_WIDTH * page->point};
    double range = log(band->speed_high / band->speed_low);
    for (int32_t k = 0; k + 1 < clock->frames; ++k) {
        double slow = range > 1e-9 ? log(band->speed_high / clock->speed[k]) / range : 0;
        Box column = {round(axes_place(axes, (double)k / clock->rate, 0).x), band->strip.top,
                      round(axes_place(axes, (double)(k + 1) / clock->rate, 0).x),
                      band->strip.bottom};
        draw_fill(page->canvas, between(STRIP_PALE, STRIP_COLOR, slow), &column);
    }
    draw_outline(page->canvas, &stroke, &band->strip);
}

// Handy numbers of U, less those that would touch the one before.
static void draw_numbers(const Page *page, const FilmBand *band, const Ticks *ticks, double factor)
{
    double point = page->point, written = -INFINITY;
    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK, .across = 0.5, .up = 1};
    Stroke stroke = {.color = INK, .width = FRAME_WIDTH * point};
    int32_t k = 0;
    for (int32_t i = 0; i < ticks->count; ++i) {
        char label[TICK_LABEL_SIZE];

        // Where the film, from frame k on, comes to U.
        double U = tick_value(ticks, i) / factor;
        const FilmClock *clock = band->clock;
        const ResultView *view = band->view;
        while (k + 1 < clock->frames && film_moment(view, clock->t[k]).U < U) ++k;
        int32_t first = k > 0 ? k - 1 : 0;
        double after = film_moment(view, clock->t[k]).U,
               before = film_moment(view, clock->t[first]).U;
        double part = after > before ? fmin(fmax((U - before) / (after - before), 0), 1) : 0;
        Point foot =
            axes_place(&band->map.axes, (first + part) / clock->rate, band->map.axes.y.low);

        Point end = {foot.x, foot.y + TICK_LENGTH * point};
        draw_segment(page->canvas, &stroke, foot, end);
        tick_label(ticks, i, label);
        double half = NUMBER_PITCH * text_width(page->text, style.size, label) / 2;
        if (foot.x - half < written) continue;
        written = foot.x + half;
        text_draw(page->text, &style, (Point){foot.x, end.y + NUMBER_GAP * point}, label);
    }
}

static void draw_U(const Page *page, const FilmBand *band)
{
    const Axes *axes = &band->map.axes;
    const FilmClock *clock = band->clock;
    char name[AXIS_LABEL_SIZE + 64], power[TICK_LABEL_SIZE] = "";
    double point = page->point, first = film_moment(band->view, clock->t[0]).U;
    double last = film_moment(band->view, clock->t[clock->frames - 1]).U;
    Axis U = figure_length_axis(band->view, "U", first, last);
    Ticks ticks = ticks_choose(first * U.factor, last * U.factor, TICKS_WANTED);
    TextStyle style = {.size = LABEL_SIZE * point, .color = INK, .across = 0.5, .up = 1};
    draw_numbers(page, band, &ticks, U.factor);
    if (ticks.exponent != 0) snprintf(power, sizeof power, " (\u00d710^{%d})", ticks.exponent);
    snprintf(name, sizeof name, "%s%s, stretched where slip is rapid", U.label, power);
    text_draw(
        page->text, &style,
        (Point){(axes->box.left + axes->box.right) / 2, axes->box.bottom + LABEL_DROP * point},
        name);
}

void film_band_draw(const Page *page, const FilmBand *band)
{
    const Axes *axes = &band->map.axes;
    map_page_draw_field(page, band->view, &band->map);
    draw_strip(page, band);
    axes_draw_left(page, axes);
    draw_U(page, band);
}

// --- what moves ----------------------------------------------------------------------------------

static void draw_words(const Page *page, const FilmBand *band, int32_t k)
{
    char time[FILM_WORDS_SIZE], words[FILM_WORDS_SIZE + 80], times[32];
    double point = page->point, speed = band->clock->speed[k];
    TextStyle style = {.size = WORDS_SIZE * point, .color = INK};
    Point place = {band->strip.left, band->strip.top - 3.2 * point};
    film_time_words(band->view, speed, time);
    snprintf(words, sizeof words, "1 s of film = %s", time);
    text_draw(page->text, &style, place, words);
    double slow = band->speed_high / speed;
    if (slow < SLOW_LEAST) return;
    short_number(slow, times, sizeof times);
    snprintf(words, sizeof words, "slow motion \u00d7 %s", times);
    style.color = STRIP_COLOR;
    place.x += 110 * point;
    text_draw(page->text, &style, place, words);
}

void film_band_now(const Page *page, const FilmBand *band, int32_t k)
{
    const Axes *axes = &band->map.axes;
    Stroke cursor = {.color = INK, .width = CURSOR_WIDTH * page->point};
    double x = axes_place(axes, (double)k / band->clock->rate, 0).x;
    double edge = FRAME_WIDTH * page->point;
    Box later = {x, axes->box.top + edge, axes->box.right - edge, axes->box.bottom - edge};
    if (later.right > later.left) draw_fill(page->canvas, TO_COME, &later);
    draw_segment(page->canvas, &cursor, (Point){x, band->strip.top}, (Point){x, axes->box.bottom});
    draw_words(page, band, k);
}
