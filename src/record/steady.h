// SPDX-License-Identifier: GPL-2.0-or-later
// Steady sliding: where friction does not weaken faster than the block damps, the whole contact
// slides slowly after the rod and the load never drops. What it then holds is F_T/F_N at which it
// slides. Steady is a state in which every node of the contact slips (or is open), none fast, and
// mu keeps within STEADY_RANGE while the drive goes as far as the slip that the drop of friction
// drives, and as what the contact remembers takes to fall below STEADY_RANGE: before, mu is on its
// way, or turns back for a moment. Fed after record/events; read by answers/answers.
#ifndef AMONTONS_RECORD_STEADY_H
#define AMONTONS_RECORD_STEADY_H

#include "record/events.h"
#include "record/series.h"

typedef struct Steady {
    const Events *events;   // not owned
    double way;   // of the drive, that it takes to be sure, length
    bool slides;   // in the step seen last: all of the contact, slowly
    double from, to;   // of the drive, in which it slid so and mu kept within the range, length
    double low, high, sum;   // of mu there; sum: integral of mu over the way, length
    Estimate before;   // of the way before `from`, where mu drifted out of the range; NaN: none
} Steady;

// way: the slip that the drop of friction drives. fading: the slip over which the slowest of
// friction's states falls to 1/e, 0 without states. Both lengths.
Steady steady_of(const Events *events, double way, double fading);
bool steady_record(void *self, const Observation *seen, Error *err);   // a Recorder

// The mean of mu since it is steady, and half its range; NaN: the run does not end so.
Estimate steady_mu(const Steady *steady);

void steady_archive(Steady *steady, Archive *archive);

#endif
