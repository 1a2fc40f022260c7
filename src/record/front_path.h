// SPDX-License-Identifier: GPL-2.0-or-later
// How the front of a rapid event runs along the contact: when slip first became faster than the
// event's threshold, node by node while it goes on, and at evenly spaced stations along the
// contact's line (contact/interface) once it is over.
// A front of slip that was slow before is a front of speeding up, and may run faster than any wave;
// ahead of where slow slip had come to it is a rupture. Between pads nothing slips: there is no
// station in a gap, and no speed across one. Kept by record/events.
#ifndef AMONTONS_RECORD_FRONT_PATH_H
#define AMONTONS_RECORD_FRONT_PATH_H

#include "record/observation.h"

enum { FRONT_STATIONS = 21 };   // from the first node of the line to the last, evenly spaced

// A place between two contact nodes one behind the other, or on one of them.
typedef struct FrontStation {
    int32_t node[2];   // the second the same where there is none behind the first
    double part;   // of the way to the next node, from 0 to 1
    int32_t pad;   // that it stands on; -1: in a gap
} FrontStation;

typedef struct FrontPath {
    double threshold;   // velocity
    double t_before;   // time of the step seen before
    double *rate_before;   // [contact_count] |slip rate| there; owned
    double *arrival;   // [contact_count] time, NaN: not yet; owned
    double spacing;   // of the stations, length
    FrontStation station[FRONT_STATIONS];
} FrontPath;

bool front_path_create(const Interface *interface, double threshold, FrontPath *path, Error *err);
void front_path_destroy(FrontPath *path);
void front_path_restart(const Interface *interface, FrontPath *path);   // nothing has arrived
// Takes in one accepted step; arrivals within it are found by linear interpolation of the rates.
void front_path_follow(FrontPath *path, const Observation *seen);
void front_path_keep(FrontPath *path, const Observation *seen);   // the step is the one before now

// Times after `origin` at which the front came to each station; NaN: never, or no contact there.
// Between nodes linear.
void front_path_stations(const FrontPath *path, double origin, double times[FRONT_STATIONS]);
// Velocity from station k to k + 1, below 0 towards the trailing edge; NaN: it did not pass both,
// or both at once, or they stand on different pads.
double front_path_speed(const FrontPath *path, const double times[FRONT_STATIONS], int32_t k);

void front_path_archive(FrontPath *path, int32_t contact_count, Archive *archive);

#endif
