// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a result, drawn off-screen from its stored history alone: `amontons render RESULT`
// redraws any of them without solving again; of curves that a file describes; and of a mesh before
// anything is computed. A module opened on first use (symbols "amontons_render",
// "amontons_render_plot", "amontons_render_film", "amontons_render_mesh"); knows
// base/ and io/ only.
#ifndef AMONTONS_RENDER_RENDER_H
#define AMONTONS_RENDER_RENDER_H

#include "amontons_pictures.h"
#include "base/error.h"
#include "io/mesh/mesh_file.h"
#include "io/text/html_writer.h"

// Quantities that `field` may show: X(symbol, name, words, unit in SI, unit in normalised scenes).
// Stresses hold the viscous part.
#define BLOCK_QUANTITIES(X)                                                                        \
    X(BLOCK_VON_MISES, "von_mises", "von Mises stress", "Pa", "~{E}")                              \
    X(BLOCK_STRESS_XX, "stress_xx", "stress ~{\u03c3}_{xx}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_YY, "stress_yy", "stress ~{\u03c3}_{yy}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_ZZ, "stress_zz", "stress ~{\u03c3}_{zz}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_XZ, "stress_xz", "stress ~{\u03c3}_{xz}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_XY, "stress_xy", "stress ~{\u03c3}_{xy}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_YZ, "stress_yz", "stress ~{\u03c3}_{yz}", "Pa", "~{E}")                         \
    X(BLOCK_PRESSURE, "pressure", "pressure \u2212(~{\u03c3}_{xx} + ~{\u03c3}_{zz})/2", "Pa",      \
      "~{E}")                                                                                      \
    X(BLOCK_VELOCITY, "velocity", "velocity |~{v}|", "m/s", "(~{L}_{0} / ~{t}_{0})")               \
    X(BLOCK_DISPLACEMENT, "displacement", "displacement |~{u}|", "m", "~{L}_{0}")                  \
    X(BLOCK_ENERGY, "strain_energy", "strain energy density", "J/m^{3}", "~{E}")                   \
    X(BLOCK_DISSIPATION, "dissipation", "dissipation rate", "W/m^{3}", "(~{E} / ~{t}_{0})")

// Quantities that `contact-plane` may show, in the same way; a state also by its own name.
#define CONTACT_QUANTITIES(X)                                                                      \
    X(CONTACT_SLIP_RATE, "slip_rate", "slip rate", "m/s", "(~{L}_{0} / ~{t}_{0})")                 \
    X(CONTACT_DENSITY, "contact_density", "contact density ~{\u03c6}", "", "")                     \
    X(CONTACT_PRESSURE, "pressure", "pressure ~{p}", "Pa", "~{E}")                                 \
    X(CONTACT_SHEAR, "shear", "shear stress |~{\u03c4}|", "Pa", "~{E}")                            \
    X(CONTACT_RATIO, "shear_over_pressure", "|~{\u03c4}| / ~{p}", "", "")                          \
    X(CONTACT_SLIP, "slip", "slip since (a)", "m", "~{L}_{0}")                                     \
    X(CONTACT_STATE, "state", "", "", "")                                                          \
    X(CONTACT_ARRIVAL, "arrival", "arrival of rapid slip", "s", "~{t}_{0}")

// X(symbol, name, title)
#define RENDER_FIGURES(X)                                                                          \
    X(FIGURE_FORCE, "force", "F_T/F_N against U, with an inset of the precursors")                 \
    X(FIGURE_SLIP_MAP, "slip-map", "log10 of slip rate over V, against U and x")                   \
    X(FIGURE_CONTACT_DENSITY, "contact-density", "contact density before sliding, zoomed in U")    \
    X(FIGURE_STATE_MAP, "state-map", "what friction remembers, against U and x")                   \
    X(FIGURE_CONTACT_PLANE, "contact-plane", "the contact of a block in space at chosen moments")  \
    X(FIGURE_PRECURSORS, "precursors", "how long slip is against F_T/F_N")                         \
    X(FIGURE_FRONT_SPEED, "front-speed", "how fast the front of a sliding runs, against x")        \
    X(FIGURE_FIELD, "field", "a field of the block at one time")                                   \
    X(FIGURE_STRIP, "field-strip", "a field of the block in frames of one sliding")

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
// Part of a result that the film shows: from one place of the drive to another, length, in so many
// frames.
typedef struct FilmPart {
    double from_U, to_U;
    int32_t frames;
} FilmPart;
typedef bool (*RenderFilmPartFunction)(const char *folder, const FilmRequest *request,
                                       FilmPart *part, Error *err);
bool amontons_render_film_part(const char *folder, const FilmRequest *request, FilmPart *part,
                               Error *err);

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

// The three figures of a history as SVG, each in light and in dark, with what they show below them.
typedef bool (*RenderFiguresFunction)(const char *folder, HtmlWriter *html, Error *err);
bool amontons_render_figures(const char *folder, HtmlWriter *html, Error *err);

// The same of a plot that a file describes; `caption` is ours, without markup.
typedef bool (*RenderPlotHtmlFunction)(const char *plot, const char *caption, HtmlWriter *html,
                                       Error *err);
bool amontons_render_plot_html(const char *plot, const char *caption, HtmlWriter *html, Error *err);

enum { RENDER_FRAMES_MAX = 40, RENDER_CURVES_MAX = 8 };

// Frames that amontons_render_frames found.
typedef struct RenderFrames {
    bool fields;   // frames show the block, at times that are stored; else steps of the history
    int32_t count, stored;   // frames, of so many there are
    double U[RENDER_FRAMES_MAX];   // [count] rod displacement of each, length
} RenderFrames;

// A row of <figure id='frame-1'> and so on, `count` of them.
typedef bool (*RenderFramesFunction)(const char *folder, HtmlWriter *html, RenderFrames *found,
                                     Error *err);
bool amontons_render_frames(const char *folder, HtmlWriter *html, RenderFrames *found, Error *err);

// Force curves of several histories over each other, with their names; of one that cannot be drawn
// the page says why. *drawn false: some are in SI and some are not.
typedef bool (*RenderCurvesFunction)(const char *const *folders, const char *const *names,
                                     int32_t count, HtmlWriter *html, bool *drawn, Error *err);
bool amontons_render_curves(const char *const *folders, const char *const *names, int32_t count,
                            HtmlWriter *html, bool *drawn, Error *err);

#endif
