// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_page.h"

#include "base/memory.h"
#include "render/film/film_block.h"
#include "render/film/film_times.h"
#include "render/figures/color_scale.h"
#include "render/figures/figure_axes.h"
#include "render/figures/figure_contact_plane.h"
#include "render/figures/figure_maps.h"
#include "render/figures/figures.h"
#include "render/view/space_time.h"

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

typedef struct FilmBand {
    MapPage map;   // its axes: x is seconds of film; its bar is that of all panels; owned
    Box strip;
    double speed_low, speed_high;   // of the clock
} FilmBand;

typedef struct FilmForce {
    Axes axes;
    int64_t first, last;   // rows of the history inside the film
    int64_t drawn;   // the row up to which the curve is drawn in full colour
} FilmForce;

struct FilmPage {
    FilmPageDef def;
    Page base, frame;   // what stands; what is seen. Owned
    FilmBand band;
    FilmForce force;
    bool in_space;   // the contact as a plane, in the place of its profile
    Axes contact;   // of the plane, or of the profile
    double *plane_values;   // [rows * all_nodes] slip rates or states, in space; owned
    float *level;   // [all_nodes] work, in space; owned
    double *states;   // [rows * nodes] shown of the contact in the place of slip rates; NULL: none
    FilmBlock block;   // where fields are stored
    int32_t U_decimals, t_decimals;
};

// --- the band of stretched time -----------------------------------------------------------------
// The film's time from left to right, on which the run's time is stretched where slip is rapid: a
// strip that is the darker the slower time goes, the slip map over this axis, and below it U.

enum { TICKS_WANTED = 12, TIME_SIZE = 96 };

static const double WORDS_HEIGHT = 12, STRIP_HEIGHT = 5, STRIP_GAP = 1.5;   // points
static const double TICK_LENGTH = 2.6, NUMBER_GAP = 1.6;   // points, as of axes
static const double LABEL_DROP = 14;   // points: axis to the top of its name
static const double SIDE = 6;   // points: frame to the cell's right end
static const double NUMBER_PITCH = 1.25;   // a number's room over its width
static const double CURSOR_WIDTH = 1.1;   // points
static const double SLOW_LEAST = 1.15;   // a slow motion that is named
static const Color STRIP_COLOR = {0.08f, 0.35f, 0.70f, 1};
static const Color STRIP_PALE = {0.90f, 0.92f, 0.95f, 1};
static const Color TO_COME = {1, 1, 1, 0.72f};

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

// A time in words of two digits, with its unit: "0.43 ~{t}_{0}", "12 ms".
static void time_words(const ResultView *view, double t, char words[TIME_SIZE])
{
    static const char *const prefix[] = {"n", "\u00b5", "m", ""};
    char number[32];
    int32_t k = 3;
    if (!view->si) {
        short_number(t, number, sizeof number);
        snprintf(words, TIME_SIZE, "%s ~{t}_{0}", number);
        return;
    }
    for (; k > 0 && fabs(t) < 0.9995; --k) t *= 1000;
    short_number(t, number, sizeof number);
    snprintf(words, TIME_SIZE, "%s %ss", number, prefix[k]);
}

// In `cell`, pixels. Fills the map.
static bool band_create(FilmPage *self, const Box *cell, Error *err)
{
    const Page *page = &self->base;
    FilmBand *band = &self->band;
    const FilmClock *clock = self->def.clock;
    const ResultView *view = self->def.view;
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

// Draws the parts that stand: strip, map, axes.
static void band_draw(const FilmPage *self)
{
    const Page *page = &self->base;
    const FilmBand *band = &self->band;
    const Axes *axes = &band->map.axes;
    const FilmClock *clock = self->def.clock;
    const ResultView *view = self->def.view;
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

// Draws the parts that move at frame k: the time to come is pale; "1 s of film = ...".
static void band_now(const FilmPage *self, int32_t k)
{
    const Page *page = &self->frame;
    const FilmBand *band = &self->band;
    const FilmClock *clock = self->def.clock;
    const Axes *axes = &band->map.axes;
    double point = page->point, speed = clock->speed[k];
    Stroke cursor = {.color = INK, .width = CURSOR_WIDTH * point};
    double x = axes_place(axes, (double)k / clock->rate, 0).x;
    double edge = FRAME_WIDTH * point;
    Box later = {x, axes->box.top + edge, axes->box.right - edge, axes->box.bottom - edge};
    if (later.right > later.left) draw_fill(page->canvas, TO_COME, &later);
    draw_segment(page->canvas, &cursor, (Point){x, band->strip.top}, (Point){x, axes->box.bottom});

    // "1 s of film = 0.43 t_0", and where it is slow how much.
    char time[TIME_SIZE], words[TIME_SIZE + 80], times[32];
    TextStyle style = {.size = TITLE_SIZE * point, .color = INK};
    Point place = {band->strip.left, band->strip.top - 3.2 * point};
    time_words(self->def.view, speed, time);
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

// --- force ---------------------------------------------------------------------------------------

static const double ABOVE = 0.08;   // of the range of mu: room over and below the curve
static const double RIGHT = 6;   // points: frame to the cell's right end
static const double DOT = 2.6, RING = 1.0;   // points: radius, white around it
static const double THIN_DISTANCE = 0.3;   // pixels: nearer points of a curve add nothing
static const double STICK_SHARE = 0.02;   // of the height: the foot where the contact sticks
static const double PAST_WIDTH = 1.2, LATER_WIDTH = 0.8;   // points

static const Color PAST = {0.05f, 0.27f, 0.55f, 1};
static const Color LATER = {0.78f, 0.81f, 0.85f, 1};
static const Color DOT_COLOR = {0.75f, 0.12f, 0.12f, 1};

static void force_place(FilmPage *self, const Box *cell)
{
    const ResultView *view = self->def.view;
    const FilmClock *clock = self->def.clock;
    FilmForce *force = &self->force;
    FilmMoment from = film_moment(view, clock->t[0]);
    FilmMoment to = film_moment(view, clock->t[clock->frames - 1]);
    double low = fmin(from.mu, to.mu), high = fmax(from.mu, to.mu);
    double U[2] = {fmin(from.U, to.U), fmax(from.U, to.U)};
    force->first = from.row + 1;
    force->last = to.row;
    for (int64_t row = force->first; row <= force->last; ++row) {
        low = fmin(low, view->mu[row]);
        high = fmax(high, view->mu[row]);
        U[0] = fmin(U[0], view->U[row]);
        U[1] = fmax(U[1], view->U[row]);
    }
    if (!(high > low)) high = low + 1;
    if (!(U[1] > U[0])) U[1] = U[0] + 1;   // the rod stands all the time
    force->axes.x = figure_length_axis(view, "U", U[0], U[1]);
    double beyond = ABOVE * (high - low);
    force->axes.y = (Axis){low - beyond, high + beyond, 1, .label = FIGURE_MU};
    force->drawn = from.row;
    axes_fit(&self->base, cell, RIGHT, &force->axes);
}

// Rows from `first` to `last`, then `end` where it is not NULL.
static void curve_draw(const FilmPage *self, const Page *page, const Stroke *stroke,
                       const int64_t rows[2], const Point *end)
{
    const ResultView *view = self->def.view;
    const Axes *axes = &self->force.axes;
    canvas_clip(page->canvas, &axes->box);
    LinePen pen = line_begin(page->canvas, stroke);
    for (int64_t row = rows[0]; row <= rows[1]; ++row) {
        pen.thin = row < rows[1] ? THIN_DISTANCE : 0;
        line_add(&pen, axes_place(axes, view->U[row], view->mu[row]));
    }
    if (end) line_add(&pen, *end);
    line_end(&pen);
    canvas_clip(page->canvas, NULL);
}

static void force_draw(const FilmPage *self)
{
    const FilmForce *force = &self->force;
    Stroke stroke = {.color = LATER, .width = LATER_WIDTH * self->base.point};
    curve_draw(self, &self->base, &stroke, (const int64_t[]){force->first - 1, force->last}, NULL);
    axes_draw(&self->base, &force->axes);
}

enum { STEPS_AT_ONCE = 64 };

// Draws the part that the film has passed on the page that stands, so that it stays: in pieces of
// some steps; of the last one force_now draws the rest.
static void force_pass(FilmPage *self, const FilmMoment *now)
{
    FilmForce *force = &self->force;
    Stroke stroke = {.color = PAST, .width = PAST_WIDTH * self->base.point};
    while (force->drawn < now->row) {
        int64_t last = force->drawn + STEPS_AT_ONCE;
        if (last > now->row) last = now->row;
        curve_draw(self, &self->base, &stroke, (const int64_t[]){force->drawn, last}, NULL);
        force->drawn = last;
    }
}

static void force_now(const FilmPage *self, const FilmMoment *now)
{
    const Page *page = &self->frame;
    double point = page->point;
    Stroke stroke = {.color = PAST, .width = PAST_WIDTH * point};
    Point place = axes_place(&self->force.axes, now->U, now->mu);
    curve_draw(self, page, &stroke, (const int64_t[]){now->row, now->row}, &place);
    draw_disc(page->canvas, PAPER, place, (DOT + RING) * point);
    draw_disc(page->canvas, DOT_COLOR, place, DOT * point);
}

// --- slip rate, or a state -----------------------------------------------------------------------

static void profile_place(FilmPage *self, const Box *cell)
{
    const ResultView *view = self->def.view;
    Axes *axes = &self->contact;
    double low = 0, high = 0;
    result_view_x_extent(view, &low, &high);
    axes->x = figure_length_axis(view, "x", low, high);
    const Colorbar *bar = &self->band.map.bar;
    axes->y = (Axis){.low = bar->powers ? pow(10, bar->low) : bar->low,
                     .high = bar->powers ? pow(10, bar->high) : bar->high,
                     .factor = 1,
                     .is_log = bar->powers};
    snprintf(axes->y.label, sizeof axes->y.label, "%s", bar->label);
    axes_fit(&self->base, cell, RIGHT, axes);
}

// A bar a node, as wide as the part of the contact it stands for, in the colours of the map; what
// is slower than the scale is a grey foot.
static void profile_now(const FilmPage *self, const FilmMoment *now)
{
    const Page *page = &self->frame;
    const ResultView *view = self->def.view;
    const Axes *axes = &self->contact;
    const Colorbar *scale = &self->band.map.bar;
    const double *values = self->states ? self->states : view->slip_rate;
    const Stroke stroke = {.color = INK, .width = FRAME_WIDTH * page->point};
    SpaceTime data = {.nodes = view->nodes, .x = view->x, .pad = view->pad};
    double height = axes->box.bottom - axes->box.top;
    canvas_set_below(page->canvas, scale->neutral_color);
    for (int32_t i = 0; i < view->nodes; ++i) {
        double from = 0, to = 0;
        node_extent(&data, i, &from, &to);
        float level = colorbar_level(scale, film_value(now, values, view->nodes, i));
        if (level <= (float)HEAT_MISSING) continue;
        Box bar = axes->box;
        bar.left = round(axes_place(axes, from, axes->y.low).x);
        bar.right = round(fmax(axes_place(axes, to, axes->y.low).x, bar.left + 1));
        bar.top = bar.bottom - round(fmax((double)level, STICK_SHARE) * height);
        canvas_heat_cell(page->canvas, &bar, level);
    }
    draw_outline(page->canvas, &stroke, &axes->box);
}

// --- the contact in space ------------------------------------------------------------------------

static const double BAR_GAP = 5, PLANE_ABOVE = 6;   // points
static const double BAR_LEAST = 30;   // points: how high the bar is at least

// Draws to scale in `cell`, pixels. Reads what it needs.
static bool plane_create(FilmPage *self, const Box *cell, Error *err)
{
    const Page *page = &self->base;
    ResultView *view = self->def.view;
    double point = page->point;
    if (!result_view_read_plane(view, err)) return false;
    ResultSeries series = self->states ? SERIES_STATE : SERIES_SLIP_RATE;
    if (!result_view_read(view, series, true, &self->plane_values, err)) return false;
    if (!(self->level = NEW_ARRAY(float, view->all_nodes, err))) return false;
    Axes *axes = &self->contact;
    *axes = contact_map_axes(view);
    double left = axes_left_margin(page, axes) * point, below = axes_bottom_margin(axes) * point;
    double beside = (BAR_GAP + colorbar_width(page, &self->band.map.bar)) * point;
    double room[2] = {cell->right - cell->left - left - beside,
                      cell->bottom - cell->top - below - PLANE_ABOVE * point};
    double scale =
        fmin(room[0] / (axes->x.high - axes->x.low), room[1] / (axes->y.high - axes->y.low));
    if (!(room[0] > 0 && room[1] > BAR_LEAST * point))
        return REFUSE(err, "the film is too small for the contact of the block");
    axes->box.left = round(cell->left + left);
    axes->box.right = axes->box.left + round(scale * (axes->x.high - axes->x.low));
    axes->box.top = round(cell->top + PLANE_ABOVE * point);
    axes->box.bottom = axes->box.top + round(scale * (axes->y.high - axes->y.low));
    return true;
}

static void plane_draw(const FilmPage *self)
{
    Box bar = self->contact.box;
    bar.bottom = fmax(bar.bottom, bar.top + BAR_LEAST * self->base.point);
    axes_draw(&self->base, &self->contact);
    colorbar_draw(&self->base, &self->band.map.bar, &bar, BAR_GAP);
}

static bool plane_now(const FilmPage *self, const FilmMoment *now, Error *err)
{
    const ResultView *view = self->def.view;
    const Colorbar *bar = &self->band.map.bar;
    for (int32_t i = 0; i < view->all_nodes; ++i)
        self->level[i] =
            colorbar_level(bar, film_value(now, self->plane_values, view->all_nodes, i));
    return contact_map_draw(&self->frame, &view->plane, self->level, bar->neutral_color,
                            &self->contact, err);
}

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
    if (page->in_space && !plane_create(page, &left, err)) return false;
    if (!page->in_space) profile_place(page, &left);
    force_place(page, &right);
    if (page->block.stored && !page->in_space)   // one above the other: frames begin at one line
        page->force.axes.box.left = page->contact.box.left =
            fmax(page->force.axes.box.left, page->contact.box.left);
    return band_create(page, &foot, err);
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
    force_pass(page, &now);
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

    band_now(page, k);
    force_now(page, &now);
    if (page->in_space && !plane_now(page, &now, err)) return false;
    if (!page->in_space) profile_now(page, &now);
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
        .map = {.view = def->view, .share = 1, .magnification = def->film->magnification}};
    page->in_space = def->view->line && result_file_has_faces(def->view->file);

    // The values that the film shows: of the contact the state that def->film->of names, or slip
    // rates; of the block the field.
    ResultView *view = def->view;
    const FilmClock *clock = def->clock;
    Colorbar *bar = &page->band.map.bar;
    *bar = slip_scale(view, fabs(view->number[NUMBER_ROD_VELOCITY]));
    bool state = def->film->of && result_view_choose_state(view, def->film->of);
    TRY(block_quantity_find(state ? NULL : def->film->of, &page->block.source.quantity, err));
    if (state) {
        char name[VIEW_STATE_SIZE];
        ValueWords words = state_words(view, name);
        const double range[2] = {film_moment(view, clock->t[0]).U,
                                 film_moment(view, clock->t[clock->frames - 1]).U};
        TRY(result_view_read(view, SERIES_STATE, false, &page->states, err));
        TRY(history_bar_fit(view, range, page->states, &words, NULL, bar, err));
    }
    page->band.map.states = page->states;
    page->band.map.sign = state ? -1 : 0;

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
    band_draw(page);
    if (page->in_space)
        plane_draw(page);
    else
        axes_draw(&page->base, &page->contact);
    force_draw(page);
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
    map_page_destroy(&page->band.map);
    film_block_close(&page->block);
    memory_free_all(page->plane_values, page->level, page->states, page);
}
