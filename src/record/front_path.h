// SPDX-License-Identifier: GPL-2.0-or-later
// How the front of a rapid event runs along the contact: when slip first became faster than the
// event's threshold, node by node while it goes on, and at evenly spaced stations once it is over.
// A front of slip that was slow before is a front of speeding up, and may run faster than any wave;
// ahead of where slow slip had come to it is a rupture. Kept by record/events.
#ifndef AMONTONS_RECORD_FRONT_PATH_H
#define AMONTONS_RECORD_FRONT_PATH_H

#include "record/observation.h"

enum { FRONT_STATIONS = 21 };   // from one end of the contact to the other, L/20 apart

typedef struct FrontPath {
    double threshold;   // velocity
    double t_before;   // time of the step seen before
    double *rate_before;   // [contact_count] |slip rate| there; owned
    double *arrival;   // [contact_count] time, NaN: not yet; owned
} FrontPath;

bool front_path_create(const Interface *interface, double threshold, FrontPath *path, Error *err);
void front_path_destroy(FrontPath *path);
void front_path_restart(const Interface *interface, FrontPath *path);   // nothing has arrived
// Takes in one accepted step; arrivals within it are found by linear interpolation of the rates.
void front_path_follow(FrontPath *path, const Observation *seen);
void front_path_keep(FrontPath *path, const Observation *seen);   // the step is the one before now

// Times after `origin` at which the front came to each station; NaN: never. Between nodes linear.
void front_path_stations(const FrontPath *path, const Interface *interface, double origin,
                         double times[FRONT_STATIONS]);
// Velocity from station k to k + 1, below 0 towards the trailing edge; NaN: it did not pass both,
// or both at once.
double front_path_speed(const double times[FRONT_STATIONS], double length, int32_t k);

#endif
