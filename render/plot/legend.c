// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/legend.h"

#include "render/plot/marks.h"

static const double LEGEND_SAMPLE = 14, LEGEND_GAP = 3;   // points
static const double LEGEND_PITCH = 1.5;   // line to line, over the size of the words
static const double LEGEND_SPACE = 8;   // points between entries of one line

// One entry from `at`, the left end of its middle line.
static void entry_draw(const Page *page, const PlotSeries *series, Point at, double font)
{
    TextStyle style = {.size = font, .color = INK, .up = 0.5};
    Stroke stroke = mark_stroke(page, series, 1);
    double sample = LEGEND_SAMPLE * page->point, gap = LEGEND_GAP * page->point;
    if (series->line != LINE_NONE)
        draw_segment(page->canvas, &stroke, at, (Point){at.x + sample, at.y});
    mark_draw(page, series, (Point){at.x + sample / 2, at.y}, 1);
    text_draw(page->text, &style, (Point){at.x + sample + gap, at.y}, series->label);
}

// Goes from the room's top down, line by line. Returns the height of all.
static double walk(const Page *page, const PlotPanel *panel, const Box *room, bool draws)
{
    double font = NUMBER_SIZE * page->point, pitch = LEGEND_PITCH * font;
    double beside = (LEGEND_SAMPLE + LEGEND_GAP) * page->point, x = room->left, y = room->top;
    int32_t count = 0;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        if (!series->label[0]) continue;
        double width = beside + text_width(page->text, font, series->label);
        if (count++ > 0 && x + width > room->right) {
            x = room->left;
            y += pitch;
        }
        if (draws) entry_draw(page, series, (Point){x, y + pitch / 2}, font);
        x += width + LEGEND_SPACE * page->point;
    }
    return count > 0 ? y + pitch - room->top : 0;
}

double legend_height(const Page *page, const PlotPanel *panel, const Box *room)
{
    return walk(page, panel, room, false);
}

void legend_draw(const Page *page, const PlotPanel *panel, const Box *room)
{
    walk(page, panel, room, true);
}
