// SPDX-License-Identifier: GPL-2.0-or-later
// Observations made up number by number, for those who read them: events, peaks, history. Five
// contact nodes at x = 0, 0.25, ..., 1, no rod nodes.
#ifndef AMONTONS_TESTS_SEEN_BY_HAND_H
#define AMONTONS_TESTS_SEEN_BY_HAND_H

#include "near.h"
#include "plane.h"
#include "record/events.h"
#include "record/observation.h"

enum { SEEN_NODES = 5 };

typedef struct HandSeen {
    Interface interface;
    BulkOperator system;
    State state;
    Observation seen;
    double x[SEEN_NODES], weight[SEEN_NODES];
    int32_t pad[SEEN_NODES], dofs[2 * SEEN_NODES];
    double displacement[2 * SEEN_NODES], slip_rate[2 * SEEN_NODES], reaction[2 * SEEN_NODES];
    uint8_t status[SEEN_NODES];
    bool open[SEEN_NODES];   // by choice of the test: open in every step
} HandSeen;

// At rest, all sticking. Must not be moved.
static inline void hand_seen_init(HandSeen *hand)
{
    memset(hand, 0, sizeof *hand);
    for (int32_t i = 0; i < SEEN_NODES; i++) {
        hand->x[i] = 0.25 * i;
        hand->weight[i] = i == 0 || i == SEEN_NODES - 1 ? 0.125 : 0.25;
        hand->status[i] = CONTACT_STICK;
    }
    for (int32_t k = 0; k < 2 * SEEN_NODES; k++) hand->dofs[k] = k;
    hand->interface = (Interface){.dim = 2,
                                  .contact_count = SEEN_NODES,
                                  .count = 2 * SEEN_NODES,
                                  .x = hand->x,
                                  .weight = hand->weight,
                                  .pad = hand->pad,
                                  .pad_count = 1,
                                  .dofs = hand->dofs};
    hand->system = (BulkOperator){.dof_count = 2 * SEEN_NODES,
                                  .interface_count = 2 * SEEN_NODES,
                                  .interface_dofs = hand->dofs};
    hand->state = (State){.dof_count = 2 * SEEN_NODES,
                          .interface_count = 2 * SEEN_NODES,
                          .contact_count = SEEN_NODES,
                          .displacement = hand->displacement,
                          .slip_rate = hand->slip_rate,
                          .reaction = hand->reaction,
                          .status = hand->status};
    hand->seen = (Observation){.state = &hand->state,
                               .interface = &hand->interface,
                               .system = &hand->system,
                               .certified = true};
}

// Two pads, the second of nodes 3 and 4; or three, nodes 2 and 3 and node 4 apart.
static inline void hand_split(HandSeen *hand, int32_t pads)
{
    static const int32_t pad_of[][SEEN_NODES] = {{0, 0, 0, 0, 0}, {0, 0, 0, 1, 1}, {0, 0, 1, 1, 2}};
    memcpy(hand->pad, pad_of[pads - 1], sizeof hand->pad);
    hand->interface.pad_count = pads;
}

// At time t and U = t/10: nodes slip at these rates and have then moved as far as U, 0 means they
// stick; front and largest rate as record/observation defines them.
static inline const Observation *hand_seen(HandSeen *hand, double t, const double rate[SEEN_NODES])
{
    bool together = true;
    hand->state.time = hand->seen.t = t;
    hand->seen.U = t / 10;
    hand->seen.rod_way = 0.6 * hand->seen.U;
    hand->seen.front = 0;
    hand->seen.front_slips = false;
    hand->seen.max_slip_rate = 0;
    for (int32_t i = 0; i < SEEN_NODES; i++) {
        hand->slip_rate[plane_tangent(i)] = rate[i];
        if (rate[i] != 0) hand->displacement[plane_tangent(i)] = hand->seen.U;
        hand->status[i] = rate[i] > 0 ? CONTACT_SLIP_FORWARD
                                      : (rate[i] < 0 ? CONTACT_SLIP_BACKWARD : CONTACT_STICK);
        if (hand->open[i]) hand->status[i] = CONTACT_OPEN;
        together = together && (rate[i] != 0 || hand->open[i]);
        if (together) hand->seen.front = hand->x[i];
        hand->seen.front_slips = hand->seen.front_slips || (together && !hand->open[i]);
        hand->seen.max_slip_rate = fmax(hand->seen.max_slip_rate, fabs(rate[i]));
    }
    return &hand->seen;
}

// A made-up run: observations at t = 0, 1, ... handed to events and what follows them.
typedef struct HandRun {
    HandSeen hand;
    char names[3][GROUP_NAME_SIZE];   // of the pads
    Events events;   // the caller's to destroy
    Recorders recorders;   // events; the caller adds the others
    double time;   // of the next observation
} HandRun;

static inline void hand_run_begin(HandRun *run, int32_t pads)
{
    Error err = {0};
    *run = (HandRun){.names = {"left", "right", "third"}};
    hand_seen_init(&run->hand);
    hand_split(&run->hand, pads);
    run->hand.interface.pad_name = run->names;
    assert_true(events_create(&run->hand.interface, 1, &run->events, &err));
    recorders_add(&run->recorders, &run->events, events_record);
}

static inline void hand_run_see(HandRun *run, double mu, const double rate[SEEN_NODES])
{
    Error err = {0};
    run->hand.seen.mu = mu;
    assert_true(recorders_record(&run->recorders, hand_seen(&run->hand, run->time++, rate), &err));
}

#endif
