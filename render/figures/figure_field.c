// SPDX-License-Identifier: GPL-2.0-or-later
// The block at one stored time: a field in colours with contour lines, on the deformed mesh.
#include "render/figures/figure_field.h"

#include "render/figures/figures.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

static const double LEFT = 30, RIGHT = 60;   // points beside the frame: numbers; the colour bar
static const double WORDS_HEIGHT = 11;   // points above the frame
static const double LEGEND_HEIGHT = 10;   // points below the names of the axes
static const double BAR_GAP = 6;   // points: frame to colour bar
static const double SHAPE_MAX = 1.1;   // of the frame's height over the room for its width

enum { WORDS_SIZE = 160 };

double field_page_lay_out(BlockPage *map, double page_width)
{
    double room = page_width - LEFT - RIGHT;
    Axes axes = {.x.label = "x"};
    block_page_size(map, room, SHAPE_MAX * room);
    return (WORDS_HEIGHT + map->height + axes_bottom_margin(&axes) + LEGEND_HEIGHT) / page_width;
}

bool field_page_draw(const Page *page, const BlockPage *map, const Block *block, Error *err)
{
    double point = page->point, low = map->extent[0], high = map->extent[1];
    Axes axes = {.x = figure_length_axis(map->view, "x", low, high)};
    axes.y = axes.x;
    snprintf(axes.y.label, sizeof axes.y.label, "~{z}%.80s", axes.x.label + 4);   // behind "~{x}"
    block_page_place(page, map, round(LEFT * point), page->room.top + round(WORDS_HEIGHT * point),
                     &axes);
    if (!block_page_draw(page, map, block, &axes, err)) return false;
    block_page_axes(page, map, block, &axes);

    // "U / L_0 = 0.0117   deformation x 50".
    char words[WORDS_SIZE];
    Axis U = figure_length_axis(map->view, "U", block->U, block->U);
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = INK};
    snprintf(words, sizeof words, "%s = %.5g    deformation \u00d7 %g", U.label,
             block->U * U.factor, map->magnification);
    text_draw_within(page->text, &style, (Point){axes.box.left, axes.box.top - 3.5 * page->point},
                     axes.box.right - axes.box.left, words);

    colorbar_draw(page, &map->bar, &axes.box, BAR_GAP);
    double below = axes.box.bottom + (axes_bottom_margin(&axes) + 0.5 * LEGEND_HEIGHT) * point;
    block_page_legend(page, (Point){axes.box.left, below}, 0);
    return true;
}

bool figure_field_shows(const char *folder, const char *quantity)
{
    Error unknown = {0};
    BlockQuantity found = BLOCK_VON_MISES;
    return block_is_stored(folder) && block_quantity_find(quantity, &found, &unknown);
}

bool figure_field(Page *page, const FigureInput *input, Error *err)
{
    Block block = {0};
    PageDef def = input->def;
    BlockSource source = {.folder = input->folder,
                          .view = input->view,
                          .quantity = BLOCK_VON_MISES,
                          .depth = def.style->depth};
    BlockPage map = {
        .view = input->view, .edges = input->field->edges, .share = 1, .style = input->def.style};
    TRY(block_cut_read(input->view, input->field->cut, &map.cut, err));
    TRY(block_quantity_find(input->field->of, &source.quantity, err));

    // The state that the request asks for; without a word the last one before the zoomed sliding.
    TRY(block_source_open(&source, err));
    Zoom zoom = zoom_choose(input->view);
    int32_t index = zoom.found ? block_time_before(&source, zoom.U_slide) : source.count - 1;
    if (input->field->at) TRY(block_time_find(&source, input->field->at, &index, err));
    TRY(block_read(&source, index, &block, err));
    TRY(result_view_read_status(input->view, err));

    TRY(block_page_fit(&map, &block, 1, source.quantity, err));
    def.height = field_page_lay_out(&map, page_width(def.style));
    TRY(page_begin(page, &def, err));
    TRY(field_page_draw(page, &map, &block, err));
cleanup:
    block_source_close(&source);
    block_destroy(&block);
    return error_is_clean(err);
}
