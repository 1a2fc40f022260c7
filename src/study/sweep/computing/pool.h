// SPDX-License-Identifier: GPL-2.0-or-later
// Computes pending points in processes of this computer.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_POOL_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_POOL_H

#include "study/sweep/computing/point.h"

typedef struct PoolDef {
    int32_t workers;   // points at a time; 0: as many as there are cores
    int32_t step;   // every so many points are looked at; 1: all
} PoolDef;

bool pool_run(Sweep *sweep, const PoolDef *def, Error *err);

#endif
