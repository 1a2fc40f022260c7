// SPDX-License-Identifier: GPL-2.0-or-later
// An element is cut into a lattice of parts, each some pixels wide, on which positions and quantity
// are those of the shape functions; in a part they are linear. The error of that is below
// 1 / (8 n^2) of the second difference over the element, for n parts along its side.
#include "render/figures/block_mesh.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/mesh/shape_functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS_MAX = 16, LATTICE_MAX = (PARTS_MAX + 1) * (PARTS_MAX + 1) };

static const double PART_SIZE = 12;   // pixels: a part's side, half a millimetre in print

typedef struct Corner {
    Point at;   // pixels
    double value;
} Corner;

typedef bool (*TriangleFunction)(void *context, const Corner corner[3]);

static Point node_place(const Block *block, const Axes *axes, int32_t node)
{
    return axes_place(axes, block->place[node][0], block->place[node][1]);
}

// Each side has as many parts as its length asks for, whichever element it belongs to: elements
// side by side leave no crack. Inside as many as along the side that has most. A T3 stays whole:
// beside a quadrilateral that is cut a pixel may be missed.
typedef struct Parts {
    int32_t inside, side[4];
} Parts;

static Parts choose_parts(const Block *block, const Axes *axes, int32_t e)
{
    const int32_t *nodes = block->frame.element_nodes + block->frame.first_node[e];
    ElementKind kind = (ElementKind)block->frame.kind[e];
    int32_t corners = element_corner_count(kind);
    Parts parts = {1, {1, 1, 1, 1}};
    if (kind == ELEMENT_T3) return parts;
    for (int32_t k = 0; k < corners; ++k) {
        Point a = node_place(block, axes, nodes[k]);
        Point b = node_place(block, axes, nodes[(k + 1) % corners]);
        double wanted = ceil(hypot(b.x - a.x, b.y - a.y) / PART_SIZE);
        parts.side[k] = (int32_t)fmin(fmax(wanted, 2), PARTS_MAX);
        if (parts.side[k] > parts.inside) parts.inside = parts.side[k];
    }
    return parts;
}

// Place of the i-th of `inside` parts, moved to where a side's own parts meet.
static double side_place(const Parts *parts, int32_t side, int32_t i)
{
    int32_t count = parts->side[side];
    return round((double)i * count / parts->inside) / count;
}

// Shape functions where the parts of an element meet: of the one before, if it is alike.
typedef struct Lattice {
    int32_t kind;   // -1: of none yet
    Parts parts;
    double weight[LATTICE_MAX][ELEMENT_NODES_MAX];
} Lattice;

// Row by row along eta; of a triangle only where i + j <= inside. Places go from 0 to 1 along both
// axes, on a side to where its own parts meet.
static void lattice_weigh(ElementKind kind, const Parts *parts, Lattice *lattice)
{
    int32_t last = parts->inside;
    bool triangle = element_corner_count(kind) == 3;
    if (lattice->kind == (int32_t)kind && memcmp(&lattice->parts, parts, sizeof *parts) == 0)
        return;
    lattice->kind = (int32_t)kind;
    lattice->parts = *parts;
    for (int32_t j = 0; j <= last; ++j)
        for (int32_t i = 0; i <= (triangle ? last - j : last); ++i) {
            double at[2] = {(double)i / last, (double)j / last};
            if (j == 0) at[0] = side_place(parts, 0, i);
            if (!triangle && i == last) at[1] = side_place(parts, 1, j);
            if (!triangle && j == last) at[0] = side_place(parts, 2, i);
            if (i == 0) at[1] = side_place(parts, triangle ? 2 : 3, j);
            if (triangle && i > 0 && j > 0 && i + j == last) {
                at[1] = side_place(parts, 1, j);
                at[0] = 1 - at[1];
            }
            for (int32_t d = 0; d < 2 && !triangle; ++d) at[d] = 2 * at[d] - 1;
            ShapeValues shape = shape_at(kind, at);
            memcpy(lattice->weight[j * (last + 1) + i], shape.value,
                   (size_t)element_node_count(kind) * sizeof(double));
        }
}

// All triangles of all elements, or of those that may reach *level; ends where `work` gives false.
static bool each_triangle(const Block *block, const Axes *axes, const double *level,
                          TriangleFunction work, void *context)
{
    const FieldFrame *frame = &block->frame;
    Corner corners[LATTICE_MAX];
    Lattice lattice = {.kind = -1};
    bool going = true;
    for (int32_t e = 0; going && e < frame->element_count; ++e) {
        const int32_t *nodes = frame->element_nodes + frame->first_node[e];
        ElementKind kind = (ElementKind)frame->kind[e];

        // Shape functions of order 2 leave the range of the nodes by less than its width.
        double low = INFINITY, high = -INFINITY;
        for (int32_t k = 0; level && k < frame->first_node[e + 1] - frame->first_node[e]; ++k) {
            low = fmin(low, block->value[nodes[k]]);
            high = fmax(high, block->value[nodes[k]]);
        }
        if (level && !(*level >= low - (high - low) && *level <= high + (high - low))) continue;

        // Corners of the lattice.
        Parts chosen = choose_parts(block, axes, e);
        int32_t parts = chosen.inside, row = parts + 1, count = element_node_count(kind);
        bool triangle = element_corner_count(kind) == 3;
        lattice_weigh(kind, &chosen, &lattice);
        for (int32_t j = 0; j <= parts; ++j)
            for (int32_t i = 0; i <= (triangle ? parts - j : parts); ++i) {
                const double *weight = lattice.weight[j * row + i];
                double x = 0, z = 0, value = 0;
                for (int32_t a = 0; a < count; ++a) {
                    x += weight[a] * block->place[nodes[a]][0];
                    z += weight[a] * block->place[nodes[a]][1];
                    value += weight[a] * block->value[nodes[a]];
                }
                corners[j * row + i] = (Corner){axes_place(axes, x, z), value};
            }

        for (int32_t j = 0; going && j < parts; ++j)
            for (int32_t i = 0; going && i < (triangle ? parts - j : parts); ++i) {
                const Corner *lower = corners + j * row + i, *upper = lower + row;
                const Corner first[3] = {lower[0], lower[1], upper[0]};
                going = work(context, first);
                if (!going || (triangle && i + j == parts - 1)) continue;
                const Corner second[3] = {lower[1], upper[1], upper[0]};
                going = work(context, second);
            }
    }
    return going;
}

// --- pixels --------------------------------------------------------------------------------------

// Triangles that are drawn, and their colours.
typedef struct Fill {
    const Box *box;
    double low, range;   // the quantity at colour 0, and up to colour 1
    GlCorner *corners;   // [3 * count] owned
    int32_t count, room;
    Error *err;
} Fill;

// false: no memory. What has no place or no number is left out.
static bool fill_add(void *context, const Corner corner[3])
{
    Fill *fill = context;
    for (int32_t k = 0; k < 3; ++k)
        if (!isfinite(corner[k].at.x + corner[k].at.y + corner[k].value)) return true;
    if (!memory_grow(&fill->corners, fill->count, &fill->room, 3 * sizeof(GlCorner), fill->err))
        return false;
    GlCorner *to = fill->corners + 3 * (int64_t)fill->count++;
    for (int32_t k = 0; k < 3; ++k)
        to[k] = (GlCorner){(float)(corner[k].at.x - fill->box->left),
                           (float)(corner[k].at.y - fill->box->top),
                           (float)((corner[k].value - fill->low) / fill->range), 0};
    return true;
}

bool block_colors_draw(Canvas *canvas, const Block *block, const Axes *axes, double low,
                       double high, Error *err)
{
    Fill fill = {.box = &axes->box, .low = low, .range = high - low, .err = err};
    if (each_triangle(block, axes, NULL, fill_add, &fill))
        canvas_heat_triangles(canvas, &axes->box, fill.corners, 3 * (int64_t)fill.count, NULL);
    memory_free(fill.corners);
    return error_is_clean(err);
}

// --- lines ---------------------------------------------------------------------------------------

typedef struct Contour {
    double level;
    LinePen pen;
} Contour;

// The straight piece of a contour in a triangle whose corners lie on both sides of the level.
static bool cut_triangle(void *context, const Corner corner[3])
{
    Contour *contour = context;
    for (int32_t k = 0; k < 3; ++k) {
        const Corner *a = &corner[k], *b = &corner[(k + 1) % 3];
        if ((a->value < contour->level) == (b->value < contour->level)) continue;
        double part = (contour->level - a->value) / (b->value - a->value);
        line_add(&contour->pen, (Point){a->at.x + part * (b->at.x - a->at.x),
                                        a->at.y + part * (b->at.y - a->at.y)});
    }
    contour->pen.down = false;
    return true;
}

void block_contour_draw(const Page *page, const Block *block, const Axes *axes, double level,
                        const Stroke *stroke)
{
    Contour contour = {level, line_begin(page->canvas, stroke)};
    each_triangle(block, axes, &level, cut_triangle, &contour);
    line_end(&contour.pen);
}

// A side of an element, its lower corner first; through: the node in its middle, or -1.
typedef struct Side {
    int32_t low, high, through;
} Side;

static Side element_side(const FieldFrame *frame, int32_t e, int32_t k)
{
    const int32_t *nodes = frame->element_nodes + frame->first_node[e];
    int32_t corners = element_corner_count((ElementKind)frame->kind[e]);
    int32_t a = nodes[k], b = nodes[(k + 1) % corners];
    bool curved = frame->first_node[e + 1] - frame->first_node[e] >= 2 * corners;
    return (Side){a < b ? a : b, a < b ? b : a, curved ? nodes[corners + k] : -1};
}

static void side_draw(const Page *page, const Block *block, const Axes *axes, const Side *side,
                      const Stroke *stroke)
{
    Point line[3] = {node_place(block, axes, side->low)};
    int32_t count = 1;
    if (side->through >= 0) line[count++] = node_place(block, axes, side->through);
    line[count++] = node_place(block, axes, side->high);
    draw_line(page->canvas, stroke, line, count);
}

// The outline consists of the sides that belong to one element alone.
bool block_outline_draw(const Page *page, const Block *block, const Axes *axes,
                        const Stroke *stroke, Error *err)
{
    const FieldFrame *frame = &block->frame;
    int64_t count = 0;
    Side *sides = NEW_ARRAY(Side, 4 * (int64_t)frame->element_count, err);
    if (!sides) return false;
    for (int32_t e = 0; e < frame->element_count; ++e)
        for (int32_t k = 0; k < element_corner_count((ElementKind)frame->kind[e]); ++k)
            sides[count++] = element_side(frame, e, k);
    qsort(sides, (size_t)count, sizeof *sides, order_int32_pairs);
    for (int64_t k = 0; k < count; ++k) {
        bool before = k > 0 && order_int32_pairs(&sides[k - 1], &sides[k]) == 0;
        bool after = k + 1 < count && order_int32_pairs(&sides[k], &sides[k + 1]) == 0;
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
        for (int32_t k = 0; k < element_corner_count((ElementKind)frame->kind[e]); ++k) {
            Side side = element_side(frame, e, k);
            side_draw(page, block, axes, &side, stroke);
        }
}
