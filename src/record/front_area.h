// SPDX-License-Identifier: GPL-2.0-or-later
// How fast a front runs over the contact of a block in space, in whichever direction. Asked by
// record/events.
#ifndef AMONTONS_RECORD_FRONT_AREA_H
#define AMONTONS_RECORD_FRONT_AREA_H

#include "contact/interface.h"

// The area that the front swept over the integral of its length in time, velocity. arrival:
// [contact_count] time, not finite where it did not come; faces that it had come to by `origin` do
// not count. NaN: it swept no whole face, or all at once, or the block is in the plane.
double front_area_speed(const Interface *interface, const double *arrival, double origin);

#endif
