// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a result, drawn off-screen from what is stored of it alone: `amontons render RESULT`
// redraws any of them without solving again; of curves that a file describes; and of a mesh before
// anything is computed. A module opened on first use, by the names of the functions below; it knows
// base/ and io/ only. From a result to pixels: render.c, figures/picture.c (its table KINDS names
// the function that draws each figure), view/ reads the history, canvas/ draws.
#ifndef AMONTONS_RENDER_RENDER_H
#define AMONTONS_RENDER_RENDER_H

#include "amontons_pictures.h"
#include "base/error.h"
#include "io/mesh/mesh_file.h"
#include "io/text/html_writer.h"

typedef bool (*RenderFunction)(const char *folder, const PictureRequest *request, Error *err);

// The module's entry: amontons_render_result. An unknown name is ERROR_INPUT and lists those that
// exist.
bool amontons_render(const char *folder, const PictureRequest *request, Error *err);

// amontons_render_plot_file.
typedef bool (*RenderPlotFunction)(const char *plot, const char *picture, const PictureStyle *style,
                                   Error *err);
bool amontons_render_plot(const char *plot, const char *picture, const PictureStyle *style,
                          Error *err);

// amontons_film.
typedef bool (*RenderFilmFunction)(const char *folder, const FilmRequest *request, Error *err);
bool amontons_render_film(const char *folder, const FilmRequest *request, Error *err);

// A mesh to draw: arrays as in io/mesh/mesh_file, all borrowed.
typedef struct RenderMesh {
    const char *title, *note;   // two lines above the picture; NULL or empty: none
    int32_t node_count;
    int32_t dim;
    const double *position;   // [node_count * dim] (x, z), in space (x, y, z), length
    int32_t element_count;
    const uint8_t *kind;   // [element_count] ElementKind
    const int32_t *first_node;   // [element_count + 1] offsets into element_nodes
    const int32_t *element_nodes;
    int32_t group_count;
    const MeshGroup *groups;   // [group_count]; curves are drawn and named, in space surfaces
    const char *unit;   // of lengths: "m" (drawn with a prefix), "~{L}_{0}"; NULL: not known
    double rod_low, rod_high;   // strip of the face x = least that the rod pushes, z; NaN: none
    PictureStyle style;   // but its format
} RenderMesh;

typedef bool (*RenderMeshFunction)(const RenderMesh *mesh, const char *path, Error *err);

// Draws `mesh` to scale into the file `path`, which ends in .png, .pdf or .svg.
bool amontons_render_mesh(const RenderMesh *mesh, const char *path, Error *err);

// --- inside of a page (page/) --------------------------------------------------------------------

// The figures that report.html has of a history (those with a `page_format` in figures/picture.c)
// as SVG, each in light and in dark, with a sentence below it. cycle: the one that figures of one
// cycle show, as `--cycle` has it; NULL: as they choose.
typedef bool (*RenderFiguresFunction)(const char *folder, const char *cycle, TextWriter *html,
                                      Error *err);
bool amontons_render_figures(const char *folder, const char *cycle, TextWriter *html, Error *err);

// The same of a plot that the file `name` inside of the result `folder` describes
// (plot_file_read_inside); `caption` is ours, without markup.
typedef bool (*RenderPlotHtmlFunction)(const char *folder, const char *name, const char *caption,
                                       TextWriter *html, Error *err);
bool amontons_render_plot_html(const char *folder, const char *name, const char *caption,
                               TextWriter *html, Error *err);

enum { RENDER_FRAMES_MAX = 40, RENDER_CURVES_MAX = 8 };

// Frames that amontons_render_frames found.
typedef struct RenderFrames {
    bool fields;   // frames show the block, at times that are stored; else steps of the history
    int32_t count, stored;   // frames, of so many there are
    double U[RENDER_FRAMES_MAX];   // [count] rod displacement of each, length
} RenderFrames;

// A row of <figure id='frame-1'> and so on, `count` of them.
typedef bool (*RenderFramesFunction)(const char *folder, TextWriter *html, RenderFrames *found,
                                     Error *err);
bool amontons_render_frames(const char *folder, TextWriter *html, RenderFrames *found, Error *err);

// Force curves of several histories over each other, with their names; of one that cannot be drawn
// the page says why. *drawn false: some are in SI and some are not.
typedef bool (*RenderCurvesFunction)(const char *const *folders, const char *const *names,
                                     int32_t count, TextWriter *html, bool *drawn, Error *err);
bool amontons_render_curves(const char *const *folders, const char *const *names, int32_t count,
                            TextWriter *html, bool *drawn, Error *err);

#endif
