// SPDX-License-Identifier: GPL-2.0-or-later
// Chooses a level of dt, tries it, and accepts a step only when
//   1. the contact problems of all its stages were solved,
//   2. the estimated local error is within tolerance,
//   3. numerics take or give no more energy than a part of what the run's ledger may miss (asked
//      of steps too long to resolve waves, and of the longest that resolves them),
//   4. one of these holds at its end state:
//      a. it is certified dissipative (stepping/certificate);
//      b. the step resolves waves (dt <= wave_step), and no single real rate of growth lies above
//         1/(gamma dt);
//      c. what oscillates stays small, as certified or as seen before
//         (stepping/oscillation_record), and nothing grows without oscillating.
// Otherwise it goes back to the old state with a shorter one. Used by run/start,
// run/simulation and the studies of stability and of the 1D model.
#ifndef AMONTONS_STEPPING_STEP_CONTROL_H
#define AMONTONS_STEPPING_STEP_CONTROL_H

#include "stepping/explicit_reference.h"
#include "stepping/half_step.h"
#include "stepping/sdirk.h"
#include "stepping/oscillation_record.h"

enum { STEPS_LOOKED = 20000 };   // an event takes some hundred; under a slow rod also 40000

typedef struct StepControlDef {
    double tolerance;   // of the local error of u in one step, length. The estimate is that error
        // to leading order where motion is smooth (stepping/tableau)
    double step_max;   // longest, time
    double relax_step;   // while relaxing steps may be so long, also where step_max is less, time
    double step_min;   // below it the run stops with an error, time
    double wave_step;   // largest step while not certified, time
    double watch_time;   // oscillations are resolved so long before they are stepped over, time; 0:
        // always
    double energy_tolerance;   // of the ledger, relative to what was turned over; 0: not asked
    double slip_per_mu;   // of friction that remembers: what an error of mu counts as, length
    bool use_certificate;   // off only to study what it prevents
} StepControlDef;

typedef struct StepCounters {
    int64_t accepted, rejected_error, rejected_energy, rejected_uncertified, unsolved;
    int64_t stepped_over_oscillations;   // accepted, longer than wave_step though not certified
} StepCounters;

typedef struct StepControl {
    StepControlDef def;
    DtLevels dt_levels;   // owned, like all that follows
    Sdirk scheme;
    Certificate certificate;   // of the whole contact
    HalfStep half;   // of its parts, where it is its own mirror image
    OscillationRecord oscillations;
    State now;   // the last accepted state
    State next;   // work
    EnergyLedger ledger;
    StepOutcome outcome;   // of the last accepted step
    double last_step;   // its length, time
    bool certified;   // `now` is dissipative
    bool antisymmetric_decays;   // its antisymmetric part cannot gain energy
    bool asymmetric;   // a problem was not its own mirror image: all are solved whole from then on
    bool grows;   // slip runs away in `now`: real growth rates stand on both sides of some level's
        // 1/(gamma dt); looked at when more nodes slip than ever since it was certified
    int32_t scanned;   // nodes that slipped then
    int32_t level;   // to try next; the larger the shorter is the step (stepping/dt_levels)
    int32_t coarsest;   // level of the longest step allowed
    bool settles;   // while the block relaxes: only the state in the end matters
    bool lands;   // steps end where `remaining` does, on levels made for it, down to an eighth of
        // the wave step
    int64_t looked_steps;   // accepted when step_control_gets_on looked last
    double looked_time;   // reached then
    StepCounters counters;
} StepControl;

bool step_control_create(const Block *block, const StepControlDef *def, StepControl *control,
                         Error *err);   // `control` must not be moved afterwards
void step_control_destroy(StepControl *control);

// One accepted step, at most `remaining` long if a level that is built already fits (so that a run
// ends where it should). ERROR_COMPUTE when even step_min is not accepted: the message says why.
bool step_control_advance(StepControl *control, double remaining, Error *err);

// True if a level that is built is at most `remaining` long: less time is not worth a new level.
bool step_control_fits(const StepControl *control, double remaining);

// Is called after each accepted step. ERROR_COMPUTE: at the pace of the last STEPS_LOOKED (of the
// whole run where these resolved waves, as an event does) the time `end` would take more than 1e8
// more: a state lets no step be accepted but very short ones, and does not change.
bool step_control_gets_on(StepControl *control, double end, Error *err);

// Explicit steps of one length in place of those that step_control_advance chooses; the levels of
// dt so far are freed. `scheme` is at `now`.
void step_control_use_explicit(StepControl *control, const ExplicitReference *scheme);
// Steps to the next whole multiple of `steps`, or less: to where slip is faster than `rate`, looked
// at as often as implicit steps would resolve waves.
bool step_control_advance_explicit(StepControl *control, ExplicitReference *scheme, int64_t steps,
                                   double rate, Error *err);

// Must be called when the drive has changed between two steps: waves are resolved again, and
// earlier records of oscillations no longer count.
void step_control_disturb(StepControl *control);

// Starts counting anew at `now`: time 0, ledger opened, coarse steps to be earned again.
void step_control_restart(StepControl *control);

// Before the rod moves the block settles under its load until nothing moves any more, by the steps
// that the run takes later; then t = 0.
typedef struct RelaxationDef {
    double speed_max;   // settled when every speed is below this, velocity
    double duration_max;   // ERROR_COMPUTE beyond it, time
    bool (*may_go_on)(const void *self, Error *err);   // asked after each step; NULL: it may
    const void *self;
} RelaxationDef;

// Steps `control` with the rod as it stands until it has settled; step_control_restart after it
// forbids again steps longer than step_max. steps: how many it took.
bool relax(StepControl *control, const RelaxationDef *def, int64_t *steps, Error *err);

// Everything on which the next step depends but what drives the block. `next` is work.
bool step_control_archive(StepControl *control, Archive *archive, Error *err);

#endif
