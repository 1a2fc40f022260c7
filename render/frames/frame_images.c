// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/frames/frame_images.h"

// Size of a picture for a screen: 600 pixels wide, letters 14 pixels high.
static const double WIDTH = 95, DPI = 160;   // mm

enum { LOOKED_AT = 6 };   // of the times; memory for so many blocks

bool frame_images_fit(FrameImages *images, const int32_t *chosen, int32_t count, Error *err)
{
    Block blocks[LOOKED_AT] = {0};
    int32_t looked = count < LOOKED_AT ? count : LOOKED_AT;
    for (int32_t k = 0; k < looked; ++k) {
        int32_t at = looked > 1 ? (int32_t)((int64_t)k * (count - 1) / (looked - 1)) : 0;
        TRY(block_read(images->source, chosen[at], &blocks[k], err));
    }
    block_page_deform(blocks, looked, &images->field.magnification, images->field.extent);
    images->style = (PictureStyle){.format = "png", .width = WIDTH, .dpi = DPI};
    images->map = (BlockPage){.view = images->source->view, .share = 1};
    TRY(block_page_fit(&images->map, blocks, looked, images->source->quantity, err));
    images->shape = field_page_lay_out(&images->field, page_width(&images->style));
cleanup:
    for (int32_t k = 0; k < LOOKED_AT; ++k) block_destroy(&blocks[k]);
    return error_is_clean(err);
}

bool frame_images_html(const FrameImages *images, int32_t index, HtmlWriter *html, Error *err)
{
    Block block = {0};
    Page page = {0};
    PictureBytes picture = {0};
    PageDef def = {.style = &images->style, .height = images->shape};
    BlockWords words = block_words(images->source->quantity);
    TRY(block_read(images->source, index, &block, err));
    block_deform(&block, images->field.magnification);
    TRY(page_begin(&page, &def, err));
    TRY(field_page_draw(&page, &images->field, &images->map, &block, err));
    TRY(canvas_finish(page.canvas, words.name, true, &picture, err));
    html_markup(html,
                "<img class='paper' width='%d' height='%d' alt='The deformed block, %s in "
                "colours, and which parts of its contact stick, slip or are open, at U = %.6g' "
                "src='",
                canvas_width(page.canvas), canvas_height(page.canvas), words.name, block.U);
    html_data(html, "image/png", picture.bytes, picture.size);
    html_markup(html, "'>");
cleanup:
    page_destroy(&page);
    block_destroy(&block);
    return error_is_clean(err);
}
