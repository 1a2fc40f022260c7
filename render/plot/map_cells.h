// SPDX-License-Identifier: GPL-2.0-or-later
// The grid that the points of a map form, complete or with gaps: cells, each half way to its
// neighbours. Numbers only. Called by plot_file and plot_map.
#ifndef AMONTONS_RENDER_PLOT_MAP_CELLS_H
#define AMONTONS_RENDER_PLOT_MAP_CELLS_H

#include "render/picture_options.h"
#include "render/plot/plot.h"

// Coordinates are those of the axes' scales: logarithms on a logarithmic one.
typedef struct MapGrid {
    int32_t columns, rows;   // 0: the points are no grid
    double *x, *y;   // [columns + 1], [rows + 1] edges of the cells, rising; owned
    int32_t *point;   // [rows * columns] in the cell, -1: none; owned
} MapGrid;

// Most places of a grid must be taken, none twice. Points that an axis cannot show do not count.
bool map_grid_find(const PlotMap *map, bool x_is_log, bool y_is_log, MapGrid *grid, Error *err);
void map_grid_destroy(MapGrid *grid);   // zeroed is fine

// Median, for each point that has a value, of those in MAP_MEDIANS by MAP_MEDIANS cells around it.
void map_medians(const MapGrid *grid, const double *values, double *medians);

#endif
