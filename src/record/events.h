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

#include "record/observation.h"

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

// --- the front of a rapid event -----------------------------------------------------------------

// How it runs along the contact: when slip first became faster than the event's threshold, node by
// node while it goes on, and at evenly spaced stations along the contact's line (contact/interface)
// once it is over. A front of slip that was slow before is a front of speeding up, and may run
// faster than any wave; ahead of where slow slip had come to it is a rupture. Between pads nothing
// slips: there is no station in a gap, and no speed across one.
enum { FRONT_STATIONS = 21 };   // from the first node of the line to the last, evenly spaced

// A place between two contact nodes one behind the other, or on one of them.
typedef struct FrontStation {
    int32_t node[2];   // the second the same where there is none behind the first
    double part;   // of the way to the next node, from 0 to 1
    int32_t pad;   // that it stands on; -1: in a gap
} FrontStation;

typedef struct FrontPath {
    double threshold;   // velocity
    double t_before;   // time of the step seen before
    double *rate_before;   // [contact_count] |slip rate| there; owned
    double *arrival;   // [contact_count] time, NaN: not yet; owned
    double spacing;   // of the stations, length
    FrontStation station[FRONT_STATIONS];
} FrontPath;

bool front_path_create(const Interface *interface, double threshold, FrontPath *path, Error *err);
void front_path_destroy(FrontPath *path);
void front_path_restart(const Interface *interface, FrontPath *path);   // nothing has arrived
// Takes in one accepted step; arrivals within it are found by linear interpolation of the rates.
void front_path_follow(FrontPath *path, const Observation *seen);
void front_path_keep(FrontPath *path, const Observation *seen);   // the step is the one before now

// Times after `origin` at which the front came to each station; NaN: never, or no contact there.
// Between nodes linear.
void front_path_stations(const FrontPath *path, double origin, double times[FRONT_STATIONS]);
// Velocity from station k to k + 1, below 0 towards the trailing edge; NaN: it did not pass both,
// or both at once, or they stand on different pads.
double front_path_speed(const FrontPath *path, const double times[FRONT_STATIONS], int32_t k);

// --- events -------------------------------------------------------------------------------------

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
