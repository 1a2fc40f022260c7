// SPDX-License-Identifier: GPL-2.0-or-later
// A plot on its page: one frame, perhaps with an inset, or a page of frames with the same axes and
// colours; the legend in lines below.
#include "render/plot/plot_draw.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/text/csv_reader.h"
#include "io/text/csv_writer.h"
#include "render/picture_options.h"
#include "render/plot/plot_map.h"
#include "render/plot/legend.h"
#include "render/plot/marks.h"
#include "render/plot/plot_file.h"
#include "render/render.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- one frame ----------------------------------------------------------------------------------

static const double BAR_GAP = 6;   // points: frame to colour bar
static const double BAR_WIDTH = 0.5, BAR_CAP = 1.4;   // points: error bars, half their caps

// Lines and bars are cut off at the frame. A NaN breaks a line; so does what a logarithmic axis
// cannot show.
static void series_draw(const Page *page, const Axes *axes, const PlotPanel *panel, double share)
{
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        Stroke stroke = mark_stroke(page, series, share);
        if (series->line != LINE_NONE)
            axes_curve(page, axes, &stroke, series->x, series->y, series->count);
    }

    // Error bars from low to high with caps: upright, or lying where the y axis has names.
    bool lying = axes->y.names != NULL;
    double cap_x = lying ? 0 : BAR_CAP * page->point, cap_y = lying ? BAR_CAP * page->point : 0;
    canvas_clip(page->canvas, &axes->box);
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        Stroke stroke = {.color = mark_color(series), .width = BAR_WIDTH * page->point};
        for (int32_t i = 0; i < series->count; ++i) {
            Point end[2];
            if (!plot_bar_ends(axes, series, i, end)) continue;
            draw_segment(page->canvas, &stroke, end[0], end[1]);
            for (int32_t side = 0; side < 2; ++side)
                draw_segment(page->canvas, &stroke,
                             (Point){end[side].x - cap_x, end[side].y - cap_y},
                             (Point){end[side].x + cap_x, end[side].y + cap_y});
        }
    }
    canvas_clip(page->canvas, NULL);

    // A mark on the frame is drawn whole, one beyond it not at all.
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        for (int32_t i = 0; i < series->count; ++i) {
            Point at = axes_place(axes, series->x[i], series->y[i]);
            bool inside = at.x >= axes->box.left - 1 && at.x <= axes->box.right + 1 &&
                          at.y >= axes->box.top - 1 && at.y <= axes->box.bottom + 1;
            if (inside) mark_draw(page, series, at, share);
        }
    }
}

// A panel in the frame of `axes`, and over it `common`, what all panels show; NULL: nothing. The
// maps lie below, then lines, then error bars, then marks. share: of the usual size of marks and
// lines.
static bool panel_draw(const Page *page, const PlotPanel *panel, const PlotPanel *common,
                       const MapScale *scale, double share, const Axes *axes, Error *err)
{
    if (panel->has_map && !plot_map_draw(page, axes, panel, scale, err)) return false;
    if (common && common->has_map && !plot_map_draw(page, axes, common, scale, err)) return false;
    series_draw(page, axes, panel, share);
    if (common) series_draw(page, axes, common, share);
    axes_draw(page, axes);
    return true;
}

// --- a page of frames ---------------------------------------------------------------------------

static const double BETWEEN = 7;   // points between frames side by side
static const double TITLE_HEIGHT = 13.5, TITLE_DROP = 3;   // points: above each frame; its baseline
static const double LAST_MARGIN = 9;   // points: beside the last frame
static const double PANEL_SHARE = 0.8;   // marks and lines of a panel over those of one frame
static const double WIDTH_OF[] = {86, 130, 178, 178};   // mm, of so many columns: a journal's sizes
static const double BESIDE = 0.24, ABOVE = 0.16;   // of the page's width: axis, bar; names, legend

static int32_t column_count(int32_t panels)
{
    if (panels <= 3) return panels;
    if (panels == 4) return 2;
    return panels <= 9 ? 3 : 4;
}

// Small multiples: the panels in rows and columns above the legend. Numbers stand at the left and
// below the lowest.
static bool panels_draw(const Page *page, const Plot *plot, const Box *below, Error *err)
{
    MapScale scale = map_scale_fit(plot);
    Axes axes = {.x = plot->main.x, .y = plot->main.y};
    double point = page->point, right = LAST_MARGIN;
    int32_t columns = column_count(plot->panel_count);
    int32_t rows = (plot->panel_count + columns - 1) / columns;
    bool has_map = plot->main.has_map;
    for (int32_t k = 0; k < plot->panel_count; k++) has_map = has_map || plot->panels[k].has_map;
    if (has_map) right = BAR_GAP + colorbar_width(page, &scale.bar);

    // Place of the first frame and size of all, pixels.
    axes.box.bottom = (below->top - page->room.top) / 2;   // where ticks are counted
    double left = round(axes_left_margin(page, &axes) * point);
    double top = page->room.top + TITLE_HEIGHT * point;
    double wide = canvas_width(page->canvas) - right * point - left;
    double high = below->top - axes_bottom_margin(&axes) * point - page->room.top;
    double width = floor((wide - (columns - 1) * BETWEEN * point) / columns);
    double height = floor(high / rows - TITLE_HEIGHT * point);
    if (width < 2 * BETWEEN * point || height < 2 * BETWEEN * point)
        return REFUSE(err, "the page is too small for %d panels", plot->panel_count);

    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK, .across = 0.5};
    Box all = {0};   // the first line's last frame, down to the last line
    for (int32_t k = 0; k < plot->panel_count; k++) {
        int32_t line = k / columns, column = k % columns;
        axes.box.left = round(left + (width + BETWEEN * point) * column);
        axes.box.top = round(top + (height + TITLE_HEIGHT * point) * line);
        axes.box.right = axes.box.left + width;
        axes.box.bottom = axes.box.top + height;
        axes.bare_x = k + columns < plot->panel_count;
        axes.bare_y = column > 0;
        if (!panel_draw(page, &plot->panels[k], &plot->main, &scale, PANEL_SHARE, &axes, err))
            return false;
        Point above = {(axes.box.left + axes.box.right) / 2, axes.box.top - TITLE_DROP * point};
        text_draw(page->text, &style, above, plot->panels[k].title);
        if (k == columns - 1) all = axes.box;
        all.bottom = axes.box.bottom;
    }
    if (has_map) colorbar_draw(page, &scale.bar, &all, BAR_GAP);
    return true;
}

// --- measurements --------------------------------------------------------------------------------
// One more series with the misfit in its label, from a table of comma-separated values.

static const double WIDER = 0.05;   // of the axis, beyond a measurement outside of it

// The column called `given`, with a unit or without, else the plain one. *factor: to SI where it
// has a unit, else the numbers are the plot's.
static bool find_column(const CsvTable *table, const char *given, const char *plain,
                        int32_t *column, double *factor, Error *err)
{
    CsvUnit unit = {"", 0};
    *factor = 1;
    *column = -1;
    if (given[0] && !csv_find(table, given, column, &unit, err)) return false;
    if (*column < 0 && !csv_find(table, plain, column, &unit, err)) return false;
    return unit.length == 0 || csv_to_si(table, *column, unit, NULL, factor, err);
}

static bool read_points(const Plot *plot, const CsvTable *table, PlotSeries *series, Error *err)
{
    CsvUnit unit;
    int32_t x = -1, y = -1, error = -1;
    double factor[3];   // of x, y, error
    if (!find_column(table, plot->column[0], "x", &x, &factor[0], err) ||
        !find_column(table, plot->column[1], "y", &y, &factor[1], err))
        return false;
    if (x < 0 || y < 0)
        return REFUSE(err, "%s: it needs the columns %s and %s", table->path,
                      plot->column[0][0] ? plot->column[0] : "x",
                      plot->column[1][0] ? plot->column[1] : "y");
    csv_find_error(table, y, &error, &unit);
    factor[2] = factor[1];   // in the unit of y where it has none
    if (error >= 0 && unit.length > 0 && !csv_to_si(table, error, unit, NULL, &factor[2], err))
        return false;
    if (table->rows == 0)
        return REFUSE(err, "%s: below the names of its columns there is no row", table->path);
    if (!(csv_check(table, x, false, err) && csv_check(table, y, false, err) &&
          csv_check(table, error, true, err)))
        return false;
    if (!(series->x = NEW_ARRAY(double, table->rows, err))) return false;
    if (!(series->y = NEW_ARRAY(double, table->rows, err))) return false;
    if (!(series->low = NEW_ARRAY(double, table->rows, err))) return false;
    if (!(series->high = NEW_ARRAY(double, table->rows, err))) return false;
    for (int32_t row = 0; row < table->rows; ++row) {
        double value = factor[1] * csv_value(table, row, y);
        double bar = error < 0 ? (double)NAN : factor[2] * csv_value(table, row, error);
        series->x[row] = factor[0] * csv_value(table, row, x);
        series->y[row] = value;
        series->low[row] = value - bar;
        series->high[row] = value + bar;
    }
    series->count = table->rows;
    return true;
}

static double on_axis(const Axis *axis, double value)
{
    return axis->is_log ? log10(value) : value;
}

// Widens an axis to values outside of it.
static void widen(Axis *axis, const double *values, int32_t count)
{
    double low = on_axis(axis, axis->low), high = on_axis(axis, axis->high);
    double margin = WIDER * (high - low), least = low, most = high;
    for (int32_t k = 0; k < count; ++k) {
        double value = on_axis(axis, values[k]);
        if (!isfinite(value)) continue;
        least = fmin(least, value - (value < low ? margin : 0));
        most = fmax(most, value + (value > high ? margin : 0));
    }
    axis->low = axis->is_log ? pow(10, least) : least;
    axis->high = axis->is_log ? pow(10, most) : most;
}

// The columns are those that the axes name (`column`), or x and y; `error`, or the second column's
// name with _error behind it, is the bar. The misfit is the root of the mean square of measured
// less computed, linear between the points of the curve (over logarithms where the axis has them),
// over those that it covers; in parts of the errors too where all have one. Where a plot has
// several curves there is none. ERROR_INPUT: a column is missing, or the plot is a map.
static bool compare_draw(Plot *plot, const char *path, Error *err)
{
    CsvTable table = {0};
    if (plot->main.y.names) return true;   // a ranking
    TRY(csv_read(path, &table, err));
    if (plot->main.has_map || (plot->panel_count > 0 && plot->panels[0].has_map))
        FAIL(err, ERROR_INPUT, "measurements are drawn over curves, not over a map");
    if (plot->main.series_count == PLOT_SERIES_MAX)
        FAIL(err, ERROR_INPUT, "the plot has %d curves, and no room for measurements",
             PLOT_SERIES_MAX);

    // The curve to compare with: the one with a line through several points, if it is one alone.
    PlotSeries *series = &plot->main.series[plot->main.series_count], *curve = NULL;
    int32_t curves = 0;
    for (int32_t k = 0; k < plot->main.series_count; ++k) {
        PlotSeries *other = &plot->main.series[k];
        if (other->line == LINE_NONE || other->count < 2) continue;
        curve = other;
        ++curves;
    }
    if (plot->panel_count > 0 || curves > 1) curve = NULL;
    plot->main.series_count++;
    *series = (PlotSeries){.marker = MARKER_CROSS, .filled = true, .line = LINE_NONE};
    TRY(read_points(plot, &table, series, err));

    // Name of the file and misfit, where there is one curve.
    const char *slash = strrchr(path, '/');
    const char *name = plot->measured[0] ? plot->measured : slash ? slash + 1 : path;
    int length = snprintf(series->label, sizeof series->label, "%.40s", name);
    if (curve) {
        double sum = 0, parts = 0;
        int32_t count = 0;
        if (!curve->label[0]) snprintf(curve->label, sizeof curve->label, "computed");
        TRY(plot->computed = NEW_ARRAY(double, series->count, err));
        for (int32_t k = 0; k < series->count; ++k) {
            // Between two points of the curve, on its axis; NaN: the curve does not come to x.
            const Axis *axis = &plot->main.x;
            double x = series->x[k];
            plot->computed[k] = NAN;
            for (int32_t i = 0; i + 1 < curve->count; ++i) {
                double low = curve->x[i], high = curve->x[i + 1];
                if (!(x >= fmin(low, high) && x <= fmax(low, high))) continue;
                double span = on_axis(axis, high) - on_axis(axis, low);
                double part = span != 0 ? (on_axis(axis, x) - on_axis(axis, low)) / span : 1;
                plot->computed[k] = curve->y[i] + part * (curve->y[i + 1] - curve->y[i]);
                break;
            }
            double away = series->y[k] - plot->computed[k];
            double error = (series->high[k] - series->low[k]) / 2;
            if (!isfinite(away)) continue;
            sum += away * away;
            parts += away * away / (error * error);
            ++count;
        }
        size_t room = sizeof series->label;
        if (count > 0)
            length += snprintf(series->label + length, room - (size_t)length, ": misfit %.3g",
                               sqrt(sum / count));
        if (count > 0 && isfinite(parts))
            snprintf(series->label + length, room - (size_t)length, ", %.3g of its errors",
                     sqrt(parts / count));
    }

    // The ends of the axes were those of what was computed.
    widen(&plot->main.x, series->x, series->count);
    widen(&plot->main.y, series->y, series->count);
    widen(&plot->main.y, series->low, series->count);
    widen(&plot->main.y, series->high, series->count);
cleanup:
    csv_destroy(&table);
    error_context(err, "measurements");
    return error_is_clean(err);
}

// Each measurement with what was computed there, into PICTURE-compared.csv, if anything is.
static bool compare_write(const Plot *plot, const char *picture, Error *err)
{
    static const char *const plain[2] = {"x", "y"};
    char path[PATH_MAX];
    const char *dot = strrchr(picture, '.');
    if (!plot->computed) return true;
    const PlotSeries *series = &plot->main.series[plot->main.series_count - 1];
    int length = snprintf(path, sizeof path, "%.*s-compared.csv", (int)(dot - picture), picture);
    if (length >= (int)sizeof path) return REFUSE(err, "the picture's path is too long");
    TextWriter *csv = text_writer_create(path, false, err);
    if (!csv) return false;
    for (int32_t c = 0; c < 2; ++c) csv_text(csv, plot->column[c][0] ? plot->column[c] : plain[c]);
    csv_text(csv, "error");
    csv_text(csv, "computed");
    csv_end_row(csv);
    for (int32_t k = 0; k < series->count; ++k) {
        csv_number(csv, series->x[k]);
        csv_number(csv, series->y[k]);
        csv_rounded(csv, (series->high[k] - series->low[k]) / 2);   // a difference: digits are lost
        csv_number(csv, plot->computed[k]);
        csv_end_row(csv);
    }
    return text_writer_finish(csv, err);
}

// --- the page -----------------------------------------------------------------------------------

static const double RIGHT_MARGIN = 6, POWER_MARGIN = 9;   // points: half a number may stand there
static const double LEGEND_MARGIN = 6;   // points beside the legend
static const double FRAME_LEAST = 10;   // points: height above the legend
static const double INSET_SHARE = 0.75;   // marks and lines of an inset over the main ones

// The frame above `bottom`, with room for what stands beside it.
static Axes frame_axes(const Page *page, const Plot *plot, const MapScale *scale, double bottom)
{
    double right = plot->main.x.is_log ? POWER_MARGIN : RIGHT_MARGIN;
    Axes axes = {.x = plot->main.x, .y = plot->main.y};
    Box room = page->room;
    room.bottom = bottom;
    if (plot->main.has_map) right = BAR_GAP + colorbar_width(page, &scale->bar);
    axes_fit(page, &room, right, &axes);
    return axes;
}

// Turns parts of the frame into pixels.
static Box inset_place(const Plot *plot, const Box *frame)
{
    double width = frame->right - frame->left, height = frame->bottom - frame->top;
    return (Box){.left = frame->left + plot->place[0] * width,
                 .top = frame->top + plot->place[1] * height,
                 .right = frame->left + plot->place[2] * width,
                 .bottom = frame->top + plot->place[3] * height};
}

// A plot of one frame. axes: from frame_axes.
static bool frame_draw(const Page *page, const Plot *plot, const MapScale *scale, const Axes *axes,
                       Error *err)
{
    if (axes->box.bottom - axes->box.top < FRAME_LEAST * page->point)
        return REFUSE(err,
                      "the page is too low for its legend: give it another height, or no legend");
    if (!panel_draw(page, &plot->main, NULL, scale, 1, axes, err)) return false;
    if (plot->main.has_map) colorbar_draw(page, &scale->bar, &axes->box, BAR_GAP);
    if (!plot->has_inset) return true;

    // The inset covers what lies below it: its place is cleared to paper first. Its frame is what
    // is left of that when its numbers and names have their room.
    Box place = inset_place(plot, &axes->box);
    Axes inset = {.box = place, .x = plot->inset.x, .y = plot->inset.y, .small = true};
    inset.box.left = round(place.left + axes_left_margin(page, &inset) * page->point);
    inset.box.bottom = round(place.bottom - axes_bottom_margin(&inset) * page->point);
    inset.box.right = round(place.right);
    inset.box.top = round(place.top);
    draw_fill(page->canvas, PAPER, &place);
    return panel_draw(page, &plot->inset, NULL, scale, INSET_SHARE, &inset, err);
}

// Puts the ends of the colours where the style asks for them.
static bool limit_colors(Plot *plot, const PictureStyle *style, Error *err)
{
    double *sorted = NULL, *end[2] = {&plot->color.low, &plot->color.high};
    int64_t count = 0, all = plot->main.map.count;
    if (!style->limits) return true;
    for (int32_t k = 0; k < plot->panel_count; k++) all += plot->panels[k].map.count;
    TRY(sorted = NEW_ARRAY(double, all, err));
    for (int32_t k = -1; k < plot->panel_count; k++) {
        const PlotMap *map = k < 0 ? &plot->main.map : &plot->panels[k].map;
        for (int32_t i = 0; i < map->count; i++)
            if (isfinite(map->value[i])) sorted[count++] = map->value[i];
    }
    qsort(sorted, (size_t)count, sizeof *sorted, order_doubles);
    for (int32_t k = 0; k < 2 && count > 0; k++) {
        bool is_part = false;
        double limit = picture_limit(style, k, &is_part);
        *end[k] = is_part ? sorted[llround(limit * (double)(count - 1))]
                          : limit / plot->color.factor;
    }
cleanup:
    memory_free(sorted);
    return error_is_clean(err);
}

bool plot_draw(Page *page, Plot *plot, const PictureStyle *style, const char *title, Error *err)
{
    // The style, and the size of the page.
    PictureStyle used = *style;
    picture_style_complete(&used, &plot->style);
    PageDef def = {.style = &used, .title = page_title(&used, title, true)};
    def.height = page_shape(&used, plot->height_over_width);
    if (plot->panel_count > 0) {
        int32_t columns = column_count(plot->panel_count);
        int32_t rows = (plot->panel_count + columns - 1) / columns;
        def.height = rows * plot->height_over_width * (1 - BESIDE) / columns + ABOVE;
        if (!(used.width > 0) && !used.style) used.width = WIDTH_OF[columns - 1];
    }
    if (used.legend) plot->no_legend = strcmp(used.legend, "none") == 0;
    if (!limit_colors(plot, &used, err)) return false;
    if (used.compare && !compare_draw(plot, used.compare, err)) return false;
    if (!page_begin(page, &def, err)) return false;

    // The frames, above the legend.
    double margin = LEGEND_MARGIN * page->point, bottom = page->room.bottom;
    MapScale scale = map_scale_fit(plot);
    Box below = {margin, bottom, canvas_width(page->canvas) - margin, bottom};
    if (!plot->no_legend) below.top -= round(legend_height(page, &plot->main, &below));
    Axes axes = frame_axes(page, plot, &scale, below.top);
    bool drawn = plot->panel_count > 0 ? panels_draw(page, plot, &below, err)
                                       : frame_draw(page, plot, &scale, &axes, err);
    if (drawn && !plot->no_legend) legend_draw(page, &plot->main, &below);
    return drawn;
}

// The module's second entry: one plot from its description to its file.
__attribute__((visibility("default"))) bool
amontons_render_plot(const char *path, const char *picture, const PictureStyle *style, Error *err)
{
    PictureStyle used = style ? *style : (PictureStyle){0};
    Page page = {0};
    Plot *plot = NEW_ARRAY(Plot, 1, err);
    TRY(plot);
    TRY(page_style_of_name(picture, &used, err));
    static const char *const name[] = {"plot"};
    TRY(picture_options_fit(&used, NULL, name, 1, err));
    TRY(plot_file_read(path, plot, err));
    if (!picture_options_fit(&plot->style, NULL, name, 1, err))
        error_context(err, "%s: page", path);
    TRY(error_is_clean(err));
    TRY(plot_draw(&page, plot, &used, plot->title, err));
    TRY(page_finish(&page, picture, plot->title, err));
    TRY(compare_write(plot, picture, err));
cleanup:
    page_destroy(&page);
    if (plot) plot_destroy(plot);
    memory_free(plot);
    return error_is_clean(err);
}
