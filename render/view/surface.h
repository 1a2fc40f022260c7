// SPDX-License-Identifier: GPL-2.0-or-later
// The boundary of a block in space, cut open where that is asked, and the cut itself, or a block in
// the plane, as small triangles and lines. Numbers only; called by surface_draw.
#ifndef AMONTONS_RENDER_VIEW_SURFACE_H
#define AMONTONS_RENDER_VIEW_SURFACE_H

#include "render/view/block.h"

// Planes x, y or z = value through the block as it was; what lies before all of them, as seen from
// the camera, is taken away.
typedef struct SpaceCut {
    int32_t count;
    int32_t axis[3];   // 0 to 2
    double value[3];   // length
} SpaceCut;

typedef struct SurfacePoint {
    double was[3], at[3];   // before anything moved, and as drawn; length
    double value;
} SurfacePoint;

typedef struct SurfaceParts {
    SurfacePoint *points;   // [each * count] owned
    int32_t count, room;
} SurfaceParts;

typedef struct Surface {
    SurfaceParts triangles;   // three points each
    SurfaceParts outline;   // two: where faces meet at an angle, around the cut and in the plane
    SurfaceParts edges;   // two: of elements, where they were asked for
} Surface;

// "y=0.25", or several, as in "x=0.2,y=0.25"; NULL: none. ERROR_INPUT: not so.
bool space_cut_read(const char *words, SpaceCut *cut, Error *err);

// parts: along a side of a face, but a T3 stays whole; 0: as many as its kind asks for.
enum { SURFACE_PARTS_MAX = 16 };
bool surface_build(const Block *block, const SpaceCut *cut, bool edges, int32_t parts,
                   Surface *surface, Error *err);
void surface_destroy(Surface *surface);   // zeroed is fine

#endif
