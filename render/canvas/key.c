// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/key.h"

#include <math.h>
#include <string.h>

static const double MARGIN = 4, SPACE = 9,
                    GAP = 3;   // points: page to entry; between; to its words
static const double SAMPLE = 12;   // points: width of a line or a patch
static const double PITCH = 1.35;   // line to line, over the size of the words
static const double DROP = 2;   // points above the first line

void key_draw_back(Canvas *canvas, Color color, Point centre, double radius)
{
    Point corners[] = {{centre.x - 1.6 * radius, centre.y},
                       {centre.x + 1.1 * radius, centre.y - 1.5 * radius},
                       {centre.x + 1.1 * radius, centre.y + 1.5 * radius}};
    draw_polygon(canvas, color, corners, 3);
}

static void mark_draw(const Page *page, const KeyEntry *entry, Point at)
{
    double point = page->point, width = SAMPLE * point;
    Stroke stroke = {.color = entry->color, .width = CURVE_WIDTH * point};
    Box patch = {at.x, at.y - 2.5 * point, at.x + width, at.y + 2.5 * point};
    Point middle = {at.x + KEY_RADIUS * point, at.y};
    if (entry->mark == KEY_DASHED) stroke.dash = 3 * point;
    stroke.space = 2 * point;
    switch (entry->mark) {
    case KEY_LINE:
    case KEY_DASHED:
        draw_segment(page->canvas, &stroke, at, (Point){at.x + width, at.y});
        break;
    case KEY_DISC:
    case KEY_RING:
        draw_disc(page->canvas, entry->color, middle, KEY_RADIUS * point);
        if (entry->mark == KEY_RING)
            draw_disc(page->canvas, PAPER, middle, 0.6 * KEY_RADIUS * point);
        break;
    case KEY_BACK:
        key_draw_back(page->canvas, entry->color, middle, KEY_RADIUS * point);
        break;
    case KEY_HATCH:
        stroke.width = 0.4 * point;
        draw_hatch(page->canvas, &stroke, &patch, 2.5 * point);
        draw_outline(page->canvas, &stroke, &patch);
        break;
    case KEY_PATCH:
        stroke.width = 0.4 * point;
        draw_fill(page->canvas, entry->color, &patch);
        stroke.color = INK;
        draw_outline(page->canvas, &stroke, &patch);
        break;
    case KEY_NONE:
        break;
    }
}

// Line by line from `top` down; returns where the last one ends.
static double walk(const Page *page, const KeyEntry *entries, int32_t count, double top, bool draws)
{
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = INK, .up = 0.5};
    double left = page->room.left + MARGIN * page->point, x = left, pitch = PITCH * style.size;
    for (int32_t k = 0; k < count; ++k) {
        bool disc = entries[k].mark == KEY_DISC || entries[k].mark == KEY_RING;
        double sample = entries[k].mark == KEY_NONE ? 0 : (disc ? 2 * KEY_RADIUS : SAMPLE) + GAP;
        sample *= page->point;
        double width = sample + text_width(page->text, style.size, entries[k].words);
        if (x > left && x + width > page->room.right - MARGIN * page->point) {
            x = left;
            top += pitch;
        }
        Point at = {x, top + pitch / 2};
        if (draws) mark_draw(page, &entries[k], at);
        if (draws) text_draw(page->text, &style, (Point){x + sample, at.y}, entries[k].words);
        x += width + SPACE * page->point;
    }
    return top + pitch;
}

double key_line_height(void)
{
    return PITCH * SMALL_SIZE + 2 * DROP;
}

void key_draw(Page *page, const KeyEntry *entries, int32_t count)
{
    bool none = page->style.legend && strcmp(page->style.legend, "none") == 0;
    if (count == 0 || none) return;
    double height = ceil(walk(page, entries, count, 0, false) + 2 * DROP * page->point);
    page->room.bottom -= height;
    walk(page, entries, count, page->room.bottom + DROP * page->point, true);
}
