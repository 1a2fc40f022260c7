// SPDX-License-Identifier: GPL-2.0-or-later
// The contact of a block in space as it is seen from above: each node with the part of its faces
// that is nearest, and the outline of each pad. Called by result_view.
#ifndef AMONTONS_RENDER_VIEW_CONTACT_PLANE_H
#define AMONTONS_RENDER_VIEW_CONTACT_PLANE_H

#include "io/hdf5/result_file.h"

enum { PATCH_CORNERS = 4 };

typedef struct ContactPatch {
    int32_t node;
    double corner[PATCH_CORNERS][2];   // x, y, length
} ContactPatch;

// A side goes from corner to corner over the node between them, or the middle.
typedef struct ContactSide {
    double point[3][2];
} ContactSide;

typedef struct ContactPlane {
    int32_t nodes;
    double *x, *y, *weight;   // [nodes] length, length^2; owned, like all
    int32_t patch_count, side_count;
    ContactPatch *patches;   // [patch_count]
    ContactSide *sides;   // [side_count]
    double low[2], high[2];   // extent of all patches
} ContactPlane;

// nodes: of the contact. ERROR_INPUT: the history has no faces.
bool contact_plane_read(ArrayFile *file, int32_t nodes, ContactPlane *plane, Error *err);
void contact_plane_destroy(ContactPlane *plane);   // zeroed is fine

#endif
