// SPDX-License-Identifier: GPL-2.0-or-later
// A share of the points, computed by a process that Slurm starts, an element of an array. It calls
// amontons_sweep_element (amontons.h).
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_ELEMENT_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_ELEMENT_H

#include "study/sweep/computing/point.h"

// What the elements of an array read: element e computes the share first + e.
bool elements_write(const Sweep *sweep, const char *path, int32_t first, Error *err);

#endif
