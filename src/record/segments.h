// SPDX-License-Identifier: GPL-2.0-or-later
// The state of the whole contact in a few numbers. The contact is cut into segments, a pad or a
// part of one; each carries a share of the load and lags behind the drive. An elastic block at rest
// is in the same state as before when all of them carry the same again, and it can only come back
// to it when each has slipped as far as the drive has gone: a segment that sticks on is loaded more
// and more. Kept for each drop by record/drops, judged by answers/regime.
#ifndef AMONTONS_RECORD_SEGMENTS_H
#define AMONTONS_RECORD_SEGMENTS_H

#include "record/observation.h"

typedef struct Segments {
    int32_t count;
    int32_t contact_count;
    int32_t *of_node;   // [contact_count] the segment, from 0; owned
    double *nodes;   // [count] how many it has; owned
    uint8_t *slipped;   // [contact_count] the node has slipped since the first step; owned
    int32_t stuck;   // nodes that have not
} Segments;

bool segments_create(const Interface *interface, Segments *segments, Error *err);
void segments_destroy(Segments *segments);

// Marks the nodes that slip, or are open, in this step.
void segments_follow(Segments *segments, const Observation *seen);

// state: [2 count], overwritten: the shear of each over the normal force of all, whose sum is mu;
// then how far it lags behind the drive, length.
void segments_read(const Segments *segments, const Observation *seen, double *state);

void segments_archive(Segments *segments, Archive *archive);

#endif
