// SPDX-License-Identifier: GPL-2.0-or-later
// Letters of one size and slant are handed to Cairo together, so that a PDF holds words. Slanted
// letters are the upright ones sheared: the base package of the font has no oblique face.
#include "render/canvas/text.h"

#include "base/memory.h"
#include "base/text.h"

#include <cairo-ft.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NEST_MAX = 4, RUN_SIZE = 256, LETTER_SIZE = 4 };

static const double SCRIPT_SIZE = 0.7;   // of the text around it
static const double SCRIPT_DROP = 0.18;   // of a lowered baseline, over the size around it
static const double SCRIPT_RISE = 0.36;   // of a raised one
static const double SLANT = 0.2;   // shear of slanted letters
static const double DIGIT_HEIGHT = 0.729;   // of DejaVu Sans, over its size
static const double PI = 3.14159265358979323846;
static const char MINUS[] = "\u2212", REPLACEMENT[] = "\ufffd";

struct Text {
    Canvas *canvas;   // not owned
    cairo_font_face_t *font;   // owned
    cairo_font_options_t *options;   // owned
};

// State of the pen for a run of letters: marks change it, and a stack keeps it.
typedef struct Pen {
    double size, baseline;   // pixels; baseline: upwards from the text's
    bool slanted, raised;
} Pen;

// A line of text being laid out.
typedef struct Line {
    cairo_t *cairo;   // its origin is the start of the baseline
    double along;   // the pen's way from there
    bool drawn;   // false: only measured
    char run[RUN_SIZE + LETTER_SIZE];   // letters that wait for the pen to change
    size_t length;   // of these, bytes
} Line;

static const char *const FONT_FILES[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/local/share/fonts/dejavu/DejaVuSans.ttf"};

// NULL where it is no font, or one of fixed sizes.
static FT_Face face_open(FT_Library library, const char *path)
{
    FT_Face face = NULL;
    if (FT_New_Face(library, path, 0, &face)) return NULL;
    if (FT_IS_SCALABLE(face)) return face;
    FT_Done_Face(face);
    return NULL;
}

// Closes its faces, too.
static void library_close(void *library)
{
    FT_Done_FreeType(library);
}

Text *text_create(Canvas *canvas, Error *err)
{
    static const cairo_user_data_key_t file;
    FT_Library library = NULL;
    FT_Face face = NULL;
    const char *path = getenv("AMONTONS_FONT");
    bool named = path && path[0];
    Text *text = NULL;
    TRY(text = NEW_ARRAY(Text, 1, err));
    text->canvas = canvas;

    // AMONTONS_FONT is taken at its word: where it is wrong, no other font is tried. Cairo keeps
    // fonts for longer than we do: the file is closed with the last of them. Fontconfig has no part
    // in it, as nothing is looked up.
    if (FT_Init_FreeType(&library)) FAIL(err, ERROR_LIBRARY, "FreeType does not start");
    if (named) face = face_open(library, path);
    if (named && !face)
        FAIL(err, ERROR_LIBRARY, "AMONTONS_FONT=%s is not a font that FreeType can read and scale",
             path);
    for (size_t k = 0; !face && k < sizeof FONT_FILES / sizeof *FONT_FILES; ++k)
        face = face_open(library, FONT_FILES[k]);
    if (!face)
        FAIL(err, ERROR_LIBRARY,
             "no DejaVuSans.ttf in the system's font folders (%s, ...): install the Debian package "
             "fonts-dejavu-core, or set AMONTONS_FONT to a .ttf file",
             FONT_FILES[0]);
    text->font = cairo_ft_font_face_create_for_ft_face(face, 0);
    if (cairo_font_face_set_user_data(text->font, &file, library, library_close)) {
        cairo_font_face_destroy(text->font);
        text->font = NULL;
        FAIL(err, ERROR_MEMORY, "no memory for a font");
    }
    library = NULL;   // the font's

    // Letters are not hinted: they keep their shape at print size, and are as wide in a PDF as in a
    // PNG.
    text->options = cairo_font_options_create();
    cairo_font_options_set_hint_style(text->options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(text->options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(text->options, CAIRO_ANTIALIAS_GRAY);
    return text;
cleanup:
    if (library) FT_Done_FreeType(library);
    text_destroy(text);
    return NULL;
}

void text_destroy(Text *text)
{
    if (!text) return;
    if (text->options) cairo_font_options_destroy(text->options);
    cairo_font_face_destroy(text->font);   // NULL is fine
    memory_free(text);
}

double text_digit_height(void)
{
    return DIGIT_HEIGHT;
}

// Draws, or only measures, the letters that wait.
static void run_end(Line *line, const Pen *pen)
{
    cairo_matrix_t matrix;
    cairo_text_extents_t extents;
    if (line->length == 0) return;
    line->run[line->length] = '\0';
    line->length = 0;
    cairo_matrix_init(&matrix, pen->size, 0, pen->slanted ? -SLANT * pen->size : 0, pen->size, 0,
                      0);
    cairo_set_font_matrix(line->cairo, &matrix);
    if (line->drawn) {
        cairo_move_to(line->cairo, line->along, -pen->baseline);
        cairo_show_text(line->cairo, line->run);
    }
    cairo_text_extents(line->cairo, line->run, &extents);
    line->along += extents.x_advance;
}

// Goes along the words, letter by letter, opening and closing marks.
static void line_walk(Line *line, double size, const char *words)
{
    Pen pen[NEST_MAX + 1] = {{.size = size}};
    int32_t depth = 0;
    while (*words) {
        bool opens = (*words == '_' || *words == '^' || *words == '~') && words[1] == '{';
        if (opens && depth < NEST_MAX) {
            run_end(line, &pen[depth]);
            // The pen inside a mark's braces.
            Pen inner = pen[depth];
            if (*words == '~') {
                inner.slanted = true;
            } else {
                inner.baseline += inner.size * (*words == '^' ? SCRIPT_RISE : -SCRIPT_DROP);
                inner.size *= SCRIPT_SIZE;
                inner.slanted = false;
                inner.raised = *words == '^';
            }
            pen[++depth] = inner;
            words += 2;
        } else if (*words == '}' && depth > 0) {
            run_end(line, &pen[depth--]);
            ++words;
        } else {
            size_t length = (size_t)text_utf8_length(words);
            bool minus = *words == '-' && pen[depth].raised;
            const char *letter = minus ? MINUS : length ? words : REPLACEMENT;
            size_t added = letter == words ? length : strlen(letter);
            if (line->length + added >= RUN_SIZE) run_end(line, &pen[depth]);
            memcpy(line->run + line->length, letter, added);
            line->length += added;
            words += length ? length : 1;
        }
    }
    run_end(line, &pen[depth]);
}

static void line_begin(Text *text, Line *line, Color color)
{
    line->cairo = canvas_ink(text->canvas, color);
    cairo_set_font_face(line->cairo, text->font);
    cairo_set_font_options(line->cairo, text->options);
}

// Width in the pixels of `size`, marks not counted.
double text_width(Text *text, double size, const char *words)
{
    Line line = {0};
    line_begin(text, &line, (Color){0, 0, 0, 1});
    line_walk(&line, size, words);
    return line.along;
}

// Placed by its measured width.
void text_draw(Text *text, const TextStyle *style, Point place, const char *words)
{
    double back = style->across * text_width(text, style->size, words);
    double down = style->up * style->size * DIGIT_HEIGHT;
    Line line = {.drawn = true};
    line_begin(text, &line, style->color);
    cairo_save(line.cairo);
    cairo_translate(line.cairo, round(place.x + (style->rising ? down : -back)),
                    round(place.y + (style->rising ? back : down)));
    if (style->rising) cairo_rotate(line.cairo, -PI / 2);
    line_walk(&line, style->size, words);
    cairo_restore(line.cairo);
}

void text_draw_within(Text *text, const TextStyle *style, Point place, double room,
                      const char *words)
{
    TextStyle fitting = *style;
    fitting.size *= fmin(1, room / text_width(text, style->size, words));
    text_draw(text, &fitting, place, words);
}
