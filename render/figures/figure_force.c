// SPDX-License-Identifier: GPL-2.0-or-later
// Figure 1(b): F_T/F_N against U with mu_S, mu_M and mu_K, its peaks, and above it a frame of its
// own that enlarges the last precursors before a sliding.
#include "render/figures/figures.h"

#include "render/figures/columns.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LEVELS_MAX = 3, LEVEL_NAME_SIZE = 40 };

static const double HEADROOM = 1.06;   // frame's top over the largest value
static const double INSET_SHARE = 0.3;   // of the figure's height
static const double INSET_GAP = 5;   // points between its numbers and the frame below
static const double LEADER = 5;   // points: from a line's end to a name that had to move
static const double LEVEL_MARGIN = 19;   // points: names of the levels, right of the frame
static const double AWAY_MARGIN = 36;   // points: the same, where one is beyond the frame
static const double AWAY = 1.5;   // a level above so many times the curve would press it flat
static const double PEAK_PITCH = 0.3;   // of the distance of peaks: radius of a crowd's marks
static const double THIN_DISTANCE = 0.3;   // pixels: nearer points of a curve add nothing

// A horizontal line and its name.
typedef struct Level {
    double mu;
    const char *name;
    double y;   // of the name's middle, pixels
    bool away;   // beyond the frame: named at its top with its value
} Level;

Axes figure_force_axes(const ResultView *views, int32_t count, Box box, double headroom)
{
    double U[2] = {INFINITY, -INFINITY}, mu[2] = {0, 0};
    for (int32_t k = 0; k < count; ++k) {
        double low = 0, high = 0, own[2];
        result_view_range(&views[k], &low, &high);
        U[0] = fmin(U[0], low);
        U[1] = fmax(U[1], high);
        result_view_mu_range(&views[k], (double[]){-INFINITY, INFINITY}, own);
        mu[0] = fmin(mu[0], own[0]);
        mu[1] = fmax(mu[1], own[1]);
    }
    if (!(mu[1] > mu[0])) mu[1] = mu[0] + 1;
    return (Axes){.box = box,
                  .x = figure_length_axis(&views[0], "U", U[0], U[1]),
                  .y = {mu[0] * headroom, mu[1] * headroom, 1, .label = FIGURE_MU}};
}

// mu against U, clipped to the frame: the inset draws the same curve in other axes.
static void curve_draw(const Page *page, const ResultView *view, const Axes *axes)
{
    Stroke stroke = {.color = FIGURE_CURVE, .width = CURVE_WIDTH * page->point};
    canvas_clip(page->canvas, &axes->box);
    LinePen pen = line_begin(page->canvas, &stroke);
    pen.thin = THIN_DISTANCE;
    for (int64_t row = 0; row < view->rows; ++row)
        line_add(&pen, axes_place(axes, view->U[row], view->mu[row]));
    line_end(&pen);
    canvas_clip(page->canvas, NULL);
}

// Dashed lines across the frame, their names right of it.
static void levels_draw(const Page *page, const Axes *axes, Level *level, int32_t count)
{
    double point = page->point;
    Stroke stroke = dashed_stroke(page, FIGURE_LEVEL, 0.5);
    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK, .up = 0.5};

    // Names that would overlap move apart, downwards from the highest.
    double spacing = 1.1 * style.size;
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

    for (int32_t k = 0; k < count; ++k) {
        char words[LEVEL_NAME_SIZE];
        Point to = axes_place(axes, axes->x.high, level[k].mu);
        if (!level[k].away) axes_level(page, axes, &stroke, level[k].mu, 0, NULL);
        style.size = (level[k].away ? SMALL_SIZE : NUMBER_SIZE) * point;
        snprintf(words, sizeof words, level[k].away ? "\u2191%s %.3g" : "%s", level[k].name,
                 level[k].mu);
        Point name = {to.x + 2 * point, level[k].y};
        if (!level[k].away && fabs(name.y - to.y) > point) {
            Stroke leader = {.color = FIGURE_LEVEL, .width = 0.4 * point};
            name.x += LEADER * point;
            draw_segment(page->canvas, &leader, to, (Point){name.x - point, name.y});
        }
        text_draw(page->text, &style, name, words);
    }
}

static bool is_shown(const ViewPeak *peak, const Axes *axes)
{
    return isfinite(peak->mu) && peak->U >= axes->x.low && peak->U <= axes->x.high;
}

// Peaks that count for mu_M are filled, the others hollow; smaller where they are many.
static void peaks_draw(const Page *page, const ResultView *view, const Axes *axes)
{
    double width = axes->box.right - axes->box.left;
    int32_t shown = 0;
    for (int32_t k = 0; k < view->peak_count; ++k) shown += is_shown(&view->peaks[k], axes);
    double radius = fmin(KEY_RADIUS * page->point, fmax(PEAK_PITCH * width / (shown + 1), 1));
    for (int32_t k = 0; k < view->peak_count; ++k) {
        const ViewPeak *peak = &view->peaks[k];
        if (!is_shown(peak, axes)) continue;
        Point place = axes_place(axes, peak->U, peak->mu);
        draw_disc(page->canvas, INK, place, radius);
        if (!peak->counts) draw_disc(page->canvas, PAPER, place, 0.6 * radius);
    }
}

// On pads the largest load before a sliding of the whole block may be that at which one pad slid:
// where the block itself slid stands at the foot of the frame.
static const double SLIDING_HEIGHT = 4;   // points

static int32_t slidings_draw(const Page *page, const ResultView *view, const Axes *axes)
{
    int32_t count = 0;
    bool pads = result_view_pads(view) > 1;
    for (int32_t k = 0; k < view->event_count && pads; ++k) {
        const ViewEvent *event = &view->events[k];
        bool shown = event->U_start >= axes->x.low && event->U_start <= axes->x.high;
        if (event->kind != VIEW_LEADING || !shown) continue;
        ++count;
        if (!page) continue;
        Stroke stroke = {.color = ZOOM_FORCE, .width = CURVE_WIDTH * page->point};
        Point foot = axes_place(axes, event->U_start, axes->y.low);
        draw_segment(page->canvas, &stroke, foot,
                     (Point){foot.x, foot.y - SLIDING_HEIGHT * page->point});
    }
    return count;
}

// True if the zoom lies in what is shown, and the style does not forbid it.
static bool has_inset(const ResultView *view, const PictureStyle *style, const ViewRange *shown)
{
    Zoom zoom = zoom_choose(view);
    bool none = style->inset && strcmp(style->inset, "none") == 0;
    double range[2];
    result_view_mu_range(view, (double[]){zoom.U_low, zoom.U_slide}, range);
    return !none && zoom.found && !zoom.smooth && zoom.U_low >= shown->low &&
           zoom.U_high <= shown->high && range[1] > range[0];
}

bool figure_force_enlarges(const ResultView *view, const PictureStyle *style)
{
    Error ignored = {0};   // who draws the figure says it
    ViewRange shown;
    return view_range_find(view, style, &shown, &ignored) && has_inset(view, style, &shown);
}

// The frame of the U that is shown, all of mu there and the levels that the result knows: mu_M is
// missing in a run that did not end. The frame lies below `top`. level: [returned].
static int32_t axes_layout(const Page *page, const ResultView *view, const ViewRange *shown,
                           double top, Axes *axes, Level level[LEVELS_MAX])
{
    static const struct {
        ResultNumber number;
        const char *name;
    } known[LEVELS_MAX] = {{NUMBER_MU_STATIC, "~{\u03bc}_{S}"},
                           {NUMBER_MU_M, "~{\u03bc}_{M}"},
                           {NUMBER_MU_KINETIC, "~{\u03bc}_{K}"}};
    double range[2];
    Box room = page->room;
    room.top = top;
    result_view_mu_range(view, (double[]){shown->low, shown->high}, range);
    if (!(range[1] >= range[0])) range[0] = range[1] = 0;
    double highest = range[1];   // of the curve
    int32_t count = 0;
    bool away = false;
    for (int32_t k = 0; k < LEVELS_MAX; ++k) {
        double mu = view->number[known[k].number];
        if (!isfinite(mu)) continue;
        bool beyond = highest > 0 && mu > AWAY * highest;
        level[count++] = (Level){.mu = mu, .name = known[k].name, .away = beyond};
        if (!beyond) range[1] = fmax(range[1], mu);
        away = away || beyond;
    }
    *axes = (Axes){.x = figure_length_axis(view, "U", shown->low, shown->high),
                   .y = {.low = fmin(0, range[0] * HEADROOM), .factor = 1, .label = FIGURE_MU},
                   .bare_x = page->bare_x};
    axes->y.high = range[1] * HEADROOM;
    if (!(axes->y.high > axes->y.low)) axes->y.high = axes->y.low + 1;
    axes_fit(page, &room, away ? AWAY_MARGIN : LEVEL_MARGIN, axes);
    return count;
}

bool figure_force(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    ViewRange shown;
    Measured measured = {0};
    Axes axes, inset = {0};
    Level level[LEVELS_MAX];
    if (!view_range_find(view, &page.style, &shown, err) ||
        !measured_read(page.style.compare, MEASURED_MU, view, &measured, err))
        return false;

    // The key.
    KeyEntry entries[5];
    int32_t count = 0;
    const Axes all = {.x = {.low = shown.low, .high = shown.high}};
    bool seen[2] = {false, false};
    for (int32_t k = 0; k < view->peak_count; ++k)
        if (is_shown(&view->peaks[k], &all)) seen[view->peaks[k].counts] = true;
    if (seen[1])
        entries[count++] =
            (KeyEntry){KEY_DISC, INK, "largest before the block slid, counts for ~{\u03bc}_{M}"};
    if (seen[0]) entries[count++] = (KeyEntry){KEY_RING, INK, "does not count"};
    if (slidings_draw(NULL, view, &all) > 0)
        entries[count++] =
            (KeyEntry){KEY_LINE, ZOOM_FORCE, "ticks at the foot: the whole block slides"};
    if (shown.words[0]) entries[count++] = (KeyEntry){.words = shown.words};
    key_draw(&page, entries, measured_key(&measured, KEY_DISC, entries, count));

    // The inset, a frame above: the zoom's U, mu from the first precursor shown to a little above
    // the peak.
    bool enlarged = has_inset(view, &page.style, &shown);
    double top = page.room.top;
    if (enlarged) {
        Zoom zoom = zoom_choose(view);
        double range[2];
        result_view_mu_range(view, (double[]){zoom.U_low, zoom.U_slide}, range);
        double pad = 0.12 * (range[1] - range[0]);
        inset = (Axes){
            .color = ZOOM_FORCE,
            .x = figure_length_axis(view, "U", zoom.U_low, zoom.U_high),
            .y = {.low = range[0] - pad, .high = range[1] + pad, .factor = 1, .label = FIGURE_MU}};
        inset.x.factor = figure_length_axis(view, "U", shown.low, shown.high).factor;
        inset.x.label[0] = '\0';
        inset.box.top = page.room.top + round(axes_top_margin(&inset) * page.point);
        inset.box.bottom = inset.box.top + round(INSET_SHARE * (page.room.bottom - page.room.top));
        top = round(inset.box.bottom + (axes_bottom_margin(&inset) + INSET_GAP) * page.point);
    }
    int32_t levels = axes_layout(&page, view, &shown, top, &axes, level);

    // Both frames are equally wide: the wider numbers say where they begin.
    double left = enlarged ? round(page.room.left + axes_left_margin(&page, &inset) * page.point)
                           : 0;
    axes.box.left = fmax(axes.box.left, left);
    axes_settle(&page, &axes);
    inset.box.left = axes.box.left;
    inset.box.right = axes.box.right;

    levels_draw(&page, &axes, level, levels);
    curve_draw(&page, view, &axes);
    peaks_draw(&page, view, &axes);
    slidings_draw(&page, view, &axes);
    measured_draw(&page, &measured, -1, &axes);
    if (enlarged) {
        // A frame around the part that the inset shows, with lines from it to below the inset's
        // numbers: all in one colour.
        Stroke stroke = {.color = ZOOM_FORCE, .width = 0.5 * page.point};
        Point from = axes_place(&axes, inset.x.low, inset.y.high);
        Point to = axes_place(&axes, inset.x.high, inset.y.low);
        Box box = {from.x, from.y, to.x, to.y};
        draw_outline(page.canvas, &stroke, &box);
        stroke.width *= 0.6;
        double foot = inset.box.bottom + axes_bottom_margin(&inset) * page.point;
        draw_segment(page.canvas, &stroke, from, (Point){inset.box.left, foot});
        draw_segment(page.canvas, &stroke, (Point){to.x, from.y}, (Point){inset.box.right, foot});

        curve_draw(&page, view, &inset);
        measured_draw(&page, &measured, -1, &inset);
        axes_draw(&page, &inset);
    }
    axes_draw(&page, &axes);
    measured_destroy(&measured);
    return true;
}

bool figure_force_table(const char *path, ResultView *view, const FieldChoice *field, Error *err)
{
    const Column columns[] = {
        {"U", "m", view->U}, {"t", "s", view->t}, {"F_T/F_N", NULL, view->mu}};
    (void)field;
    return columns_write(path, columns, 3, view->rows, view->si, err);
}
