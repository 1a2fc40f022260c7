// SPDX-License-Identifier: GPL-2.0-or-later
// Each accepted step is handed to recorders, in the order in which they were added. A recorder is
// whoever wants to see steps: events and peaks (which others read), history, fields, the caller.
#ifndef AMONTONS_RECORD_RECORDER_H
#define AMONTONS_RECORD_RECORDER_H

#include "record/observation.h"

typedef struct Recorder {
    void *self;   // not owned
    bool (*record)(void *self, const Observation *seen, Error *err);
} Recorder;

enum { RECORDERS_MAX = 8 };

typedef struct Recorders {
    int32_t count;
    Recorder list[RECORDERS_MAX];
} Recorders;

void recorders_add(Recorders *recorders, void *self,
                   bool (*record)(void *self, const Observation *seen, Error *err));
bool recorders_record(const Recorders *recorders, const Observation *seen, Error *err);

#endif
