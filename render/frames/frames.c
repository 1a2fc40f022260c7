// SPDX-License-Identifier: GPL-2.0-or-later
// The row of frames that a page's slider goes through: the block where fields are stored, pressure,
// friction and slip rate along the contact, and the force curve with a mark. Each frame is a figure
// of its own, so that all are there without a script, too.
#include "render/render.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/canvas/svg_chart.h"
#include "render/figures/figure_field.h"
#include "render/figures/figures.h"
#include "render/frames/frame_choice.h"
#include "render/view/space_time.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STRIPS = 3, PRINTED = 6, STATUSES = 4 };
enum { FIELDS_LEAST = 4 };   // stored times: fewer tell no story, the steps of the history do

// Units of the drawing; a page shows it some 500 pixels wide.
enum { WIDTH = 560, LEFT = 70, RIGHT = 505, TOP = 26, STRIP = 72, STRIP_GAP = 16 };
enum { FORCE_TOP = TOP + STRIPS * (STRIP + STRIP_GAP) + 48, FORCE_HEIGHT = 96 };
enum { HEIGHT = FORCE_TOP + FORCE_HEIGHT + 44, BAND_TOP = 6, BAND_HEIGHT = 9 };

static const double RATE_LEAST = 1e-2, RATE_MOST = 1e6;   // over V: as the slip map has it; drawn
static const double PRESSURE_LEAST = 1e-3;   // over P_ext: of less, friction over it means nothing
static const double LEFT_OUT = 0.01;   // of the pressures: those of singular corners
static const double HEADROOM = 1.12;
static const double IMAGE_WIDTH = 95, IMAGE_DPI = 160;   // mm: 600 pixels, letters 14 high
enum { LOOKED_AT = 6 };   // blocks in memory, to find the range of all

typedef enum StripId { STRIP_PRESSURE, STRIP_RATIO, STRIP_RATE } StripId;

typedef struct Frames {
    ResultView view;
    bool fields;   // of the block are stored
    BlockSource source;   // of the fields
    int64_t *rows;   // [stored] of the history, of which there are frames; owned
    int32_t stored, count;
    int32_t chosen[RENDER_FRAMES_MAX];   // [count] indices into rows
    int32_t points;   // along the contact: nodes, and a gap after each pad but the last
    double *x;   // [points] NaN in gaps; owned
    double *y[STRIPS];   // [count * points] owned
    uint8_t *status;   // [count * nodes] owned
    Axes strip[STRIPS], force;
    BlockPage map;   // the pictures of the block: one size, range and magnification
    double image_shape;   // height over width
} Frames;

// --- along the contact ---------------------------------------------------------------------------

// A point for each node, and one that is not there between two pads.
static bool read_contact(Frames *frames, Error *err)
{
    ResultView *view = &frames->view;
    int32_t count = frames->count;
    double *pressure = NULL, *shear = NULL, *rate = NULL, *status = NULL;
    int64_t rows[RENDER_FRAMES_MAX];
    for (int32_t k = 0; k < count; ++k) rows[k] = frames->rows[frames->chosen[k]];
    TRY(result_view_read_at(view, SERIES_PRESSURE, false, rows, count, &pressure, err));
    TRY(result_view_read_at(view, SERIES_SHEAR, false, rows, count, &shear, err));
    TRY(result_view_read_at(view, SERIES_SLIP_RATE, false, rows, count, &rate, err));
    TRY(result_view_read_at(view, SERIES_STATUS, false, rows, count, &status, err));
    TRY(frames->x = NEW_ARRAY(double, 2 * (int64_t)view->nodes, err));
    for (int32_t i = 0; i < view->nodes; ++i) {
        if (i > 0 && view->pad[i] != view->pad[i - 1]) frames->x[frames->points++] = NAN;
        frames->x[frames->points++] = view->x[i];
    }
    for (int32_t strip = 0; strip < STRIPS; ++strip)
        TRY(frames->y[strip] = NEW_ARRAY(double, (int64_t)count * frames->points, err));
    TRY(frames->status = NEW_ARRAY(uint8_t, (int64_t)count * view->nodes, err));
    for (int32_t k = 0; k < count; ++k)
        for (int32_t p = 0, i = 0; p < frames->points; ++p) {
            int64_t to = (int64_t)k * frames->points + p, from = (int64_t)k * view->nodes + i;
            bool gap = isnan(frames->x[p]);
            double part = gap ? NAN : pressure[from] / view->number[NUMBER_PRESSURE];
            double speed = gap ? NAN : fabs(rate[from]) / view->number[NUMBER_ROD_VELOCITY];
            frames->y[STRIP_PRESSURE][to] = part;
            frames->y[STRIP_RATIO][to] = part > PRESSURE_LEAST ? shear[from] / pressure[from] : NAN;
            frames->y[STRIP_RATE][to] = fmax(speed, gap ? NAN : RATE_LEAST);
            if (gap) continue;
            frames->status[from] = (uint8_t)fmin(fmax(status[from], 0), STATUSES - 1);
            ++i;
        }
cleanup:
    memory_free_all(pressure, shear, rate, status);
    return error_is_clean(err);
}

// --- axes ----------------------------------------------------------------------------------------

// The value that all but `left_out` of the finite ones of a strip stay below; `least` or more.
static bool find_high(const Frames *frames, StripId strip, double left_out, double least,
                      double *high, Error *err)
{
    int64_t count = (int64_t)frames->count * frames->points, kept = 0;
    double *sorted = NEW_ARRAY(double, count, err);
    TRY(sorted);
    for (int64_t k = 0; k < count; ++k)
        if (isfinite(frames->y[strip][k])) sorted[kept++] = frames->y[strip][k];
    qsort(sorted, (size_t)kept, sizeof *sorted, order_doubles);
    *high = least;
    if (kept > 0) *high = fmax(least, sorted[kept - 1 - (int64_t)(left_out * (double)kept)]);
cleanup:
    memory_free(sorted);
    return error_is_clean(err);
}

static bool fit_strips(Frames *frames, Error *err)
{
    const ResultView *view = &frames->view;
    static const char *const names[STRIPS] = {"~{p} / ~{P}_{ext}", "~{\u03c4} / ~{p}",
                                              "|~{v}| / ~{V}"};
    double high[STRIPS], mu = view->number[NUMBER_MU_STATIC];
    if (!find_high(frames, STRIP_PRESSURE, LEFT_OUT, 1, &high[STRIP_PRESSURE], err)) return false;
    if (!find_high(frames, STRIP_RATIO, LEFT_OUT, mu > 0 ? mu : 0.1, &high[STRIP_RATIO], err))
        return false;
    if (!find_high(frames, STRIP_RATE, 0, 10, &high[STRIP_RATE], err)) return false;
    high[STRIP_RATE] = fmin(pow(10, ceil(log10(high[STRIP_RATE]))), RATE_MOST);
    double first = view->x[0], last = view->x[view->nodes - 1];
    if (!(last > first)) last = first + 1;
    for (int32_t s = 0; s < STRIPS; ++s) {
        Axes *axes = &frames->strip[s];
        double top = TOP + s * (STRIP + STRIP_GAP);
        *axes = (Axes){.box = {.left = LEFT, .right = RIGHT, .top = top, .bottom = top + STRIP},
                       .x = figure_length_axis(view, "x", first, last)};
        axes->y = (Axis){.high = high[s] * HEADROOM, .factor = 1};
        snprintf(axes->y.label, sizeof axes->y.label, "%s", names[s]);
    }
    Axis *rate = &frames->strip[STRIP_RATE].y;
    rate->is_log = true;
    rate->low = RATE_LEAST;
    rate->high = high[STRIP_RATE];
    return true;
}

// Fits the pictures of the block to some of the times.
static bool fit_images(Frames *frames, Error *err)
{
    const PictureStyle style = {.width = IMAGE_WIDTH, .dpi = IMAGE_DPI};
    int32_t count = frames->count, looked = count < LOOKED_AT ? count : LOOKED_AT, at[LOOKED_AT];
    for (int32_t k = 0; k < looked; ++k)
        at[k] = frames->chosen[looked > 1 ? (int64_t)k * (count - 1) / (looked - 1) : 0];
    frames->map = (BlockPage){.view = &frames->view, .share = 1};
    if (!block_page_sample(&frames->map, &frames->source, at, looked, err)) return false;
    frames->image_shape = field_page_lay_out(&frames->map, page_width(&style));
    return true;
}

// --- a frame -------------------------------------------------------------------------------------

// The block as an <img> with the picture in it.
static bool write_image(const Frames *frames, int32_t k, TextWriter *html, Error *err)
{
    Block block = {0};
    Page page = {0};
    PictureBytes picture = {0};
    const PictureStyle style = {.format = "png", .width = IMAGE_WIDTH, .dpi = IMAGE_DPI};
    PageDef def = {.style = &style, .height = frames->image_shape};
    BlockWords words = block_words(frames->source.quantity);
    TRY(block_read(&frames->source, frames->chosen[k], &block, err));
    block_deform(&block, frames->map.magnification);
    TRY(page_begin(&page, &def, err));
    TRY(field_page_draw(&page, &frames->map, &block, err));
    TRY(canvas_finish(page.canvas, words.name, true, &picture, err));
    html_markup(html,
                "<img class='paper' width='%d' height='%d' alt='The deformed block, %s in "
                "colours, and which parts of its contact stick, slip or are open, at U = %.6g' "
                "src='",
                canvas_width(page.canvas), canvas_height(page.canvas), words.name, block.U);
    html_data(html, "image/png", picture.bytes, picture.size);
    html_markup(html, "'>");
cleanup:
    page_destroy(&page);
    block_destroy(&block);
    return error_is_clean(err);
}

static void write_chart(const Frames *frames, int32_t k, TextWriter *html)
{
    const ResultView *view = &frames->view;
    int64_t row = frames->rows[frames->chosen[k]];
    html_markup(html,
                "<svg class='chart' viewBox='0 0 %d %d' role='img' aria-label='Pressure, friction "
                "over pressure and slip rate along the contact, and the force curve, at U = "
                "%.6g'><use href='#common-axes'/>",
                WIDTH, HEIGHT, view->U[row]);

    // Draw above the strips a colour for each part of the contact that is of one status.
    const uint8_t *status = frames->status + (int64_t)k * view->nodes;
    const Axes *axes = &frames->strip[0];
    SpaceTime contact = {.nodes = view->nodes, .x = view->x, .pad = view->pad};
    double from, to, behind;
    for (int32_t i = 0; i < view->nodes;) {
        int32_t end = i;
        while (end + 1 < view->nodes && view->pad[end + 1] == view->pad[i] &&
               status[end + 1] == status[i])
            ++end;
        node_extent(&contact, i, &from, &to);
        node_extent(&contact, end, &behind, &to);
        double left = axes_place(axes, from, 0).x, right = axes_place(axes, to, 0).x;
        html_markup(html, "<rect class='status%d' x='%.1f' y='%d' width='%.1f' height='%d'/>",
                    status[i], left, BAND_TOP, right - left, BAND_HEIGHT);
        i = end + 1;
    }

    // The strips, and the place on the force curve.
    for (int32_t s = 0; s < STRIPS; ++s)
        svg_curve(html, &frames->strip[s], "curve1", frames->x,
                  frames->y[s] + (int64_t)k * frames->points, frames->points);
    Point at = axes_place(&frames->force, view->U[row], view->mu[row]);
    if (isfinite(at.x + at.y))
        html_markup(html,
                    "<path class='cursor' d='M%.1f %dv%d'/><circle class='cursor' cx='%.1f' "
                    "cy='%.1f' r='4'/>",
                    at.x, FORCE_TOP, FORCE_HEIGHT, at.x, at.y);
    html_markup(html, "</svg>");
}

// A figure is whole also where its picture fails. Some frames, evenly spread, are for paper, too.
static void write_frame(const Frames *frames, int32_t k, TextWriter *html, Error *err)
{
    const ResultView *view = &frames->view;
    int64_t row = frames->rows[frames->chosen[k]];
    int32_t every = (frames->count + PRINTED - 1) / PRINTED;
    html_markup(html, "<figure class='frame%s' id='frame-%d' tabindex='-1'>",
                k % every == every / 2 ? " printed" : "", k + 1);
    if (frames->fields) write_image(frames, k, html, err);
    write_chart(frames, k, html);
    html_markup(html, "<figcaption>Frame %d of %d: ", k + 1, frames->count);
    html_words(html, frames->force.x.label);
    html_markup(html,
                " = %.6g, <i>t</i> = %.6g%s, <i>F</i><sub>T</sub>/<i>F</i><sub>N</sub> = "
                "%.4f</figcaption>",
                view->U[row] * frames->force.x.factor, view->t[row],
                view->si ? "\u202fs" : " <i>t</i><sub>0</sub>", view->mu[row]);
    html_markup(html, "</figure>\n");
}

__attribute__((visibility("default"))) bool
amontons_render_frames(const char *folder, TextWriter *html, RenderFrames *found, Error *err)
{
    Frames frames = {0};
    ResultView *view = &frames.view;
    TRY(result_view_open(folder, view, err));

    // Which times: with some fields theirs, else those of steps.
    frames.source = (BlockSource){.folder = folder, .view = view};
    if (block_is_stored(folder)) TRY(block_source_open(&frames.source, err));
    frames.fields = frames.source.count >= FIELDS_LEAST;
    int64_t stored = frames.fields ? frames.source.count : view->rows;
    if (stored > INT32_MAX) FAIL(err, ERROR_INPUT, "the history has too many steps for a page");
    frames.stored = (int32_t)stored;
    TRY(frames.rows = NEW_ARRAY(int64_t, stored, err));
    for (int32_t k = 0; k < frames.stored; ++k)
        frames.rows[k] = frames.fields ? frames.source.row[k] : k;
    frames.count =
        frames_choose(view, frames.rows, frames.stored, RENDER_FRAMES_MAX, frames.chosen);

    TRY(read_contact(&frames, err));
    TRY(fit_strips(&frames, err));
    frames.force = figure_force_axes(
        view, 1, (Box){LEFT, FORCE_TOP, RIGHT, FORCE_TOP + FORCE_HEIGHT}, HEADROOM);
    if (frames.fields) TRY(result_view_read_status(view, err));
    if (frames.fields) TRY(fit_images(&frames, err));

    // The parts that all frames have in common are drawn once and used in each of them.
    html_markup(html, "<svg class='common' width='0' height='0' aria-hidden='true'><defs>"
                      "<g id='common-axes'>");
    for (int32_t s = 0; s < STRIPS; ++s) svg_axes(html, &frames.strip[s], s == STRIPS - 1);
    svg_level(html, &frames.strip[STRIP_RATIO], view->number[NUMBER_MU_STATIC], "~{\u03bc}_{S}");
    svg_level(html, &frames.strip[STRIP_RATIO], view->number[NUMBER_MU_KINETIC], "~{\u03bc}_{K}");
    svg_level(html, &frames.strip[STRIP_RATE], 1, "~{V}");
    svg_axes(html, &frames.force, true);
    svg_level(html, &frames.force, view->number[NUMBER_MU_M], "~{\u03bc}_{M}");
    svg_curve(html, &frames.force, "curve0", view->U, view->mu, view->rows);
    html_markup(html, "</g></defs></svg>\n");

    // A reader wants to see the last sliding first, where there is one.
    double U = INFINITY;
    int32_t first = 0;
    for (int32_t e = 0; e < view->event_count; ++e)
        if (view->events[e].kind == VIEW_LEADING) U = view->events[e].U_start;
    while (first < frames.count && !(view->U[frames.rows[frames.chosen[first]]] >= U)) ++first;
    html_markup(html, "<div class='frames' id='frames' data-first='%d'>\n",
                first < frames.count ? first + 1 : 1);
    for (int32_t k = 0; k < frames.count && error_is_clean(err); ++k) {
        write_frame(&frames, k, html, err);
        found->U[k] = view->U[frames.rows[frames.chosen[k]]];
        found->count = k + 1;
    }
    html_markup(html, "</div>\n");
    found->stored = frames.stored;
    found->fields = frames.fields;
cleanup:
    result_view_close(view);
    block_source_close(&frames.source);
    memory_free_all(frames.rows, frames.x, frames.status);
    memory_free_list((void *const *)frames.y, STRIPS);
    return error_is_clean(err);
}
