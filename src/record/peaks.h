// SPDX-License-Identifier: GPL-2.0-or-later
// The peaks of F_T/F_N: the largest mu between two slidings, known when a leading event has crossed
// the interface. The first belongs to the start, not to the periodic regime. mu_M is the mean of
// the peaks in whole rounds of the regime; where none is found, of all but the start's. Fed after
// record/events.
#ifndef AMONTONS_RECORD_PEAKS_H
#define AMONTONS_RECORD_PEAKS_H

#include "record/events.h"

typedef struct Peak {
    double U, mu;
    double front;   // l when the leading event began: l_c from the dynamics, length
    double
        front_uncertified;   // l when the certificate was first lost since the last sliding: l_sc
    double front_growth;   // l when real growth was first seen since then: l_c from the rates; NaN
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
    int32_t period;   // each of the last peaks agrees with the one so many before it; 0: none found
    double mu_M;   // NaN: no peak
    double spread;   // largest minus smallest of them; NaN with fewer than two
    double low, high;   // of all peaks but the first (of the first where it is alone)
    double critical_length;   // mean l_c of those counted, length
    double subcritical_length;   // mean l_sc of those counted that have one, length; NaN: none
} PeaksSummary;

// Peaks that lie closer together than the tolerance.
typedef struct PeakBranch {
    int32_t count;   // how many of those counted
    double low, mu, high;   // the smallest, the mean and the largest of them
} PeakBranch;

bool peaks_create(const Events *events, double tolerance, Peaks *peaks, Error *err);
void peaks_destroy(Peaks *peaks);
bool peaks_record(void *self, const Observation *seen, Error *err);   // a Recorder
PeaksSummary peaks_summarise(Peaks *peaks);   // sets `counts`
// The branch of the counted peaks next above mu = `above`; false: there is none. From -INFINITY on,
// with `high` of the one before as `above`, every branch in turn; one where all peaks agree.
bool peaks_branch_above(const Peaks *peaks, double above, PeakBranch *branch);

#endif
