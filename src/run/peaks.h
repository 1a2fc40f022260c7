// SPDX-License-Identifier: GPL-2.0-or-later
// The peaks of F_T/F_N: the largest mu between two slidings, known when a leading event has crossed
// the interface. The first belongs to the start, not to the periodic regime; mu_M is the mean of
// the last peaks that agree with the very last one within a tolerance. Fed after run/events.
#ifndef AMONTONS_RUN_PEAKS_H
#define AMONTONS_RUN_PEAKS_H

#include "run/events.h"

typedef struct Peak {
    double U, mu;
    double front;   // l when the leading event began: l_c from the dynamics, length
    double
        front_uncertified;   // l when the certificate was first lost since the last sliding: l_sc
    bool counts;   // belongs to the periodic regime
} Peak;

typedef struct Peaks {
    const Events *events;   // not owned
    double tolerance;   // relative
    int32_t count, room;
    Peak *list;   // [count]; owned
    Peak rising;   // the largest mu since the last sliding
    double mu_max;   // of the whole run
} Peaks;

typedef struct PeaksSummary {
    int32_t counted;   // peaks in the mean
    double mu_M;   // NaN: no peak
    double spread;   // largest minus smallest of them; NaN with fewer than two
    double critical_length;   // mean l_c of them, length
    double subcritical_length;   // mean l_sc of those that have one, length; NaN: none
    bool periodic;   // at least three agree
} PeaksSummary;

bool peaks_create(const Events *events, double tolerance, Peaks *peaks, Error *err);
void peaks_destroy(Peaks *peaks);
bool peaks_record(void *self, const Observation *seen, Error *err);   // a Recorder
PeaksSummary peaks_summarise(Peaks *peaks);   // sets `counts`

#endif
