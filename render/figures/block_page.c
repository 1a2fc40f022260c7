// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/block_page.h"

#include "base/memory.h"
#include "io/mesh/shape_functions.h"
#include "render/figures/figures.h"
#include "render/figures/rod_mark.h"
#include "render/figures/color_scale.h"
#include "render/view/space_time.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ARROWS = 9, ARROWS_IN_SPACE = 7, STATUSES = 4, TICKS_WANTED = 4 };

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

static double floor_height(const Block *block)
{
    return block->low[2] - camera_drop(block->low, block->high);
}

// Finds where the camera sees the corners of its floor.
static void find_corners(const Block *block, double corner[4][2])
{
    for (int32_t k = 0; k < 4; ++k) {
        const double place[3] = {k % 2 ? block->high[0] : block->low[0],
                                 k / 2 ? block->high[1] : block->low[1], floor_height(block)};
        double seen[3];
        camera_see(&block->camera, place, seen);
        memcpy(corner[k], seen, sizeof corner[k]);
    }
}

// --- size and colours ----------------------------------------------------------------------------

bool block_page_fit(BlockPage *map, Block *blocks, int32_t count, BlockQuantity quantity,
                    Error *err)
{
    int64_t total = 0;
    double least = INFINITY, corner[4][2], *extent = map->extent;
    WeighedValue *nodes = NULL;
    BlockWords words = block_words(quantity);
    ValueWords shown = {words.words, words.si, words.normalised, map->view->si, false};
    if (quantity == BLOCK_PRESSURE && map->view->line) shown.words = PRESSURE_IN_SPACE;
    for (int32_t k = 0; k < count && map->magnification == 0; ++k)
        least = fmin(least, block_magnification(&blocks[k]));
    if (map->magnification == 0) map->magnification = least;
    extent[0] = extent[2] = INFINITY;
    extent[1] = extent[3] = -INFINITY;
    for (int32_t k = 0; k < count; ++k) {
        block_deform(&blocks[k], map->magnification);
        for (int32_t i = 0; i < blocks[k].frame.node_count; ++i)
            take_place(blocks[k].place[i], extent);
        if (blocks[k].moved) find_corners(&blocks[k], corner);
        for (int32_t c = 0; c < 4 && blocks[k].moved; ++c) take_place(corner[c], extent);
    }

    // The range of the colours.
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

bool block_page_sample(BlockPage *map, const BlockSource *source, const int32_t *index,
                       int32_t count, Error *err)
{
    Block *blocks = NEW_ARRAY(Block, count, err);
    TRY(blocks);
    for (int32_t k = 0; k < count; ++k) TRY(block_read(source, index[k], &blocks[k], err));
    TRY(block_page_fit(map, blocks, count, source->quantity, err));
cleanup:
    for (int32_t k = 0; blocks && k < count; ++k) block_destroy(&blocks[k]);
    memory_free(blocks);
    return error_is_clean(err);
}

void block_page_size(BlockPage *map, double width, double most_height)
{
    double beside = map->share * (ROOM_LEFT + ROOM_RIGHT), length = map->extent[1] - map->extent[0];
    double over = map->share * (ROOM_ABOVE + ROOM_BELOW), rise = map->extent[3] - map->extent[2];
    map->width = width;
    map->scale = (width - beside) / length;
    map->height = map->scale * rise + over;
    if (!(map->height > most_height)) return;
    map->height = most_height;
    map->scale = (most_height - over) / rise;
    map->width = map->scale * length + beside;
}

void block_page_place(const Page *page, const BlockPage *map, double left, double top, Axes *axes)
{
    double mark = map->share / map->scale;   // length: a point of a mark
    axes->x.low = map->extent[0] - mark * ROOM_LEFT;
    axes->x.high = map->extent[1] + mark * ROOM_RIGHT;
    axes->y.low = map->extent[2] - mark * ROOM_BELOW;
    axes->y.high = map->extent[3] + mark * ROOM_ABOVE;
    axes->box = (Box){.left = left,
                      .right = left + round(map->width * page->point),
                      .top = top,
                      .bottom = top + round(map->height * page->point)};
}

bool block_cut_read(const ResultView *view, const char *words, SpaceCut *cut, Error *err)
{
    if (words && !view->line)
        return REFUSE(err, "the block is in the plane: there is nothing to cut open");
    return space_cut_read(words, cut, err);
}

// --- in space ------------------------------------------------------------------------------------

static const double SEAM = 0.2, FLOOR_WIDTH = 0.4, STRIP_WIDTH = 1.2;   // points
static const double ROD_LENGTH = 11, ROD_HEAD = 3, ROD_WIDTH = 1;   // points
static const double TICK = 2.5, NUMBER_GAP = 2, NAME_GAP = 13;   // points
static const double GAP_IN_SPACE = 1;   // points: load to the top
static const double SLACK_IN_SPACE = 1e-6;   // of the diagonal

static double diagonal(const Block *block)
{
    double sum = 0;
    for (int32_t d = 0; d < 3; ++d) sum += pow(block->high[d] - block->low[d], 2);
    return sqrt(sum);
}

static Point see_on_page(const Block *block, const Axes *axes, double x, double y, double z)
{
    const double place[3] = {x, y, z};
    return surface_see(block, axes, place).at;
}

// Distance of a node of the trailing face above or below the strip; INFINITY: it is beside it.
static double off_strip(const Block *block, int64_t node, const double low[2], const double high[2])
{
    const double *was = block->frame.position + 3 * node;
    double slack = SLACK_IN_SPACE * diagonal(block);
    bool beside = was[0] > block->low[0] + slack || was[1] < low[0] - slack ||
                  was[1] > high[0] + slack;
    return beside ? INFINITY : fmax(0, fmax(low[1] - was[2], was[2] - high[1]));
}

// The strip that the rod pushes, and an arrow against its middle; not where it was cut away.
static void draw_rod(const Page *page, const BlockPage *map, const Block *block, const Axes *axes)
{
    static const int32_t round[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    double unit = map->share * page->point;
    const double *number = map->view->number;
    const SpaceCut *cut = &map->cut;
    double breadth = number[NUMBER_ROD_BREADTH], middle = (block->low[1] + block->high[1]) / 2;
    double low[2] = {block->low[1], number[NUMBER_ROD_LOW]};
    double high[2] = {block->high[1], number[NUMBER_ROD_HIGH]};
    if (breadth > 0) low[0] = middle - breadth / 2, high[0] = middle + breadth / 2;

    // The cut leaves the strip from this y on.
    double left = cut->count > 0 ? INFINITY : low[0];
    for (int32_t k = 0; k < cut->count; ++k) {
        if (cut->axis[k] == 1) left = fmax(low[0], cut->value[k]);
        if (cut->axis[k] == 2 && (low[1] + high[1]) / 2 < cut->value[k]) {
            left = low[0];
            break;
        }
    }
    low[0] = left;
    middle = (low[0] + high[0]) / 2;
    if (!(low[0] < high[0]) || !isfinite(low[1] + high[1])) return;

    // Mean way, as drawn, of the nodes of the trailing face in the strip, or next to it where no
    // node is inside.
    double nearest = INFINITY, count = 0, moved[3] = {0, 0, 0};
    for (int64_t i = 0; i < block->frame.node_count; ++i)
        nearest = fmin(nearest, off_strip(block, i, low, high));
    for (int64_t i = 0; i < block->frame.node_count && isfinite(nearest); ++i) {
        if (off_strip(block, i, low, high) > nearest + SLACK_IN_SPACE * diagonal(block)) continue;
        count += 1;
        for (int32_t d = 0; d < 3; ++d)
            moved[d] += block->moved[i][d] - block->frame.position[3 * i + d];
    }
    if (count == 0) return;
    for (int32_t d = 0; d < 3; ++d) moved[d] /= count;

    Stroke strip = {.color = ROD_COLOR, .width = STRIP_WIDTH * unit};
    Stroke shaft = {.color = ROD_COLOR, .width = ROD_WIDTH * unit};
    Point line[5];
    for (int32_t k = 0; k < 5; ++k)
        line[k] = see_on_page(block, axes, block->low[0] + moved[0],
                              (round[k][0] ? high[0] : low[0]) + moved[1],
                              (round[k][1] ? high[1] : low[1]) + moved[2]);
    draw_line(page->canvas, &strip, line, 5);
    double z = (low[1] + high[1]) / 2 + moved[2], x = block->low[0] + moved[0];
    Point tip = see_on_page(block, axes, x, middle, z);
    Point back = see_on_page(block, axes, x - diagonal(block), middle, z);
    double way = hypot(back.x - tip.x, back.y - tip.y);
    double part = ROD_LENGTH * unit / way;
    Point from = {tip.x + part * (back.x - tip.x), tip.y + part * (back.y - tip.y)};
    arrow_draw(page, &shaft, from, tip, ROD_HEAD * unit);
}

// Statuses of the contact at a step, on the floor let down.
static void draw_floor(const Page *page, const BlockPage *map, const Block *block, int64_t row,
                       const Axes *axes)
{
    static const int32_t round[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    double unit = map->share * page->point;
    const ContactPlane *plane = &map->view->plane;
    double floor = floor_height(block);
    Stroke border = {.color = INK, .width = FLOOR_WIDTH * unit};
    Point line[5];
    for (int32_t k = 0; k < plane->patch_count && map->view->contact_status; ++k) {
        const ContactPatch *patch = &plane->patches[k];
        double status = map->view->contact_status[row * plane->nodes + patch->node];
        if (status >= 0 && status < STATUSES) {
            Color color = STATUS[(int32_t)status].color;
            Stroke seam = {.color = color, .width = fmax(1, SEAM * unit)};
            Point corner[PATCH_CORNERS + 1];
            for (int32_t c = 0; c <= PATCH_CORNERS; ++c) {
                const double *at = patch->corner[c % PATCH_CORNERS];
                corner[c] = see_on_page(block, axes, at[0], at[1], floor_height(block));
            }
            draw_polygon(page->canvas, color, corner, PATCH_CORNERS);
            draw_line(page->canvas, &seam, corner, PATCH_CORNERS + 1);
        }
    }
    for (int32_t k = 0; k < plane->side_count; ++k) {
        for (int32_t c = 0; c < 3; ++c)
            line[c] = see_on_page(block, axes, plane->sides[k].point[c][0],
                                  plane->sides[k].point[c][1], floor);
        draw_line(page->canvas, &border, line, 3);
    }
    for (int32_t k = 0; k < 5; ++k)
        line[k] = see_on_page(block, axes, round[k][0] ? block->high[0] : block->low[0],
                              round[k][1] ? block->high[1] : block->low[1], floor);
    draw_line(page->canvas, &border, line, 5);
}

// Draws along `axis` from `start`: ticks go to `aside`, a direction on the page. Where that is left
// or right the name rises, beside the numbers that it passes: the axis may lean.
static void draw_axis(const Page *page, const BlockPage *map, const Block *block, const Axes *axes,
                      int32_t axis, const double start[3], Point aside)
{
    static const char *const names[] = {"x", "y", "z"};
    Axis own = figure_length_axis(map->view, names[axis], block->low[axis], block->high[axis]);
    Ticks ticks = axis_ticks(&own, TICKS_WANTED);
    double point = page->point, at[3] = {start[0], start[1], start[2]};
    bool flat = fabs(aside.x) > fabs(aside.y), left = aside.x < 0;
    Stroke stroke = {.color = INK, .width = FRAME_WIDTH * point};
    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK};
    TextStyle name_style = {.size = LABEL_SIZE * point, .color = INK, .across = 0.5, .up = 1};
    style.across = flat ? left ? 1 : 0 : 0.5;
    style.up = flat ? 0.5 : 1;
    at[axis] = (block->low[axis] + block->high[axis]) / 2;
    Point name = see_on_page(block, axes, at[0], at[1], at[2]);
    double half = text_width(page->text, name_style.size, own.label) / 2 + style.size;
    double away = flat ? (TICK + NUMBER_GAP) * point : NAME_GAP * point;   // of the name
    for (int32_t k = 0; k < ticks.count; ++k) {
        char number[TICK_LABEL_SIZE];
        double offset = axis == 2 ? start[2] - block->low[2] : 0;   // the block's own heights
        at[axis] = tick_value(&ticks, k) / own.factor + offset;
        Point foot = see_on_page(block, axes, at[0], at[1], at[2]);
        Point end = {foot.x + TICK * point * aside.x, foot.y + TICK * point * aside.y};
        draw_segment(page->canvas, &stroke, foot, end);
        tick_label(&ticks, k, number);
        end.x += NUMBER_GAP * point * aside.x;
        end.y += NUMBER_GAP * point * aside.y;
        text_draw(page->text, &style, end, number);
        if (!flat || fabs(end.y - name.y) > half) continue;
        double outer = (end.x - name.x) / aside.x + text_width(page->text, style.size, number);
        away = fmax(away, outer + NUMBER_GAP * point);
    }
    if (flat) {
        name_style.rising = true;
        name_style.up = left ? 0 : 1;
    }
    text_draw(page->text, &name_style, (Point){name.x + away * aside.x, name.y + away * aside.y},
              own.label);
}

// The block, its floor, load and rod.
static bool draw_in_space(const Page *page, const BlockPage *map, const Block *block,
                          const Axes *axes, Error *err)
{
    double unit = map->share * page->point, top = -INFINITY;
    draw_floor(page, map, block, block->row, axes);
    if (!surface_draw(page, map, block, axes, err)) return false;

    // The load: arrows on the far edge of the top.
    Stroke load = {.color = LOAD_COLOR, .width = 0.6 * unit};
    for (int64_t i = 0; i < block->frame.node_count; ++i) top = fmax(top, block->moved[i][2]);
    for (int32_t k = 0; k < ARROWS_IN_SPACE && map->view->number[NUMBER_PRESSURE] > 0; ++k) {
        double x = block->low[0] + (block->high[0] - block->low[0]) * (k + 0.5) / ARROWS_IN_SPACE;
        Point tip = see_on_page(block, axes, x, block->high[1], top);
        tip.y -= GAP_IN_SPACE * unit;
        arrow_draw(page, &load, (Point){tip.x, tip.y - LOAD_LENGTH * unit}, tip, LOAD_HEAD * unit);
    }
    draw_rod(page, map, block, axes);
    return true;
}

// --- the block -----------------------------------------------------------------------------------

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
    if (block->moved)
        draw_floor(page, map, block, row, axes);
    else
        draw_contact(page, map, block, row, axes);
}

void block_page_axes(const Page *page, const BlockPage *map, const Block *block, const Axes *axes)
{
    if (!block->moved) {
        axes_draw(page, axes);
        return;
    }
    const double front[3] = {block->low[0], block->low[1], floor_height(block)};
    const double side[3] = {block->low[0], block->high[1], block->low[2]};
    draw_axis(page, map, block, axes, 0, front, (Point){0, 1});
    draw_axis(page, map, block, axes, 1, front, (Point){-1, 0});
    draw_axis(page, map, block, axes, 2, side, (Point){-1, 0});
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
    if (block->moved) return draw_in_space(page, map, block, axes, err);
    Stroke outline = {.color = INK, .width = OUTLINE_WIDTH * (map->share * page->point)};
    if (!surface_draw(page, map, block, axes, err)) return false;
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
