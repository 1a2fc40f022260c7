// SPDX-License-Identifier: GPL-2.0-or-later
// The block at one stored time: a field in colours with contour lines, on the deformed mesh.
#include "render/figures/figures.h"

#include "render/figures/field_page.h"
#include "render/view/zoom.h"

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

bool figure_field_shows(const char *quantity)
{
    Error unknown = {0};
    BlockQuantity found = BLOCK_VON_MISES;
    return block_quantity_find(quantity, &found, &unknown);
}

bool figure_field(Page *page, const FigureInput *input, Error *err)
{
    Block block = {0};
    FieldPage field = {0};
    PageDef def = input->def;
    BlockQuantity quantity = BLOCK_VON_MISES;
    SpaceCut cut;
    BlockPage map = {.view = input->view,
                     .edges = input->field->edges,
                     .cut = &cut,
                     .share = 1,
                     .style = input->def.style};
    TRY(block_cut_read(input->view, input->field->cut, &cut, err));
    TRY(block_quantity_find(input->field->of, &quantity, err));
    TRY(read_block(input, &block, err));
    field.magnification = block_magnification(&block);
    block_deform(&block, field.magnification);
    block_extent(&block, field.extent);
    TRY(block_page_fit(&map, &block, 1, quantity, err));
    def.height = field_page_lay_out(&field, page_width(def.style));
    TRY(page_begin(page, &def, err));
    TRY(field_page_draw(page, &field, &map, &block, err));
cleanup:
    block_destroy(&block);
    return error_is_clean(err);
}
