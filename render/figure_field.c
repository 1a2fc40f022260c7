// SPDX-License-Identifier: GPL-2.0-or-later
// The block at one stored time: a field in colours with contour lines, on the deformed mesh.
#include "render/figures.h"

#include "render/block_page.h"
#include "render/zoom.h"

#include <math.h>
#include <stdio.h>

static const double LEFT = 30, RIGHT = 60;   // points beside the frame: numbers; the colour bar
static const double WORDS_HEIGHT = 11;   // points above the frame
static const double LEGEND_HEIGHT = 10;   // points below the names of the axes
static const double BAR_GAP = 6;   // points: frame to colour bar
static const double SHAPE_MAX = 1.1;   // of the frame's height over the room for its width

enum { WORDS_SIZE = 160 };

// What is drawn, where, and its scale in points.
typedef struct FieldPage {
    Block block;
    double extent[4];
    double scale, width, height;   // of the frame, points
    double magnification;
} FieldPage;

// The state that the request asks for; without a word the last one before the zoomed sliding.
static bool read_block(const FigureInput *input, Block *block, Error *err)
{
    BlockTimes times = {0};
    BlockQuantity quantity = BLOCK_VON_MISES;
    int32_t index = 0;
    TRY(block_quantity_find(input->field->of, &quantity, err));
    TRY(block_times_read(input->folder, input->view, &times, err));
    Zoom zoom = zoom_choose(input->view);
    index = zoom.found ? block_time_before(&times, input->view, zoom.U_slide) : times.count - 1;
    if (input->field->at) TRY(block_time_find(&times, input->view, input->field->at, &index, err));
    TRY(block_read(input->folder, input->view, &times, index, block, err));
    TRY(block_take(block, quantity, err));
    TRY(result_view_read_status(input->view, err));
cleanup:
    block_times_destroy(&times);
    return error_is_clean(err);
}

// To scale, as wide as there is room, or less where it would be too high.
static void lay_out(const FigureInput *input, FieldPage *field)
{
    double room = page_width(input->def.style) - LEFT - RIGHT;
    field->magnification = block_magnification(&field->block);
    block_deform(&field->block, field->magnification);
    block_extent(&field->block, field->extent);
    field->width = room;
    field->scale = block_page_scale(field->extent, room, 1);
    field->height = block_page_height(field->extent, field->scale, 1);
    if (field->height > SHAPE_MAX * room) {
        double part = SHAPE_MAX * room / field->height;
        field->scale *= part;
        field->height = block_page_height(field->extent, field->scale, 1);
        Axes axes = {0};
        block_page_ranges(field->extent, field->scale, 1, &axes);
        field->width = field->scale * (axes.x.high - axes.x.low);
    }
}

// "U / L_0 = 0.0117   deformation x 50".
static void draw_words(const Page *page, const FigureInput *input, const FieldPage *field,
                       const Axes *axes)
{
    char words[WORDS_SIZE];
    Axis U = figure_length_axis(input->view, "U", field->block.U, field->block.U);
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = INK};
    snprintf(words, sizeof words, "%s = %.5g    deformation \u00d7 %g", U.label,
             field->block.U * U.factor, field->magnification);
    text_draw(page->text, &style, (Point){axes->box.left, axes->box.top - 3.5 * page->point},
              words);
}

static bool draw_field(const Page *page, const FigureInput *input, const FieldPage *field,
                       Error *err)
{
    double point = page->point, low = field->extent[0], high = field->extent[1];
    uint8_t colors[3 * MAP_SIZE];
    BlockQuantity quantity = BLOCK_VON_MISES;
    BlockPage map = {.view = input->view, .edges = input->field->edges, .share = 1};
    Axes axes = {.x = figure_length_axis(input->view, "x", low, high),
                 .number_size = NUMBER_SIZE,
                 .color = INK};
    axes.y = axes.x;
    snprintf(axes.y.label, sizeof axes.y.label, "~{z}%.80s", axes.x.label + 4);   // behind "~{x}"
    block_page_ranges(field->extent, field->scale, 1, &axes);
    axes.box.left = round(LEFT * point);
    axes.box.top = page->head + round(WORDS_HEIGHT * point);
    axes.box.right = axes.box.left + round(field->width * point);
    axes.box.bottom = axes.box.top + round(field->height * point);
    TRY(block_quantity_find(input->field->of, &quantity, err));
    TRY(block_page_fit(&map, &field->block, 1, quantity, err));
    color_map_fill(colors);
    canvas_set_map(page->canvas, colors, PAPER);
    TRY(block_page_draw(page, &map, &field->block, &axes, err));
    axes_draw(page, &axes);
    draw_words(page, input, field, &axes);
    Box beside = axes.box;
    beside.left = round(axes.box.right + BAR_GAP * point);
    colorbar_draw(page, &map.bar, &beside);
    double below = axes.box.bottom + (axes_bottom_margin(&axes) + 0.5 * LEGEND_HEIGHT) * point;
    block_page_legend(page, (Point){axes.box.left, below});
cleanup:
    return error_is_clean(err);
}

bool figure_field(Page *page, const FigureInput *input, Error *err)
{
    FieldPage field = {0};
    PageDef def = input->def;
    Axes axes = {.x.label = "x", .number_size = NUMBER_SIZE};
    TRY(read_block(input, &field.block, err));
    lay_out(input, &field);
    def.height = (WORDS_HEIGHT + field.height + axes_bottom_margin(&axes) + LEGEND_HEIGHT) /
                 page_width(def.style);
    TRY(page_begin(page, &def, err));
    TRY(draw_field(page, input, &field, err));
cleanup:
    block_destroy(&field.block);
    return error_is_clean(err);
}
