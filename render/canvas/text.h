// SPDX-License-Identifier: GPL-2.0-or-later
// Text on a canvas: DejaVu Sans, opened by FreeType, drawn by Cairo. Called by page, axes and the
// figures.
//
// Marks in a text (UTF-8): _{below} ^{above} ~{slanted, for variables}; they nest:
// "~{F}_{T} / ~{F}_{N}", "10^{-3}" (the hyphen is drawn as a minus sign inside ^{}).
#ifndef AMONTONS_RENDER_CANVAS_TEXT_H
#define AMONTONS_RENDER_CANVAS_TEXT_H

#include "render/canvas/canvas.h"

typedef struct Text Text;

typedef struct TextStyle {
    double size;   // of the font, pixels
    Color color;
    double across, up;   // which point of the text stands where it is put: 0 its start or its
        // baseline, 1 its end or the top of its digits, 0.5 the middle
    bool rising;   // turned by a quarter: reads from the bottom to the top
} TextStyle;

// Opens the font: the file of the environment's AMONTONS_FONT, else DejaVu Sans where systems keep
// it. ERROR_LIBRARY names the package to install. Draws on `canvas`, which must outlive it.
Text *text_create(Canvas *canvas, Error *err);
void text_destroy(Text *text);   // NULL is fine

// Pixels along the line. A bad font is reported by canvas_write.
double text_width(Text *text, double size, const char *words);
void text_draw(Text *text, const TextStyle *style, Point place, const char *words);
// Draws words as much smaller as they must be to be no wider than `room`, pixels.
void text_draw_within(Text *text, const TextStyle *style, Point place, double room,
                      const char *words);

// Height of the digits over the font's size.
double text_digit_height(void);

#endif
