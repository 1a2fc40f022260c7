// SPDX-License-Identifier: GPL-2.0-or-later
// The bar is a heat map of one column, so it shows exactly the colours of the map beside it.
#include "render/canvas/colorbar.h"

#include <math.h>
#include <stdio.h>

enum { TICKS_MAX = 6, POWERS_MOST = 10, LABEL_LENGTH = TICK_LABEL_SIZE + 8 };

static const double NAME_MARGIN = 2;   // points: of the page above and below the name, at least
static const double SLACK = 1e-9;   // of a step: a range that ends at a number is not widened
static const double BAR_WIDTH = 7;   // points
static const double TICK_LENGTH = 2.2;   // points
static const double NUMBER_GAP = 1.6;   // points
static const double LABEL_GAP = 3;   // points
static const double EDGE_GAP = 1.5;   // points
static const double POWER_GAP = 4.5;   // points: bar to a power of ten above it
static const double PATCH_GAP = 5;   // points: bar to the neutral patch below it
static const double PATCH_HEIGHT = 7;   // points

void colorbar_fit(Colorbar *bar, const double range[2])
{
    double low = range[0], high = range[1];
    if (bar->powers) {
        bar->low = floor(low + SLACK);
        bar->high = fmax(ceil(high - SLACK), bar->low + 1);
        return;
    }
    if (!(high > low)) high = low + fmax(fabs(low), 1) * 1e-3;
    double step = ticks_choose(low, high, TICKS_MAX).step;
    if (!(step > 0)) step = high - low;   // a range too small for handy numbers
    bar->low = floor(low / step + SLACK) * step;
    bar->high = ceil(high / step - SLACK) * step;
}

float colorbar_level(const Colorbar *bar, double value)
{
    double number = bar->factor * value;
    if (isnan(number)) return HEAT_MISSING;
    if (bar->powers)
        number = number != 0 ? log10(fabs(number)) : -INFINITY;   // 0 is of most pixels
    double part = (number - bar->low) / (bar->high - bar->low);
    if (part < 0 && bar->neutral && (bar->powers || isinf(value))) return HEAT_BELOW;
    part = fmin(fmax(part, 0), 1);
    return (float)(bar->falling ? 1 - part : part);
}

// Whole powers of ten, or a linear scale's ticks.
Ticks colorbar_ticks(const Colorbar *bar)
{
    if (!bar->powers) return ticks_choose(bar->low, bar->high, TICKS_MAX);
    double step = bar->high - bar->low > POWERS_MOST ? ceil((bar->high - bar->low) / TICKS_MAX) : 1;
    Ticks ticks = {.step = step, .minor = 1, .first = (int64_t)ceil(bar->low / step - 1e-9)};
    ticks.count = (int32_t)(floor(bar->high / step + 1e-9) - (double)ticks.first) + 1;
    return ticks;
}

// The number at tick k; "≤" before the lowest where smaller values share its colour, "≥"
// before the highest where larger ones do.
static void bar_label(const Colorbar *bar, const Ticks *ticks, int32_t k, char *label)
{
    char number[TICK_LABEL_SIZE];
    bool below = bar->clipped && k == 0, above = bar->clipped_above && k == ticks->count - 1;
    tick_label(ticks, k, number);
    if (bar->powers) snprintf(number, sizeof number, "10^{%.0f}", tick_value(ticks, k));
    snprintf(label, LABEL_LENGTH, "%s%s", below ? "≤" : above ? "≥" : "", number);
}

// Points that the widest number takes, the neutral colour's name included.
static double numbers_width(const Page *page, const Colorbar *bar)
{
    Ticks ticks = colorbar_ticks(bar);
    double size = NUMBER_SIZE * page->point, widest = 0;
    char label[LABEL_LENGTH];
    for (int32_t k = 0; k < ticks.count; ++k) {
        bar_label(bar, &ticks, k, label);
        widest = fmax(widest, text_width(page->text, size, label));
    }
    if (bar->neutral) widest = fmax(widest, text_width(page->text, size, bar->neutral));
    return widest / page->point;
}

double colorbar_width(const Page *page, const Colorbar *bar)
{
    return BAR_WIDTH + TICK_LENGTH + NUMBER_GAP + numbers_width(page, bar) + LABEL_GAP +
           1.35 * LABEL_SIZE + EDGE_GAP;
}

// The same colour map as the picture's, sampled along the bar, so the two cannot differ.
void colorbar_draw(const Page *page, const Colorbar *bar, const Box *frame, double gap)
{
    double point = page->point;
    Stroke stroke = {.color = INK, .width = FRAME_WIDTH * point};
    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK, .up = 0.5};
    Box colors = *frame;
    float values[MAP_SIZE];
    char label[LABEL_LENGTH];
    colors.left = round(frame->right + gap * point);
    colors.right = round(colors.left + BAR_WIDTH * point);
    if (bar->neutral) {
        // The neutral colour and its name, below the bar.
        Box patch = colors;
        patch.top = round(patch.bottom - PATCH_HEIGHT * point);
        colors.bottom = round(patch.top - PATCH_GAP * point);
        Point place = {patch.right + (TICK_LENGTH + NUMBER_GAP) * point,
                       (patch.top + patch.bottom) / 2};
        draw_fill(page->canvas, bar->neutral_color, &patch);
        draw_outline(page->canvas, &stroke, &patch);
        text_draw(page->text, &style, place, bar->neutral);
    }
    for (int32_t row = 0; row < MAP_SIZE; ++row) {
        float down = (float)row / (MAP_SIZE - 1);
        values[row] = bar->falling ? down : 1 - down;
    }
    canvas_heat(page->canvas, &colors,
                &(HeatMap){.columns = 1, .rows = MAP_SIZE, .values = values});
    draw_outline(page->canvas, &stroke, &colors);

    // Ticks and numbers to the right of the bar.
    Ticks ticks = colorbar_ticks(bar);
    double out = colors.right + TICK_LENGTH * point;
    for (int32_t k = 0; k < ticks.count; ++k) {
        double up = (tick_value(&ticks, k) - bar->low) / (bar->high - bar->low);
        double y = colors.bottom - up * (colors.bottom - colors.top);
        draw_segment(page->canvas, &stroke, (Point){colors.right, y}, (Point){out, y});
        bar_label(bar, &ticks, k, label);
        text_draw(page->text, &style, (Point){out + NUMBER_GAP * point, y}, label);
    }
    ticks_power(&ticks, label);   // of powers none
    style.up = 0;
    text_draw(page->text, &style, (Point){colors.left, colors.top - POWER_GAP * point}, label);

    // The name, rising; a long one gets smaller, and moves.
    style = (TextStyle){
        .size = LABEL_SIZE * point, .color = INK, .across = 0.5, .up = 1, .rising = true};
    out += (NUMBER_GAP + numbers_width(page, bar) + LABEL_GAP) * point;
    double margin = NAME_MARGIN * point;
    double first = page->room.top + margin, last = page->room.bottom - margin;
    style.size *= fmin(1, (last - first) / text_width(page->text, style.size, bar->label));
    double half = text_width(page->text, style.size, bar->label) / 2;
    double middle = fmin((colors.top + colors.bottom) / 2, last - half);
    text_draw(page->text, &style, (Point){out, fmax(middle, first + half)}, bar->label);
}
