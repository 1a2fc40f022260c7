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

// Of the printed page; zeroed is fine. Letters and lines keep their size, whatever the width.
typedef struct PictureStyle {
    const char *format;   // "png", "pdf", "svg"; NULL: png
    double width;   // mm; 0: 86, the column of a journal
    double dpi;   // dots per inch, of a PNG and of maps in the others; 0: 508
    bool dark;   // light lines on dark paper
    bool overwrite;   // a file that is there and is not ours goes; else it is refused
} PictureStyle;

// What the figures of the block show; zeroed is fine.
typedef struct FieldChoice {
    const char *of;   // "von_mises", "stress_xx", ...; NULL: von_mises
    const char *at;   // "U=0.0117" or "t=120": the nearest time that is stored; NULL: the last one
        // before the last sliding
    bool edges;   // of elements are drawn
} FieldChoice;

typedef struct PictureRequest {
    const char *const *figures;   // [figure_count] names, as output.figures has them; 0: all
    int32_t figure_count;
    PictureStyle style;
    FieldChoice field;
} PictureRequest;

// Draws figures of the result in `folder` into folder/figures/NAME.png (.pdf, .svg). NULL: all.
bool amontons_render_result(const char *folder, const PictureRequest *request, Error *err);

// Draws the curves that the YAML file `plot` describes (render/plot/plot_file.h) into the file
// `picture`, whose name ends in .png, .pdf or .svg: style->format is not asked. NULL is fine.
bool amontons_render_plot_file(const char *plot, const char *picture, const PictureStyle *style,
                               Error *err);

// Draws pictures of the sweep in `folder` into folder/figures: the one that `plot` describes in the
// words of a study's `plot`, as in "{x: load.pressure, y: mu_M}"; NULL: those of its study again.
bool amontons_render_sweep(const char *folder, const char *plot, const PictureStyle *style,
                           Error *err);

// Writes one page about results (count folders) into `file`, an .html that needs nothing else: of a
// run, of a sweep, or of several runs side by side. overwrite: a file that is there and is not ours
// goes; else it is refused.
bool amontons_report(const char *const *results, int32_t count, const char *file, bool overwrite,
                     Error *err);

// Called after each frame of a film that is drawn, `frame` from 1.
typedef void (*FrameCallback)(int32_t frame, int32_t frames, void *context);

// A film of a result; zeroed but for its path is fine.
typedef struct FilmRequest {
    const char *path;   // ends in .mp4, .webm or .gif; or a folder of PNG frames, or their names
        // with one number: "run-%04d.png"
    double seconds;   // 0: 20
    int32_t rate;   // frames a second; 0: 30, of a GIF 20
    int32_t width, height;   // pixels, even; 0: 1920 and 1080, of a GIF 800 and 450
    const char *begin, *end;   // "U=0.0117" or "t=120"; NULL: those of the history
    bool last_cycle;   // from the end of a bulk sliding to a little after the next, the last
    const char *of;   // field of the block, as FieldChoice has it; without fields not asked
    double magnification;   // of the deformation; 0: chosen
    bool dark;   // light lines on dark paper
    bool overwrite;   // a file that is there and is not ours goes; else it is refused
    FrameCallback on_frame;   // NULL: none
    void *context;   // handed to it
    const volatile sig_atomic_t *stop;   // non-zero: ERROR_INTERRUPT, and no file; NULL: never
} FilmRequest;

// Films the result in `folder`: the block where fields are stored, slip rate along the contact, the
// force. Time goes slower where slip is rapid. The file has its name once it is whole.
bool amontons_film(const char *folder, const FilmRequest *request, Error *err);

#ifdef __cplusplus
}
#endif

#endif
