// SPDX-License-Identifier: GPL-2.0-or-later
// Where gmsh 4.8 puts the nodes of a straight transfinite curve, to the bit. Called by
// io/plain_model.
#ifndef AMONTONS_IO_PLAIN_CURVE_H
#define AMONTONS_IO_PLAIN_CURVE_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

// ratio 1: even, of any law. LAW_PROGRESSION: each cell `ratio` times as long as the one before it.
// LAW_BUMP: lengths follow a parabola, the middle cell about 1 / ratio times as long as the end
// ones.
typedef enum CurveLaw { LAW_PROGRESSION, LAW_BUMP } CurveLaw;

typedef struct CurveSpacing {
    int32_t cells;
    CurveLaw law;
    double ratio;   // above 0
} CurveSpacing;

// As the .geo says it: Progression or Bump whose coefficient is `ratio`, on `cells`. false: none
// that is reproduced (a number of cells that is none, or a grading so steep that gmsh needs a long
// time).
bool curve_spacing(CurveLaw law, double ratio, double cells, CurveSpacing *spacing);

// Nodes at[0] = from ... at[cells] = to.
bool curve_place_nodes(double from, double to, const CurveSpacing *spacing, double *at, Error *err);

#endif
