// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/page.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double WIDTH_DEFAULT = 86;   // mm: a journal's column
static const double DPI_DEFAULT = 508;   // 20 pixels a millimetre
static const double INCH = 25.4;   // mm
static const double POINTS_AN_INCH = 72;
static const double TITLE_HEIGHT = 14;   // points kept above the figure
static const double TITLE_DROP = 4;   // points: figure to the title's baseline
static const double TITLE_LEFT = 4;   // points: beside it
static const double TITLE_LEAST = 0.75;   // of its size, where it is long

enum { TITLE_MAX = 200 };   // bytes

static bool find_format(const char *name, CanvasFormat *format)
{
    for (int32_t k = 0; k < CANVAS_FORMATS; ++k) {
        *format = (CanvasFormat)k;
        if (strcmp(canvas_ending(*format), name) == 0) return true;
    }
    return false;
}

bool page_style_of_name(const char *path, PictureStyle *style, Error *err)
{
    const char *dot = strrchr(path, '.');
    CanvasFormat format = CANVAS_PNG;
    if (!dot || !find_format(dot + 1, &format))
        FAIL(err, ERROR_INPUT, "%s: the name of a picture ends in .png, .pdf or .svg", path);
    style->format = canvas_ending(format);
cleanup:
    return error_is_clean(err);
}

static double width_in_mm(const PictureStyle *style)
{
    return style->width > 0 ? style->width : WIDTH_DEFAULT;
}

double page_width(const PictureStyle *style)
{
    return width_in_mm(style) / INCH * POINTS_AN_INCH;
}

// A long one gets smaller, and ends in dots where that is not enough.
static void title_draw(const Page *page, const char *title)
{
    char words[TITLE_MAX + 4];
    double room = canvas_width(page->canvas) - 2 * TITLE_LEFT * page->point;
    TextStyle style = {.size = LABEL_SIZE * page->point, .color = INK};
    size_t length = strlen(title);
    snprintf(words, sizeof words, "%.*s", TITLE_MAX, title);
    style.size *= fmin(1, fmax(TITLE_LEAST, room / text_width(page->text, style.size, words)));
    if (length > TITLE_MAX) length = TITLE_MAX;
    while (length > 1 && text_width(page->text, style.size, words) > room)
        snprintf(words + --length, 4, "\u2026");   // bytes of a letter cut in two become a mark
    text_draw(page->text, &style,
              (Point){TITLE_LEFT * page->point, page->head - TITLE_DROP * page->point}, words);
}

bool page_begin(Page *page, const PageDef *page_def, Error *err)
{
    const PictureStyle *style = page_def->style;
    const char *title = page_def->title;
    CanvasDef def = {.dpi = style->dpi > 0 ? style->dpi : DPI_DEFAULT, .dark = style->dark};
    double width = width_in_mm(style) / INCH * def.dpi;
    *page = (Page){.point = def.dpi / POINTS_AN_INCH, .overwrite = style->overwrite};
    page->foot = round(page_def->foot * page->point);
    page->head = title && title[0] ? round(TITLE_HEIGHT * page->point) : 0;
    if (style->format && !find_format(style->format, &def.format))
        FAIL(err, ERROR_INPUT, "there is no format \"%s\"; known are png, pdf, svg", style->format);
    def.width = (int32_t)lround(fmin(width, INT32_MAX));
    def.height = (int32_t)(lround(fmin(width * page_def->height, INT32_MAX / 2)) +
                           lround(page->head + page->foot));
    TRY(page->canvas = canvas_create(&def, err));
    TRY(page->text = text_create(page->canvas, err));
    if (title && title[0]) title_draw(page, title);
cleanup:
    return error_is_clean(err);
}

bool page_finish(Page *page, const char *path, const char *title, Error *err)
{
    return canvas_write(page->canvas, path, title, page->overwrite, err);
}

void page_destroy(Page *page)
{
    text_destroy(page->text);
    canvas_destroy(page->canvas);
    *page = (Page){0};
}
