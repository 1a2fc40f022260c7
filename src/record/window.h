// SPDX-License-Identifier: GPL-2.0-or-later
// The part of a run that a scene wants written, output.window: from one place to another, around
// the n-th sliding, or the last slidings. A recorder that hands steps on to those inside of it
// while it is open. Where `around` and `last` lie is known only when they are past: run/rewind then
// takes the run back, and it goes through them again. Recorders outside see each step once.
#ifndef AMONTONS_RECORD_WINDOW_H
#define AMONTONS_RECORD_WINDOW_H

#include "record/events.h"

enum { WINDOW_SLIDINGS_MAX = 16 };   // of `last`: as many states are kept, and one more

typedef struct WindowDef {
    bool given;   // else all of the run
    double from_U, to_U, from_t, to_t;   // length, time; to: INFINITY where not asked
    int32_t around;   // number of a sliding, from 1; 0: not asked
    int32_t last;   // so many slidings; 0: not asked
} WindowDef;

typedef struct Window {
    WindowDef def;
    const Events *events;   // not owned
    Recorders inside, outside;
    int32_t steps;   // handed on inside
    // The fields below serve `around` and `last`.
    int32_t slidings;   // that have ended
    bool slides, ended;   // the rapid event under way is a sliding; one ended in the step seen last
    double before, onset;   // time of the step seen last; of the one before the rapid event
    bool found;   // it lies between these two times
    double begin, end;
    bool again;   // the run was taken back, and has yet to pass `furthest`, or has
    double furthest;   // time
} Window;

Window window_of(const WindowDef *def, const Events *events);
bool window_is_sought(const Window *window);   // around or last
bool window_record(void *self, const Observation *seen, Error *err);   // a Recorder

// The run ends with the step seen last. `last` begins at `begin`, where the scene's slidings are
// there; around a sliding that is not over ends with the run.
void window_close(Window *window, double begin);
// The run goes on from an earlier state, `seen`.
bool window_take_back(Window *window, const Observation *seen, Error *err);

void window_archive(Window *window, Archive *archive);

#endif
