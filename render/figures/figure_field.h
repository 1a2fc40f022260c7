// SPDX-License-Identifier: GPL-2.0-or-later
// A page with one field of the block: its size, and what is drawn on it. Called by frames.
#ifndef AMONTONS_RENDER_FIGURES_FIGURE_FIELD_H
#define AMONTONS_RENDER_FIGURES_FIGURE_FIELD_H

#include "render/figures/block_page.h"

// map: fitted. Lays it out to scale on a page so many points wide, or less where it would be too
// high. The page's height over its width.
double field_page_lay_out(BlockPage *map, double page_width);

// map: laid out; block: deformed.
bool field_page_draw(const Page *page, const BlockPage *map, const Block *block, Error *err);

#endif
