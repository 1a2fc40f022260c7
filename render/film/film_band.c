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

bool film_band_create(const Page *page, const Box *cell, FilmBand *band, Error *err)
{
    const FilmClock *clock = band->clock;
    const ResultView *view = band->view;
    MapPage *map = &band->map;
    Axes *axes = &map->axes;
    double point = page->point, low = 0, high = 0, *seconds = NULL;

    // Strip and frame, one below the other.
    result_view_x_extent(view, &low, &high);
    axes->x = (Axis){.high = (double)(clock->frames - 1) / clock->rate, .factor = 1};
    axes->y = figure_length_axis(view, "x", low, high);
    band->strip.top = round(cell->top + WORDS_HEIGHT * point);
    band->strip.bottom = round(band->strip.top + STRIP_HEIGHT * point);
    axes->box.top = round(band->strip.bottom + STRIP_GAP * point);
    axes->box.bottom = round(cell->bottom - (LABEL_DROP + 1.1 * LABEL_SIZE) * point);
    axes->box.left = round(cell->left + axes_left_margin(page, axes) * point);
    axes->box.right = round(cell->right - SIDE * point);
    band->strip.left = axes->box.left;
    band->strip.right = axes->box.right;
    band->speed_low = band->speed_high = clock->speed[0];
    for (int32_t k = 1; k < clock->frames; ++k) {
        band->speed_low = fmin(band->speed_low, clock->speed[k]);
        band->speed_high = fmax(band->speed_high, clock->speed[k]);
    }

    // The slip map over seconds of film in the place of U.
    TRY(seconds = NEW_ARRAY(double, view->rows, err));
    for (int64_t row = 0; row < view->rows; ++row) {
        bool shown = view->t[row] >= clock->t[0] && view->t[row] <= clock->t[clock->frames - 1];
        seconds[row] = shown ? film_clock_seconds(clock, view->t[row]) : NAN;
        // The first step behind the end: what lies in the last long step has its value.
        if (!shown && row > 0 && isfinite(seconds[row - 1]))
            seconds[row] = axes->x.high * (1 + 1e-9);
    }
    SpaceTime data = {.rows = view->rows,
                      .U = seconds,
                      .nodes = view->nodes,
                      .x = view->x,
                      .pad = view->pad,
                      .value = map->states ? map->states : view->slip_rate,
                      .sign = map->sign};
    map->grid = (PixelGrid){.U_high = axes->x.high,
                            .x_low = axes->y.low,
                            .x_high = axes->y.high,
                            .columns = (int32_t)(axes->box.right - axes->box.left),
                            .rows = (int32_t)(axes->box.bottom - axes->box.top)};
    TRY(map_page_fill(&data, map, err));
cleanup:
    memory_free(seconds);
    return error_is_clean(err);
}

void film_band_destroy(FilmBand *band)
{
    map_page_destroy(&band->map);
}

void film_band_draw(const Page *page, const FilmBand *band)
{
    const Axes *axes = &band->map.axes;
    const FilmClock *clock = band->clock;
    const ResultView *view = band->view;
    double point = page->point;
    Stroke stroke = {.color = INK, .width = FRAME_WIDTH * point};
    map_page_draw_field(page, view, &band->map);

    // The strip: a column a frame, by the logarithm of its speed.
    double range = log(band->speed_high / band->speed_low);
    for (int32_t k = 0; k + 1 < clock->frames; ++k) {
        float slow = range > 1e-9 ? (float)(log(band->speed_high / clock->speed[k]) / range) : 0;
        Color color = {STRIP_PALE.red + slow * (STRIP_COLOR.red - STRIP_PALE.red),
                       STRIP_PALE.green + slow * (STRIP_COLOR.green - STRIP_PALE.green),
                       STRIP_PALE.blue + slow * (STRIP_COLOR.blue - STRIP_PALE.blue), 1};
        Box column = {round(axes_place(axes, (double)k / clock->rate, 0).x), band->strip.top,
                      round(axes_place(axes, (double)(k + 1) / clock->rate, 0).x),
                      band->strip.bottom};
        draw_fill(page->canvas, color, &column);
    }
    draw_outline(page->canvas, &stroke, &band->strip);
    axes_draw_left(page, axes);

    // U below: handy numbers, less those that would touch the one before, each where the film comes
    // to it.
    double first = film_moment(view, clock->t[0]).U, written = -INFINITY;
    double last = film_moment(view, clock->t[clock->frames - 1]).U;
    Axis U = figure_length_axis(view, "U", first, last);
    Ticks ticks = ticks_choose(first * U.factor, last * U.factor, TICKS_WANTED);
    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK, .across = 0.5, .up = 1};
    int32_t k = 0;   // the first frame at or behind the number
    for (int32_t i = 0; i < ticks.count; ++i) {
        char label[TICK_LABEL_SIZE];
        double wanted = tick_value(&ticks, i) / U.factor;
        while (k + 1 < clock->frames && film_moment(view, clock->t[k]).U < wanted) ++k;
        int32_t earlier = k > 0 ? k - 1 : 0;
        double after = film_moment(view, clock->t[k]).U;
        double before = film_moment(view, clock->t[earlier]).U;
        double part = after > before ? fmin(fmax((wanted - before) / (after - before), 0), 1) : 0;
        Point foot = axes_place(axes, (earlier + part) / clock->rate, axes->y.low);
        Point end = {foot.x, foot.y + TICK_LENGTH * point};
        draw_segment(page->canvas, &stroke, foot, end);
        tick_label(&ticks, i, label);
        double half = NUMBER_PITCH * text_width(page->text, style.size, label) / 2;
        if (foot.x - half < written) continue;
        written = foot.x + half;
        text_draw(page->text, &style, (Point){foot.x, end.y + NUMBER_GAP * point}, label);
    }
    char name[AXIS_LABEL_SIZE + 64], power[TICK_LABEL_SIZE] = "";
    if (ticks.exponent != 0) snprintf(power, sizeof power, " (\u00d710^{%d})", ticks.exponent);
    snprintf(name, sizeof name, "%s%s, stretched where slip is rapid", U.label, power);
    style.size = LABEL_SIZE * point;
    text_draw(
        page->text, &style,
        (Point){(axes->box.left + axes->box.right) / 2, axes->box.bottom + LABEL_DROP * point},
        name);
}

// --- what moves ----------------------------------------------------------------------------------

void film_band_now(const Page *page, const FilmBand *band, int32_t k)
{
    const Axes *axes = &band->map.axes;
    double point = page->point, speed = band->clock->speed[k];
    Stroke cursor = {.color = INK, .width = CURSOR_WIDTH * point};
    double x = axes_place(axes, (double)k / band->clock->rate, 0).x;
    double edge = FRAME_WIDTH * point;
    Box later = {x, axes->box.top + edge, axes->box.right - edge, axes->box.bottom - edge};
    if (later.right > later.left) draw_fill(page->canvas, TO_COME, &later);
    draw_segment(page->canvas, &cursor, (Point){x, band->strip.top}, (Point){x, axes->box.bottom});

    // "1 s of film = 0.43 t_0", and where it is slow how much.
    char time[FILM_WORDS_SIZE], words[FILM_WORDS_SIZE + 80], times[32];
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
