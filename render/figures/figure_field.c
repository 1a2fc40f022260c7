// SPDX-License-Identifier: GPL-2.0-or-later
// The block at one stored time: a field in colours with contour lines, on the deformed mesh.
#include "render/figures/figures.h"

#include "render/figures/field_page.h"
#include "render/view/zoom.h"

// The state that the request asks for; without a word the last one before the zoomed sliding.
static bool read_block(const FigureInput *input, BlockQuantity quantity, Block *block, Error *err)
{
    BlockSource source = {.folder = input->folder,
                          .view = input->view,
                          .quantity = quantity,
                          .depth = input->def.style->depth};
    TRY(block_source_open(&source, err));
    Zoom zoom = zoom_choose(input->view);
    int32_t index = zoom.found ? block_time_before(&source, zoom.U_slide) : source.count - 1;
    if (input->field->at) TRY(block_time_find(&source, input->field->at, &index, err));
    TRY(block_read(&source, index, block, err));
    TRY(result_view_read_status(input->view, err));
cleanup:
    block_source_close(&source);
    return error_is_clean(err);
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
    TRY(read_block(input, quantity, &block, err));
    block_page_deform(&block, 1, &field.magnification, field.extent);
    TRY(block_page_fit(&map, &block, 1, quantity, err));
    def.height = field_page_lay_out(&field, page_width(def.style));
    TRY(page_begin(page, &def, err));
    TRY(field_page_draw(page, &field, &map, &block, err));
cleanup:
    block_destroy(&block);
    return error_is_clean(err);
}
