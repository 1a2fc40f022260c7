// SPDX-License-Identifier: GPL-2.0-or-later
// Draws one chart of the validation report with amontons' own renderer.
//
//   amontons_chart OUT.png < description
//
// The description: title, label of x, label of y (a line each), 1 or 0 (logarithmic or not), then for
// each curve a line with its number of points and its name, and a line "x y" for each point.
#include "base/memory.h"
#include "render/axes.h"
#include "render/context.h"
#include "render/png_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LINE_SIZE = 200, CURVES_MAX = 8, WIDTH = 1600, HEIGHT = 1100, MARKED_MAX = 20 };

typedef struct Curve {
    char name[LINE_SIZE];
    int64_t count;
    double *x, *y;   // [count]; owned
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
        if (!chart->logarithmic) continue;
        curve->x[i] = log10(curve->x[i]);
        curve->y[i] = log10(curve->y[i]);
    }
cleanup:
    return error_is_clean(err);
}

static bool read_chart(Chart *chart, Error *err)
{
    int logarithmic = 0;
    if (!read_line(chart->title) || !read_line(chart->x_label) || !read_line(chart->y_label) ||
        scanf("%d ", &logarithmic) != 1)
        FAIL(err, ERROR_INPUT, "a chart begins with title, labels, and 1 or 0");
    chart->logarithmic = logarithmic != 0;
    for (int next = getchar(); next != EOF; next = getchar()) {
        ungetc(next, stdin);
        if (chart->curve_count == CURVES_MAX) FAIL(err, ERROR_INPUT, "more than 8 curves");
        TRY(read_curve(chart, err));
    }
cleanup:
    return error_is_clean(err);
}

// The range of all curves, with a twentieth to spare.
static void fit_axis(const Chart *chart, bool of_x, Axis *axis)
{
    axis->low = INFINITY;
    axis->high = -INFINITY;
    for (int32_t c = 0; c < chart->curve_count; c++) {
        const Curve *curve = &chart->curves[c];
        for (int64_t i = 0; i < curve->count; i++) {
            double value = of_x ? curve->x[i] : curve->y[i];
            if (!isfinite(value)) continue;
            axis->low = fmin(axis->low, value);
            axis->high = fmax(axis->high, value);
        }
    }
    double spare = 0.05 * (axis->high > axis->low ? axis->high - axis->low : 1);
    axis->low -= spare;
    axis->high += spare;
    axis->factor = 1;
    const char *label = of_x ? chart->x_label : chart->y_label;
    snprintf(axis->label, sizeof axis->label, chart->logarithmic ? "log_{10} %.70s" : "%.90s",
             label);
}

static bool draw_curve(const Page *page, const Axes *axes, const Curve *curve, Color color,
                       Error *err)
{
    Stroke stroke = {.color = color, .width = CURVE_WIDTH * page->point};
    Point *points = NEW_ARRAY(Point, curve->count, err);
    if (!points) return false;
    for (int64_t i = 0; i < curve->count; i++)
        points[i] = axes_place(axes, curve->x[i], curve->y[i]);
    shape_line(page->canvas, &stroke, points, curve->count);
    for (int64_t i = 0; curve->count <= MARKED_MAX && i < curve->count; i++)
        shape_disc(page->canvas, color, points[i], 1.6 * page->point);
    memory_free(points);
    return true;
}

static bool draw_chart(const Page *page, const Chart *chart, Error *err)
{
    double point = page->point;
    Axes axes = {.number_size = NUMBER_SIZE, .color = INK};
    fit_axis(chart, true, &axes.x);
    fit_axis(chart, false, &axes.y);
    axes.box = (Box){.left = round((axes_left_margin(page, &axes) + 4) * point),
                     .top = round(22 * point),
                     .right = round(WIDTH - 8 * point),
                     .bottom = round(HEIGHT - (axes_bottom_margin(&axes) + 4) * point)};
    TextStyle title = {.size = LABEL_SIZE * point, .color = INK};
    text_draw(page->text, &title, (Point){axes.box.left, 12 * point}, chart->title);
    for (int32_t c = 0; c < chart->curve_count; c++) {
        TRY(draw_curve(page, &axes, &chart->curves[c], COLORS[c], err));
        TextStyle name = {.size = NUMBER_SIZE * point, .color = COLORS[c], .across = 1, .up = 0.5};
        Point place = {axes.box.right - 4 * point, axes.box.bottom - (6 + 9 * c) * point};
        text_draw(page->text, &name, place, chart->curves[c].name);
    }
    axes_draw(page, &axes);
cleanup:
    return error_is_clean(err);
}

static bool make_chart(const char *path, Chart *chart, Error *err)
{
    RenderContext *context = NULL;
    Page page = {.point = WIDTH / COLUMN_WIDTH_POINTS};
    uint8_t *pixels = NULL;
    TRY(read_chart(chart, err));
    context = context_create(err);
    TRY(context);
    page.canvas = canvas_create(WIDTH, HEIGHT, err);
    TRY(page.canvas);
    page.text = text_create(page.canvas, err);
    TRY(page.text);
    TRY(draw_chart(&page, chart, err));
    TRY(canvas_read(page.canvas, &pixels, err));
    PngPicture picture = {.width = WIDTH,
                          .height = HEIGHT,
                          .pixels = pixels,
                          .pixels_per_metre = WIDTH / (1e-3 * COLUMN_WIDTH_MM),
                          .title = chart->title};
    TRY(png_file_write(path, &picture, err));
cleanup:
    text_destroy(page.text);
    canvas_destroy(page.canvas);
    context_destroy(context);
    memory_free(pixels);
    for (int32_t c = 0; c < chart->curve_count; c++) {
        memory_free(chart->curves[c].x);
        memory_free(chart->curves[c].y);
    }
    return error_is_clean(err);
}

int main(int argc, char **argv)
{
    static Chart chart;
    Error err = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: amontons_chart OUT.png < description\n");
        return 2;
    }
    if (make_chart(argv[1], &chart, &err)) return 0;
    fprintf(stderr, "amontons_chart: error: %s\n", err.message);
    return error_exit_status(err.code);
}
