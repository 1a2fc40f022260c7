// SPDX-License-Identifier: GPL-2.0-or-later
// Readings of an experiment in which the rod changes its velocity at once: velocity steps and
// slide-hold-slide. mu here is the friction of the contact, its shear over its normal force:
// F_T/F_N without the block's inertia, since on a rigid drive a jump is a blow. Slip is the mean of
// the contact.
//
//     direct effect   mu in the first step in which every node slides with the rod's new velocity,
//                     within 2 %, less the level before. (The largest mu of a jump is that of waves
//                     in the block.)
//     level           the middle of mu over the last quarter of a piece's slip, between two
//                     points of the program. Its error: all of the range there, and how far it
//                     moved from the quarter before, which holds if slip goes on for twice the
//                     slip distance
//     slip distance   from there on until 1/e of what mu still has to go to the new level is left
//     healing         the first peak of mu after a hold, less the level before the hold
//
// Errors add up what levels, velocities, slip so far and bins leave open. Only of a
// program that jumps (program_jumps); answers/program_results says what they come to.
#ifndef AMONTONS_RECORD_PROGRAM_READINGS_H
#define AMONTONS_RECORD_PROGRAM_READINGS_H

#include "contact/rod_course.h"
#include "record/observation.h"
#include "record/series.h"

enum { PROGRAM_BINS = 512, PROGRAM_READINGS_MAX = 64 };

typedef enum ReadingKind { READING_NONE, READING_STEP, READING_HOLD, READING_KINDS } ReadingKind;

typedef struct ProgramReading {
    int32_t kind;   // ReadingKind
    double t, U;   // of the jump (of a hold: when it ends), time, length
    double velocity_before, velocity;   // of the rod, velocity
    double duration;   // of a hold, time
    Estimate before, after;   // levels of mu; NaN: not steady
    Estimate peak;   // less `before`: direct effect, healing; NaN: not known
    Estimate distance;   // length; NaN: not known
} ProgramReading;

// Reference point that a level is compared with. After a velocity step it is the first step in
// which all of the contact has the rod's velocity; after a hold it is the first largest mu.
typedef struct ProgramTop {
    double mu, slip;   // slip since the jump, length; mu NaN: none yet
    double off;   // largest |ln(v/V)| of a node; of a hold: how far mu falls in the step behind
} ProgramTop;

// Steps between two points of the program, in bins of slip: as many as there is room for.
typedef struct ProgramPiece {
    ProgramReading reading;   // what began it
    bool level;   // the rod's velocity is the same in all of it
    double begins, ends;   // time
    double mu, slip;   // where it begins; mean slip since the start, length
    double width;   // of a bin, at least; length
    int32_t count;
    double at[PROGRAM_BINS], first[PROGRAM_BINS];   // slip and mu of a bin's first step
    double low[PROGRAM_BINS], high[PROGRAM_BINS];   // of mu in it
    ProgramTop top;
    bool fell;   // behind a hold's
} ProgramPiece;

typedef struct ProgramReadings {
    const RodCourse *course;   // not owned; NULL: nothing is read. Set at the start, all else 0
    bool started;   // the first step was seen
    double mu, slip, U, off;   // of the step seen last; off: as in ProgramTop
    ProgramPiece now;
    int32_t count;   // readings of pieces that are over; later ones are left out
    ProgramReading list[PROGRAM_READINGS_MAX];
} ProgramReadings;

bool program_jumps(const RodCourse *course);   // its velocity does, somewhere
bool program_readings_record(void *self, const Observation *seen, Error *err);   // a Recorder

// Number k of those that are over, and of the one under way. false: there are no more.
bool program_readings_at(const ProgramReadings *readings, int32_t k, ProgramReading *reading);
void program_readings_archive(ProgramReadings *readings, Archive *archive);

#endif
