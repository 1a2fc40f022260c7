// SPDX-License-Identifier: GPL-2.0-or-later
// A grid of values made finer, so that lines of equal value bend where they turn: in each direction
// a cubic between two points whose slopes are those of Fritsch and Carlson (SIAM J. Numer. Anal.
// 17, 238, 1980), which goes through every value and beyond none. Called by plot_map.
#ifndef AMONTONS_RENDER_PLOT_MAP_SMOOTH_H
#define AMONTONS_RENDER_PLOT_MAP_SMOOTH_H

#include "render/picture_options.h"
#include "render/canvas/canvas.h"
#include "render/plot/map_cells.h"

typedef struct SmoothGrid {
    int32_t columns, rows;
    Point *place;   // [rows * columns] owned, as the next
    double *value;   // [rows * columns] NaN: between points of which one has none
    MapTriangles triangles;   // two between any four of them
} SmoothGrid;

// values, place: of the map's points; parts: of each distance between two points. A cell of the
// grid without a point has no value.
bool map_smooth(const MapGrid *grid, const double *values, const Point *place, int32_t parts,
                SmoothGrid *smooth, Error *err);
void smooth_destroy(SmoothGrid *smooth);   // zeroed is fine

// Median, for each point that has a value, of those in MAP_MEDIANS by MAP_MEDIANS cells around it.
void map_medians(const MapGrid *grid, const double *values, double *medians);

#endif
