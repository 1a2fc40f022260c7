// SPDX-License-Identifier: GPL-2.0-or-later
// The height must be known before there is a canvas to measure text on: lines end by their number
// of characters, few enough for wide ones.
#include "render/canvas/foot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SIZE = 7;   // points
static const double LETTER = 0.6;   // of the size: what a character takes, rather more
static const double LINE_HEIGHT = 1.25;   // of it
static const double MARGIN = 4;   // points: below the last line and left of all
static const Color WARNING_COLOR = {0.62f, 0.20f, 0.05f, 1};
enum { CHARACTERS_LEAST = 30, CHARACTERS_MOST = FOOT_LINE_SIZE - 4 };
static const char *const REST = "... the rest stands in run.json (warnings).";

// Up to `room` characters of `from`, to a blank where there is one; how many are taken with it.
static size_t take_line(const char *from, size_t length, size_t room, char *line, size_t size)
{
    size_t end = length;
    if (length > room)
        for (end = room; end > 0 && from[end] != ' ';) end--;
    if (end == 0) end = room;
    snprintf(line, size, "%.*s", (int)end, from);
    while (end < length && from[end] == ' ') end++;
    return end;
}

// One warning: its first line begins with the word, the others are indented.
static void add_warning(Foot *foot, const char *warning, size_t length, size_t room)
{
    const char *lead = "Warning: ";
    while (length > 0) {
        char words[FOOT_LINE_SIZE];
        if (foot->count == FOOT_LINES_MAX) {
            snprintf(foot->line[foot->count - 1], FOOT_LINE_SIZE, "%s", REST);
            return;
        }
        size_t taken = take_line(warning, length, room - strlen(lead), words, sizeof words);
        snprintf(foot->line[foot->count++], FOOT_LINE_SIZE, "%.12s%.140s", lead, words);
        warning += taken;
        length -= taken;
        lead = "   ";
    }
}

Foot foot_wrap(const char *warnings, double width)
{
    Foot foot = {0};
    double room =
        fmin(fmax((width - 2 * MARGIN) / (LETTER * SIZE), CHARACTERS_LEAST), CHARACTERS_MOST);
    while (*warnings) {
        size_t length = strcspn(warnings, "\n");
        add_warning(&foot, warnings, length, (size_t)room);
        warnings += length + (warnings[length] == '\n');
    }
    return foot;
}

double foot_height(const Foot *foot)
{
    return foot->count > 0 ? foot->count * LINE_HEIGHT * SIZE + MARGIN : 0;
}

void foot_draw(const Page *page, const Foot *foot)
{
    double point = page->point;
    TextStyle style = {.size = SIZE * point, .color = WARNING_COLOR};
    double top = page->room.bottom;
    for (int32_t k = 0; k < foot->count; ++k)
        text_draw(page->text, &style,
                  (Point){MARGIN * point, round(top + (k + 0.8) * LINE_HEIGHT * style.size)},
                  foot->line[k]);
}
