// SPDX-License-Identifier: GPL-2.0-or-later
// An element is cut into a lattice of parts, each some pixels wide, on which positions and quantity
// are those of the shape functions; in a part they are linear. The error of that is below
// 1 / (8 n^2) of the second difference over the element, for n parts along its side.
#include "render/block_mesh.h"

#include "base/memory.h"
#include "bulk/shape.h"

#include <math.h>
#include <stdlib.h>

enum { PARTS_MAX = 16, LATTICE_MAX = (PARTS_MAX + 1) * (PARTS_MAX + 1) };

static const double PART_SIZE = 8;   // pixels: a part's side
static const double SLACK = 1e-9;   // of a part: what lies between two belongs to both

typedef struct Corner {
    Point at;   // pixels
    double value;
} Corner;

typedef bool (*TriangleFunction)(void *context, const Corner corner[3]);

static Point node_place(const Block *block, const Axes *axes, int32_t node)
{
    return axes_place(axes, block->place[node][0], block->place[node][1]);
}

static int32_t corner_count(ElementKind kind)
{
    return kind == ELEMENT_T3 || kind == ELEMENT_T6 ? 3 : 4;
}

// Parts along a side: one where all is linear.
static int32_t choose_parts(const Block *block, const Axes *axes, int32_t e)
{
    const int32_t *nodes = block->frame.element_nodes + block->frame.first_node[e];
    ElementKind kind = (ElementKind)block->frame.kind[e];
    int32_t corners = corner_count(kind);
    double longest = 0;
    if (kind == ELEMENT_T3) return 1;
    for (int32_t k = 0; k < corners; ++k) {
        Point a = node_place(block, axes, nodes[k]);
        Point b = node_place(block, axes, nodes[(k + 1) % corners]);
        longest = fmax(longest, hypot(b.x - a.x, b.y - a.y));
    }
    return (int32_t)fmin(fmax(ceil(longest / PART_SIZE), 2), PARTS_MAX);
}

// lattice: [(parts + 1)^2], row by row along eta; of a triangle only where i + j <= parts.
static void fill_lattice(const Block *block, const Axes *axes, int32_t e, int32_t parts,
                         Corner *lattice)
{
    const int32_t *nodes = block->frame.element_nodes + block->frame.first_node[e];
    ElementKind kind = (ElementKind)block->frame.kind[e];
    int32_t count = element_node_count(kind);
    bool triangle = corner_count(kind) == 3;
    for (int32_t j = 0; j <= parts; ++j)
        for (int32_t i = 0; i <= (triangle ? parts - j : parts); ++i) {
            double xi = (double)i / parts, eta = (double)j / parts, x = 0, z = 0, value = 0;
            ShapeValues shape = triangle ? shape_at(kind, xi, eta)
                                         : shape_at(kind, 2 * xi - 1, 2 * eta - 1);
            for (int32_t a = 0; a < count; ++a) {
                x += shape.value[a] * block->place[nodes[a]][0];
                z += shape.value[a] * block->place[nodes[a]][1];
                value += shape.value[a] * block->value[nodes[a]];
            }
            lattice[j * (parts + 1) + i] = (Corner){axes_place(axes, x, z), value};
        }
}

// All triangles of all elements; ends where `work` gives false.
static bool each_triangle(const Block *block, const Axes *axes, TriangleFunction work,
                          void *context)
{
    Corner lattice[LATTICE_MAX];
    bool going = true;
    for (int32_t e = 0; going && e < block->frame.element_count; ++e) {
        int32_t parts = choose_parts(block, axes, e), row = parts + 1;
        bool triangle = corner_count((ElementKind)block->frame.kind[e]) == 3;
        fill_lattice(block, axes, e, parts, lattice);
        for (int32_t j = 0; going && j < parts; ++j)
            for (int32_t i = 0; going && i < (triangle ? parts - j : parts); ++i) {
                const Corner *low = lattice + j * row + i, *high = low + row;
                const Corner lower[3] = {low[0], low[1], high[0]};
                going = work(context, lower);
                if (!going || (triangle && i + j == parts - 1)) continue;
                const Corner upper[3] = {low[1], high[1], high[0]};
                going = work(context, upper);
            }
    }
    return going;
}

// --- pixels --------------------------------------------------------------------------------------

// Barycentric coordinates of a pixel's middle say whether it is inside.
static bool fill_triangle(void *context, const Corner c[3])
{
    BlockRaster *raster = context;
    double ax = c[1].at.x - c[0].at.x, ay = c[1].at.y - c[0].at.y;
    double bx = c[2].at.x - c[0].at.x, by = c[2].at.y - c[0].at.y, area = ax * by - ay * bx;
    double left = fmin(c[0].at.x, fmin(c[1].at.x, c[2].at.x)) - raster->box.left;
    double right = fmax(c[0].at.x, fmax(c[1].at.x, c[2].at.x)) - raster->box.left;
    double top = fmin(c[0].at.y, fmin(c[1].at.y, c[2].at.y)) - raster->box.top;
    double bottom = fmax(c[0].at.y, fmax(c[1].at.y, c[2].at.y)) - raster->box.top;
    if (area == 0 || !isfinite(left + right + top + bottom)) return true;
    int32_t first = (int32_t)fmax(ceil(left - 0.5 - SLACK), 0);
    int32_t last = (int32_t)fmin(floor(right - 0.5 + SLACK), raster->width - 1);
    int32_t end = (int32_t)fmin(floor(bottom - 0.5 + SLACK), raster->height - 1);
    for (int32_t row = (int32_t)fmax(ceil(top - 0.5 - SLACK), 0); row <= end; ++row) {
        float *line = raster->values + (int64_t)row * raster->width;
        double y = row + 0.5 + raster->box.top - c[0].at.y;
        for (int32_t column = first; column <= last; ++column) {
            double x = column + 0.5 + raster->box.left - c[0].at.x;
            double a = (x * by - y * bx) / area, b = (ax * y - ay * x) / area;
            if (a < -SLACK || b < -SLACK || a + b > 1 + SLACK) continue;
            line[column] =
                (float)(c[0].value + a * (c[1].value - c[0].value) + b * (c[2].value - c[0].value));
        }
    }
    return true;
}

bool block_raster_fill(const Block *block, const Axes *axes, const Box *box, BlockRaster *raster,
                       Error *err)
{
    *raster = (BlockRaster){.box = *box,
                            .width = (int32_t)lround(box->right - box->left),
                            .height = (int32_t)lround(box->bottom - box->top)};
    if (raster->width < 2 || raster->height < 2)
        FAIL(err, ERROR_INPUT, "the picture is too small for its axes");
    int64_t count = (int64_t)raster->width * raster->height;
    TRY(raster->values = NEW_ARRAY(float, count, err));
    for (int64_t k = 0; k < count; ++k) raster->values[k] = NAN;
    each_triangle(block, axes, fill_triangle, raster);
cleanup:
    return error_is_clean(err);
}

void block_raster_destroy(BlockRaster *raster)
{
    memory_free(raster->values);
    *raster = (BlockRaster){0};
}

// --- lines ---------------------------------------------------------------------------------------

// Pieces of lines, three points each, the third one not finite: it ends the piece.
typedef struct Pieces {
    double level;
    Point *points;   // [3 * count] owned
    int32_t count, room;
    Error *err;
} Pieces;

static bool pieces_add(Pieces *pieces, Point from, Point to)
{
    Point *longer =
        memory_grow(pieces->points, pieces->count, &pieces->room, 3 * sizeof(Point), pieces->err);
    if (!longer) return false;
    pieces->points = longer;
    Point *piece = longer + 3 * (int64_t)pieces->count++;
    piece[0] = from;
    piece[1] = to;
    piece[2] = (Point){NAN, NAN};
    return true;
}

// The straight piece of a contour in a triangle whose corners lie on both sides of the level.
static bool cut_triangle(void *context, const Corner corner[3])
{
    Pieces *pieces = context;
    Point crossing[3];
    int32_t found = 0;
    for (int32_t k = 0; k < 3; ++k) {
        const Corner *a = &corner[k], *b = &corner[(k + 1) % 3];
        if ((a->value < pieces->level) == (b->value < pieces->level)) continue;
        double part = (pieces->level - a->value) / (b->value - a->value);
        crossing[found++] =
            (Point){a->at.x + part * (b->at.x - a->at.x), a->at.y + part * (b->at.y - a->at.y)};
    }
    return found != 2 || pieces_add(pieces, crossing[0], crossing[1]);
}

bool block_contour_draw(const Page *page, const Block *block, const Axes *axes, double level,
                        const Stroke *stroke, Error *err)
{
    Pieces pieces = {.level = level, .err = err};
    if (each_triangle(block, axes, cut_triangle, &pieces))
        shape_line(page->canvas, stroke, pieces.points, 3 * (int64_t)pieces.count);
    memory_free(pieces.points);
    return error_is_clean(err);
}

// A side of an element, its lower corner first; through: the node in its middle, or -1.
typedef struct Side {
    int32_t low, high, through;
} Side;

static Side element_side(const FieldFrame *frame, int32_t e, int32_t k)
{
    const int32_t *nodes = frame->element_nodes + frame->first_node[e];
    int32_t corners = corner_count((ElementKind)frame->kind[e]);
    int32_t a = nodes[k], b = nodes[(k + 1) % corners];
    bool curved = frame->first_node[e + 1] - frame->first_node[e] >= 2 * corners;
    return (Side){a < b ? a : b, a < b ? b : a, curved ? nodes[corners + k] : -1};
}

static int compare_sides(const void *left, const void *right)
{
    const Side *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    return a->high < b->high ? -1 : a->high > b->high;
}

static void side_draw(const Page *page, const Block *block, const Axes *axes, const Side *side,
                      const Stroke *stroke)
{
    Point line[3] = {node_place(block, axes, side->low)};
    int32_t count = 1;
    if (side->through >= 0) line[count++] = node_place(block, axes, side->through);
    line[count++] = node_place(block, axes, side->high);
    shape_line(page->canvas, stroke, line, count);
}

// What belongs to one element alone.
bool block_outline_draw(const Page *page, const Block *block, const Axes *axes,
                        const Stroke *stroke, Error *err)
{
    const FieldFrame *frame = &block->frame;
    int64_t count = 0;
    Side *sides = NEW_ARRAY(Side, 4 * (int64_t)frame->element_count, err);
    if (!sides) return false;
    for (int32_t e = 0; e < frame->element_count; ++e)
        for (int32_t k = 0; k < corner_count((ElementKind)frame->kind[e]); ++k)
            sides[count++] = element_side(frame, e, k);
    qsort(sides, (size_t)count, sizeof *sides, compare_sides);
    for (int64_t k = 0; k < count; ++k) {
        bool before = k > 0 && compare_sides(&sides[k - 1], &sides[k]) == 0;
        bool after = k + 1 < count && compare_sides(&sides[k], &sides[k + 1]) == 0;
        if (!before && !after) side_draw(page, block, axes, &sides[k], stroke);
    }
    memory_free(sides);
    return true;
}

// Inner sides twice: not worth a search.
void block_edges_draw(const Page *page, const Block *block, const Axes *axes, const Stroke *stroke)
{
    const FieldFrame *frame = &block->frame;
    for (int32_t e = 0; e < frame->element_count; ++e)
        for (int32_t k = 0; k < corner_count((ElementKind)frame->kind[e]); ++k) {
            Side side = element_side(frame, e, k);
            side_draw(page, block, axes, &side, stroke);
        }
}
