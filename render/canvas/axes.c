// SPDX-License-Identifier: GPL-2.0-or-later
// All is laid out from the frame outwards: ticks, their numbers, the name. The margins that figures
// keep free are sums of the same sizes, so nothing is cut off at the edge of the picture.
#include "render/canvas/axes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PREFIX_SLACK = 1e-5;   // decades over 3: 0.99999 m is 1 m

enum { TICKS_X_MAX = 7, TICKS_Y_MAX = 6, TICKS_MIN = 2, THIRDS_MIN = 3 };

static const double TICK_LENGTH = 2.6;   // points
static const double MINOR_LENGTH = 1.5;   // points
static const double NUMBER_GAP = 1.6;   // points: tick to number
static const double LABEL_GAP = 3.2;   // points: numbers to name
static const double NUMBER_PITCH = 1.5;   // a number's share of the axis over its width ...
static const double LOG_PITCH = 1.15;   // ... and of a power of ten, of which two must be seen
static const double EDGE_GAP = 1.5;   // points: name to the picture's edge

// 0 at the low end of the axis, 1 at the high one; what a logarithmic axis cannot show is NaN.
static double axis_part(const Axis *axis, double value)
{
    if (!axis->is_log) return (value - axis->low) / (axis->high - axis->low);
    return value > 0 ? log(value / axis->low) / log(axis->high / axis->low) : NAN;
}

// Sets a prefix of the unit for each factor of 1000; kg takes none.
void axis_set_unit(Axis *axis, const char *name, const char *unit)
{
    static const char *const prefix[] = {"n", "\u00b5", "m", "", "k", "M", "G"};
    static const char *const scaled[] = {"m",    "m/s",  "s",       "Pa",
                                         "Pa s", "Pa/s", "J/m^{3}", "W/m^{3}"};
    double largest = fmax(fabs(axis->low), fabs(axis->high));
    bool has_prefixes = false;
    for (size_t k = 0; k < sizeof scaled / sizeof *scaled; ++k)
        has_prefixes = has_prefixes || strcmp(scaled[k], unit) == 0;
    int32_t power = (int32_t)floor(log10(largest) / 3 + PREFIX_SLACK);
    if (!has_prefixes || !(largest > 0) || !isfinite(largest)) power = 0;
    power = power < -3 ? -3 : power > 3 ? 3 : power;
    if (unit[0] == 'm' && power > 0) power = 0;   // nobody says km of a block
    axis->factor = pow(1000, -power);
    snprintf(axis->label, sizeof axis->label, "%.70s (%s%.16s)", name, prefix[power + 3], unit);
}

double axes_number_size(const Axes *axes)
{
    return axes->small ? SMALL_SIZE : NUMBER_SIZE;
}

static Color frame_color(const Axes *axes)
{
    return axes->color.alpha > 0 ? axes->color : INK;
}

// y grows upwards in the data and downwards on the canvas.
Point axes_place(const Axes *axes, double x, double y)
{
    const Box *box = &axes->box;
    double across = axis_part(&axes->x, x), up = axis_part(&axes->y, y);
    return (Point){box->left + across * (box->right - box->left),
                   box->bottom - up * (box->bottom - box->top)};
}

// The widest number of an axis, pixels: the room left of the frame depends on it.
static double number_width(const Page *page, const Axes *axes, const Ticks *ticks)
{
    double widest = 0;
    char label[TICK_LABEL_SIZE];
    for (int32_t k = 0; k < ticks->count; ++k) {
        tick_label(ticks, k, label);
        widest = fmax(widest, text_width(page->text, axes_number_size(axes) * page->point, label));
    }
    return widest;
}

// Ticks are chosen for the numbers shown, that is, in the unit of the axis. A logarithmic axis so
// short that it has no two powers of ten gets 1, 2 and 5 times them; one too short for that gets
// plain numbers at their logarithmic places.
Ticks axis_ticks(const Axis *axis, int32_t wanted)
{
    Ticks log_ticks = {0};
    if (axis->is_log)
        log_ticks = ticks_choose_log(axis->low * axis->factor, axis->high * axis->factor, wanted);
    if (log_ticks.count >= TICKS_MIN) return log_ticks;
    if (axis->is_log)
        log_ticks = ticks_choose_thirds(axis->low * axis->factor, axis->high * axis->factor);
    if (log_ticks.count >= THIRDS_MIN) return log_ticks;
    Ticks ticks = ticks_choose(axis->low * axis->factor, axis->high * axis->factor, wanted);
    return axis->whole ? ticks_whole(&ticks, axis->low, axis->high) : ticks;
}

// Chooses as many ticks as leave room between their numbers.
static Ticks ticks_along_x(const Page *page, const Axes *axes)
{
    double room = axes->box.right - axes->box.left;
    Ticks ticks = {0};
    for (int32_t wanted = TICKS_X_MAX; wanted >= TICKS_MIN; --wanted) {
        ticks = axis_ticks(&axes->x, wanted);
        double pitch = ticks.is_log ? LOG_PITCH : NUMBER_PITCH;
        if (pitch * ticks.count * number_width(page, axes, &ticks) <= room) break;
    }
    return ticks;
}

// Numbers stand one above the other: their height limits how many there can be.
static Ticks ticks_along_y(const Page *page, const Axes *axes)
{
    double room = (axes->box.bottom - axes->box.top) / page->point;
    int32_t wanted = (int32_t)(room / (2.4 * axes_number_size(axes)));
    if (wanted > TICKS_Y_MAX) wanted = TICKS_Y_MAX;
    if (wanted < TICKS_MIN) wanted = TICKS_MIN;
    Ticks ticks = axis_ticks(&axes->y, wanted);
    // One number alone gives no scale: then rather a little crowded.
    for (int32_t more = 1; ticks.count < TICKS_MIN && more <= TICKS_Y_MAX; ++more)
        ticks = axis_ticks(&axes->y, wanted + more);
    return ticks;
}

// The widest number or name beside the y axis, pixels.
static double left_width(const Page *page, const Axes *axes)
{
    Ticks ticks = ticks_along_y(page, axes);
    double widest = 0, size = axes_number_size(axes) * page->point;
    if (!axes->y.names) return number_width(page, axes, &ticks);
    for (int32_t k = 0; k < axes->y.name_count; ++k)
        widest = fmax(widest, text_width(page->text, size, axes->y.names[k]));
    return widest;
}

// The margin is in points; the same sums as in draw_left, from the frame to the picture's edge.
double axes_left_margin(const Page *page, const Axes *axes)
{
    double numbers = left_width(page, axes) / page->point;
    double name = axes->y.label[0] ? LABEL_GAP + LABEL_SIZE + EDGE_GAP
                  : axes->y.names  ? EDGE_GAP
                                   : 0;
    return TICK_LENGTH + NUMBER_GAP + numbers + name;
}

double axes_bottom_margin(const Axes *axes)
{
    double name = axes->x.label[0] ? LABEL_GAP + LABEL_SIZE + EDGE_GAP : 0;
    if (axes->bare_x) return TICK_LENGTH;
    return TICK_LENGTH + NUMBER_GAP + axes_number_size(axes) * text_digit_height() + name;
}

// A power of ten stands above the axis and needs a line of its own.
double axes_top_margin(const Axes *axes)
{
    Ticks ticks = axis_ticks(&axes->y, TICKS_Y_MAX);
    double lines = ticks.exponent == 0 || axes->y.names ? 0.6 : 1.8;
    return fmax(axes_number_size(axes) * lines, axes->above);
}

void axes_settle(const Page *page, Axes *axes)
{
    axes->box.left = fmax(axes->box.left, page->room.left + page->beside[0]);
    axes->box.right = fmin(axes->box.right, page->room.right - page->beside[1]);
    if (page->frame) *page->frame = axes->box;
}

void axes_fit(const Page *page, const Box *room, double right, Axes *axes)
{
    double point = page->point;
    axes->box.top = round(room->top + axes_top_margin(axes) * point);
    axes->box.bottom = round(room->bottom - axes_bottom_margin(axes) * point);
    axes->box.left = round(room->left + axes_left_margin(page, axes) * point);
    axes->box.right = round(room->right - right * point);
    axes_settle(page, axes);
}

// --- inside --------------------------------------------------------------------------------------

void axes_curve(const Page *page, const Axes *axes, const Stroke *stroke, const double *x,
                const double *y, int64_t count)
{
    canvas_clip(page->canvas, &axes->box);
    LinePen pen = line_begin(page->canvas, stroke);
    for (int64_t k = 0; k < count; ++k) line_add(&pen, axes_place(axes, x[k], y[k]));
    line_end(&pen);
    canvas_clip(page->canvas, NULL);
}

Stroke dashed_stroke(const Page *page, Color color, double width)
{
    double point = page->point;
    return (Stroke){color, width * point, 3 * point, 2 * point};
}

void axes_level(const Page *page, const Axes *axes, const Stroke *stroke, double y, double gap,
                const char *name)
{
    Point from = axes_place(axes, axes->x.low, y), to = axes_place(axes, axes->x.high, y);
    TextStyle style = {.size = NUMBER_SIZE * page->point, .color = INK, .up = 0.5};
    draw_segment(page->canvas, stroke, from, to);
    if (name) text_draw(page->text, &style, (Point){to.x + gap * page->point, to.y}, name);
}

// --- around --------------------------------------------------------------------------------------

// The power of ten that all numbers of an axis are to be multiplied by, where there is one.
static void exponent_write(const Page *page, const TextStyle *style, Point place,
                           const Ticks *ticks)
{
    char words[TICK_LABEL_SIZE];
    ticks_power(ticks, words);
    text_draw(page->text, style, place, words);
}

// A tick from `foot` on the frame outwards: downwards, or else to the left.
static void tick_mark(const Page *page, const Axes *axes, Point foot, bool below, double length)
{
    Stroke stroke = {.color = frame_color(axes), .width = FRAME_WIDTH * page->point};
    double out = length * page->point;
    Point end = {foot.x - (below ? 0 : out), foot.y + (below ? out : 0)};
    draw_segment(page->canvas, &stroke, foot, end);
}

// Minor ticks lie between the ticks and beyond them to both ends of the axis.
static void minor_marks(const Page *page, const Axes *axes, const Ticks *ticks, bool below)
{
    const Axis *axis = below ? &axes->x : &axes->y;
    if (ticks->count == 0) return;
    for (int32_t k = -ticks->minor; k <= ticks->count * ticks->minor; ++k) {
        // Minor ticks stand at equal distances, or at 1 to 9 times a power of ten.
        double even = ((double)ticks->first + (double)k / ticks->minor) * ticks->step;
        double value = (ticks->is_log ? ticks_minor_log(ticks, k) : even) / axis->factor;
        double part = axis_part(axis, value);
        if (!(part >= -1e-6 && part <= 1 + 1e-6)) continue;
        Point foot = below ? axes_place(axes, value, axes->y.low)
                           : axes_place(axes, axes->x.low, value);
        tick_mark(page, axes, foot, below, MINOR_LENGTH);
    }
}

// Is drawn with the frame, last: its line covers where ticks and data meet it. A power of ten
// stands above the frame.
void axes_draw_left(const Page *page, const Axes *axes)
{
    Stroke stroke = {.color = frame_color(axes), .width = FRAME_WIDTH * page->point};
    TextStyle style = {
        .size = axes_number_size(axes) * page->point, .color = INK, .across = 1, .up = 0.5};
    double edge = axes->box.left - (TICK_LENGTH + NUMBER_GAP) * page->point;
    if (axes->y.names) {
        // Names at y = 1, 2, ... in the place of numbers, without minor ticks between them.
        for (int32_t k = 0; k < axes->y.name_count; ++k) {
            Point foot = axes_place(axes, axes->x.low, k + 1);
            tick_mark(page, axes, foot, false, TICK_LENGTH);
            if (!axes->bare_y)
                text_draw(page->text, &style, (Point){edge, foot.y}, axes->y.names[k]);
        }
    } else {
        Ticks ticks = ticks_along_y(page, axes);
        minor_marks(page, axes, &ticks, false);
        for (int32_t k = 0; k < ticks.count; ++k) {
            char label[TICK_LABEL_SIZE];
            Point foot = axes_place(axes, axes->x.low, tick_value(&ticks, k) / axes->y.factor);
            tick_mark(page, axes, foot, false, TICK_LENGTH);
            tick_label(&ticks, k, label);
            if (!axes->bare_y) text_draw(page->text, &style, (Point){edge, foot.y}, label);
        }
        style.across = style.up = 0;
        Point above = {axes->box.left, axes->box.top - NUMBER_GAP * page->point};
        if (!axes->bare_y) exponent_write(page, &style, above, &ticks);
    }
    style =
        (TextStyle){.size = LABEL_SIZE * page->point, .color = INK, .across = 0.5, .rising = true};
    edge -= left_width(page, axes) + LABEL_GAP * page->point;
    if (!axes->bare_y)
        text_draw(page->text, &style, (Point){edge, (axes->box.top + axes->box.bottom) / 2},
                  axes->y.label);
    draw_outline(page->canvas, &stroke, &axes->box);
}

// Draws from the frame downwards: ticks, numbers, then the name in the middle with the power of ten
// at its right.
void axes_draw(const Page *page, const Axes *axes)
{
    Ticks ticks = ticks_along_x(page, axes);
    TextStyle style = {
        .size = axes_number_size(axes) * page->point, .color = INK, .across = 0.5, .up = 1};
    double line = axes->box.bottom + (TICK_LENGTH + NUMBER_GAP) * page->point;
    minor_marks(page, axes, &ticks, true);
    for (int32_t k = 0; k < ticks.count; ++k) {
        char label[TICK_LABEL_SIZE];
        Point foot = axes_place(axes, tick_value(&ticks, k) / axes->x.factor, axes->y.low);
        tick_mark(page, axes, foot, true, TICK_LENGTH);
        tick_label(&ticks, k, label);
        if (!axes->bare_x) text_draw(page->text, &style, (Point){foot.x, line}, label);
    }
    if (!axes->bare_x) {
        line += (axes_number_size(axes) * text_digit_height() + LABEL_GAP) * page->point;
        style.across = 1;
        exponent_write(page, &style, (Point){axes->box.right, line}, &ticks);
        style.across = 0.5;
        style.size = LABEL_SIZE * page->point;
        text_draw(page->text, &style, (Point){(axes->box.left + axes->box.right) / 2, line},
                  axes->x.label);
    }
    axes_draw_left(page, axes);
}
