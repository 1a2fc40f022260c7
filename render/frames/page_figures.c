// SPDX-License-Identifier: GPL-2.0-or-later
// Figures inside of a page: pictures in light and in dark, of which the browser shows the one that
// suits; and force curves over each other.
#include "render/render.h"

#include "base/memory.h"
#include "render/canvas/svg_chart.h"
#include "render/figures/picture.h"
#include "render/plot/plot_draw.h"
#include "render/plot/plot_file.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Size of the pictures; a page shows them as wide as its column.
static const double WIDTH = 140, DPI = 240;   // mm; of maps

// Units of the drawing of several curves.
enum { CURVES_WIDTH = 760, CURVES_HEIGHT = 400, CURVES_LEFT = 70, CURVES_RIGHT = 740 };
enum { CURVES_TOP = 24, CURVES_BOTTOM = 350 };

static const double HEADROOM = 1.05;

// --- pictures ------------------------------------------------------------------------------------

// Drawing on a fresh page, and the words with it; they are ours, and caption is markup.
typedef struct Drawing {
    bool (*draw)(void *context, const PictureStyle *style, Page *page, Error *err);
    void *context;
    const char *format, *alt, *caption;
} Drawing;

// Both are drawn before anything is written: a failure leaves no half markup.
static bool write_figure(TextWriter *html, const Drawing *drawing, Error *err)
{
    Page pages[2] = {0};
    PictureBytes pictures[2];
    const char *type = strcmp(drawing->format, "svg") == 0 ? "image/svg+xml" : "image/png";
    for (int32_t dark = 0; dark < 2; ++dark) {
        const PictureStyle style = {
            .format = drawing->format, .width = WIDTH, .dpi = DPI, .dark = dark};
        TRY(drawing->draw(drawing->context, &style, &pages[dark], err) &&
            canvas_finish(pages[dark].canvas, "", true, &pictures[dark], err));
    }
    html_markup(html, "<figure><picture><source media='screen and (prefers-color-scheme: dark)' "
                      "srcset='");
    html_data(html, type, pictures[1].bytes, pictures[1].size);
    html_markup(html, "'><img src='");
    html_data(html, type, pictures[0].bytes, pictures[0].size);
    html_markup(html, "' alt='%s'></picture><figcaption>%s</figcaption></figure>\n", drawing->alt,
                drawing->caption);
cleanup:
    for (int32_t dark = 0; dark < 2; ++dark) page_destroy(&pages[dark]);
    return error_is_clean(err);
}

typedef struct HistoryFigure {
    ResultView *view;
    const Figure *figure;
} HistoryFigure;

static bool draw_history(void *context, const PictureStyle *style, Page *page, Error *err)
{
    const HistoryFigure *asked = context;
    const Picture picture = {asked->figure, .count = 1, .panels = {{.figure = asked->figure}}};
    const PictureRequest request = {.style = *style};
    return picture_draw(&picture, "", &request, asked->view, page, err);
}

// Title and warnings stand on the page already.
__attribute__((visibility("default"))) bool
amontons_render_figures(const char *folder, const char *cycle, TextWriter *html, Error *err)
{
    ResultView view = {0};
    TRY(result_view_open(folder, &view, err));
    if (cycle) TRY(zoom_choose_cycle(&view, cycle, err));
    view.title[0] = view.warnings[0] = '\0';
    for (int32_t k = 0; k < FIGURE_COUNT; ++k) {
        const Figure *figure = figure_get((FigureId)k);
        const FigureKind *kind = figure->kind;
        if (!kind->page_format || !figure_is_there(figure, &view)) continue;
        HistoryFigure asked = {&view, figure};
        const Drawing drawing = {draw_history, &asked, kind->page_format, kind->page_words,
                                 kind->page_caption};
        TRY(write_figure(html, &drawing, err));
    }
cleanup:
    result_view_close(&view);
    return error_is_clean(err);
}

static bool draw_plot(void *context, const PictureStyle *style, Page *page, Error *err)
{
    return plot_draw(page, context, style, NULL, err);
}

__attribute__((visibility("default"))) bool amontons_render_plot_html(const char *folder,
                                                                      const char *name,
                                                                      const char *caption,
                                                                      TextWriter *html, Error *err)
{
    Plot *plot = NEW_ARRAY(Plot, 1, err);
    TRY(plot);
    TRY(plot_file_read_inside(folder, name, plot, err));
    const Drawing drawing = {draw_plot, plot, "svg", caption, caption};
    TRY(write_figure(html, &drawing, err));
    if (plot->left_out) {
        html_markup(html, "<p class='note'>Without the measurements ");
        html_text(html, plot->left_out);
        html_markup(html, ", which lie outside of the result, where a page reads nothing; "
                          "<code>amontons render</code> draws them.</p>\n");
    }
cleanup:
    if (plot) plot_destroy(plot);
    memory_free(plot);
    return error_is_clean(err);
}

// --- several force curves ------------------------------------------------------------------------

typedef struct Curves {
    ResultView views[RENDER_CURVES_MAX];   // [count] owned
    const char *names[RENDER_CURVES_MAX];   // [count]
    int32_t count;
} Curves;

__attribute__((visibility("default"))) bool amontons_render_curves(const char *const *folders,
                                                                   const char *const *names,
                                                                   int32_t count, TextWriter *html,
                                                                   bool *drawn, Error *err)
{
    Curves curves = {0};
    const ResultView *views = curves.views;
    *drawn = true;

    // A history that cannot be drawn is left out, and the page says why.
    for (int32_t k = 0; k < count; ++k) {
        if (result_view_open(folders[k], &curves.views[curves.count], err)) {
            curves.names[curves.count++] = names[k];
            continue;
        }
        TRY(err->code != ERROR_MEMORY && err->code != ERROR_LIBRARY);
        html_markup(html, "<p class='note'>");
        html_text(html, names[k]);
        html_markup(html, " has no curve here: ");
        html_text(html, err->message);
        html_markup(html, "</p>\n");
        error_clear(err);
    }
    for (int32_t k = 1; k < curves.count; ++k) *drawn = *drawn && views[k].si == views[0].si;
    if (!*drawn || curves.count == 0) goto cleanup;
    Axes axes = figure_force_axes(
        views, curves.count, (Box){CURVES_LEFT, CURVES_TOP, CURVES_RIGHT, CURVES_BOTTOM}, HEADROOM);
    html_markup(html,
                "<figure id='figure-force'><svg class='chart' viewBox='0 0 %d %d' role='img' "
                "aria-label='Friction force over load against the displacement of the rod, a "
                "curve for each run'>",
                CURVES_WIDTH, CURVES_HEIGHT);
    svg_axes(html, &axes, true);
    for (int32_t k = 0; k < curves.count; ++k) {
        char class[16];
        snprintf(class, sizeof class, "curve%d", k + 1);
        svg_curve(html, &axes, class, views[k].U, views[k].mu, views[k].rows);
    }
    html_markup(html, "</svg>");
    html_markup(html, "<ul class='legend'>");
    for (int32_t k = 0; k < curves.count; ++k) {
        html_markup(html,
                    "<li><svg width='34' height='12' aria-hidden='true'><path class='curve%d' "
                    "d='M2 6h30'/></svg> ",
                    k + 1);
        html_text(html, curves.names[k]);
        html_markup(html, "</li>");
    }
    html_markup(html, "</ul>");
    html_markup(html,
                "<figcaption><i>F</i><sub>T</sub>/<i>F</i><sub>N</sub> against the rod\u2019s "
                "displacement <i>U</i></figcaption></figure>\n");
cleanup:
    for (int32_t k = 0; k < curves.count; ++k) result_view_close(&curves.views[k]);
    return error_is_clean(err);
}
