// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/legend.h"

#include "render/plot/legend_place.h"
#include "render/plot/marks.h"

#include <math.h>

static const double LEGEND_SAMPLE = 14, LEGEND_GAP = 3, LEGEND_MARGIN = 4;   // points
static const double LEGEND_CLEARANCE = 2;   // points: words to data
static const double LEGEND_PITCH = 1.5;   // line to line, over the size of the words
static const double FRAME_LEAST = 0.6;   // of its width that a legend beside it leaves
static const double LEGEND_SPACE = 8;   // points between entries of one line

// Size of the legend of the labelled series; height 0: there is no legend.
static LegendSize legend_measure(const Page *page, const Axes *axes, const PlotPanel *panel,
                                 double share)
{
    double font = axes_number_size(axes) * page->point, widest = 0;
    LegendSize size = {.margin = LEGEND_MARGIN * page->point,
                       .clearance = LEGEND_CLEARANCE * page->point,
                       .mark = MARKER_RADIUS * share * page->point};
    if (panel->legend == CORNER_NONE || panel->legend == CORNER_BELOW) return size;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        if (!panel->series[k].label[0]) continue;
        widest = fmax(widest, text_width(page->text, font, panel->series[k].label));
        size.height += LEGEND_PITCH * font;
    }
    size.width = widest + (LEGEND_SAMPLE + LEGEND_GAP) * page->point;
    return size;
}

Box legend_settle(const Page *page, const PlotPanel *panel, double share, const Box *taken,
                  Axes *axes)
{
    LegendSize size = legend_measure(page, axes, panel, share);
    PlotCorner corner = panel->legend;
    if (!(size.height > 0)) return (Box){0};
    if (corner == CORNER_AUTO) corner = legend_choose(panel, axes, &size, taken);
    if (corner == CORNER_OUTSIDE)
        axes->box.right = round(axes->box.right - size.width - size.margin);
    return legend_box(axes, &size, corner);
}

// One entry from `at`, the left end of its middle line.
static void entry_draw(const Page *page, const PlotSeries *series, Point at, double font,
                       double share)
{
    TextStyle style = {.size = font, .color = INK, .up = 0.5};
    Stroke stroke = mark_stroke(page, series, share);
    double sample = LEGEND_SAMPLE * page->point, gap = LEGEND_GAP * page->point;
    if (series->line != LINE_NONE)
        draw_segment(page->canvas, &stroke, at, (Point){at.x + sample, at.y});
    mark_draw(page, series, (Point){at.x + sample / 2, at.y}, share);
    text_draw(page->text, &style, (Point){at.x + sample + gap, at.y}, series->label);
}

void legend_draw(const Page *page, const Axes *axes, const PlotPanel *panel, const Box *box,
                 double share)
{
    double font = axes_number_size(axes) * page->point;
    double pitch = LEGEND_PITCH * font, y = box->top + pitch / 2;
    if (!(box->bottom > box->top)) return;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        if (!series->label[0]) continue;
        entry_draw(page, series, (Point){box->left, y}, font, share);
        y += pitch;
    }
}

// --- below --------------------------------------------------------------------------------------

bool legend_is_below(const Page *page, const Plot *plot, const Axes *frame)
{
    const PlotPanel *panel = &plot->main;
    if (panel->legend != CORNER_AUTO) return panel->legend == CORNER_BELOW;
    if (panel->has_map || plot->panel_count > 0) return true;
    LegendSize size = legend_measure(page, frame, panel, 1);
    if (plot->has_inset || !(size.height > 0)) return false;
    PlotCorner corner = legend_choose(panel, frame, &size, NULL);
    Box box = legend_box(frame, &size, corner);
    double width = frame->box.right - frame->box.left;
    if (corner == CORNER_OUTSIDE) return width - size.width - size.margin < FRAME_LEAST * width;
    return legend_hides(panel, frame, &size, &box) > 0;
}

// From the room's top down, line by line. Returns the height of all.
static double below_walk(const Page *page, const PlotPanel *panel, const Box *room, bool draws)
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
        if (draws) entry_draw(page, series, (Point){x, y + pitch / 2}, font, 1);
        x += width + LEGEND_SPACE * page->point;
    }
    return count > 0 ? y + pitch - room->top : 0;
}

double legend_below_height(const Page *page, const PlotPanel *panel, const Box *room)
{
    return below_walk(page, panel, room, false);
}

void legend_below_draw(const Page *page, const PlotPanel *panel, const Box *room)
{
    below_walk(page, panel, room, true);
}
