// SPDX-License-Identifier: GPL-2.0-or-later
// The list of drops. A drop is a rapid event in which mu falls by LEAST_DROP of itself or more, or
// in which a pad or the whole block slides. Everything that a run is asked about its load is read
// off this one list, as three kinds of drops:
//   bulk slidings   every contact node has slipped; the largest mu before each is a peak
//   load drops      what a load cell sees: a bulk sliding, or mu falls by LEAST_DROP or more. A
//                   block on pads may have them without ever sliding as a whole
//   pad slidings    some pads slid over all their length, also where their neighbours took over
//                   the load and mu hardly fell
// Fed after record/events; read by answers/.
#ifndef AMONTONS_RECORD_DROPS_H
#define AMONTONS_RECORD_DROPS_H

#include "record/events.h"
#include "record/observation.h"
#include "record/series.h"

// --- the contact in segments --------------------------------------------------------------------

// The state of the whole contact in a few numbers. The contact is cut into segments, a pad or a
// part of one; each carries a share of the load and lags behind the drive. An elastic block at rest
// is in the same state as before when all of them carry the same again, and it can only come back
// to it when each has slipped as far as the drive has gone: a segment that sticks on is loaded more
// and more. Kept for each drop, judged by answers/regime.
typedef struct Segments {
    int32_t count;
    int32_t contact_count;
    int32_t *of_node;   // [contact_count] the segment, from 0; owned
    double *nodes;   // [count] how many it has; owned
    uint8_t *slipped;   // [contact_count] the node has slipped since the first step; owned
    int32_t stuck;   // nodes that have not
} Segments;

bool segments_create(const Interface *interface, Segments *segments, Error *err);
void segments_destroy(Segments *segments);

// Marks the nodes that slip, or are open, in this step.
void segments_follow(Segments *segments, const Observation *seen);

// state: [2 count], overwritten: the shear of each over the normal force of all, whose sum is mu;
// then how far it lags behind the drive, length.
void segments_read(const Segments *segments, const Observation *seen, double *state);

// --- drops --------------------------------------------------------------------------------------

typedef enum DropKind { DROP_BULK, DROP_LOAD, DROP_PADS } DropKind;

typedef struct Drop {
    double U, mu;   // the largest mu since the drop before, and where it was; length, 1
    double mu_after;   // the smallest mu of the event
    int32_t event;   // its number in the list of events
    int32_t state;   // the row of drops->states that holds the contact's state at that mu
    int32_t pads;   // how many slid over all their length in it (which: drops->slid)
    bool bulk, load;   // of these kinds; every bulk sliding is a load drop
    double critical_length;   // when the event began: l; on several pads how much slipped of the
        // one on which slow slip turned fast. Of a bulk sliding l_c from the dynamics, length; NaN:
        // no slow slip had come from the trailing end
    double critical_part;   // of the whole contact, how much slipped then: A_c/A
    // On one pad: l when the certificate was first lost (l_sc) and when real growth was first seen
    // (l_c from the rates) since the drop before, length; NaN: not seen.
    double front_uncertified, front_growth;
} Drop;

typedef struct Drops {
    const Events *events;   // not owned
    double tolerance;   // drops agree within this, relative
    int32_t count, room;
    Drop *list;   // [count] in order of time; owned
    SeriesItem *series;   // [room] work of drops_series; owned
    Segments segments;   // of the contact
    uint8_t *slid;   // [room][pad_count] 1: this pad slid over all its length in the drop; owned
    int32_t pad_count;
    char (*pad_name)[GROUP_NAME_SIZE];   // [pad_count], not owned; NULL: they have none
    double *states;   // [room + 1][2 segments.count] a row a drop (segments_read), the next one's
        // behind the last; owned
    int32_t settled;   // drops on the list when the last node of the contact slipped for the first
        // time; -1: some have not
    double mu_static;   // no mu can be larger; NaN: not known
    Drop rising;   // what the next drop holds so far
    double top;   // the largest mu of the event under way, or of the step before it
    double fall;   // the largest way down from it
    double mu_max;   // of all steps
    double mu_seen;   // in the step seen last; -infinity: none yet
    double mu_beside;   // the larger one of those in the steps before and after that of mu_max
} Drops;

// So many cells must slip before slow slip turns fast for mu to be sure; measured: run/warnings.
enum { SLIP_CELLS_ENOUGH = 8 };

extern const double LEAST_DROP;

Drops drops_none(void);   // before anything is recorded: every answer of it is NaN
bool drops_create(const Interface *interface, const Events *events, double tolerance, Drops *drops,
                  Error *err);
void drops_destroy(Drops *drops);
bool drops_record(void *self, const Observation *seen, Error *err);   // a Recorder

bool drop_is(const Drop *drop, DropKind kind);
int32_t drops_count(const Drops *drops, DropKind kind);
// Drop k of the list as one of this kind: what it holds since the drop before, it holds since the
// one of the same kind before.
Drop drops_as(const Drops *drops, DropKind kind, int32_t k);
// mu of the drops of one kind from number `first` of the list on, into drops->series, their kind
// the number of pads that slid, with the contact's state. Returns how many they are.
int32_t drops_series(const Drops *drops, DropKind kind, int32_t first);
// Among the load drops from number `first` of the list on, finds the event before which the fewest
// cells slipped on the pad where slow slip turned fast; NULL: no such drop.
const Event *drops_least_resolved(const Drops *drops, int32_t first);
bool drops_archive(Drops *drops, Archive *archive, Error *err);

#endif
