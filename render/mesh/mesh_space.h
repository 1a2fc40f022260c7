// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh in space in perspective: its outside in the colours of its groups, its contact once more
// below it. Called by mesh_picture.
#ifndef AMONTONS_RENDER_MESH_MESH_SPACE_H
#define AMONTONS_RENDER_MESH_MESH_SPACE_H

#include "render/canvas/axes.h"
#include "render/render.h"

// The picture's height over its width, without what stands above and below the block.
double mesh_space_shape(const RenderMesh *mesh);
// color: [group_count] of the groups of surfaces. ERROR_MEMORY.
bool mesh_space_draw(const RenderMesh *mesh, const Page *page, const Box *box, const Color *color,
                     Error *err);

#endif
