// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/block_page.h"

#include "base/memory.h"
#include "io/mesh/shape_functions.h"
#include "render/figures/rod_mark.h"
#include "render/figures/space_page.h"
#include "render/figures/surface_draw.h"
#include "render/figures/color_scale.h"
#include "render/view/space_time.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ARROWS = 9, STATUSES = 4 };

static const double ROOM_LEFT = 15, ROOM_RIGHT = 5;   // points: rod and its arrow; paper
static const double ROOM_ABOVE = 13, ROOM_BELOW = 7;   // points: load; contact
static const double CONTACT_GAP = 0.6,
                    CONTACT_HEIGHT = 4;   // points: the floor's line to the band, its height
static const double LOAD_GAP = 1.5, LOAD_LENGTH = 8, LOAD_HEAD = 2;   // points
static const double OUTLINE_WIDTH = 0.5;   // points
static const double FACE_SLACK = 1e-3;   // of the rod's width: nodes of the face it pushes
static const double SAME_PLACE = 1e-5;   // of the contact's length: nodes of fields and contact
static const double TOP_SHARE = 1e-6;   // of the height: what is less below the top is the top

static const Color LOAD_COLOR = {0.10f, 0.32f, 0.66f, 1};
static const char PRESSURE_IN_SPACE[] =
    "pressure \u2212(~{\u03c3}_{xx} + ~{\u03c3}_{yy} + ~{\u03c3}_{zz})/3";
// Colour and name by the history's status: open, sticks, slips where friction weakens, slips where
// it does not.
static const struct {
    Color color;
    const char *name;
} STATUS[STATUSES] = {{{0.30f, 0.62f, 0.85f, 1}, "open"},
                      {{0.84f, 0.85f, 0.87f, 1}, "sticks"},
                      {{0.93f, 0.58f, 0.08f, 1}, "slips, weakening"},
                      {{0.55f, 0.08f, 0.30f, 1}, "slips"}};

static void take_place(const double place[2], double extent[4])
{
    for (int32_t d = 0; d < 2; ++d) {
        extent[2 * d] = fmin(extent[2 * d], place[d]);
        extent[2 * d + 1] = fmax(extent[2 * d + 1], place[d]);
    }
}

void block_page_deform(Block *blocks, int32_t count, double *magnification, double extent[4])
{
    double least = INFINITY, corner[4][2];
    for (int32_t k = 0; k < count && *magnification == 0; ++k)
        least = fmin(least, block_magnification(&blocks[k]));
    if (*magnification == 0) *magnification = least;
    extent[0] = extent[2] = INFINITY;
    extent[1] = extent[3] = -INFINITY;
    for (int32_t k = 0; k < count; ++k) {
        block_deform(&blocks[k], *magnification);
        for (int32_t i = 0; i < blocks[k].frame.node_count; ++i)
            take_place(blocks[k].place[i], extent);
        if (blocks[k].moved) space_page_floor_corners(&blocks[k], corner);
        for (int32_t c = 0; c < 4 && blocks[k].moved; ++c) take_place(corner[c], extent);
    }
}

double block_page_scale(const double extent[4], double width, double share)
{
    return (width - share * (ROOM_LEFT + ROOM_RIGHT)) / (extent[1] - extent[0]);
}

double block_page_height(const double extent[4], double scale, double share)
{
    return scale * (extent[3] - extent[2]) + share * (ROOM_ABOVE + ROOM_BELOW);
}

void block_page_ranges(const double extent[4], double scale, double share, Axes *axes)
{
    axes->x.low = extent[0] - share * ROOM_LEFT / scale;
    axes->x.high = extent[1] + share * ROOM_RIGHT / scale;
    axes->y.low = extent[2] - share * ROOM_BELOW / scale;
    axes->y.high = extent[3] + share * ROOM_ABOVE / scale;
}

// --- range of the colours ------------------------------------------------------------------------

bool block_page_fit(BlockPage *map, const Block *blocks, int32_t count, BlockQuantity quantity,
                    Error *err)
{
    int64_t total = 0;
    WeighedValue *nodes = NULL;
    BlockWords words = block_words(quantity);
    ValueWords shown = {words.words, words.si, words.normalised, map->view->si, false};
    if (quantity == BLOCK_PRESSURE && map->view->line) shown.words = PRESSURE_IN_SPACE;
    for (int32_t k = 0; k < count; ++k) total += blocks[k].frame.node_count;
    TRY(nodes = NEW_ARRAY(WeighedValue, total, err));
    WeighedValue *own = nodes;   // those of block k
    for (int32_t k = 0; k < count; own += blocks[k++].frame.node_count) {
        const FieldFrame *frame = &blocks[k].frame;
        for (int32_t i = 0; i < frame->node_count; ++i) own[i].value = blocks[k].value[i];

        // The weight of a node is its share of the elements around it.
        for (int32_t e = 0; e < frame->element_count; ++e) {
            const int32_t *around = frame->element_nodes + frame->first_node[e];
            ElementKind kind = (ElementKind)frame->kind[e];
            int32_t node_count = element_node_count(kind);
            MeshPlace place[ELEMENT_NODES_MAX];
            Quadrature points = shape_quadrature(kind);
            double size = 0;
            for (int32_t a = 0; a < node_count; ++a)
                memcpy(place[a], frame->position + 3 * (int64_t)around[a], sizeof place[a]);
            for (int32_t q = 0; q < points.count; ++q) {
                ShapeValues shape = shape_at(kind, points.point[q]);
                size += points.weight[q] * shape_jacobian(kind, &shape, (const MeshPlace *)place);
            }
            for (int32_t a = 0; a < node_count; ++a)
                own[around[a]].weight += fabs(size) / node_count;
        }
    }
    TRY(value_bar_fit(nodes, total, &shown, map->style, &map->bar, err));
cleanup:
    memory_free(nodes);
    return error_is_clean(err);
}

bool block_cut_read(const ResultView *view, const char *words, SpaceCut *cut, Error *err)
{
    if (words && !view->line)
        return REFUSE(err, "the block is in the plane: there is nothing to cut open");
    return space_cut_read(words, cut, err);
}

// --- the block -----------------------------------------------------------------------------------

static SpacePage space_of(const Page *page, const BlockPage *map, const Axes *axes)
{
    static const SpaceCut whole = {0};
    SpacePage space = {.view = map->view,
                       .cut = map->cut ? map->cut : &whole,
                       .edges = map->edges,
                       .unit = map->share * page->point,
                       .axes = *axes,
                       .bar = &map->bar};
    for (int32_t k = 0; k < STATUSES; ++k) space.status[k] = STATUS[k].color;
    return space;
}

// Draws below the floor's line a colour for each contact node, where it is drawn on the deformed
// block: at its node of the block, the lowest one there of the elements above the floor's line,
// which those of a base are not. Without memory the nodes are drawn where they were.
static void draw_contact(const Page *page, const BlockPage *map, const Block *block, int64_t row,
                         const Axes *axes)
{
    const ResultView *view = map->view;
    const FieldFrame *frame = &block->frame;
    Error ignored = {0};
    double near = SAME_PLACE * (view->x[view->nodes - 1] - view->x[0]);
    bool *above = NEW_ARRAY(bool, frame->node_count, &ignored);
    double *height = NEW_ARRAY(double, view->nodes, &ignored);
    double *place = NEW_ARRAY(double, view->nodes, &ignored);
    bool placed = above && height && place;
    for (int32_t e = 0; placed && e < frame->element_count; ++e) {
        double top = -INFINITY;
        for (int32_t k = frame->first_node[e]; k < frame->first_node[e + 1]; ++k)
            top = fmax(top, frame->position[3 * frame->element_nodes[k] + 1]);
        for (int32_t k = frame->first_node[e]; k < frame->first_node[e + 1] && top > near; ++k)
            above[frame->element_nodes[k]] = true;
    }
    for (int32_t i = 0; placed && i < view->nodes; ++i) {
        place[i] = view->x[i];
        height[i] = INFINITY;
    }
    for (int32_t n = 0; placed && n < frame->node_count; ++n)
        for (int32_t i = 0; i < view->nodes && above[n]; ++i) {
            const double *at = frame->position + 3 * (int64_t)n;
            if (fabs(at[0] - view->x[i]) > near || at[1] >= height[i]) continue;
            height[i] = at[1];
            place[i] = block->place[n][0];
        }

    const double *status = view->status + row * view->nodes;
    double unit = map->share * page->point, floor_y = axes_place(axes, 0, 0).y, from, to;
    SpaceTime contact = {.nodes = view->nodes, .x = placed ? place : view->x, .pad = view->pad};
    for (int32_t i = 0; i < view->nodes; ++i) {
        node_extent(&contact, i, &from, &to);
        int32_t kind = (int32_t)status[i];
        Box box = {axes_place(axes, from, 0).x, floor_y + CONTACT_GAP * unit,
                   axes_place(axes, to, 0).x, floor_y + (CONTACT_GAP + CONTACT_HEIGHT) * unit};
        box.left = round(box.left);
        box.right = fmax(round(box.right), box.left + 1);
        if (kind >= 0 && kind < STATUSES) draw_fill(page->canvas, STATUS[kind].color, &box);
    }
    memory_free_all(above, height, place);
}

void block_page_contact(const Page *page, const BlockPage *map, const Block *block, int64_t row,
                        const Axes *axes)
{
    SpacePage space = space_of(page, map, axes);
    if (block->moved)
        space_page_floor(page, &space, block, row);
    else
        draw_contact(page, map, block, row, axes);
}

void block_page_axes(const Page *page, const BlockPage *map, const Block *block, const Axes *axes)
{
    SpacePage space = space_of(page, map, axes);
    if (block->moved)
        space_page_axes(page, &space, block);
    else
        axes_draw(page, axes);
}

// Arrows along what was the top before anything moved.
static void draw_load(const Page *page, const BlockPage *map, const Block *block, const Axes *axes)
{
    const FieldFrame *frame = &block->frame;
    double unit = map->share * page->point, low = INFINITY, high = -INFINITY, top = -INFINITY;
    double bottom = INFINITY, z = -INFINITY;
    Stroke stroke = {.color = LOAD_COLOR, .width = 0.6 * unit};
    if (!(map->view->number[NUMBER_PRESSURE] > 0)) return;
    for (int32_t i = 0; i < frame->node_count; ++i) {
        top = fmax(top, frame->position[3 * i + 1]);
        bottom = fmin(bottom, frame->position[3 * i + 1]);
    }
    for (int32_t i = 0; i < frame->node_count; ++i) {
        if (frame->position[3 * i + 1] < top - TOP_SHARE * (top - bottom)) continue;
        low = fmin(low, block->place[i][0]);
        high = fmax(high, block->place[i][0]);
        z = fmax(z, block->place[i][1]);
    }
    for (int32_t k = 0; k < ARROWS; ++k) {
        Point tip = axes_place(axes, low + (high - low) * (k + 0.5) / ARROWS, z);
        tip.y -= LOAD_GAP * unit;
        arrow_draw(page, &stroke, (Point){tip.x, tip.y - LOAD_LENGTH * unit}, tip,
                   LOAD_HEAD * unit);
    }
}

// Drawn place of a height of the trailing face: between the nodes of it below and above.
static double drawn_height(const Block *block, double height, double face, double slack)
{
    const FieldFrame *frame = &block->frame;
    double below[2] = {-INFINITY, 0}, above[2] = {INFINITY, 0};   // height, and where it is drawn
    for (int32_t i = 0; i < frame->node_count; ++i) {
        const double *was = frame->position + 3 * i;
        if (was[0] > face + slack || !rod_mark_pushes(height, height, was[1])) continue;
        const double at[2] = {was[1], block->place[i][1]};
        if (at[0] <= height + slack && at[0] > below[0]) memcpy(below, at, sizeof at);
        if (at[0] >= height - slack && at[0] < above[0]) memcpy(above, at, sizeof at);
    }
    double part = (height - below[0]) / (above[0] - below[0]);
    return above[0] > below[0] ? below[1] + part * (above[1] - below[1]) : above[1];
}

bool block_page_draw(const Page *page, const BlockPage *map, const Block *block, const Axes *axes,
                     Error *err)
{
    SpacePage space = space_of(page, map, axes);
    if (block->moved) return space_page_draw(page, &space, block, err);
    const SurfaceDrawing drawing = {block, axes, &map->bar, space.cut, map->edges, space.unit};
    Stroke outline = {.color = INK, .width = OUTLINE_WIDTH * space.unit};
    if (!surface_draw(page, &drawing, err)) return false;
    draw_contact(page, map, block, block->row, axes);
    Point left = axes_place(axes, axes->x.low, 0), right = axes_place(axes, axes->x.high, 0);
    draw_segment(page->canvas, &outline, left, right);
    draw_load(page, map, block, axes);

    // The rod where its strip of the face is drawn, before all that is drawn at these heights, also
    // a soft layer that bulges.
    const FieldFrame *frame = &block->frame;
    double low = map->view->number[NUMBER_ROD_LOW], high = map->view->number[NUMBER_ROD_HIGH];
    double face = INFINITY, slack = FACE_SLACK * (high - low);
    for (int32_t i = 0; i < frame->node_count; ++i)
        if (rod_mark_pushes(low, high, frame->position[3 * i + 1]))
            face = fmin(face, frame->position[3 * i]);
    RodMark rod = {INFINITY, drawn_height(block, low, face, slack),
                   drawn_height(block, high, face, slack), map->share};
    for (int32_t i = 0; i < frame->node_count; ++i)
        if (block->place[i][1] >= rod.low && block->place[i][1] <= rod.high)
            rod.face = fmin(rod.face, block->place[i][0]);
    rod_mark_draw(page, axes, &rod);
    return true;
}

void block_page_legend(const Page *page, Point place, double below)
{
    double point = page->point, first = place.x;
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK, .up = 0.5};
    text_draw(page->text, &style, place, "contact");
    place.x += text_width(page->text, style.size, "contact") + 5 * point;
    for (int32_t k = STATUSES - 1; k >= 0; --k) {
        if (below > 0) place = (Point){first, place.y + below * point};
        Box patch = {place.x, place.y - 2 * point, place.x + 6 * point, place.y + 2 * point};
        draw_fill(page->canvas, STATUS[k].color, &patch);
        text_draw(page->text, &style, (Point){patch.right + 2 * point, place.y}, STATUS[k].name);
        place.x = patch.right + 7 * point + text_width(page->text, style.size, STATUS[k].name);
    }
}
