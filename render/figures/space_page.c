// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/space_page.h"

#include "render/figures/figures.h"
#include "render/figures/rod_mark.h"
#include "render/figures/surface_draw.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ARROWS = 7, STATUSES = 4, TICKS_WANTED = 4 };

static const double SEAM = 0.2, FLOOR_WIDTH = 0.4, STRIP_WIDTH = 1.2;   // points
static const double LOAD_LENGTH = 8, LOAD_GAP = 1, LOAD_HEAD = 2;   // points
static const double ROD_LENGTH = 11, ROD_HEAD = 3, ROD_WIDTH = 1;   // points
static const double TICK = 2.5, NUMBER_GAP = 2, NAME_GAP = 13;   // points
static const double FACE_SLACK = 1e-6;   // of the diagonal

static const Color LOAD_COLOR = {0.10f, 0.32f, 0.66f, 1};

static double diagonal(const Block *block)
{
    double sum = 0;
    for (int32_t d = 0; d < 3; ++d) sum += pow(block->high[d] - block->low[d], 2);
    return sqrt(sum);
}

static Point see_on_page(const SpacePage *space, const Block *block, double x, double y, double z)
{
    const double place[3] = {x, y, z};
    return surface_see(block, &space->axes, place).at;
}

static double floor_height(const Block *block)
{
    return block->low[2] - camera_drop(block->low, block->high);
}

void space_page_floor_corners(const Block *block, double corner[4][2])
{
    for (int32_t k = 0; k < 4; ++k) {
        const double place[3] = {k % 2 ? block->high[0] : block->low[0],
                                 k / 2 ? block->high[1] : block->low[1], floor_height(block)};
        double seen[3];
        camera_see(&block->camera, place, seen);
        memcpy(corner[k], seen, sizeof corner[k]);
    }
}

// --- marks ---------------------------------------------------------------------------------------

// Distance of a node of the trailing face above or below the strip; INFINITY: it is beside it.
static double off_strip(const Block *block, int64_t node, const double low[2], const double high[2])
{
    const double *was = block->frame.position + 3 * node;
    double slack = FACE_SLACK * diagonal(block);
    bool beside = was[0] > block->low[0] + slack || was[1] < low[0] - slack ||
                  was[1] > high[0] + slack;
    return beside ? INFINITY : fmax(0, fmax(low[1] - was[2], was[2] - high[1]));
}

// The strip that the rod pushes, and an arrow against its middle; not where it was cut away.
static void draw_rod(const Page *page, const SpacePage *space, const Block *block)
{
    static const int32_t round[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    const double *number = space->view->number;
    const SpaceCut *cut = space->cut;
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
        if (off_strip(block, i, low, high) > nearest + FACE_SLACK * diagonal(block)) continue;
        count += 1;
        for (int32_t d = 0; d < 3; ++d)
            moved[d] += block->moved[i][d] - block->frame.position[3 * i + d];
    }
    if (count == 0) return;
    for (int32_t d = 0; d < 3; ++d) moved[d] /= count;

    Stroke strip = {.color = ROD_COLOR, .width = STRIP_WIDTH * space->unit};
    Stroke shaft = {.color = ROD_COLOR, .width = ROD_WIDTH * space->unit};
    Point line[5];
    for (int32_t k = 0; k < 5; ++k)
        line[k] = see_on_page(space, block, block->low[0] + moved[0],
                              (round[k][0] ? high[0] : low[0]) + moved[1],
                              (round[k][1] ? high[1] : low[1]) + moved[2]);
    draw_line(page->canvas, &strip, line, 5);
    double z = (low[1] + high[1]) / 2 + moved[2], x = block->low[0] + moved[0];
    Point tip = see_on_page(space, block, x, middle, z);
    Point back = see_on_page(space, block, x - diagonal(block), middle, z);
    double way = hypot(back.x - tip.x, back.y - tip.y);
    double part = ROD_LENGTH * space->unit / way;
    Point from = {tip.x + part * (back.x - tip.x), tip.y + part * (back.y - tip.y)};
    arrow_draw(page, &shaft, from, tip, ROD_HEAD * space->unit);
}

// --- the floor -----------------------------------------------------------------------------------

void space_page_floor(const Page *page, const SpacePage *space, const Block *block, int64_t row)
{
    static const int32_t round[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    const ContactPlane *plane = &space->view->plane;
    double floor = floor_height(block);
    Stroke border = {.color = INK, .width = FLOOR_WIDTH * space->unit};
    Point line[5];
    for (int32_t k = 0; k < plane->patch_count && space->view->contact_status; ++k) {
        const ContactPatch *patch = &plane->patches[k];
        double status = space->view->contact_status[row * plane->nodes + patch->node];
        if (status >= 0 && status < STATUSES) {
            Color color = space->status[(int32_t)status];
            Stroke seam = {.color = color, .width = fmax(1, SEAM * space->unit)};
            Point corner[PATCH_CORNERS + 1];
            for (int32_t c = 0; c <= PATCH_CORNERS; ++c) {
                const double *at = patch->corner[c % PATCH_CORNERS];
                corner[c] = see_on_page(space, block, at[0], at[1], floor_height(block));
            }
            draw_polygon(page->canvas, color, corner, PATCH_CORNERS);
            draw_line(page->canvas, &seam, corner, PATCH_CORNERS + 1);
        }
    }
    for (int32_t k = 0; k < plane->side_count; ++k) {
        for (int32_t c = 0; c < 3; ++c)
            line[c] = see_on_page(space, block, plane->sides[k].point[c][0],
                                  plane->sides[k].point[c][1], floor);
        draw_line(page->canvas, &border, line, 3);
    }
    for (int32_t k = 0; k < 5; ++k)
        line[k] = see_on_page(space, block, round[k][0] ? block->high[0] : block->low[0],
                              round[k][1] ? block->high[1] : block->low[1], floor);
    draw_line(page->canvas, &border, line, 5);
}

// --- axes ----------------------------------------------------------------------------------------

// Draws along `axis` from `start`: ticks go to `aside`, a direction on the page. Where that is left
// or right the name rises, beside the numbers that it passes: the axis may lean.
static void draw_axis(const Page *page, const SpacePage *space, const Block *block, int32_t axis,
                      const double start[3], Point aside)
{
    static const char *const names[] = {"x", "y", "z"};
    Axis own = figure_length_axis(space->view, names[axis], block->low[axis], block->high[axis]);
    Ticks ticks = axis_ticks(&own, TICKS_WANTED);
    double point = page->point, at[3] = {start[0], start[1], start[2]};
    bool flat = fabs(aside.x) > fabs(aside.y), left = aside.x < 0;
    Stroke stroke = {.color = INK, .width = FRAME_WIDTH * point};
    TextStyle style = {.size = NUMBER_SIZE * point, .color = INK};
    TextStyle name_style = {.size = LABEL_SIZE * point, .color = INK, .across = 0.5, .up = 1};
    style.across = flat ? left ? 1 : 0 : 0.5;
    style.up = flat ? 0.5 : 1;
    at[axis] = (block->low[axis] + block->high[axis]) / 2;
    Point name = see_on_page(space, block, at[0], at[1], at[2]);
    double half = text_width(page->text, name_style.size, own.label) / 2 + style.size;
    double away = flat ? (TICK + NUMBER_GAP) * point : NAME_GAP * point;   // of the name
    for (int32_t k = 0; k < ticks.count; ++k) {
        char number[TICK_LABEL_SIZE];
        double offset = axis == 2 ? start[2] - block->low[2] : 0;   // the block's own heights
        at[axis] = tick_value(&ticks, k) / own.factor + offset;
        Point foot = see_on_page(space, block, at[0], at[1], at[2]);
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

void space_page_axes(const Page *page, const SpacePage *space, const Block *block)
{
    double floor = floor_height(block);
    const double front[3] = {block->low[0], block->low[1], floor};
    const double side[3] = {block->low[0], block->high[1], block->low[2]};
    draw_axis(page, space, block, 0, front, (Point){0, 1});
    draw_axis(page, space, block, 1, front, (Point){-1, 0});
    draw_axis(page, space, block, 2, side, (Point){-1, 0});
}

bool space_page_draw(const Page *page, const SpacePage *space, const Block *block, Error *err)
{
    double unit = space->unit, top = -INFINITY;
    const SurfaceDrawing drawing = {block,      &space->axes, space->bar,
                                    space->cut, space->edges, unit};
    space_page_floor(page, space, block, block->row);
    if (!surface_draw(page, &drawing, err)) return false;

    // The load: arrows on the far edge of the top.
    Stroke load = {.color = LOAD_COLOR, .width = 0.6 * unit};
    for (int64_t i = 0; i < block->frame.node_count; ++i) top = fmax(top, block->moved[i][2]);
    for (int32_t k = 0; k < ARROWS && space->view->number[NUMBER_PRESSURE] > 0; ++k) {
        double x = block->low[0] + (block->high[0] - block->low[0]) * (k + 0.5) / ARROWS;
        Point tip = see_on_page(space, block, x, block->high[1], top);
        tip.y -= LOAD_GAP * unit;
        arrow_draw(page, &load, (Point){tip.x, tip.y - LOAD_LENGTH * unit}, tip, LOAD_HEAD * unit);
    }
    draw_rod(page, space, block);
    return true;
}
