// SPDX-License-Identifier: GPL-2.0-or-later
// A geometry of rectangles with straight transfinite curves, and its mesh of quadrilaterals as gmsh
// 4.8 makes it, to the bit. Points, curves, patches stand in the order of gmsh's tags. Built by
// io/plain_block and io/plain_pads, meshed for io/plain_mesh.
#ifndef AMONTONS_IO_PLAIN_MODEL_H
#define AMONTONS_IO_PLAIN_MODEL_H

#include "io/mesh_file.h"
#include "io/plain_curve.h"

#include <stdbool.h>

typedef struct PlainCurve {
    int32_t point[2];   // where it begins and ends
    CurveSpacing spacing;   // of its cells, in its direction
} PlainCurve;

// side[]: the curves below, right, above, left, as gmsh's loop has them. Each may run either way.
enum { PATCH_SIDES = 4 };
typedef struct PlainPatch {
    int32_t side[PATCH_SIDES];
} PlainPatch;

// `count` curves (dimension 1) or patches (2) from `first` on.
typedef struct PlainGroup {
    char name[GROUP_NAME_SIZE];
    int32_t dimension, number;   // gmsh's physical number
    int32_t first, count;
} PlainGroup;

typedef struct PlainModel {
    int32_t point_count, curve_count, patch_count, group_count;
    double (*point)[2];   // [point_count] x, z; owned
    PlainCurve *curve;   // [curve_count]; owned
    PlainPatch *patch;   // [patch_count] each in a group; owned
    PlainGroup *group;   // [group_count] in the order of io/mesh_file.h; owned
} PlainModel;

// All zero, with the four counts.
bool plain_model_create(int32_t points, int32_t curves, int32_t patches, int32_t groups,
                        PlainModel *model, Error *err);
void plain_model_destroy(PlainModel *model);

// *mesh is destroyed by the caller.
bool plain_model_mesh(const PlainModel *model, MeshFile *mesh, Error *err);

// For those who read a .geo's parameters. Each of `given` goes to the one of its name and kind in
// `known`; false: there is none.
bool plain_take(const MeshParameter *given, int32_t given_count, MeshParameter *known,
                int32_t known_count);
// Those from `first` to `end` are what they are by default.
bool plain_unchanged(const MeshParameter *known, const MeshParameter *defaults, int32_t first,
                     int32_t end);
// A number of cells `refine` times as fine, as the files round it.
double plain_refined(double cells, double refine);
// Below and beyond, lengths are left to gmsh, as are more cells.
#define PLAIN_EXTENT_MIN 1e-6
#define PLAIN_CELLS_MAX 1e7
bool plain_is_extent(double length);

#endif
