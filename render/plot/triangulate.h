// SPDX-License-Identifier: GPL-2.0-or-later
// Delaunay's triangles of points in the plane, by Qhull (Barber, Dobkin and Huhdanpaa, ACM Trans.
// Math. Softw. 22, 1996). Called by map_cells.
#ifndef AMONTONS_RENDER_PLOT_TRIANGULATE_H
#define AMONTONS_RENDER_PLOT_TRIANGULATE_H

#include "render/canvas/canvas.h"

// *corners: [*triangles * 3] indices, the caller's (memory_free). Points that are not finite are in
// none; where all lie on one line there is none.
bool triangulate(const Point *points, int32_t count, int32_t **corners, int32_t *triangles,
                 Error *err);

#endif
