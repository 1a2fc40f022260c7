// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/svg_chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TICKS_X = 7, TICKS_Y_MAX = 6, WORDS_SIZE = 256, DEPTH_MAX = 8 };

static const double TICK = 4, NUMBER_DROP = 17, LABEL_DROP = 36, LABEL_LEFT = 46;   // units
static const double NUMBER_PITCH = 22;   // units of height that a number beside y takes
static const double SHIFT = 4;   // units: of what stands below or above the line
static const double NEAR = 0.4;   // units: a point this near to the last one drawn is left out
static const double OVER = 3;   // units: how far a curve may leave the frame

// --- words ---------------------------------------------------------------------------------------

typedef struct Mark {
    const char *begin, *end;   // markup around what stands in ~{}, _{}, ^{}
} Mark;

// A bracket without its mark, or more of them than DEPTH_MAX in each other, is text.
static void write_words(TextWriter *html, const char *words, bool svg)
{
    const char *ends[DEPTH_MAX];
    int32_t depth = 0;
    for (const char *at = words; *at;) {
        if (strchr("~_^", *at) && at[1] == '{' && depth < DEPTH_MAX) {
            static const Mark marks[3][2] = {
                {{"<i>", "</i>"}, {"<tspan font-style='italic'>", "</tspan>"}},
                {{"<sub>", "</sub>"},
                 {"<tspan dy='4' font-size='75%'>", "</tspan><tspan dy='-4'>\u200b</tspan>"}},
                {{"<sup>", "</sup>"},
                 {"<tspan dy='-4' font-size='75%'>", "</tspan><tspan dy='4'>\u200b</tspan>"}},
            };
            Mark mark = marks[*at == '~' ? 0 : *at == '_' ? 1 : 2][svg];
            html_raw(html, mark.begin);
            ends[depth++] = mark.end;
            at += 2;
        } else if (*at == '}' && depth > 0) {
            html_raw(html, ends[--depth]);
            ++at;
        } else {
            char run[WORDS_SIZE];
            bool minus = *at == '-' && depth > 0;   // of a power
            size_t length = minus ? 1 : 1 + strcspn(at + 1, "~_^}-");
            snprintf(run, sizeof run, "%.*s", (int)length, at);
            html_text(html, minus ? "\u2212" : run);
            at += length;
        }
    }
    while (depth > 0) html_raw(html, ends[--depth]);
}

void html_words(TextWriter *html, const char *words)
{
    write_words(html, words, false);
}

// The same as tspans inside of an SVG text.
static void svg_words(TextWriter *html, const char *words)
{
    write_words(html, words, true);
}

// --- axes ----------------------------------------------------------------------------------------

static void write_text(TextWriter *html, const char *attributes, double x, double y,
                       const char *words)
{
    html_markup(html, "<text %s x='%.1f' y='%.1f'>", attributes, x, y);
    svg_words(html, words);
    html_markup(html, "</text>");
}

// The power of ten that all numbers are to be multiplied by.
static void write_exponent(TextWriter *html, const Ticks *ticks, double x, double y)
{
    char words[TICK_LABEL_SIZE];
    ticks_power(ticks, words);
    if (words[0]) write_text(html, "class='number'", x, y, words);
}

void svg_axes(TextWriter *html, const Axes *axes, bool with_x)
{
    char label[TICK_LABEL_SIZE], turned[120];
    const Box *box = &axes->box;
    html_markup(html, "<rect class='axis' x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>",
                box->left, box->top, box->right - box->left, box->bottom - box->top);

    // Below the frame.
    Ticks ticks = axis_ticks(&axes->x, TICKS_X);
    for (int32_t k = 0; k < ticks.count; ++k) {
        double x = axes_place(axes, tick_value(&ticks, k) / axes->x.factor, axes->y.low).x;
        html_markup(html, "<path class='axis' d='M%.1f %.1fv%g'/>", x, box->bottom, TICK);
        if (!with_x) continue;
        tick_label(&ticks, k, label);
        write_text(html, "class='number' text-anchor='middle'", x, box->bottom + NUMBER_DROP,
                   label);
    }
    if (with_x) {
        write_text(html, "class='label' text-anchor='middle'", (box->left + box->right) / 2,
                   box->bottom + LABEL_DROP, axes->x.label);
        write_exponent(html, &ticks, box->right - 30, box->bottom + LABEL_DROP);
    }

    // Left of it.
    int32_t wanted = (int32_t)((box->bottom - box->top) / NUMBER_PITCH);
    wanted = wanted < 2 ? 2 : wanted < TICKS_Y_MAX ? wanted : TICKS_Y_MAX;
    ticks = axis_ticks(&axes->y, wanted);
    for (int32_t k = 0; k < ticks.count; ++k) {
        double y = axes_place(axes, axes->x.low, tick_value(&ticks, k) / axes->y.factor).y;
        html_markup(html, "<path class='axis' d='M%.1f %.1fh%g'/>", box->left, y, -TICK);
        tick_label(&ticks, k, label);
        write_text(html, "class='number' text-anchor='end'", box->left - TICK - 3, y + SHIFT,
                   label);
    }
    double x = box->left - LABEL_LEFT, y = (box->top + box->bottom) / 2;
    snprintf(turned, sizeof turned,
             "class='label' text-anchor='middle' transform='rotate(-90 %.1f %.1f)'", x, y);
    write_text(html, turned, x, y, axes->y.label);
    write_exponent(html, &ticks, box->left, box->top - 4);
}

// --- curves --------------------------------------------------------------------------------------

void svg_curve(TextWriter *html, const Axes *axes, const char *class, const double *x,
               const double *y, int64_t count)
{
    const Box *box = &axes->box;
    Point last = {0};
    bool drawing = false;
    html_markup(html, "<path class='%s' d='", class);
    for (int64_t k = 0; k < count; ++k) {
        Point place = axes_place(axes, x[k], y[k]);
        bool seen = isfinite(place.x + place.y) && place.x >= box->left - NEAR &&
                    place.x <= box->right + NEAR;
        place.y = fmin(fmax(place.y, box->top - OVER), box->bottom + OVER);
        if (seen && drawing && fabs(place.x - last.x) < NEAR && fabs(place.y - last.y) < NEAR)
            continue;
        if (seen) html_markup(html, "%c%.1f %.1f", drawing ? 'L' : 'M', place.x, place.y);
        drawing = seen;
        last = place;
    }
    html_markup(html, "'/>");
}

void svg_level(TextWriter *html, const Axes *axes, double y, const char *name)
{
    double at = axes_place(axes, axes->x.low, y).y;
    const Box *box = &axes->box;
    if (!(at >= box->top && at <= box->bottom)) return;
    html_markup(html, "<path class='level' d='M%.1f %.1fH%.1f'/>", box->left, at, box->right);
    write_text(html, "class='number'", box->right + 4, at + SHIFT, name);
}
