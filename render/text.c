// SPDX-License-Identifier: GPL-2.0-or-later
// A glyph is rasterised once a size and slant and copied onto the sheet, row by row of glyphs from
// the top. Slanted letters are the upright ones sheared: the base package of the font has no
// oblique face.
#include "render/text.h"

#include "base/memory.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GLYPHS_MAX = 512, NEST_MAX = 4, MINUS = 0x2212, REPLACEMENT = 0xfffd };

static const double SCRIPT_SIZE = 0.7;   // of the text around it
static const double SCRIPT_DROP = 0.18;   // of a lowered baseline, over the size around it
static const double SCRIPT_RISE = 0.36;   // of a raised one
static const double SLANT = 0.2;   // shear of slanted letters
static const double DIGIT_HEIGHT = 0.729;   // of DejaVu Sans, over its size

typedef struct Glyph {
    uint32_t letter;   // Unicode
    int32_t size;   // pixels
    bool slanted;
    int32_t x, y;   // upper left corner on the sheet
    int32_t width, height;   // on the sheet, pixels
    int32_t left, top;   // from the pen to the upper left corner; top upwards
    double advance;   // of the pen, pixels
} Glyph;

struct Text {
    Canvas *canvas;   // not owned
    FT_Library library;   // owned
    FT_Face face;   // owned
    uint8_t *sheet;   // [GLYPH_SHEET_SIZE squared]; owned
    int32_t shelf_x, shelf_y, shelf_height;   // where the next glyph goes
    int32_t glyph_count;
    Glyph glyphs[GLYPHS_MAX];
};

// Where a run of letters is: changed by the marks, kept on a stack.
typedef struct Pen {
    double size, baseline;   // pixels; baseline: upwards from the text's
    bool slanted, raised;
} Pen;

// A line of text being laid out.
typedef struct Line {
    const TextStyle *style;
    Point start;   // of the baseline, on the picture, whole pixels
    double along;   // the pen's way from there
    bool drawn;   // false: only measured
} Line;

static const char *const FONT_FILES[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/local/share/fonts/dejavu/DejaVuSans.ttf"};

// AMONTONS_FONT is taken at its word: where it is wrong, no other font is tried.
static bool font_open(Text *text, Error *err)
{
    const char *given = getenv("AMONTONS_FONT");
    if (FT_Init_FreeType(&text->library)) FAIL(err, ERROR_LIBRARY, "FreeType does not start");
    if (given && given[0]) {
        if (FT_New_Face(text->library, given, 0, &text->face))
            FAIL(err, ERROR_LIBRARY, "AMONTONS_FONT=%s is not a font that FreeType can read",
                 given);
    } else {
        for (size_t k = 0; k < sizeof FONT_FILES / sizeof *FONT_FILES && !text->face; ++k)
            if (FT_New_Face(text->library, FONT_FILES[k], 0, &text->face)) text->face = NULL;
    }
    if (!text->face)
        FAIL(err, ERROR_LIBRARY,
             "no DejaVuSans.ttf in the system's font folders (%s, ...): install the Debian package "
             "fonts-dejavu-core, or set AMONTONS_FONT to a .ttf file",
             FONT_FILES[0]);
    if (!FT_IS_SCALABLE(text->face))
        FAIL(err, ERROR_LIBRARY, "the font %s has no outlines that can be scaled", given);
cleanup:
    return error_is_clean(err);
}

Text *text_create(Canvas *canvas, Error *err)
{
    Text *text = NULL;
    TRY(text = NEW_ARRAY(Text, 1, err));
    text->canvas = canvas;
    TRY(text->sheet = NEW_ARRAY(uint8_t, (int64_t)GLYPH_SHEET_SIZE * GLYPH_SHEET_SIZE, err));
    TRY(font_open(text, err));
    return text;
cleanup:
    text_destroy(text);
    return NULL;
}

void text_destroy(Text *text)
{
    if (!text) return;
    if (text->face) FT_Done_Face(text->face);
    if (text->library) FT_Done_FreeType(text->library);
    memory_free(text->sheet);
    memory_free(text);
}

double text_digit_height(void)
{
    return DIGIT_HEIGHT;
}

// --- glyphs --------------------------------------------------------------------------------------
// Room for width by height pixels and one around them.
static bool sheet_place(Text *text, Glyph *glyph, Error *err)
{
    if (text->shelf_x + glyph->width + 1 > GLYPH_SHEET_SIZE) {
        text->shelf_x = 0;
        text->shelf_y += text->shelf_height;
        text->shelf_height = 0;
    }
    if (text->shelf_y + glyph->height + 1 > GLYPH_SHEET_SIZE || glyph->width > GLYPH_SHEET_SIZE)
        FAIL(err, ERROR_LIBRARY, "the picture's text is too large for the sheet of glyphs");
    glyph->x = text->shelf_x;
    glyph->y = text->shelf_y;
    text->shelf_x += glyph->width + 1;
    if (glyph->height + 1 > text->shelf_height) text->shelf_height = glyph->height + 1;
cleanup:
    return error_is_clean(err);
}

// Rasterises the letter at its size and slant, and puts it onto the sheet. Not hinted: letters keep
// their shape at print size, and the same file comes out wherever FreeType is set up otherwise.
static bool glyph_make(Text *text, Glyph *glyph, Error *err)
{
    FT_Matrix shear = {0x10000, (FT_Fixed)(SLANT * 0x10000), 0, 0x10000};
    FT_GlyphSlot slot = text->face->glyph;
    if (FT_Set_Pixel_Sizes(text->face, 0, (FT_UInt)glyph->size) ||
        FT_Load_Char(text->face, glyph->letter, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP))
        FAIL(err, ERROR_LIBRARY, "FreeType does not give the letter U+%04X at %d pixels",
             glyph->letter, glyph->size);
    glyph->advance = (double)slot->linearHoriAdvance / 65536;
    if (glyph->slanted) FT_Outline_Transform(&slot->outline, &shear);
    if (FT_Render_Glyph(slot, FT_RENDER_MODE_NORMAL))
        FAIL(err, ERROR_LIBRARY, "FreeType does not draw the letter U+%04X", glyph->letter);
    glyph->width = (int32_t)slot->bitmap.width;
    glyph->height = (int32_t)slot->bitmap.rows;
    glyph->left = slot->bitmap_left;
    glyph->top = slot->bitmap_top;
    TRY(sheet_place(text, glyph, err));
    for (int32_t row = 0; row < glyph->height; ++row)
        memcpy(text->sheet + (size_t)(glyph->y + row) * GLYPH_SHEET_SIZE + glyph->x,
               slot->bitmap.buffer + (ptrdiff_t)row * slot->bitmap.pitch, (size_t)glyph->width);
    canvas_set_glyphs(text->canvas, text->sheet);
cleanup:
    return error_is_clean(err);
}

// NULL after a fault, which the canvas keeps.
static const Glyph *glyph_find(Text *text, uint32_t letter, const Pen *pen)
{
    Error *err = canvas_failure(text->canvas);
    Glyph wanted = {.letter = letter, .size = (int32_t)lround(pen->size), .slanted = pen->slanted};
    for (int32_t k = 0; k < text->glyph_count; ++k) {
        const Glyph *known = &text->glyphs[k];
        if (known->letter == letter && known->size == wanted.size &&
            known->slanted == wanted.slanted)
            return known;
    }
    if (text->glyph_count == GLYPHS_MAX)
        FAIL(err, ERROR_LIBRARY, "the picture has more than %d different glyphs", GLYPHS_MAX);
    TRY(glyph_make(text, &wanted, err));
    text->glyphs[text->glyph_count] = wanted;
    return &text->glyphs[text->glyph_count++];
cleanup:
    return NULL;
}

// --- lines ---------------------------------------------------------------------------------------
// The next Unicode letter of UTF-8; *words moves behind it.
static uint32_t letter_next(const char **words)
{
    const unsigned char *byte = (const unsigned char *)*words;
    int32_t more = byte[0] >= 0xf0 ? 3 : byte[0] >= 0xe0 ? 2 : byte[0] >= 0xc0 ? 1 : 0;
    uint32_t letter = more ? byte[0] & (0x3fu >> more) : byte[0];
    if (byte[0] >= 0x80 && more == 0) letter = REPLACEMENT;
    for (int32_t k = 1; k <= more; ++k) {
        if ((byte[k] & 0xc0) != 0x80) {
            *words += k;
            return REPLACEMENT;
        }
        letter = letter << 6 | (byte[k] & 0x3f);
    }
    *words += more + 1;
    return letter;
}

// A quad of whole pixels, so that a texel is a pixel; turned by a quarter for rising text.
static void glyph_draw(Text *text, const Line *line, const Pen *pen, const Glyph *glyph)
{
    static const int32_t order[6] = {0, 1, 2, 2, 1, 3};
    double left = round(line->along) + glyph->left, top = round(pen->baseline) + glyph->top;
    Vertex corner[4], vertices[6];
    for (int32_t k = 0; k < 4; ++k) {
        int32_t right = (k & 1) * glyph->width, down = (k >> 1) * glyph->height;
        double along = left + right, up = top - down;
        bool rising = line->style->rising;
        corner[k] = (Vertex){.x = (float)(line->start.x + (rising ? -up : along)),
                             .y = (float)(line->start.y - (rising ? along : up)),
                             .u = (float)(glyph->x + right),
                             .v = (float)(glyph->y + down),
                             .color = line->style->color};
    }
    for (int32_t k = 0; k < 6; ++k) vertices[k] = corner[order[k]];
    canvas_triangles(text->canvas, PAINT_GLYPH, vertices, 6);
}

// The pen inside a mark's braces.
static Pen pen_marked(const Pen *pen, char mark)
{
    Pen inner = *pen;
    if (mark == '~') inner.slanted = true;
    if (mark == '_' || mark == '^') {
        inner.size *= SCRIPT_SIZE;
        inner.slanted = false;
        inner.raised = mark == '^';
        inner.baseline += pen->size * (mark == '^' ? SCRIPT_RISE : -SCRIPT_DROP);
    }
    return inner;
}

// Goes along the words, letter by letter, opening and closing marks; draws or only measures.
static void line_walk(Text *text, Line *line, const char *words)
{
    Pen pen[NEST_MAX + 1] = {{.size = line->style->size}};
    int32_t depth = 0;
    while (*words) {
        bool mark = (*words == '_' || *words == '^' || *words == '~') && words[1] == '{';
        if (mark && depth < NEST_MAX) {
            pen[depth + 1] = pen_marked(&pen[depth], *words);
            ++depth;
            words += 2;
            continue;
        }
        if (*words == '}' && depth > 0) {
            --depth;
            ++words;
            continue;
        }
        uint32_t letter = letter_next(&words);
        if (letter == '-' && pen[depth].raised) letter = MINUS;
        const Glyph *glyph = glyph_find(text, letter, &pen[depth]);
        if (!glyph) return;
        if (line->drawn && glyph->width > 0) glyph_draw(text, line, &pen[depth], glyph);
        line->along += glyph->advance;
    }
}

// In the pixels of `size`, marks not counted.
double text_width(Text *text, double size, const char *words)
{
    TextStyle style = {.size = size};
    Line line = {.style = &style};
    line_walk(text, &line, words);
    return line.along;
}

// Placed by its measured width; the line then starts on a whole pixel, and glyphs keep sharp.
void text_draw(Text *text, const TextStyle *style, Point place, const char *words)
{
    double back = style->across * text_width(text, style->size, words);
    double down = style->up * style->size * DIGIT_HEIGHT;
    Line line = {.style = style, .drawn = true};
    line.start.x = round(place.x + (style->rising ? down : -back));
    line.start.y = round(place.y + (style->rising ? back : down));
    line_walk(text, &line, words);
}
