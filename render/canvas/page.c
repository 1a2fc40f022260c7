// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/page.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double FULL_WIDTH = 100;   // mm: of a figure that has its full shape
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
        return REFUSE(err, "%s: the name of a picture ends in .png, .pdf or .svg", path);
    style->format = canvas_ending(format);
    return true;
}

// Purpose of a picture: its width, how much larger letters and lines are, dots.
typedef struct Purpose {
    const char *name;
    double width, scale, dpi;   // mm, 1, dots per inch
} Purpose;

static Purpose find_purpose(const PictureStyle *style)
{
    static const Purpose purposes[] = {{"column", 86, 1, 600},   // the first: by default
                                       {"columns", 178, 1, 600},
                                       {"slide", 254, 2, 200},
                                       {"poster", 400, 3, 300}};
    Purpose found = purposes[0];
    for (size_t k = 0; style->style && k < sizeof purposes / sizeof *purposes; ++k)
        if (strcmp(purposes[k].name, style->style) == 0) found = purposes[k];
    if (style->width > 0) found.width = style->width;
    if (style->dpi > 0) found.dpi = style->dpi;
    return found;
}

double page_width(const PictureStyle *style)
{
    Purpose purpose = find_purpose(style);
    return purpose.width / purpose.scale / INCH * POINTS_AN_INCH;
}

double page_shape(const PictureStyle *style, double shape)
{
    Purpose purpose = find_purpose(style);
    return shape * fmin(1, sqrt(FULL_WIDTH / (purpose.width / purpose.scale)));
}

const char *page_title(const PictureStyle *style, const char *own, bool by_default)
{
    if (!style->title) return by_default && own ? own : "";
    if (strcmp(style->title, "none") == 0) return "";
    return strcmp(style->title, "scene") == 0 && own ? own : style->title;
}

// The height that is asked is that of all: the figure has what title and foot leave. Where nobody
// asks for dots per inch they are as many as a page so long may have.
bool page_begin(Page *page, const PageDef *page_def, Error *err)
{
    const PictureStyle *style = page_def->style;
    const char *title = page_def->title;
    Purpose purpose = find_purpose(style);
    double width = purpose.width / INCH, height = style->height / INCH;   // inches
    double above = title && title[0] ? TITLE_HEIGHT : 0, below = page_def->foot;   // points
    if (!(height > 0))
        height = width * page_def->height + purpose.scale * (above + below) / POINTS_AN_INCH;
    if (!(style->dpi > 0))
        purpose.dpi = fmin(purpose.dpi, floor(CANVAS_SIZE_MAX / fmax(fmax(width, height), 1)));

    CanvasDef def = {.dpi = purpose.dpi, .dark = style->dark};
    *page = (Page){.point = purpose.scale * def.dpi / POINTS_AN_INCH, .style = *style};
    width *= def.dpi;
    double foot = round(below * page->point);
    double head = round(above * page->point);
    height = style->height > 0 ? round(height * def.dpi)
                               : round(fmin(width * page_def->height, INT32_MAX / 2)) + head + foot;
    if (style->format && !find_format(style->format, &def.format))
        return REFUSE(err, "there is no format \"%s\"; known are png, pdf, svg", style->format);
    def.width = (int32_t)lround(fmin(width, INT32_MAX));
    def.height = (int32_t)fmin(height, INT32_MAX);
    page->room = (Box){0, head, def.width, def.height - foot};
    if (!(page->canvas = canvas_create(&def, err))) return false;
    if (!(page->text = text_create(page->canvas, err))) return false;
    if (head == 0) return true;

    // A long title gets smaller, and ends in dots where that is not enough.
    char words[TITLE_MAX + 4];
    double room = canvas_width(page->canvas) - 2 * TITLE_LEFT * page->point;
    TextStyle letters = {.size = LABEL_SIZE * page->point, .color = INK};
    size_t length = strlen(title);
    snprintf(words, sizeof words, "%.*s", TITLE_MAX, title);
    letters.size *= fmin(1, fmax(TITLE_LEAST, room / text_width(page->text, letters.size, words)));
    if (length > TITLE_MAX) length = TITLE_MAX;
    while (length > 1 && text_width(page->text, letters.size, words) > room)
        snprintf(words + --length, 4, "\u2026");   // bytes of a letter cut in two become a mark
    text_draw(page->text, &letters,
              (Point){TITLE_LEFT * page->point, page->room.top - TITLE_DROP * page->point}, words);
    return true;
}

bool page_finish(Page *page, const char *path, const char *title, Error *err)
{
    return canvas_write(page->canvas, path, title, page->style.overwrite, err);
}

// --- the foot ------------------------------------------------------------------------------------

static const double FOOT_SIZE = 7;   // points
static const double LETTER = 0.6;   // of the size: what a character takes, rather more
static const double LINE_HEIGHT = 1.25;   // of it
static const double FOOT_MARGIN = 4;   // points: below the last line and left of all
static const Color WARNING_COLOR = {0.62f, 0.20f, 0.05f, 1};
enum { CHARACTERS_LEAST = 30, CHARACTERS_MOST = FOOT_LINE_SIZE - 4 };
static const char *const REST = "... the rest stands in run.json (warnings).";

// Lines end by their number of characters, few enough for wide ones, as the height must be known
// before there is a canvas to measure text on: at a blank where there is one.
Foot foot_wrap(const char *warnings, double width)
{
    Foot foot = {0};
    double most = (width - 2 * FOOT_MARGIN) / (LETTER * FOOT_SIZE);
    size_t line = (size_t)fmin(fmax(most, CHARACTERS_LEAST), CHARACTERS_MOST);
    while (*warnings) {
        size_t length = strcspn(warnings, "\n");
        const char *next = warnings + length + (warnings[length] == '\n');

        // One warning: its first line begins with the word, the others are indented.
        const char *lead = "Warning: ";
        while (length > 0) {
            char words[FOOT_LINE_SIZE];
            if (foot.count == FOOT_LINES_MAX) {
                snprintf(foot.line[foot.count - 1], FOOT_LINE_SIZE, "%s", REST);
                break;
            }
            size_t room = line - strlen(lead), end = length;
            if (length > room)
                for (end = room; end > 0 && warnings[end] != ' ';) end--;
            if (end == 0) end = room;
            snprintf(words, sizeof words, "%.*s", (int)end, warnings);
            while (end < length && warnings[end] == ' ') end++;
            snprintf(foot.line[foot.count++], FOOT_LINE_SIZE, "%.12s%.140s", lead, words);
            warnings += end;
            length -= end;
            lead = "   ";
        }
        warnings = next;
    }
    return foot;
}

double foot_height(const Foot *foot)
{
    return foot->count > 0 ? foot->count * LINE_HEIGHT * FOOT_SIZE + FOOT_MARGIN : 0;
}

void foot_draw(const Page *page, const Foot *foot)
{
    double point = page->point;
    TextStyle style = {.size = FOOT_SIZE * point, .color = WARNING_COLOR};
    double top = page->room.bottom;
    for (int32_t k = 0; k < foot->count; ++k)
        text_draw(page->text, &style,
                  (Point){FOOT_MARGIN * point, round(top + (k + 0.8) * LINE_HEIGHT * style.size)},
                  foot->line[k]);
}

void page_destroy(Page *page)
{
    text_destroy(page->text);
    canvas_destroy(page->canvas);
    *page = (Page){0};
}
