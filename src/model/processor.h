// SPDX-License-Identifier: GPL-2.0-or-later
// How fast this machine is at what model/choice weighs against each other: measured when somebody
// asks for it (`amontons cache --measure`), kept in the cache's folder, and never measured by a
// run: a run's choice must not depend on what else the machine was doing.
//
//     CACHE/processor.speed     (io/cache_file says where CACHE is)
#ifndef AMONTONS_MODEL_PROCESSOR_H
#define AMONTONS_MODEL_PROCESSOR_H

#include "io/cache_file.h"

// Time over that of the machine on which the constants of model/choice were measured.
typedef struct Processor {
    double factor;   // for the factors of a mesh: arithmetic
    double pass;   // for a pass through such a factor: memory
} Processor;

extern const Processor PROCESSOR_USUAL;   // 1 each

// About 0.1 s of processor time.
bool processor_measure(Processor *processor, Error *err);

// Both as powers of sqrt(2): what a busy machine adds is rounded off.
bool processor_keep(const Processor *processor, Error *err);

// PROCESSOR_USUAL where nothing is kept, or nothing that is valid: `note` then says why.
bool processor_kept(Processor *processor, char note[CACHE_NOTE_SIZE], Error *err);

#endif
