// SPDX-License-Identifier: GPL-2.0-or-later
// Precursors, told apart while the run goes on. Quasi-static slip goes at about the rod's velocity
// or below; a rapid event begins when some contact node slips faster than `rate_start` and ends
// when all are below `rate_stop`. It is leading when it carried the whole interface (every node
// slipped from the trailing to the leading edge). Otherwise it is bounded, and counts as a
// precursor, if it came to `rate_counts`, was rapid over LEAST_RAPID of the contact and ran as far
// from the trailing end of the block or of a pad, or slid a whole pad, and did not follow
// an event at once and ten times slower; if not, it is slight: slow slip or after-slip that rings,
// or a node or two that jump. Between slidings the slow growth of the front is one quasi-static
// event. Read by record/drops, record/pads, record/fields and run/report.
#ifndef AMONTONS_RECORD_EVENTS_H
#define AMONTONS_RECORD_EVENTS_H

#include "record/front_path.h"
#include "record/pad_sums.h"

// symbol, name, as people are told of it; the numbers stand in history.h5 (io/hdf5/result_file)
#define EVENT_KINDS(X)                                                                             \
    X(EVENT_QUASI_STATIC, "quasi-static", "quasi-static")                                          \
    X(EVENT_BOUNDED, "bounded rapid", "bounded rapid")                                             \
    X(EVENT_LEADING, "leading rapid", "bulk sliding")                                              \
    X(EVENT_SLIGHT, "slight rapid", "slight rapid")

typedef enum EventKind {
#define X(symbol, name, words) symbol,
    EVENT_KINDS(X)
#undef X
        EVENT_KIND_COUNT
} EventKind;

typedef struct Event {
    EventKind kind;
    double U_start, U_stop;   // length
    double t_start, t_stop;   // time
    double mu_start;   // F_T/F_N in the step before it began; NaN: in the first step of all
    double front_start;   // front when it began, length
    bool front_slips;   // some node up to it slipped then (record/observation)
    double reach;   // slow: the farthest front; rapid: largest x up to which a pad that took part
        // has slipped from its trailing end on, along the line of the contact, length
    double
        slipped;   // how much of the contact slipped: rapid: in all of it; slow: at most at once;
    // length, in space length^2
    double peak_slip_rate;   // velocity
    double front_speed;   // mean along the contact; rapid: of the fast front on `pad`; NaN: it did
        // not move
    // Rapid: the pad on which slow slip turned fast, and how much of it slipped in the step before,
    // length and cells: in space the mean over its breadth. Slow: -1, NaN; in the first step of
    // all: NaN.
    int32_t pad;
    double slip_length, slip_cells;
    double slip_before;   // the same of the whole contact: length, in space length^2
    double
        front_times[FRONT_STATIONS];   // rapid: when its front came to each station, from t_start
} Event;

typedef struct Events {
    double rate_start, rate_stop, rate_counts;   // velocity
    int32_t count, room;
    Event *list;   // [count] in order of their starts; owned
    int32_t kinds[EVENT_KIND_COUNT];   // counted, by kind
    int32_t rapid;   // index of the rapid event under way; -1: none
    int32_t slow;   // index of the quasi-static event under way; -1: none
    double trailing;   // x of the block's trailing end, length
    double front_before;   // front in the step seen before, length
    double mu_before;   // F_T/F_N in it; NaN: none was
    bool front_slips_before;   // some node up to it slipped
    bool began, ended, crossed;   // of a rapid event, in the step seen last; crossed: it became
        // leading in this step
    uint8_t *slipped;   // [contact_count] in the rapid event under way; owned
    double fast_front_start;   // where and when its fast front was first seen
    double fast_t_start;
    double fast_reach;   // on the pad where it began, length
    FrontPath path;   // of the rapid event under way
    double size;   // of the contact: length, in space length^2
    bool in_space;
    PadSum *pads, *pads_before;   // [pad_count] of the step seen last, and before it; owned
} Events;

// Part of the contact over which slip is rapid at least, and runs from a trailing end, in an event
// that counts as a bounded precursor.
extern const double LEAST_RAPID;

const char *event_name(EventKind kind);   // static storage
// Name of a kind as history.h5 stores it; "unknown": it is none. Static storage.
const char *event_words(double stored);

// rate_scale: the rod's velocity, or what else quasi-static slip goes at; rapid is twice that.
bool events_create(const Interface *interface, double rate_scale, Events *events, Error *err);
void events_destroy(Events *events);
bool events_record(void *self, const Observation *seen, Error *err);   // a Recorder
void events_close(Events *events, const Observation *last);   // ends what is under way
// Every node of pad p slipped in the rapid event that is under way, or that ended in this step.
bool events_pad_slid(const Events *events, const Interface *interface, int32_t p);

bool events_archive(Events *events, const Interface *interface, Archive *archive, Error *err);

#endif
