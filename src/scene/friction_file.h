// SPDX-License-Identifier: GPL-2.0-or-later
// friction.file of the law `table`: a coefficient that was measured at some speeds, a table of v
// and mu (io/text/csv_reader). Read by scene/friction_law, and by run/info for the picture of the
// law.
#ifndef AMONTONS_SCENE_FRICTION_FILE_H
#define AMONTONS_SCENE_FRICTION_FILE_H

#include "scene/scene.h"

typedef struct FrictionData {
    int32_t count;   // points as the file has them, in any order
    double *velocity, *mu;   // [count] velocity in the scene's units, 1; owned, as the next one
    double *error;   // [count] one standard deviation of mu; NULL: there is no such column
} FrictionData;

// Columns v (or V, velocity, speed, slip_rate), in an SI scene with a unit or in m/s, and mu (or
// cof, friction, F_T/F_N), with their errors where there are any; numbers alone are v and mu. Rows
// without mu are left out. ERROR_INPUT with file, line and column.
bool friction_data_read(const Scene *scene, FrictionData *data, Error *err);
void friction_data_destroy(FrictionData *data);   // zeroed is fine

// The points by ascending velocity, of those at one velocity the mean: velocity, mu [*count], room
// for FRICTION_POINTS_MAX. ERROR_INPUT: they are too many.
bool friction_data_points(const Scene *scene, const FrictionData *data, double *velocity,
                          double *mu, int32_t *count, Error *err);

#endif
