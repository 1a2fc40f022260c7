// SPDX-License-Identifier: GPL-2.0-or-later
// The block at several stored times as small pictures of one size, range and magnification. Called
// by frames.
//
//   fit (looks at some of the times) -> html, for each time
#ifndef AMONTONS_RENDER_FRAMES_FRAME_IMAGES_H
#define AMONTONS_RENDER_FRAMES_FRAME_IMAGES_H

#include "io/text/html_writer.h"
#include "render/figures/figure_field.h"

typedef struct FrameImages {
    const BlockSource *source;
    PictureStyle style;   // set by fit, like what follows
    FieldPage field;
    BlockPage map;
    double shape;   // height over width
} FrameImages;

// chosen: [count] indices of times. The source is given.
bool frame_images_fit(FrameImages *images, const int32_t *chosen, int32_t count, Error *err);
// An <img> with the picture in it.
bool frame_images_html(const FrameImages *images, int32_t index, HtmlWriter *html, Error *err);

#endif
