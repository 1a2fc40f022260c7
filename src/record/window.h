// SPDX-License-Identifier: GPL-2.0-or-later
// The part of a run that a scene wants written, output.window. A recorder that hands steps on to
// those inside of it while it is open.
#ifndef AMONTONS_RECORD_WINDOW_H
#define AMONTONS_RECORD_WINDOW_H

#include "base/archive.h"
#include "record/observation.h"

typedef struct WindowDef {
    bool given;   // else all of the run
    double from_U, to_U, from_t, to_t;   // length, time; to: INFINITY where not asked
} WindowDef;

typedef struct Window {
    WindowDef def;
    Recorders inside;
    int32_t steps;   // handed on inside
} Window;

bool window_record(void *self, const Observation *seen, Error *err);   // a Recorder
void window_archive(Window *window, Archive *archive);

#endif
