// SPDX-License-Identifier: GPL-2.0-or-later
// A picture being drawn with Cairo, and its file: PNG, PDF or SVG, laid out alike. canvas, drawing
// and text are all that knows Cairo. Maps are images that OpenGL draws (gl_image), placed by Cairo.
//
// Positions are pixels of the PNG, (0, 0) the upper left corner of the picture, y downwards; whole
// numbers lie between pixels. Drawing calls return nothing: the first failure is kept and reported
// by canvas_write.
#ifndef AMONTONS_RENDER_CANVAS_CANVAS_H
#define AMONTONS_RENDER_CANVAS_CANVAS_H

#include "base/error.h"
#include "render/canvas/color.h"
#include "render/canvas/gl_image.h"

typedef struct Canvas Canvas;
typedef struct _cairo cairo_t;   // as cairo.h has it
typedef struct _cairo_surface cairo_surface_t;

typedef struct Point {
    double x, y;   // pixels
} Point;

typedef struct Box {
    double left, top, right, bottom;   // pixels
} Box;

// Values that the colour map has no colour for.
typedef enum HeatLevel {
    HEAT_MISSING = -2,   // no data: the background shows
    HEAT_BELOW = -1   // below the range: the neutral colour of canvas_set_below
} HeatLevel;

typedef enum CanvasFormat { CANVAS_PNG, CANVAS_PDF, CANVAS_SVG, CANVAS_FORMATS } CanvasFormat;

enum { CANVAS_SIZE_MIN = 200, CANVAS_SIZE_MAX = 8192 };

typedef struct CanvasDef {
    CanvasFormat format;
    int32_t width, height;   // pixels
    double dpi;   // pixels in a printed inch
    bool dark;   // light lines on dark paper: all colours but those of maps change their lightness
} CanvasDef;

// An empty page. ERROR_INPUT for a size outside CANVAS_SIZE_MIN to CANVAS_SIZE_MAX.
Canvas *canvas_create(const CanvasDef *def, Error *err);
void canvas_destroy(Canvas *canvas);   // NULL is fine
int32_t canvas_width(const Canvas *canvas);
int32_t canvas_height(const Canvas *canvas);
const char *canvas_ending(CanvasFormat format);   // "png", ...

// Cairo context that drawing and text use, with this colour set.
cairo_t *canvas_ink(Canvas *canvas, Color color);

// Clips all that is drawn later to `box`; NULL: nothing is clipped.
void canvas_clip(Canvas *canvas, const Box *box);

// The colour for HEAT_BELOW; all other values have those of the colour map (color.h). On dark paper
// its order is turned round: much is bright there.
void canvas_set_below(Canvas *canvas, Color below);

// Values in rows and columns, 0 to 1 through the colour map (larger: as 1), or a HeatLevel.
typedef struct HeatMap {
    int32_t columns, rows;
    const float *values;   // [rows * columns] first row at the top
} HeatMap;

// Fills `box` with them: columns equally wide, rows equally high, not blended into each other.
void canvas_heat(Canvas *canvas, const Box *box, const HeatMap *map);

// Triangles in `box`, whole pixels wide and high: three corners each, in pixels from its upper left
// corner; between the corners values are linear. Below 0 is drawn as 0. depth: as GlImageDef has
// it, NULL in a plane.
void canvas_heat_triangles(Canvas *canvas, const Box *box, const GlCorner *corners, int64_t count,
                           float *depth);

// Fills `box` with the colour of one value, or of HEAT_BELOW; a PDF or SVG has a shape, no image.
void canvas_heat_cell(Canvas *canvas, const Box *box, float value);
void canvas_heat_disc(Canvas *canvas, Point centre, double radius, float value);   // likewise
bool canvas_is_vector(const Canvas *canvas);   // PDF or SVG

// Returns the pixels that are drawn so far: four bytes each (blue, green, red, unused), first row
// at the top, *stride bytes from row to row. They hold until the next call that draws. NULL: an
// error. Only a CANVAS_PNG has pixels.
const uint8_t *canvas_pixels(Canvas *canvas, int32_t *stride, Error *err);

// All that is drawn on `from` so far, in place of what is on `canvas`: both CANVAS_PNG, equally
// large.
void canvas_copy(Canvas *canvas, Canvas *from);

// The finished picture, in memory that stays the canvas's.
typedef struct PictureBytes {
    const char *bytes;   // [size]
    int64_t size;
} PictureBytes;

// Finishes the picture, with `title` stored in it (SVG: not). small: a PNG of 256 colours at most,
// a third of the bytes. Reports what went wrong since canvas_create. Nothing can be drawn any more.
bool canvas_finish(Canvas *canvas, const char *title, bool small, PictureBytes *bytes, Error *err);

// The same as the file `path`; overwrite: as part_file_replace has it.
bool canvas_write(Canvas *canvas, const char *path, const char *title, bool overwrite, Error *err);

#endif
