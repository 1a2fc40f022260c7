// SPDX-License-Identifier: GPL-2.0-or-later
// Falls of the rod's force, whoever slides: rapid events in which mu drops by at least `least` of
// itself, as a load cell would see them. A block in one piece falls when all of it slides, and its
// falls are its peaks (record/peaks). On pads, some may slide and the rest hold: soft pads take
// turns, and there need not be an event at all in which every node slips. What falls by less (a
// short pad that slides alone while its neighbours take over its load) is listed by record/pads
// only.
//
// Once the start is forgotten falls repeat with a period of one or more, or they never do. Each
// place in the period is a branch; the lowest is the one to trust. Without a period the lowest of a
// sample would sink with every fall waited for: what is trusted then is the lowest decile, and the
// errors of it and of the mean say whether there are enough. Fed after record/events and
// record/pads; written by run/report.
#ifndef AMONTONS_RECORD_FALLS_H
#define AMONTONS_RECORD_FALLS_H

#include "record/pads.h"

enum { FALL_PERIOD_MAX = 8, FALLS_ENOUGH = 30 };

typedef struct Fall {
    double U, mu;   // the largest mu since the fall before, and where; length, 1
    double mu_after;   // the smallest mu of the event
    int32_t pads;   // that slid over all their length in it
} Fall;

typedef struct Falls {
    const Events *events;   // not owned
    const Pads *pads;   // not owned
    double least;   // drop that counts, over mu: 0.05
    double tolerance;   // falls agree within this, relative
    Fall rising;   // the largest mu since the last fall
    double top;   // the largest mu of the event under way, or of the step before it
    double drop;   // the largest way down from it
    int32_t count, room;
    Fall *list;   // [count]; owned
} Falls;

// Falls of one place in the period; without a period, those in which as many pads slid.
typedef struct FallBranch {
    double mu, low, high;   // mean, smallest and largest
    int32_t pads, count;   // that slid; falls
} FallBranch;

enum { FALL_BRANCHES_MAX = 16 };

typedef struct FallsSummary {
    int32_t period;   // in falls; 0: they do not repeat within FALL_PERIOD_MAX
    int32_t counted;   // the last falls, which repeat; without a period the last three quarters
    double low, high;   // smallest and largest mu of them; NaN: no fall
    double mean, mean_error;   // of mu over them, and its standard error
    double trusted;   // `low` with a period, the lowest decile without; NaN: no fall
    double trusted_error;   // half the lowest branch's range, or the decile's standard error
    bool enough;   // they repeat, or are FALLS_ENOUGH with a mean within 2 %
    int32_t branch_count;
    FallBranch branches[FALL_BRANCHES_MAX];   // ascending mu
} FallsSummary;

bool falls_create(const Events *events, const Pads *pads, double tolerance, Falls *falls,
                  Error *err);
void falls_destroy(Falls *falls);
bool falls_record(void *self, const Observation *seen, Error *err);   // a Recorder
FallsSummary falls_summarise(const Falls *falls);
bool falls_are_settled(const Falls *falls);   // more of them would tell nothing new: `enough`
void falls_write_json(const Falls *falls, JsonWriter *json);   // results.mu_trusted, .falls

#endif
