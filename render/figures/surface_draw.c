// SPDX-License-Identifier: GPL-2.0-or-later
// Pixels have the value of what is nearest to the camera; lines are drawn over them as far as
// nothing hides them. Colours are those of the bar: there is no light.
#include "render/figures/surface_draw.h"

#include "base/memory.h"
#include "io/mesh/shape_functions.h"

#include <math.h>

enum { PARTS_LEAST = 2, CELLS_MAX = 50000 };

static const double PART_SIZE = 12;   // pixels: a part's side, half a millimetre in print
static const double OUTLINE_WIDTH = 0.5, CONTOUR_WIDTH = 0.3, EDGE_WIDTH = 0.15;   // points
static const double SLACK = 0.004;   // of the diagonal: a line on the surface is not behind it

static const Color CONTOUR = {0.08f, 0.08f, 0.10f, 0.55f};
static const Color EDGE_IN_PLANE = {0.08f, 0.08f, 0.10f, 0.80f};

// The depth goes from 0 at the camera to 1 at twice the distance of the block's middle.
DepthPoint surface_see(const Block *block, const Axes *axes, const double place[3])
{
    double seen[3] = {place[0], place[1], 0};
    if (block->moved) camera_see(&block->camera, place, seen);
    return (DepthPoint){axes_place(axes, seen[0], seen[1]),
                        block->moved ? seen[2] / (2 * block->camera.distance) : 0};
}

// Returns the number of parts along a side, the same for all elements: neighbours leave no crack.
int32_t surface_parts(const Block *block, const Axes *axes)
{
    const FieldFrame *frame = &block->frame;
    double longest = 0;
    if (block->moved) return 0;
    for (int32_t e = 0; e < frame->element_count; ++e) {
        const int32_t *nodes = frame->element_nodes + frame->first_node[e];
        int32_t corners = element_corner_count((ElementKind)frame->kind[e]);
        for (int32_t k = 0; k < corners; ++k) {
            const double *from = block->place[nodes[k]],
                         *to = block->place[nodes[(k + 1) % corners]];
            Point a = axes_place(axes, from[0], from[1]), b = axes_place(axes, to[0], to[1]);
            longest = fmax(longest, hypot(b.x - a.x, b.y - a.y));
        }
    }
    double most = fmin(SURFACE_PARTS_MAX, sqrt((double)CELLS_MAX / frame->element_count));
    return (int32_t)fmax(fmin(ceil(longest / PART_SIZE), most), PARTS_LEAST);
}

// Triangles with a corner that has no place or no number are left out.
bool surface_colors(Canvas *canvas, const Block *block, const Axes *axes, const Surface *surface,
                    double low, double high, const DepthImage *image, Error *err)
{
    const Box *box = &axes->box;
    int64_t count = 0;
    GlCorner *corners = NEW_ARRAY(GlCorner, 3 * (int64_t)surface->triangles.count, err);
    if (!corners) return false;
    for (int64_t t = 0; t < surface->triangles.count; ++t) {
        bool whole = true;
        for (int32_t k = 0; k < 3; ++k) {
            const SurfacePoint *point = &surface->triangles.points[3 * t + k];
            DepthPoint seen = surface_see(block, axes, point->at);
            double part = (point->value - low) / (high - low);
            whole = whole && isfinite(seen.at.x + seen.at.y + part);
            corners[count + k] = (GlCorner){(float)(seen.at.x - box->left),
                                            (float)(seen.at.y - box->top), (float)part,
                                            (float)seen.depth};
        }
        if (whole) count += 3;
    }
    canvas_heat_triangles(canvas, box, corners, count, image ? image->depth : NULL);
    memory_free(corners);
    return true;
}

// Compares with the farthest of the pixels around: a line on an edge has the face behind it beside
// it.
static bool shows(const DepthImage *image, Point at, double depth)
{
    double farthest = 0;
    int32_t column = (int32_t)floor(at.x - image->box.left);
    int32_t row = (int32_t)floor(at.y - image->box.top);
    for (int32_t j = row - 1; j <= row + 1; ++j)
        for (int32_t i = column - 1; i <= column + 1; ++i) {
            bool inside = i >= 0 && j >= 0 && i < image->columns && j < image->rows;
            double there = inside ? (double)image->depth[(int64_t)j * image->columns + i] : 1;
            farthest = fmax(farthest, there);
        }
    return depth <= farthest + image->slack;
}

void depth_image_line(const DepthImage *image, Canvas *canvas, const Stroke *stroke,
                      const DepthPoint ends[2])
{
    Point from = ends[0].at, to = ends[1].at, begun = {NAN, NAN};
    double length = hypot(to.x - from.x, to.y - from.y);
    int32_t steps = length < 1 ? 1 : (int32_t)fmin(ceil(length), 1e5);
    if (!isfinite(length)) return;
    for (int32_t k = 0; k <= steps; ++k) {
        double part = (double)k / steps, middle = fmin(part + 0.5 / steps, 1);
        Point here = {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
        Point seen = {from.x + middle * (to.x - from.x), from.y + middle * (to.y - from.y)};
        double depth = ends[0].depth + middle * (ends[1].depth - ends[0].depth);
        bool goes_on = k < steps && shows(image, seen, depth);
        if (goes_on && !isfinite(begun.x)) begun = here;
        if (goes_on || !isfinite(begun.x)) continue;
        draw_segment(canvas, stroke, begun, here);
        begun = (Point){NAN, NAN};
    }
}

static void draw_between(Canvas *canvas, LinePen *pen, const Stroke *stroke,
                         const DepthImage *image, const DepthPoint ends[2])
{
    if (image) {
        depth_image_line(image, canvas, stroke, ends);
        return;
    }
    line_add(pen, ends[0].at);
    line_add(pen, ends[1].at);
    pen->down = false;
}

void surface_lines(Canvas *canvas, const Block *block, const Axes *axes, const SurfaceParts *lines,
                   const Stroke *stroke, const DepthImage *image)
{
    LinePen pen = line_begin(canvas, stroke);
    for (int64_t k = 0; k < lines->count; ++k) {
        const SurfacePoint *two = lines->points + 2 * k;
        const DepthPoint ends[2] = {surface_see(block, axes, two[0].at),
                                    surface_see(block, axes, two[1].at)};
        draw_between(canvas, &pen, stroke, image, ends);
    }
    line_end(&pen);
}

// Draws a line between two sides of each triangle that has the value.
void surface_contour(Canvas *canvas, const Block *block, const Axes *axes, const Surface *surface,
                     double level, const Stroke *stroke, const DepthImage *image)
{
    LinePen pen = line_begin(canvas, stroke);
    for (int64_t t = 0; t < surface->triangles.count; ++t) {
        const SurfacePoint *corner = surface->triangles.points + 3 * t;
        DepthPoint ends[3];
        int32_t found = 0;
        for (int32_t k = 0; k < 3; ++k) {
            const SurfacePoint *a = &corner[k], *b = &corner[(k + 1) % 3];
            double place[3];
            if ((a->value < level) == (b->value < level)) continue;
            double part = (level - a->value) / (b->value - a->value);
            for (int32_t d = 0; d < 3; ++d) place[d] = a->at[d] + part * (b->at[d] - a->at[d]);
            ends[found++] = surface_see(block, axes, place);
        }
        if (found == 2) draw_between(canvas, &pen, stroke, image, ends);
    }
    line_end(&pen);
}

bool surface_draw(const Page *page, const BlockPage *map, const Block *block, const Axes *axes,
                  Error *err)
{
    const Box *box = &axes->box;
    const Colorbar *bar = &map->bar;
    double unit = map->share * page->point;
    Canvas *canvas = page->canvas;
    Surface surface = {.outline = {0}};
    DepthImage depths = {.box = *box,
                         .columns = (int32_t)lround(box->right - box->left),
                         .rows = (int32_t)lround(box->bottom - box->top)};
    const DepthImage *image = block->moved ? &depths : NULL;
    Stroke outline = {.color = INK, .width = OUTLINE_WIDTH * unit};
    Stroke edge = {.color = image ? CONTOUR : EDGE_IN_PLANE, .width = EDGE_WIDTH * unit};
    Stroke contour = {.color = CONTOUR, .width = CONTOUR_WIDTH * unit};
    if (image) {
        double sum = 0;
        for (int32_t d = 0; d < 3; ++d) sum += pow(block->high[d] - block->low[d], 2);
        depths.slack = SLACK * sqrt(sum) / (2 * block->camera.distance);
        TRY(depths.depth = NEW_ARRAY(float, (int64_t)depths.rows *depths.columns, err));
    }
    TRY(surface_build(block, &map->cut, map->edges, surface_parts(block, axes), &surface, err));
    TRY(surface_colors(canvas, block, axes, &surface, bar->low / bar->factor,
                       bar->high / bar->factor, image, err));
    surface_lines(canvas, block, axes, &surface.edges, &edge, image);
    Ticks ticks = colorbar_ticks(bar);
    for (int32_t n = 0; n < ticks.count; ++n) {
        double number = tick_value(&ticks, n);
        if (number > bar->low && number < bar->high)
            surface_contour(canvas, block, axes, &surface, number / bar->factor, &contour, image);
    }
    surface_lines(canvas, block, axes, &surface.outline, &outline, image);
cleanup:
    surface_destroy(&surface);
    memory_free(depths.depth);
    return error_is_clean(err);
}
