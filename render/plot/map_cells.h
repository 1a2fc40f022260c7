// SPDX-License-Identifier: GPL-2.0-or-later
// The grid that the points of a map form, complete or with gaps: cells, each half way to its
// neighbours, and the triangles between points. Numbers only. Called by plot_file and plot_map.
#ifndef AMONTONS_RENDER_PLOT_MAP_CELLS_H
#define AMONTONS_RENDER_PLOT_MAP_CELLS_H

#include "render/plot/plot.h"

// Coordinates are those of the axes' scales: logarithms on a logarithmic one.
typedef struct MapGrid {
    int32_t columns, rows;   // 0: the points are no grid
    double *x, *y;   // [columns + 1], [rows + 1] edges of the cells, rising; owned
    int32_t *point;   // [rows * columns] in the cell, -1: none; owned
} MapGrid;

typedef struct MapTriangles {
    int32_t count;
    int32_t *points;   // [count * 3]; owned
} MapTriangles;

// Most places of a grid must be taken, none twice. Points that an axis cannot show do not count.
bool map_grid_find(const PlotMap *map, bool x_is_log, bool y_is_log, MapGrid *grid, Error *err);
void map_grid_destroy(MapGrid *grid);   // zeroed is fine

// Points next to each other, for lines between them: two triangles in the middle of any four cells
// that meet and hold points.
bool map_triangles_find(const MapGrid *grid, MapTriangles *triangles, Error *err);
void map_triangles_destroy(MapTriangles *triangles);   // zeroed is fine

#endif
