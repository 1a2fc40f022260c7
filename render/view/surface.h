// SPDX-License-Identifier: GPL-2.0-or-later
// The boundary of a block in space, cut open where that is asked, and the cut itself. Numbers only;
// called by space_page.
#ifndef AMONTONS_RENDER_VIEW_SURFACE_H
#define AMONTONS_RENDER_VIEW_SURFACE_H

#include "render/view/surface_parts.h"

bool surface_build(const Block *block, const SpaceCut *cut, bool edges, Surface *surface,
                   Error *err);
void surface_destroy(Surface *surface);   // zeroed is fine

#endif
