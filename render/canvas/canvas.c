// SPDX-License-Identifier: GPL-2.0-or-later
// A Cairo surface: an image for PNG, else PDF or SVG into memory, in points, scaled so that all
// three are drawn in the same pixels. Same picture, same bytes: no date is stored.
#include "render/canvas/canvas.h"

#include "base/memory.h"
#include "io/files/part_file.h"
#include "render/canvas/png_encode.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS_AN_INCH = 72 };

struct Canvas {
    CanvasDef def;
    uint8_t *pixels;   // [4 * width * height] of a PNG; owned
    cairo_surface_t *surface;   // owned
    cairo_t *cairo;   // owned
    uint32_t map[MAP_SIZE], below;   // as Cairo stores pixels: alpha, red, green, blue
    FILE *out;   // the file, in memory; owned
    char *bytes;   // [size] of it so far, as libc allocates it; owned
    size_t size;
    Error failure;   // the first one
};

const char *canvas_ending(CanvasFormat format)
{
    static const char *const ending[CANVAS_FORMATS] = {"png", "pdf", "svg"};
    return ending[format];
}

// --- begin ---------------------------------------------------------------------------------------

static cairo_status_t bytes_write(void *out, const unsigned char *bytes, unsigned int length)
{
    return fwrite(bytes, 1, length, out) == length ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_NO_MEMORY;
}

Canvas *canvas_create(const CanvasDef *def, Error *err)
{
    static const Color paper = {1, 1, 1, 1};
    Canvas *canvas = NULL;
    if (def->width < CANVAS_SIZE_MIN || def->width > CANVAS_SIZE_MAX ||
        def->height < CANVAS_SIZE_MIN || def->height > CANVAS_SIZE_MAX)
        FAIL(err, ERROR_INPUT, "a picture of %d by %d pixels: each must be from %d to %d",
             def->width, def->height, CANVAS_SIZE_MIN, CANVAS_SIZE_MAX);
    TRY(canvas = NEW_ARRAY(Canvas, 1, err));
    canvas->def = *def;
    if (def->format == CANVAS_PNG)
        TRY(canvas->pixels = memory_bytes(4 * (int64_t)def->width * def->height, err));
    if (!(canvas->out = open_memstream(&canvas->bytes, &canvas->size)))
        FAIL(err, ERROR_MEMORY, "no memory for a picture");
    double points = POINTS_AN_INCH / def->dpi, width = def->width * points;
    double height = def->height * points;
    if (def->format == CANVAS_PDF) {
        canvas->surface =
            cairo_pdf_surface_create_for_stream(bytes_write, canvas->out, width, height);
    } else if (def->format == CANVAS_SVG) {
        canvas->surface =
            cairo_svg_surface_create_for_stream(bytes_write, canvas->out, width, height);
        cairo_svg_surface_set_document_unit(canvas->surface, CAIRO_SVG_UNIT_PT);
    } else {
        canvas->surface = cairo_image_surface_create_for_data(
            canvas->pixels, CAIRO_FORMAT_RGB24, def->width, def->height, 4 * def->width);
    }
    if (canvas_is_vector(canvas)) cairo_surface_set_device_scale(canvas->surface, points, points);
    canvas->cairo = cairo_create(canvas->surface);
    cairo_status_t status = cairo_status(canvas->cairo);
    if (status)
        FAIL(err, status == CAIRO_STATUS_NO_MEMORY ? ERROR_MEMORY : ERROR_LIBRARY,
             "Cairo gives no page of %d by %d pixels: %s", def->width, def->height,
             cairo_status_to_string(status));
    canvas_ink(canvas, paper);
    cairo_paint(canvas->cairo);
    return canvas;
cleanup:
    canvas_destroy(canvas);
    return NULL;
}

void canvas_destroy(Canvas *canvas)
{
    if (!canvas) return;
    cairo_destroy(canvas->cairo);   // NULL is fine, here and below
    cairo_surface_destroy(canvas->surface);
    if (canvas->out) fclose(canvas->out);
    free(canvas->bytes);
    memory_free_all(canvas->pixels, canvas);
}

int32_t canvas_width(const Canvas *canvas)
{
    return canvas->def.width;
}

int32_t canvas_height(const Canvas *canvas)
{
    return canvas->def.height;
}

// --- drawing -------------------------------------------------------------------------------------

cairo_t *canvas_ink(Canvas *canvas, Color color)
{
    if (canvas->def.dark) color = color_on_dark(color);
    cairo_set_source_rgba(canvas->cairo, (double)color.red, (double)color.green, (double)color.blue,
                          (double)color.alpha);
    cairo_new_path(canvas->cairo);   // text leaves a point, from which the next shape would begin
    return canvas->cairo;
}

// Whole pixels.
void canvas_clip(Canvas *canvas, const Box *box)
{
    cairo_reset_clip(canvas->cairo);
    if (!box) return;
    double left = round(box->left), top = round(box->top);
    cairo_rectangle(canvas->cairo, left, top, fmax(round(box->right) - left, 0),
                    fmax(round(box->bottom) - top, 0));
    cairo_clip(canvas->cairo);
}

static uint32_t opaque_pixel(uint8_t red, uint8_t green, uint8_t blue)
{
    return 0xff000000u | (uint32_t)red << 16 | (uint32_t)green << 8 | blue;
}

static void map_fill(Canvas *canvas)
{
    uint8_t colors[3 * MAP_SIZE];
    color_map_fill(colors);
    for (int32_t k = 0; k < MAP_SIZE; ++k) {
        const uint8_t *color = colors + 3 * (canvas->def.dark ? MAP_SIZE - 1 - k : k);
        canvas->map[k] = opaque_pixel(color[0], color[1], color[2]);
    }
}

void canvas_set_below(Canvas *canvas, Color below)
{
    if (canvas->def.dark) below = color_on_dark(below);
    canvas->below = opaque_pixel((uint8_t)lroundf(255 * below.red),
                                 (uint8_t)lroundf(255 * below.green),
                                 (uint8_t)lroundf(255 * below.blue));
}

// OpenGL draws an image of its own, which Cairo places.
static void draw_pixels(Canvas *canvas, const Box *box, const GlImageDef *wanted)
{
    enum { SIDE_MAX = 32767 };   // of Cairo's images
    GlImageDef def = *wanted;
    Error *err = &canvas->failure;
    cairo_t *cairo = canvas->cairo;
    cairo_surface_t *image = NULL;
    if (def.width > SIDE_MAX || def.height > SIDE_MAX)
        FAIL(err, ERROR_LIBRARY, "a map of %d by %d values: an image has at most %d a side",
             def.width, def.height, (int)SIDE_MAX);
    if (!canvas->map[0]) map_fill(canvas);   // opaque pixels are not 0
    def.colors = canvas->map;
    def.color_count = MAP_SIZE;
    def.below = canvas->below;

    // An image that covers all of its box needs no second image of where it does.
    bool opaque = def.values != NULL;
    for (int64_t k = 0; opaque && k < (int64_t)def.rows * def.columns; ++k)
        opaque = def.values[k] > (float)HEAT_MISSING;
    image = cairo_image_surface_create(opaque ? CAIRO_FORMAT_RGB24 : CAIRO_FORMAT_ARGB32, def.width,
                                       def.height);
    if (cairo_surface_status(image))
        FAIL(err, ERROR_LIBRARY, "a map of %d by %d values: %s", def.width, def.height,
             cairo_status_to_string(cairo_surface_status(image)));
    def.stride = cairo_image_surface_get_stride(image) / (int32_t)sizeof(uint32_t);
    TRY(gl_image_draw(GL_OSMESA, &def, (uint32_t *)(void *)cairo_image_surface_get_data(image),
                      err));
    cairo_surface_mark_dirty(image);

    // Exact pixels: no filter, and no edge that mixes with the paper.
    double width = box->right - box->left, height = box->bottom - box->top;
    cairo_save(cairo);
    cairo_rectangle(cairo, box->left, box->top, width, height);
    cairo_translate(cairo, box->left, box->top);
    cairo_scale(cairo, width / def.width, height / def.height);
    cairo_set_source_surface(cairo, image, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
    if (!canvas_is_vector(canvas))   // there Cairo would make a second, padded image
        cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
    cairo_fill(cairo);
    cairo_restore(cairo);
cleanup:
    cairo_surface_destroy(image);
}

// Nothing is interpolated: a colour shows a number that was computed, never a mixture.
void canvas_heat(Canvas *canvas, const Box *box, const HeatMap *map)
{
    draw_pixels(canvas, box,
                &(GlImageDef){.width = map->columns,
                              .height = map->rows,
                              .values = map->values,
                              .columns = map->columns,
                              .rows = map->rows});
}

void canvas_heat_triangles(Canvas *canvas, const Box *box, const GlCorner *corners, int64_t count,
                           float *depth)
{
    draw_pixels(canvas, box,
                &(GlImageDef){.width = (int32_t)lround(box->right - box->left),
                              .height = (int32_t)lround(box->bottom - box->top),
                              .corners = corners,
                              .corner_count = count,
                              .depth = depth});
}

bool canvas_is_vector(const Canvas *canvas)
{
    return canvas->def.format != CANVAS_PNG;
}

// The colour of a value, from 0 to 1; below 0: HEAT_BELOW.
static cairo_t *heat_ink(Canvas *canvas, float value)
{
    int32_t entry = (int32_t)lroundf(fminf(fmaxf(value, 0), 1) * (MAP_SIZE - 1));
    if (!canvas->map[0]) map_fill(canvas);
    uint32_t pixel = value < 0 ? canvas->below : canvas->map[entry];
    cairo_set_source_rgb(canvas->cairo, (pixel >> 16 & 255) / 255.0, (pixel >> 8 & 255) / 255.0,
                         (pixel & 255) / 255.0);
    cairo_new_path(canvas->cairo);
    return canvas->cairo;
}

// A cell is drawn in a PDF or SVG a little larger than asked: viewers leave a hair of paper between
// shapes that only touch.
void canvas_heat_cell(Canvas *canvas, const Box *box, float value)
{
    static const double over = 0.04;   // points
    double more = canvas_is_vector(canvas) ? over * canvas->def.dpi / POINTS_AN_INCH : 0;
    cairo_t *cairo = heat_ink(canvas, value);
    cairo_rectangle(cairo, box->left, box->top, box->right - box->left + more,
                    box->bottom - box->top + more);
    cairo_fill(cairo);
}

void canvas_heat_disc(Canvas *canvas, Point centre, double radius, float value)
{
    cairo_t *cairo = heat_ink(canvas, value);
    cairo_arc(cairo, centre.x, centre.y, radius, 0, 8 * atan(1));
    cairo_fill(cairo);
}

// --- end -----------------------------------------------------------------------------------------

// Reports the error of the drawing code, or else that of Cairo.
static bool canvas_check(Canvas *canvas, Error *err)
{
    cairo_status_t status = cairo_status(canvas->cairo);
    if (!status) status = cairo_surface_status(canvas->surface);   // of the bytes written
    if (!error_is_clean(&canvas->failure)) {
        *err = canvas->failure;
        return false;
    }
    if (status)
        return FAULT(err, status == CAIRO_STATUS_NO_MEMORY ? ERROR_MEMORY : ERROR_LIBRARY,
                     "Cairo cannot draw: %s", cairo_status_to_string(status));
    return true;
}

const uint8_t *canvas_pixels(Canvas *canvas, int32_t *stride, Error *err)
{
    if (!canvas_check(canvas, err)) return NULL;
    cairo_surface_flush(canvas->surface);
    *stride = cairo_image_surface_get_stride(canvas->surface);
    return cairo_image_surface_get_data(canvas->surface);
}

void canvas_copy(Canvas *canvas, Canvas *from)
{
    size_t line = (size_t)cairo_image_surface_get_stride(from->surface);
    cairo_surface_flush(from->surface);
    cairo_surface_flush(canvas->surface);
    memcpy(cairo_image_surface_get_data(canvas->surface),
           cairo_image_surface_get_data(from->surface), line * (size_t)from->def.height);
    cairo_surface_mark_dirty(canvas->surface);
}

bool canvas_finish(Canvas *canvas, const char *title, bool small, PictureBytes *bytes, Error *err)
{
    if (canvas->def.format == CANVAS_PDF) {
        cairo_pdf_surface_set_metadata(canvas->surface, CAIRO_PDF_METADATA_TITLE, title);
        cairo_pdf_surface_set_metadata(canvas->surface, CAIRO_PDF_METADATA_CREATOR,
                                       "amontons " AMONTONS_VERSION);
        cairo_pdf_surface_set_metadata(canvas->surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
    }
    cairo_surface_flush(canvas->surface);
    if (canvas->def.format == CANVAS_PNG) {
        PngPicture picture = {.width = canvas->def.width,
                              .height = canvas->def.height,
                              .stride = cairo_image_surface_get_stride(canvas->surface),
                              .pixels = cairo_image_surface_get_data(canvas->surface),
                              .pixels_per_metre = canvas->def.dpi / 0.0254,
                              .title = title,
                              .few_colors = small};
        png_encode(&picture, canvas->out, &canvas->failure);
    }
    cairo_surface_finish(canvas->surface);   // the last of the bytes
    if (fflush(canvas->out) != 0 && error_is_clean(&canvas->failure))
        error_set(&canvas->failure, ERROR_MEMORY, __FILE__, __LINE__, "no memory for a picture");
    *bytes = (PictureBytes){canvas->bytes, (int64_t)canvas->size};
    return canvas_check(canvas, err);
}

bool canvas_write(Canvas *canvas, const char *path, const char *title, bool overwrite, Error *err)
{
    PartFile file = {0};
    PictureBytes picture = {0};
    TRY(canvas_finish(canvas, title, false, &picture, err));
    TRY(part_file_replace(&file, path, overwrite, err));
    TRY(part_file_write(&file, picture.bytes, picture.size, err));
    TRY(part_file_commit(&file, err));
cleanup:
    part_file_discard(&file);
    return error_is_clean(err);
}
