// SPDX-License-Identifier: GPL-2.0-or-later
// One point, or the points of a share, computed by a process that Slurm starts, an element of an
// array. It calls amontons_sweep_element (amontons.h).
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_ELEMENT_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_ELEMENT_H

#include "study/sweep/computing/point.h"

// The list that the elements of an array read, `count` from `first` on: element e computes
// points[first + e], with `keep: table` the share first + e.
bool elements_write(const Sweep *sweep, const char *path, const int32_t *points, int32_t first,
                    int32_t count, Error *err);

#endif
