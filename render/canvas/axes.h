// SPDX-License-Identifier: GPL-2.0-or-later
// A frame with two axes, linear or logarithmic: ticks, numbers, names. Called by the figures.
#ifndef AMONTONS_RENDER_CANVAS_AXES_H
#define AMONTONS_RENDER_CANVAS_AXES_H

#include "render/canvas/page.h"
#include "render/canvas/ticks.h"

enum { AXIS_LABEL_SIZE = 96 };

typedef struct Axis {
    double low, high;   // ends, in the data's unit
    double factor;   // numbers shown are the data's times this
    char label[AXIS_LABEL_SIZE];   // name and unit, with text.h's marks; may be empty
    bool is_log;   // low > 0 then
    bool whole;   // what it shows is counted: no ticks between whole numbers
    const char (*names)[AXIS_LABEL_SIZE];   // of the y axis: what stands at 1, 2, ... in the place
        // of numbers, [name_count]; NULL: numbers; not owned
    int32_t name_count;
} Axis;

typedef struct Axes {
    Box box;   // the frame, whole pixels
    Axis x, y;
    bool small;   // numbers are those of an inset
    Color color;   // of the frame; zeroed: ink
    bool bare_x, bare_y;   // ticks without numbers and name: another frame has them
    double above;   // points above the frame that something else needs
} Axes;

// Writes "name (unit)" into the label, with the prefix that makes the numbers from low to high
// short, and sets the factor that belongs to it. unit: of SI, "m", "Pa", "m/s"; others get none.
void axis_set_unit(Axis *axis, const char *name, const char *unit);

// About `wanted` ticks, in the numbers shown.
Ticks axis_ticks(const Axis *axis, int32_t wanted);

// Place of (x, y) of the data on the picture.
Point axes_place(const Axes *axes, double x, double y);

double axes_number_size(const Axes *axes);   // points: of numbers at ticks
// Points to the left of the frame that numbers and name of `y` take; how many these are its height
// says.
double axes_left_margin(const Page *page, const Axes *axes);
double axes_bottom_margin(const Axes *axes);   // likewise below, for `x`
double axes_top_margin(const Axes *axes);   // likewise above: half a number, a power of ten

// The frame in `room`, less what stands around it, `right` points at its right; tells whoever asks
// where it lies, with the margins that it must have at least.
void axes_fit(const Page *page, const Box *room, double right, Axes *axes);
// The same frame, where it has been moved.
void axes_settle(const Page *page, Axes *axes);

// Both of these are cut off at the frame, but for the name.
void axes_curve(const Page *page, const Axes *axes, const Stroke *stroke, const double *x,
                const double *y, int64_t count);
// A line across the frame at y, its name `gap` points behind it; NULL: no name.
void axes_level(const Page *page, const Axes *axes, const Stroke *stroke, double y, double gap,
                const char *name);
Stroke dashed_stroke(const Page *page, Color color, double width);   // width: points

// Frame, ticks (outwards, left and below), numbers and names. Draw it after the data.
void axes_draw(const Page *page, const Axes *axes);
// The same without what stands below the frame.
void axes_draw_left(const Page *page, const Axes *axes);

#endif
