// SPDX-License-Identifier: GPL-2.0-or-later
// How a block in space turns about z while it slides, and goes across the drive: what a block in
// the plane cannot do. By the slip of its contact nodes, of which the nearest rigid motion is
// taken. A Recorder, after record/contact_arrays; in the plane all stays 0.
#ifndef AMONTONS_RECORD_TURNING_H
#define AMONTONS_RECORD_TURNING_H

#include "io/text/json_writer.h"
#include "record/contact_arrays.h"

typedef struct Turning {
    const ContactArrays *contact;   // not owned; set before the first step, all else 0
    // Since the start, each when it was largest in size:
    double angle;   // counter-clockwise seen from above, rad
    double drift;   // mean slip across the drive, length
    double across;   // of any node across the drive, what deforms the block included, length
    double way;   // mean slip along the drive, length
    double breadth;   // of the contact, length
} Turning;

bool turning_record(void *self, const Observation *seen, Error *err);   // a Recorder

// Way of the block's sides along the drive and of the block across it, over the way along the
// drive.
double turning_share(const Turning *turning);

void turning_write_json(const Turning *turning, JsonWriter *json);   // results.turning
void turning_archive(Turning *turning, Archive *archive);

#endif
