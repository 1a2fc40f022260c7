// SPDX-License-Identifier: GPL-2.0-or-later
// From slip rates, or states, at accepted steps and contact nodes to those at pixels of U against
// x. Numbers only; called by figure_maps and film_page.
//
// Steps lie very unevenly in U: thousands inside a rapid event that is thinner than a pixel, none
// for many pixels while nothing happens. A column of pixels takes the fastest of the steps
// inside it, so no event is lost; one without a step takes the step that ends behind it, as an
// implicit step holds its end's value. A rapid event shorter than `event_columns` is so many
// columns wide, around its middle. With `slip` a pixel shows the mean rate over its U instead: how
// far slip went over how far the rod went, times V. Of states a pixel shows the largest or, as slip
// makes contacts young, the smallest. A node stands for the part of its pad that is nearest.
#ifndef AMONTONS_RENDER_VIEW_SPACE_TIME_H
#define AMONTONS_RENDER_VIEW_SPACE_TIME_H

#include "base/error.h"

// All borrowed.
typedef struct SpaceTime {
    int64_t rows;   // accepted steps
    const double *U;   // [rows] not falling; rows that are not finite are passed over
    int32_t nodes;
    const double *x;   // [nodes] ascending
    const double *pad;   // [nodes] between nodes of different pads is a gap
    const double *value;   // [rows * nodes] slip rates, velocity, or states; NaN: none
    const double *slip;   // [rows * nodes] length; NULL: the fastest is wanted, not the mean
    double V;   // velocity of the rod; for the mean
    int32_t event_count;
    const double (*events)[2];   // [event_count] U from and to, of rapid events
    int32_t sign;   // of what a pixel shows: 0 the largest |value|, 1 the largest, -1 the smallest
} SpaceTime;

typedef struct PixelGrid {
    double U_low, U_high;   // what the columns span
    double x_low, x_high;   // what the rows span, x_high at the top
    int32_t columns, rows;
    int32_t event_columns;   // of a short rapid event, at least 1
    float
        *values;   // [rows * columns] of |value|, or value, first row at the top; NaN: none; owned
} PixelGrid;

// Fills `values`; the other members are given.
bool space_time_to_pixels(const SpaceTime *data, PixelGrid *grid, Error *err);
void pixel_grid_destroy(PixelGrid *grid);   // zeroed is fine

// The part of its pad that node i stands for: from half-way to its neighbours, ends at pad ends.
void node_extent(const SpaceTime *data, int32_t i, double *from, double *to);

#endif
