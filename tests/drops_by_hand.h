// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up force curves, mostly on two pads (nodes 0 to 2, and 3 and 4), for the list of drops and
// what is answered from it.
#ifndef AMONTONS_TESTS_DROPS_BY_HAND_H
#define AMONTONS_TESTS_DROPS_BY_HAND_H

#include "record/drops.h"
#include "seen_by_hand.h"

typedef struct HandDrops {
    HandRun run;
    Drops drops;
} HandDrops;

// Drops agree within 1 %.
static inline void hand_drops_begin(HandDrops *hand, int32_t pads)
{
    Error err = {0};
    hand_run_begin(&hand->run, pads);
    assert_true(
        drops_create(&hand->run.hand.interface, &hand->run.events, 1e-2, &hand->drops, &err));
    recorders_add(&hand->run.recorders, &hand->drops, drops_record);
}

static inline void hand_drops_end(HandDrops *hand)
{
    drops_destroy(&hand->drops);
    drops_destroy(&hand->drops);   // a second time is fine
    events_destroy(&hand->run.events);
}

static const double REST[] = {0, 0, 0, 0, 0}, ACROSS[] = {9, 9, 9, 9, 9}, LEFT[] = {9, 9, 9, 0, 0};
static const double PART[] = {9, 0, 0, 0, 0}, SLOW[] = {0.5, 0.5, 0, 0, 0};

static inline void see(HandDrops *hand, double mu, const double rate[SEEN_NODES])
{
    hand_run_see(&hand->run, mu, rate);
}

// Slow rise to `peak` with the front at 0.25 and 0.375 of the left pad slipping, an event with
// these rates down to `after`, rest.
static inline void drop(HandDrops *hand, double peak, double after, const double rate[SEEN_NODES])
{
    see(hand, 0.5 * peak, REST);
    see(hand, peak, SLOW);
    see(hand, peak, rate);
    see(hand, after, rate);
    see(hand, after, REST);
}

#endif
