// SPDX-License-Identifier: GPL-2.0-or-later
// A picture being drawn with OpenGL 3.3 core: triangles of three kinds, antialiased by
// multisampling. Shapes, text and heat maps are made of these; nothing else calls OpenGL.
//
// Positions are pixels, (0, 0) the upper left corner of the picture, y downwards; whole numbers
// lie between pixels. Drawing calls return nothing: the first failure is kept and reported by
// canvas_read. A context must be current.
#ifndef AMONTONS_RENDER_CANVAS_H
#define AMONTONS_RENDER_CANVAS_H

#include "base/error.h"

typedef struct Canvas Canvas;

typedef struct Point {
    double x, y;   // pixels
} Point;

typedef struct Box {
    double left, top, right, bottom;   // pixels
} Box;

typedef struct Color {
    float red, green, blue, alpha;   // sRGB, 0 to 1
} Color;

typedef struct Vertex {
    float x, y;   // pixels
    float u, v;   // texture coordinates, texels of the glyph sheet or 0 to 1
    Color color;
} Vertex;

// What a triangle's colour is made of.
typedef enum PaintKind {
    PAINT_COLOR,   // its vertices' colours
    PAINT_GLYPH,   // the same, alpha times the glyph sheet
    PAINT_HEAT   // a value of the heat texture, through the colour map
} PaintKind;

// Texels that show no value of the colour map.
typedef enum HeatLevel {
    HEAT_MISSING = -2,   // no data: the background shows
    HEAT_BELOW = -1   // below the range: the neutral colour of canvas_set_map
} HeatLevel;

enum { CANVAS_SIZE_MIN = 200, CANVAS_SIZE_MAX = 8192, MAP_SIZE = 256, GLYPH_SHEET_SIZE = 1024 };

// A white picture. ERROR_INPUT for a size outside CANVAS_SIZE_MIN to CANVAS_SIZE_MAX.
Canvas *canvas_create(int32_t width, int32_t height, Error *err);
void canvas_destroy(Canvas *canvas);   // NULL is fine
int32_t canvas_width(const Canvas *canvas);
int32_t canvas_height(const Canvas *canvas);

// From here on only what lies in `box` is drawn; NULL: everywhere.
void canvas_clip(Canvas *canvas, const Box *box);

// [count] vertices, three a triangle, drawn after all earlier ones.
void canvas_triangles(Canvas *canvas, PaintKind kind, const Vertex *vertices, int64_t count);

// The glyph sheet: GLYPH_SHEET_SIZE squared coverages, a byte each. Glyphs are drawn from what
// the sheet holds when their batch is drawn, so it may only grow.
void canvas_set_glyphs(Canvas *canvas, const uint8_t *sheet);

// Colours of PAINT_HEAT: [MAP_SIZE * 3] bytes from value 0 to value 1, and the one for HEAT_BELOW.
void canvas_set_map(Canvas *canvas, const uint8_t *colors, Color below);

// Fills `box` with [rows * columns] values, the first row at the top: 0 to 1 through the colour
// map (larger: as 1), or a HeatLevel. Texels are not blended into each other.
void canvas_heat(Canvas *canvas, const Box *box, const float *values, int32_t columns,
                 int32_t rows);

// Where drawing code leaves what went wrong; the first one stays.
Error *canvas_failure(Canvas *canvas);

// Finishes the picture: *pixels [height * width * 3] bytes, first row at the top, owned by the
// caller (memory_free). Reports what went wrong since canvas_create.
bool canvas_read(Canvas *canvas, uint8_t **pixels, Error *err);

#endif
