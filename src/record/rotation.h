// SPDX-License-Identifier: GPL-2.0-or-later
// Rotation of a block in space about z while it slides, and its way across the drive, which a block
// in the plane has not. They are those of the rigid motion that is nearest to the slip of its
// contact nodes. A Recorder, after record/contact_arrays; in the plane all stays 0.
#ifndef AMONTONS_RECORD_ROTATION_H
#define AMONTONS_RECORD_ROTATION_H

#include "io/text/json_writer.h"
#include "record/contact_arrays.h"

typedef struct Rotation {
    const ContactArrays *contact;   // not owned; set before the first step, all else 0
    // Since the start, each when it was largest in size:
    double angle;   // counter-clockwise seen from above, rad
    double drift;   // mean slip across the drive, length
    double across;   // of any node across the drive, what deforms the block included, length
    double way;   // mean slip along the drive, length
    double breadth;   // of the contact, length
} Rotation;

bool rotation_record(void *self, const Observation *seen, Error *err);   // a Recorder

// Way of the block's sides along the drive and of the block across it, over the way along the
// drive.
double rotation_share(const Rotation *rotation);

void rotation_write_json(const Rotation *rotation, JsonWriter *json);   // results.turning
void rotation_archive(Rotation *rotation, Archive *archive);

#endif
