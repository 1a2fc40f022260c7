// SPDX-License-Identifier: GPL-2.0-or-later
// Course of each pad between two slidings: its loads when mu is largest, when it first slips, when
// all of it has slipped, in what order pads detach, and how much of a pad slips slowly before its
// slip turns fast (events in which whole pads slid: record/drops). Fed after record/events; written
// by run/report, a pad an object of results.pads. The course of loads and slip over all steps is in
// history.h5 (pads/...).
#ifndef AMONTONS_RECORD_PADS_H
#define AMONTONS_RECORD_PADS_H

#include "io/text/json_writer.h"
#include "record/events.h"

// A pad's cycle lasts from the end of one sliding to the beginning of the next. NaN, order 0: did
// not happen.
typedef struct PadCycle {
    double normal_force, shear;   // where mu was largest, force/width
    double U_first_slip;   // when some of it slips, length
    double U_detached;   // when each of its nodes had slipped since the sliding before or was open,
        // length
    int32_t order;   // of that, from 1; pads that detach in the same step share it
    double U_rapid, t_rapid;   // when it slips rapidly for the last time before sliding
    double slow_length;   // how much of it slipped just before: l_c of the pad, length; NaN: slip
        // of another pad ran over it
} PadCycle;

typedef struct Pad {
    char name[GROUP_NAME_SIZE];
    PadSize size;
    double length;   // sum of its nodes' weights, in space over its breadth
    double normal_force_start;   // when the rod starts, force/width
    PadCycle now;   // of the cycle under way
    PadCycle first, last;   // of the first one that ended in sliding, and of the last
    int32_t slidings;   // rapid events in which all of it slipped
    bool rapid;   // in the step seen last
} Pad;

typedef struct Pads {
    const Events *events;   // not owned
    int32_t count;
    Pad *list;   // [count] by number of the pad; owned
    int32_t contact_count;
    uint8_t *stuck;   // [contact_count] seen sticking since the last sliding; owned
    uint8_t *slipped;   // [contact_count] slipped since it stuck; owned
    int32_t detached;   // pads, in this cycle
    int32_t cycles;   // that ended in sliding
    double mu;   // the largest of this cycle
    bool started;   // the first step was seen
    bool in_space;
} Pads;

bool pads_create(const Interface *interface, const Events *events, Pads *pads, Error *err);
void pads_destroy(Pads *pads);
bool pads_record(void *self, const Observation *seen, Error *err);   // a Recorder

void pads_write_json(const Pads *pads, JsonWriter *json);   // results.pads

// The order in which pads let go before the first or the last sliding of the whole block: "left,
// middle with right". As many names as there is room for, then "and 7 more". Empty: there was no
// such sliding.
enum { PADS_ORDER_SIZE = 200 };
void pads_order(const Pads *pads, bool of_first, char text[PADS_ORDER_SIZE]);

void pads_archive(Pads *pads, Archive *archive);

#endif
