// SPDX-License-Identifier: GPL-2.0-or-later
// Draws the validation report's page of charts with amontons' own renderer, COLUMNS to a row.
//
//   amontons_chart OUT.png < description
//
// What is there under that name goes: a report is made anew as a whole.
//
// The description holds, for each chart: title, label of x, label of y (a line each), a line with 1
// or 0 (logarithmic or not) and the number of curves, and for each curve a line with its number of
// points and its name, then a line "x y" for each point.
#include "base/memory.h"
#include "render/canvas/axes.h"
#include "render/canvas/key.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LINE_SIZE = 200, CURVES_MAX = 8, CHARTS_MAX = 60 };
enum { COLUMNS = 3, WIDTH = 1000, HEIGHT = 700 };   // WIDTH, HEIGHT: of one chart, pixels
enum { MARKED_MAX = 20 };   // curves of so few points show each of them

static const double COLUMN_MM = 86;   // of one chart in print
static const double DISC_RADIUS = 1.6;   // points

typedef struct Curve {
    char name[LINE_SIZE];
    int64_t count;
    double *x, *y;   // [count]; above 0 where the chart is logarithmic; owned
} Curve;

typedef struct Chart {
    char title[LINE_SIZE], x_label[LINE_SIZE], y_label[LINE_SIZE];
    bool logarithmic;
    int32_t curve_count;
    Curve curves[CURVES_MAX];
} Chart;

static const Color COLORS[CURVES_MAX] = {{0.05f, 0.27f, 0.55f, 1}, {0.80f, 0.30f, 0.05f, 1},
                                         {0.10f, 0.50f, 0.25f, 1}, {0.55f, 0.15f, 0.45f, 1},
                                         {0.45f, 0.40f, 0.05f, 1}, {0.05f, 0.50f, 0.55f, 1},
                                         {0.40f, 0.40f, 0.42f, 1}, {0.70f, 0.10f, 0.15f, 1}};

static bool read_line(char line[LINE_SIZE])
{
    if (!fgets(line, LINE_SIZE, stdin)) return false;
    line[strcspn(line, "\n")] = 0;
    return true;
}

// The next curve of the description into *chart. ERROR_INPUT: it is not as said above.
static bool read_curve(Chart *chart, Error *err)
{
    Curve *curve = &chart->curves[chart->curve_count++];
    long long count = 0;
    char line[LINE_SIZE];
    if (scanf("%lld ", &count) != 1 || count < 1 || !read_line(curve->name))
        FAIL(err, ERROR_INPUT, "a curve begins with its number of points and its name");
    curve->count = count;
    curve->x = NEW_ARRAY(double, count, err);
    curve->y = NEW_ARRAY(double, count, err);
    if (!curve->x || !curve->y) goto cleanup;
    for (int64_t i = 0; i < count; i++) {
        if (!read_line(line) || sscanf(line, "%lf %lf", &curve->x[i], &curve->y[i]) != 2)
            FAIL(err, ERROR_INPUT, "curve %s: wanted is \"x y\"", curve->name);
    }
cleanup:
    return error_is_clean(err);
}

// title: its first line, which is read already.
static bool read_chart(const char *title, Chart *chart, Error *err)
{
    int logarithmic = 0, curves = 0;
    memcpy(chart->title, title, LINE_SIZE);
    if (!read_line(chart->x_label) || !read_line(chart->y_label) ||
        scanf("%d %d ", &logarithmic, &curves) != 2)
        FAIL(err, ERROR_INPUT, "chart %s: wanted are labels, 1 or 0, and a number of curves",
             title);
    chart->logarithmic = logarithmic != 0;
    if (curves < 1 || curves > CURVES_MAX)
        FAIL(err, ERROR_INPUT, "chart %s: %d curves, allowed are 1 to %d", title, curves,
             CURVES_MAX);
    while (chart->curve_count < curves) TRY(read_curve(chart, err));
cleanup:
    return error_is_clean(err);
}

// charts: [CHARTS_MAX], *count of them filled.
static bool read_charts(Chart *charts, int32_t *count, Error *err)
{
    char title[LINE_SIZE];
    while (read_line(title)) {
        if (*count == CHARTS_MAX) FAIL(err, ERROR_INPUT, "more than %d charts", CHARTS_MAX);
        TRY(read_chart(title, &charts[(*count)++], err));
    }
    if (*count == 0) FAIL(err, ERROR_INPUT, "no chart is described");
cleanup:
    return error_is_clean(err);
}

// The range of all curves, with a twentieth to spare on either side.
static void fit_axis(const Chart *chart, bool of_x, Axis *axis)
{
    bool is_log = chart->logarithmic;
    double low = INFINITY, high = -INFINITY;
    for (int32_t c = 0; c < chart->curve_count; c++) {
        const Curve *curve = &chart->curves[c];
        for (int64_t i = 0; i < curve->count; i++) {
            double value = of_x ? curve->x[i] : curve->y[i];
            if (!isfinite(value) || (is_log && !(value > 0))) continue;
            low = fmin(low, is_log ? log10(value) : value);
            high = fmax(high, is_log ? log10(value) : value);
        }
    }
    double spare = high > low ? 0.05 * (high - low) : 0.5;
    *axis = (Axis){.low = is_log ? pow(10, low - spare) : low - spare,
                   .high = is_log ? pow(10, high + spare) : high + spare,
                   .factor = 1,
                   .is_log = is_log};
    snprintf(axis->label, sizeof axis->label, "%.90s", of_x ? chart->x_label : chart->y_label);
}

// A line through the curve's points, and a disc at each where they are few.
static bool draw_curve(const Page *page, const Axes *axes, const Curve *curve, Color color,
                       Error *err)
{
    Stroke stroke = {.color = color, .width = CURVE_WIDTH * page->point};
    Point *points = NEW_ARRAY(Point, curve->count, err);
    if (!points) return false;
    for (int64_t i = 0; i < curve->count; i++)
        points[i] = axes_place(axes, curve->x[i], curve->y[i]);
    draw_line(page->canvas, &stroke, points, curve->count);
    for (int64_t i = 0; curve->count <= MARKED_MAX && i < curve->count; i++)
        draw_disc(page->canvas, color, points[i], DISC_RADIUS * page->point);
    memory_free(points);
    return true;
}

// corner: the upper left one of the chart's place on the page, pixels.
static bool draw_chart(const Page *page, Point corner, const Chart *chart, Error *err)
{
    Page own = *page;
    KeyEntry names[CURVES_MAX];
    double point = page->point;
    TextStyle title = {.size = LABEL_SIZE * point, .color = INK};
    Axes axes = {.bare_x = false};
    fit_axis(chart, true, &axes.x);
    fit_axis(chart, false, &axes.y);

    // The curves' names stand below.
    own.room = (Box){corner.x + 4 * point, corner.y + 22 * point, corner.x + WIDTH,
                     corner.y + HEIGHT - 4 * point};
    for (int32_t c = 0; c < chart->curve_count; c++)
        names[c] = (KeyEntry){KEY_LINE, COLORS[c], chart->curves[c].name};
    key_draw(&own, names, chart->curve_count);
    axes_fit(&own, &own.room, 8, &axes);

    text_draw(page->text, &title, (Point){axes.box.left, corner.y + 12 * point}, chart->title);
    for (int32_t c = 0; c < chart->curve_count; c++)
        TRY(draw_curve(page, &axes, &chart->curves[c], COLORS[c], err));
    axes_draw(page, &axes);
cleanup:
    return error_is_clean(err);
}

static void charts_destroy(Chart *charts, int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        for (int32_t c = 0; c < charts[k].curve_count; c++) {
            memory_free(charts[k].curves[c].x);
            memory_free(charts[k].curves[c].y);
        }
    }
    memory_free(charts);
}

static bool make_page(const char *path, Error *err)
{
    int32_t count = 0;
    Page page = {0};
    Chart *charts = NEW_ARRAY(Chart, CHARTS_MAX, err);
    if (!charts) goto cleanup;
    TRY(read_charts(charts, &count, err));
    int32_t columns = count < COLUMNS ? count : COLUMNS, rows = (count - 1) / COLUMNS + 1;
    PictureStyle style = {
        .width = columns * COLUMN_MM, .dpi = WIDTH / COLUMN_MM * 25.4, .overwrite = true};
    PageDef def = {.style = &style, .height = (double)(rows * HEIGHT) / (columns * WIDTH)};
    TRY(page_begin(&page, &def, err));
    for (int32_t k = 0; k < count; k++) {
        Point corner = {k % COLUMNS * WIDTH, k / COLUMNS * HEIGHT};
        TRY(draw_chart(&page, corner, &charts[k], err));
    }
    TRY(page_finish(&page, path, "Validation of amontons", err));
cleanup:
    page_destroy(&page);
    charts_destroy(charts, count);
    return error_is_clean(err);
}

int main(int argc, char **argv)
{
    Error err = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: amontons_chart OUT.png < description\n");
        return 2;
    }
    if (make_page(argv[1], &err)) return 0;
    fprintf(stderr, "amontons_chart: error: %s\n", err.message);
    return amontons_error_exit_status(err.code);
}
