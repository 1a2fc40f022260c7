// SPDX-License-Identifier: GPL-2.0-or-later
// Forces and slip of each pad in one accepted step, summed over its nodes. Called by record/events,
// record/pads and record/history.
#ifndef AMONTONS_RECORD_PAD_SUMS_H
#define AMONTONS_RECORD_PAD_SUMS_H

#include "record/observation.h"

typedef struct PadSum {
    double normal_force;   // force/width
    double shear;   // positive where the plane holds the block back, force/width
    double shear_across;   // towards -y; 0 in the plane, force
    double slipping;   // how much of the pad slips, length, in space length^2
    double slipping_cells;   // in the plane the same counted in nodes, an end of the pad as half a
        // one: cells of the contact, halves of them where elements are of order 2
    double fastest;   // largest |slip rate|, velocity
} PadSum;

// sums: [pad_count], overwritten. Open nodes carry nothing and do not count as slipping.
void pad_sums(const Observation *seen, PadSum *sums);

// Size of a pad.
typedef struct PadSize {
    int32_t nodes;
    double x_from, x_to;   // length
    double y_from, y_to;   // 0 in the plane
    double weight;   // sum of its nodes': length, in space length^2
    double breadth;   // its weight over its extent along the drive, length; 1 in the plane
} PadSize;
PadSize pad_size(const Interface *interface, int32_t p);

void pad_sums_archive(PadSum *sums, int32_t count, Archive *archive);

#endif
