// SPDX-License-Identifier: GPL-2.0-or-later
// Whether the load drops of a run have come to a regime that lasts, and which of them belong to it.
//
//   run-in    until every node of the contact has slipped; while a part of it lags behind the drive
//             (what sticks on is loaded more and more, so nothing can repeat); and while mu at
//             successive drops shows a trend that stands out from their scatter, or a scatter that
//             grows
//   period    the state of the whole contact comes back: what slid, mu and the share of the load
//             that each segment carries (record/drops)
//
// Read by answers/answers.
#ifndef AMONTONS_ANSWERS_REGIME_H
#define AMONTONS_ANSWERS_REGIME_H

#include "record/drops.h"

// symbol, name in run.json
#define RUN_INS(X)                                                                                 \
    X(RUN_IN_OVER, "over")                                                                         \
    X(RUN_IN_STUCK, "part of the contact has not slipped")                                         \
    X(RUN_IN_LAGS, "part of the contact lags behind")                                              \
    X(RUN_IN_TREND, "trend")

typedef enum RunIn {
#define X(symbol, name) symbol,
    RUN_INS(X)
#undef X
} RunIn;

typedef struct Regime {
    int32_t period;   // load drops in a round; 0: they do not repeat, or not yet
    int32_t count;   // the last load drops: whole rounds, or without a period all but the start's
    int32_t first;   // number in drops->list of the first of them
    RunIn run_in;   // with fewer than two load drops only whether every node has slipped
    double drift;   // of mu or of its scatter, a load drop, over mu; NaN: none that stands out
    double ahead;   // what is still to come of it at most, relative; 0: none
    double drops_left;   // load drops that run-in may still take; NaN: not known
} Regime;

// So many load drops whose mean is known are enough where nothing repeats, and so many rounds ahead
// is a trend followed.
enum { DROPS_ENOUGH = 30 };

const char *run_in_name(RunIn run_in);   // static storage
Regime regime_of(const Drops *drops);

#endif
