// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a result, drawn off-screen from its stored history alone: `amontons render RESULT`
// redraws any of them without solving again; of curves that a file describes; and of a mesh before
// anything is computed. A module opened on first use (symbols "amontons_render",
// "amontons_render_plot", "amontons_render_mesh"); knows base/ and io/ only.
#ifndef AMONTONS_RENDER_RENDER_H
#define AMONTONS_RENDER_RENDER_H

#include "amontons_pictures.h"
#include "base/error.h"
#include "io/mesh_file.h"

// X(symbol, name, title)
#define RENDER_FIGURES(X)                                                                          \
    X(FIGURE_FORCE, "force", "F_T/F_N against U, with an inset of the precursors")                 \
    X(FIGURE_SLIP_MAP, "slip-map", "log10 of slip rate over V, against U and x")                   \
    X(FIGURE_CONTACT_DENSITY, "contact-density", "contact density before sliding, zoomed in U")    \
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

// A mesh to draw: arrays as in io/mesh_file, all borrowed.
typedef struct RenderMesh {
    const char *title, *note;   // two lines above the picture; NULL or empty: none
    int32_t node_count;
    const double *position;   // [node_count * 2] (x, z), length
    int32_t element_count;
    const uint8_t *kind;   // [element_count] ElementKind
    const int32_t *first_node;   // [element_count + 1] offsets into element_nodes
    const int32_t *element_nodes;
    int32_t group_count;
    const MeshGroup *groups;   // [group_count]; curves are drawn and named
    const char *unit;   // of lengths: "m" (drawn with a prefix), "~{L}_{0}"; NULL: not known
    double rod_low, rod_high;   // strip of the face x = least that the rod pushes, z; NaN: none
    PictureStyle style;   // but its format
} RenderMesh;

typedef bool (*RenderMeshFunction)(const RenderMesh *mesh, const char *path, Error *err);

// Draws `mesh` to scale into the file `path`, which ends in .png, .pdf or .svg.
bool amontons_render_mesh(const RenderMesh *mesh, const char *path, Error *err);

#endif
