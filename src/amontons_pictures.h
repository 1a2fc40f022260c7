// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a stored result, and of curves that a file describes; pages. Part of amontons.h.
#ifndef AMONTONS_PICTURES_H
#define AMONTONS_PICTURES_H

#include "amontons_error.h"

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Figures of a result: X(symbol, name, title). Names are those of `output.figures`.
#define PICTURE_FIGURES(X)                                                                         \
    X(FIGURE_FORCE, "force", "F_T/F_N against U, with an inset of the precursors")                 \
    X(FIGURE_SLIP_MAP, "slip-map", "log10 of slip rate over V, against U and x")                   \
    X(FIGURE_CONTACT_DENSITY, "contact-density", "contact density before sliding, zoomed in U")    \
    X(FIGURE_CONTACT_AREA, "contact-area", "area of the real contacts over that at rest")          \
    X(FIGURE_STATE_MAP, "state-map", "what friction remembers, against U and x")                   \
    X(FIGURE_CONTACT_PLANE, "contact-plane", "the contact of a block in space at chosen moments")  \
    X(FIGURE_PRECURSORS, "precursors", "how long slip is against F_T/F_N")                         \
    X(FIGURE_FRONT_SPEED, "front-speed", "how fast the front of a sliding runs, against x")        \
    X(FIGURE_PROBES, "probes", "what the probes of the scene saw, against U")                      \
    X(FIGURE_PADS, "pads", "which pad lets go first, against U")                                   \
    X(FIGURE_PROFILE, "profile", "pressure, friction, slip and gap along x at chosen moments")     \
    X(FIGURE_FIELD, "field", "a field of the block at one time")                                   \
    X(FIGURE_STRIP, "field-strip", "a field of the block in frames of one sliding")

// Other pictures than figures that take an option: none, films, or films and pages of a report.
enum { TAKEN_BY_FIGURES = 0, TAKEN_BY_FILMS = 1, TAKEN_BY_PAGES = 2 };

// The options by which a picture is drawn, in ONE table: those of `amontons render`, `film` and
// `report`, the keys of `page` in a plot file, what Python's functions take, and the members of
// PictureStyle.
// X(name, kind, least, most, figures that take it ("": all; "plot": a plot file), what else takes
// it, words that are allowed, argument, meaning)
#define PICTURE_OPTIONS(X)                                                                         \
    X(style, WORD, 0, 0, "", TAKEN_BY_FIGURES, "column columns slide poster", "NAME",              \
      "What it is for: column (86 mm, the default) or columns (178 mm) of a journal, with "        \
      "letters "                                                                                   \
      "of 8 pt; slide (254 mm) or poster (400 mm), with letters and lines two and three times as " \
      "large")                                                                                     \
    X(width, NUMBER, 20, 1000, "", TAKEN_BY_FIGURES, "", "MM",                                     \
      "Of the page in print, in the place of the style's")                                         \
    X(height, NUMBER, 20, 1000, "", TAKEN_BY_FIGURES, "", "MM",                                    \
      "Of the page in print; by default as the figure asks")                                       \
    X(dpi, NUMBER, 50, 2400, "", TAKEN_BY_FIGURES, "", "N",                                        \
      "Dots per inch, of a PNG and of maps; 600 by default, of a slide 200, of a poster 300")      \
    X(title, TEXT, 0, 0, "", TAKEN_BY_FILMS, "", "WORDS",                                          \
      "Words above it; `scene`: the title of what is shown, which a film has by default; `none`")  \
    X(inset, WORD, 0, 0, "force", TAKEN_BY_FIGURES, "above none", "WHERE",                         \
      "What force enlarges: above (the default) or none")                                          \
    X(legend, WORD, 0, 0, "", TAKEN_BY_FIGURES, "below none", "WHERE",                             \
      "What the marks mean: below (the default) or none")                                          \
    X(limits, RANGE, 0, 0, "slip-map contact-area state-map contact-plane field field-strip plot", \
      TAKEN_BY_FIGURES, "", "LOW,HIGH",                                                            \
      "Ends of the colours, in the numbers shown; or percents of what is shown, as in 1%,99%")     \
    X(from, TEXT, 0, 0, "force slip-map contact-area state-map probes", TAKEN_BY_FILMS, "", "U=U", \
      "Where a film, force, slip-map, contact-area, state-map or probes begins; or t=TIME")        \
    X(to, TEXT, 0, 0, "force slip-map contact-area state-map probes", TAKEN_BY_FILMS, "", "U=U",   \
      "Where it ends; or t=TIME")                                                                  \
    X(cycle, TEXT, 0, 0,                                                                           \
      "force slip-map contact-density contact-area state-map contact-plane precursors "            \
      "front-speed pads field field-strip",                                                        \
      TAKEN_BY_PAGES, "", "first|last|N|all",                                                      \
      "Which cycle is shown, from one sliding to the next: first (the first loading), last, its "  \
      "number, or all; by default one with precursors, and in a run of one or two slidings the "   \
      "first; of a film all")                                                                      \
    X(pixels, WORD, 0, 0, "slip-map state-map", TAKEN_BY_FIGURES, "largest mean", "WHAT",          \
      "What of the slip rates in a pixel slip-map shows: the largest (the default) or the mean; "  \
      "of states state-map shows the smallest, or the largest where that is asked for")            \
    X(line, TEXT, 0, 0,                                                                            \
      "force slip-map contact-density contact-area state-map precursors front-speed profile",      \
      TAKEN_BY_FIGURES, "", "y=Y",                                                                 \
      "Of a block in space: the line along the drive that is shown against U; by default in the "  \
      "middle")                                                                                    \
    X(compare, TEXT, 0, 0,                                                                         \
      "force slip-map contact-density contact-area precursors front-speed probes plot",            \
      TAKEN_BY_FIGURES, "", "FILE.csv", "Measurements to draw beside what was computed")           \
    X(depth, NUMBER, 1e-12, 1e12, "field field-strip", TAKEN_BY_FILMS, "", "LENGTH",               \
      "Of a base that deforms: how far below its floor it is drawn; by default all of it")         \
    X(warnings, WORD, 0, 0, "", TAKEN_BY_FIGURES, "below none", "WHERE",                           \
      "What the run was warned of: below (the default) or none; run.json has it in any case")

// Style of the printed page; zeroed is fine. Letters and lines keep their size, whatever the width.
typedef struct PictureStyle {
    const char *format;   // "png", "pdf", "svg"; NULL: png
    double width;   // mm; 0: the style's, 86, the column of a journal
    double dpi;   // dots per inch, of a PNG and of maps in the others; 0: 600, or the style's
    bool dark;   // light lines on dark paper
    bool overwrite;   // what is there goes; else it is refused, if no list has it
    double height;   // mm; 0: as the figure asks
    double depth;   // how far below its floor a base is drawn, length; 0: all of it
    // The options of PICTURE_OPTIONS; NULL: the default.
    const char *style, *title, *inset, *legend, *limits, *from, *to, *cycle, *pixels, *line,
        *compare, *warnings;
} PictureStyle;

// Sets an option of PICTURE_OPTIONS; `value` stays the caller's, who keeps it as long as the style.
// ERROR_INPUT says what is allowed.
bool amontons_picture_option(PictureStyle *style, const char *name, const char *value, Error *err);

// Which figures take each member of FieldChoice.
#define FIELD_OPTIONS(X)                                                                           \
    X(of, "contact-plane field field-strip probes")                                                \
    X(at, "contact-plane field field-strip profile")                                               \
    X(edges, "field field-strip")                                                                  \
    X(cut, "field field-strip")

// Choice of what the figures of the block show; zeroed is fine.
typedef struct FieldChoice {
    const char *of;   // "von_mises", "stress_xx", ...; NULL: von_mises
    const char *at;   // "U=0.0117" or "t=120": the nearest time that is stored; NULL: the last one
        // before the last sliding
    bool edges;   // of elements are drawn
    const char *cut;   // of a block in space: "y=0.25", up to three with commas between: what lies
        // before all these planes is taken away; NULL: none
} FieldChoice;

typedef struct PictureRequest {
    const char *const *figures;   // [figure_count] names, as output.figures has them; 0: all; one
        // name `measured`: those that show what style.compare has measured, and figures/misfit.csv
    int32_t figure_count;
    PictureStyle style;
    FieldChoice field;
    const char
        *panels;   // "force,slip-map,contact-density": these below each other, as panels.png,
    // in the place of `figures`; NULL: none
} PictureRequest;

// Draws figures of the result in `folder` into folder/figures/NAME.png (.pdf, .svg). NULL: all.
bool amontons_render_result(const char *folder, const PictureRequest *request, Error *err);

// Draws each figure that shows what the table `measured` (.csv) has beside the result in `folder`,
// and writes their misfits into folder/figures/misfit.csv and, a line each, into words [size].
// style NULL is fine; its `compare` is not asked.
bool amontons_compare(const char *folder, const char *measured, const PictureStyle *style,
                      char *words, int32_t size, Error *err);

// Draws the curves that the YAML file `plot` describes (render/plot/plot_file.h) into the file
// `picture`, whose name ends in .png, .pdf or .svg: style->format is not asked. NULL is fine.
bool amontons_render_plot_file(const char *plot, const char *picture, const PictureStyle *style,
                               Error *err);

// Draws pictures of the sweep in `folder` into folder/figures: the one that `plot` describes in the
// words of a study's `plot`, as in "{x: load.pressure, y: mu_M}"; NULL: those of its study again.
bool amontons_render_sweep(const char *folder, const char *plot, const PictureStyle *style,
                           Error *err);

// Writes one page about results (count folders) into `file`, an .html that needs nothing else: of a
// run, of a sweep, or of several runs side by side. style: of the options that pages take, `cycle`
// is for the page of one run; overwrite: what is there goes, else it is refused, if the list of its
// folder (amontons.files) does not have it. NULL is fine.
bool amontons_report(const char *const *results, int32_t count, const char *file,
                     const PictureStyle *style, Error *err);

// Called after each frame of a film that is drawn, `frame` from 1.
typedef void (*FrameCallback)(int32_t frame, int32_t frames, void *context);

// A film of a result; zeroed but for its path is fine.
typedef struct FilmRequest {
    const char *path;   // ends in .mp4, .webm or .gif; or a folder of PNG frames, or their names
        // with one number: "run-%04d.png"
    double seconds;   // 0: 20
    int32_t rate;   // frames a second; 0: 30, of a GIF 20
    int32_t width, height;   // pixels, even; 0: 1920 and 1080, of a GIF 800 and 450
    PictureStyle style;   // of the options that films take; dark, overwrite; format is not asked
    const char *of;   // field of the block, as FieldChoice has it; or a state of friction
    double magnification;   // of the deformation; 0: chosen
    FrameCallback on_frame;   // NULL: none
    void *context;   // handed to it
    const volatile sig_atomic_t *stop;   // non-zero: ERROR_INTERRUPT, and no file; NULL: never
    double *still;   // out: longest time in s for which one stored field stands; 0: there are none;
        // NULL: not asked
} FilmRequest;

// Films the result in `folder`: the block where fields are stored, slip rate along the contact, the
// force. Time goes slower where slip is rapid. The file has its name once it is whole.
bool amontons_film(const char *folder, const FilmRequest *request, Error *err);

#ifdef __cplusplus
}
#endif

#endif
