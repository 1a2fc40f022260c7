// SPDX-License-Identifier: GPL-2.0-or-later
// The cut through a block in space: what of triangles and lines is left, and the section itself.
// Called by surface and the figures of fields.
#ifndef AMONTONS_RENDER_VIEW_SURFACE_CUT_H
#define AMONTONS_RENDER_VIEW_SURFACE_CUT_H

#include "render/view/surface_parts.h"

// "y=0.25", or several, as in "x=0.2,y=0.25"; NULL: none. ERROR_INPUT: not so.
bool space_cut_read(const char *words, SpaceCut *cut, Error *err);

// By the shape functions of an element, or of a face, whose nodes these are.
SurfacePoint surface_point_at(const Block *block, ElementKind kind, const int32_t *nodes,
                              const double *at);

// Adds the part of a boundary triangle that the cut leaves; where the cut goes through it, an
// outline.
bool surface_add_outside(const SurfacePoint corner[3], const SpaceCut *cut, Surface *surface,
                         Error *err);
// Adds the part of a line between two points that the cut leaves.
bool surface_add_line(const SurfacePoint *two, const SpaceCut *cut, SurfaceParts *lines,
                      Error *err);
// Plane k through all elements, as far as the other planes take away; and its edges with them.
bool surface_add_section(const Block *block, const SpaceCut *cut, int32_t k, Surface *surface,
                         Error *err);

#endif
