// SPDX-License-Identifier: GPL-2.0-or-later
// Figure 1(b): F_T/F_N against U with mu_S, mu_M and mu_K, its peaks, and above the curve an inset
// that enlarges the last precursors before a sliding.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/figures/zoom.h"

#include <math.h>
#include <stdio.h>

enum { LEVELS_MAX = 3, LEVEL_NAME_SIZE = 40 };

static const double DATA_SHARE = 0.54;   // of the frame's height, where an inset is above it
static const double HEADROOM = 1.06;   // frame's top over the largest value
static const double INSET_TOP = 0.035;   // of the frame's height: its distance from the top
static const double INSET_HEIGHT = 0.285;   // of the frame's height
static const double INSET_WIDTH = 0.72;   // of the frame's width
static const double INSET_RIGHT = 0.03;   // of the frame's width: its distance from the right
static const double LEVEL_MARGIN = 15;   // points: names of the levels, right of the frame
static const double AWAY_MARGIN = 26;   // points: the same, where one is beyond the frame
static const double AWAY = 1.5;   // a level above so many times the curve would press it flat
static const double PEAK_RADIUS = 1.4;   // points
static const double THIN_DISTANCE = 0.3;   // pixels: nearer points of a curve add nothing

static const Color CURVE_COLOR = {0.05f, 0.27f, 0.55f, 1};
static const Color LEVEL_COLOR = {0.45f, 0.45f, 0.47f, 1};

// A horizontal line and its name.
typedef struct Level {
    double mu;
    const char *name;
    double y;   // of the name's middle, pixels
    bool away;   // beyond the frame: named at its top with its value
} Level;

// mu against U, clipped to the frame: the inset draws the same curve in other axes.
static bool curve_draw(const Page *page, const ResultView *view, const Axes *axes, Error *err)
{
    Stroke stroke = {.color = CURVE_COLOR, .width = CURVE_WIDTH * page->point};
    Point *line = NULL;
    int64_t count = 0;
    TRY(line = NEW_ARRAY(Point, view->rows, err));
    for (int64_t row = 0; row < view->rows; ++row) {
        Point place = axes_place(axes, view->U[row], view->mu[row]);
        bool near = count > 0 &&
                    hypot(place.x - line[count - 1].x, place.y - line[count - 1].y) < THIN_DISTANCE;
        if (!near) line[count++] = place;
    }
    canvas_clip(page->canvas, &axes->box);
    draw_line(page->canvas, &stroke, line, count);
    canvas_clip(page->canvas, NULL);
cleanup:
    memory_free(line);
    return error_is_clean(err);
}

// Smallest and largest mu for U from low to high; false where there is none.
static bool mu_range(const ResultView *view, const double U[2], double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int64_t row = 0; row < view->rows; ++row) {
        double mu = view->mu[row];
        if (!(view->U[row] >= U[0] && view->U[row] <= U[1]) || !isfinite(mu)) continue;
        range[0] = fmin(range[0], mu);
        range[1] = fmax(range[1], mu);
    }
    return range[1] >= range[0];
}

// The levels that the result knows: mu_M is missing in a run that did not end. highest: the largest
// mu of the curve.
static int32_t levels_list(const ResultView *view, double highest, Level level[LEVELS_MAX])
{
    static const struct {
        ResultNumber number;
        const char *name;
    } known[LEVELS_MAX] = {{NUMBER_MU_STATIC, "~{\u03bc}_{S}"},
                           {NUMBER_MU_M, "~{\u03bc}_{M}"},
                           {NUMBER_MU_KINETIC, "~{\u03bc}_{K}"}};
    int32_t count = 0;
    for (int32_t k = 0; k < LEVELS_MAX; ++k) {
        double mu = view->number[known[k].number];
        if (!isfinite(mu)) continue;
        level[count] = (Level){.mu = mu, .name = known[k].name};
        level[count++].away = highest > 0 && mu > AWAY * highest;
    }
    return count;
}

// Names that would overlap move apart, downwards from the highest.
static void names_spread(const Axes *axes, Level *level, int32_t count, double spacing)
{
    for (int32_t k = 0; k < count; ++k) {
        level[k].y = axes_place(axes, 0, level[k].mu).y;
        if (level[k].away) level[k].y = axes->box.top + spacing / 2;
    }
    for (int32_t k = 1; k < count; ++k) {
        Level moved = level[k];   // sorted by height: at most three
        int32_t place = k;
        for (; place > 0 && level[place - 1].y > moved.y; --place) level[place] = level[place - 1];
        level[place] = moved;
    }
    for (int32_t k = 1; k < count; ++k) level[k].y = fmax(level[k].y, level[k - 1].y + spacing);
}

// Dashed lines across the frame, their names right of it.
static void levels_draw(const Page *page, const Axes *axes, Level *level, int32_t count)
{
    double point = page->point;
    Stroke stroke = {.color = LEVEL_COLOR, .width = 0.5 * point};
    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK, .up = 0.5};
    stroke.dash = 3 * point;
    stroke.space = 2 * point;
    names_spread(axes, level, count, 1.1 * style.size);
    for (int32_t k = 0; k < count; ++k) {
        char words[LEVEL_NAME_SIZE];
        Point from = axes_place(axes, axes->x.low, level[k].mu);
        Point to = axes_place(axes, axes->x.high, level[k].mu);
        if (!level[k].away) draw_segment(page->canvas, &stroke, from, to);
        if (level[k].away) style.size = SMALL_SIZE * point;
        snprintf(words, sizeof words, level[k].away ? "\u2191%s %.3g" : "%s", level[k].name,
                 level[k].mu);
        text_draw(page->text, &style, (Point){to.x + 2 * point, level[k].y}, words);
        style.size = NUMBER_SIZE * point;
    }
}

// Peaks that count for mu_M are filled, the others hollow.
static void peaks_draw(const Page *page, const ResultView *view, const Axes *axes)
{
    double radius = PEAK_RADIUS * page->point;
    for (int32_t k = 0; k < view->peak_count; ++k) {
        const ViewPeak *peak = &view->peaks[k];
        if (!isfinite(peak->U) || !isfinite(peak->mu)) continue;
        Point place = axes_place(axes, peak->U, peak->mu);
        draw_disc(page->canvas, INK, place, radius);
        if (!peak->counts) draw_disc(page->canvas, PAPER, place, 0.6 * radius);
    }
}

// The inset's frame has the same colour.
static void outline_draw(const Page *page, const Axes *axes, const Axes *inset)
{
    Stroke stroke = {.color = ZOOM_FORCE, .width = 0.5 * page->point};
    Point from = axes_place(axes, inset->x.low, inset->y.high);
    Point to = axes_place(axes, inset->x.high, inset->y.low);
    Box box = {from.x, from.y, to.x, to.y};
    draw_outline(page->canvas, &stroke, &box);
}

// The inset's axes: the zoom's U, mu from the first precursor shown to a little above the peak.
static bool inset_axes(const ResultView *view, const Axes *axes, Axes *inset)
{
    Zoom zoom = zoom_choose(view);
    double range[2], width = axes->box.right - axes->box.left;
    double height = axes->box.bottom - axes->box.top;
    const double U[2] = {zoom.U_low, zoom.U_slide};
    if (!zoom.found || !mu_range(view, U, range) || !(range[1] > range[0])) return false;
    double pad = 0.12 * (range[1] - range[0]);
    *inset = (Axes){.x = axes->x, .y = axes->y, .number_size = SMALL_SIZE, .color = ZOOM_FORCE};
    inset->x.low = zoom.U_low;
    inset->x.high = zoom.U_high;
    inset->y.low = range[0] - pad;
    inset->y.high = range[1] + pad;
    inset->x.label[0] = inset->y.label[0] = '\0';
    inset->box.right = round(axes->box.right - INSET_RIGHT * width);
    inset->box.left = round(inset->box.right - INSET_WIDTH * width);
    inset->box.top = round(axes->box.top + INSET_TOP * height);
    inset->box.bottom = round(inset->box.top + INSET_HEIGHT * height);
    return true;
}

// The frame for all U and, below `share` of its height, all of mu and the levels.
static Axes axes_layout(const Page *page, const ResultView *view, double share)
{
    double U[2], range[2] = {0, 1}, point = page->point;
    Axes axes = {.number_size = NUMBER_SIZE, .color = INK};
    Level level[LEVELS_MAX];
    result_view_range(view, &U[0], &U[1]);
    if (!mu_range(view, U, range)) range[0] = range[1] = 0;
    int32_t count = levels_list(view, range[1], level);
    bool away = false;
    for (int32_t k = 0; k < count; ++k) {
        if (!level[k].away) range[1] = fmax(range[1], level[k].mu);
        away = away || level[k].away;
    }
    axes.x = figure_length_axis(view, "U", U[0], U[1]);
    axes.y = (Axis){.low = fmin(0, range[0] * HEADROOM), .factor = 1};
    axes.y.high = axes.y.low + (range[1] * HEADROOM - axes.y.low) / share;
    if (!(axes.y.high > axes.y.low)) axes.y.high = axes.y.low + 1;
    snprintf(axes.y.label, sizeof axes.y.label, "~{F}_{T} / ~{F}_{N}");
    axes.box.top = page->head + round(axes_top_margin(&axes) * point);
    axes.box.bottom =
        round(canvas_height(page->canvas) - page->foot - axes_bottom_margin(&axes) * point);
    axes.box.left = round(axes_left_margin(page, &axes) * point);
    axes.box.right =
        round(canvas_width(page->canvas) - (away ? AWAY_MARGIN : LEVEL_MARGIN) * point);
    return axes;
}

bool figure_force(const Page *page, ResultView *view, Error *err)
{
    bool enlarged = zoom_choose(view).found;
    Axes axes = axes_layout(page, view, enlarged ? DATA_SHARE : 1), inset;
    Level level[LEVELS_MAX];
    double U[2], range[2] = {0, 0};
    result_view_range(view, &U[0], &U[1]);
    mu_range(view, U, range);
    int32_t count = levels_list(view, range[1], level);
    levels_draw(page, &axes, level, count);
    TRY(curve_draw(page, view, &axes, err));
    peaks_draw(page, view, &axes);
    if (enlarged && inset_axes(view, &axes, &inset)) {
        outline_draw(page, &axes, &inset);
        TRY(curve_draw(page, view, &inset, err));
        axes_draw(page, &inset);
    }
    axes_draw(page, &axes);
cleanup:
    return error_is_clean(err);
}
