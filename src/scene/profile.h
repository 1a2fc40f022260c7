// SPDX-License-Identifier: GPL-2.0-or-later
// contact.profile: a measured shape of the substrate in a text file, a table of x and gap, or of x,
// y and gap: a height map. Read with the scene, so that what is wrong is said before anything is
// meshed, and by model/contact_nodes.
#ifndef AMONTONS_SCENE_PROFILE_H
#define AMONTONS_SCENE_PROFILE_H

#include "scene/scene.h"

typedef struct SceneProfile {
    int32_t count;   // of places along x; 0: the scene has none
    int32_t rows;   // of places along y; 1: the gap is of x alone
    double *x, *y;   // [count], [rows] length in the scene's units, ascending; y NULL with one row;
        // owned
    double *gap;   // [rows * count] row by row, length; owned
} SceneProfile;

// A table (io/text/csv_reader) of two or three numbers a line. Points of three are those of a grid,
// in any order. The first line, or a comment above the numbers, may name the columns, in any order
// and in an SI scene with units: `x [mm], gap [um]`, `x/mm, y/mm, gap/um`, `x_mm, gap_um`; else
// they are x and gap, or x, y and gap. ERROR_INPUT with file, line and column: also for
// names that are none of these.
bool scene_profile_read(const Scene *scene, SceneProfile *profile, Error *err);
void scene_profile_destroy(SceneProfile *profile);   // zeroed is fine

// Value on the straight line between two points, of a map between the four around (bilinear);
// beyond the ends as there. y: not read with one row.
double scene_profile_at(const SceneProfile *profile, double x, double y);

#endif
